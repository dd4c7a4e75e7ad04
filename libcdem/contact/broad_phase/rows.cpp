#include "libcdem/contact/broad_phase/rows.hpp"

#include "libcdem/contact/broad_phase/rigid_pairs.hpp"

#include <algorithm>
#include <tuple>

namespace cdem {
namespace {

class RowMaker {
public:
  RowMaker(const Model& model, const ContactWork& work, const SearchMargin& margins, Contact::Kind kind,
           const Renewed& renewed)
      : surface_(model.surface), work_(work), margins_(margins), kind_(kind), renewed_(renewed) {}

  std::size_t sources() const {
    return kind_ == Contact::spring ? surface_.triangles.size() : work_.edges.all.size();
  }

  // By source; the targets of each by group and number.
  void sort(const std::vector<std::vector<Near>>& parts) {
    begin_.assign(sources() + 1, 0);
    for (const std::vector<Near>& part : parts)
      for (const Near& near : part)
        ++begin_[near.source + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i)
      begin_[i] += begin_[i - 1];
    found_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const std::vector<Near>& part : parts)
      for (const Near& near : part)
        found_[next[near.source]++] = {near.target, near.springs, 0};
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
      std::sort(found_.begin() + begin_[i], found_.begin() + begin_[i + 1],
                [&](const ContactCandidate& a, const ContactCandidate& b) {
                  return std::pair(group(a.target), +a.target) < std::pair(group(b.target), +b.target);
                });
  }

  // The rows that stay, and what was found, by source and group.
  void merge(const std::vector<ContactRow>& rows, const std::vector<ContactCandidate>& candidates) {
    rows_.reserve(rows.size());
    candidates_.reserve(found_.size() + candidates.size());
    auto row = rows.begin();
    for (int source = 0; source < static_cast<int>(sources()); ++source) {
      std::uint32_t first = begin_[source];
      const auto add_found = [&](auto until) { // those of groups before this one
        while (first < begin_[source + 1] && until(group(found_[first].target)))
          first = add(source, first);
      };
      for (; row != rows.end() && source_now(*row) <= source; ++row)
        if (source_now(*row) == source && stays(*row, candidates)) {
          const auto before = group(kept_.front().target);
          add_found([&](const Group& g) { return g < before; });
          keep(*row, source);
        }
      add_found([](const Group&) { return true; });
    }
  }

  void take(std::vector<ContactRow>& rows, std::vector<ContactCandidate>& candidates) {
    candidates_.shrink_to_fit();
    rows = std::move(rows_);
    candidates = std::move(candidates_);
  }

private:
  using Group = std::pair<int, int>;

  int triangle(bool edge, int i) const { return edge ? work_.edges.all[i].triangles[0] : i; }
  int source_triangle(int i) const { return triangle(kind_ == Contact::edge, i); }
  int block(std::uint32_t target) const {
    return surface_.triangles[source_triangle(static_cast<int>(target))].block;
  }
  int mover(int i) const { return work_.movers.of_triangle[source_triangle(i)]; }
  Group group(std::uint32_t target) const {
    const int fragment = work_.movers.fragment_of_triangle[source_triangle(static_cast<int>(target))];
    return {kind_ == Contact::spring ? 0 : block(target), fragment};
  }
  bool renumbered() const { return kind_ == Contact::edge && !renewed_.edge_now.empty(); }
  // The last that stays, where this one does not: rows stand by their sources.
  int source_now(const ContactRow& row) const {
    return renumbered() ? renewed_.edge_now[row.source] : row.source;
  }

  // Fills kept_ with what stays of its targets.
  bool stays(const ContactRow& row, const std::vector<ContactCandidate>& candidates) {
    kept_.clear();
    const bool of_pair = row.pair >= 0;
    if (of_pair ? renewed_.pair_now[row.pair] < 0 : renewed_.all)
      return false;
    if (kind_ == Contact::spring) { // all its targets are of one fragment
      const ContactCandidate* const first = candidates.data() + row.begin;
      const auto target = static_cast<int>(first->target);
      if (of_pair || !is_renewed(row.source, target))
        kept_.assign(first, first + row.count);
      return !kept_.empty();
    }
    const auto is_renewed = [&](int edge) {
      return !of_pair && (renewed_.movers[mover(edge)] || renewed_.edges[edge]);
    };
    if (is_renewed(source_now(row)))
      return false;
    for (std::uint32_t i = row.begin; i < row.begin + row.count; ++i) {
      ContactCandidate candidate = candidates[i];
      if (renumbered()) {
        const int now = renewed_.edge_now[candidate.target];
        if (now < 0)
          continue;
        candidate.target = static_cast<std::uint32_t>(now) & last_contact_triangle;
      }
      if (!is_renewed(static_cast<int>(candidate.target)))
        kept_.push_back(candidate);
    }
    return !kept_.empty();
  }
  bool is_renewed(int source, int target) const { // triangles
    return renewed_.movers[mover(source)] || renewed_.movers[mover(target)] ||
           work_.movers.changed[source] == Change::surface || renewed_.surfaced[mover(target)];
  }

  void keep(ContactRow row, int source) {
    row.source = source;
    if (row.pair >= 0)
      row.pair = renewed_.pair_now[row.pair];
    place(row, kept_.data(), static_cast<std::uint32_t>(kept_.size()));
  }

  // The row that begins with this one of those found; returns where the next begins.
  std::uint32_t add(int source, std::uint32_t first) {
    std::uint32_t end = first;
    while (end < begin_[source + 1] && group(found_[end].target) == group(found_[first].target))
      ++end;
    ContactRow row;
    row.source = source;
    row.block = block(found_[first].target);
    const int own = mover(source), other = mover(static_cast<int>(found_[first].target));
    row.pair = number_of(work_.rigid_pairs.all, own, other);
    if (kind_ == Contact::edge)
      row.reach =
          static_cast<float>(margins_.known(surface_.triangles[source_triangle(source)].block, row.block) +
                             (row.pair >= 0 ? work_.rigid_pairs.all[row.pair].skin
                                            : margins_.allowed()[own] + margins_.allowed()[other]));
    place(row, &found_[first], end - first);
    return end;
  }

  void place(ContactRow row, const ContactCandidate* targets, std::uint32_t count) {
    row.source_mover = mover(row.source);
    row.mover = mover(static_cast<int>(targets->target));
    row.several_movers = std::any_of(targets, targets + count, [&](const ContactCandidate& target) {
      return mover(static_cast<int>(target.target)) != row.mover;
    });
    row.begin = static_cast<std::uint32_t>(candidates_.size());
    row.count = count;
    candidates_.insert(candidates_.end(), targets, targets + count);
    rows_.push_back(row);
  }

  const ContactSurface& surface_;
  const ContactWork& work_;
  const SearchMargin& margins_;
  Contact::Kind kind_;
  const Renewed& renewed_;
  std::vector<std::uint32_t> begin_; // per source, into found_
  std::vector<ContactCandidate> found_, kept_, candidates_;
  std::vector<ContactRow> rows_;
};

// Rows of rigid pairs, by pair.
void sort_by_pair(std::vector<ContactRow>& rows, std::size_t n_pairs, RowsOfPairs& of_pairs) {
  of_pairs.begin.assign(n_pairs + 1, 0);
  for (const ContactRow& row : rows)
    if (row.pair >= 0)
      ++of_pairs.begin[row.pair + 1];
  for (std::size_t p = 0; p < n_pairs; ++p)
    of_pairs.begin[p + 1] += of_pairs.begin[p];
  of_pairs.row.resize(of_pairs.begin.back());
  of_pairs.until.resize(of_pairs.begin.back());
  std::vector<int> next(of_pairs.begin.begin(), of_pairs.begin.end() - 1);
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (ContactRow& row = rows[r]; row.pair >= 0) {
      row.place = next[row.pair]++;
      of_pairs.row[row.place] = static_cast<int>(r);
      of_pairs.until[row.place] = row.recheck_distance;
    }
}

} // namespace

void make_rows(const Model& model, ContactWork& work, const SearchMargin& margins,
               const std::vector<std::vector<Near>>& parts, Contact::Kind kind, const Renewed& renewed) {
  RowMaker maker(model, work, margins, kind, renewed);
  maker.sort(parts);
  std::vector<ContactRow>& rows = work.rows[kind].all;
  maker.merge(rows, work.rows[kind].candidates);
  maker.take(rows, work.rows[kind].candidates);
  RowsAsleep& asleep = work.rows[kind].asleep;
  asleep.recheck_distance.resize(rows.size());
  asleep.source_mover.resize(rows.size());
  asleep.mover.resize(rows.size());
  asleep.hindered.assign((rows.size() + contact_rows_per_chunk - 1) / contact_rows_per_chunk, 0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    asleep.recheck_distance[r] = rows[r].pair >= 0        ? std::numeric_limits<float>::infinity()
                                 : rows[r].several_movers ? 0
                                                          : rows[r].recheck_distance;
    asleep.hindered[r / contact_rows_per_chunk] |= static_cast<std::uint64_t>(rows[r].hindered)
                                                   << (r % contact_rows_per_chunk);
    asleep.source_mover[r] = rows[r].source_mover;
    asleep.mover[r] = rows[r].mover;
  }
  sort_by_pair(rows, work.rigid_pairs.all.size(), asleep.of_pairs);
}

} // namespace cdem
