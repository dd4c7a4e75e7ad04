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
  int block(int i) const { return surface_.triangles[source_triangle(i)].block; }
  Group group(std::uint32_t target) const {
    const int fragment = work_.fragments.of_triangle[source_triangle(static_cast<int>(target))];
    return {kind_ == Contact::spring ? 0 : block(static_cast<int>(target)), fragment};
  }
  // By how much the numbers of a block's edges are larger now; 0 for triangles.
  int shift(int block) const {
    return kind_ == Contact::edge && !renewed_.edge_shift.empty() ? renewed_.edge_shift[block] : 0;
  }
  int source_now(const ContactRow& row) const { return row.source + shift(row.source_block); }

  // Fills kept_ with its targets, if it does.
  bool stays(const ContactRow& row, const std::vector<ContactCandidate>& candidates) {
    kept_.clear();
    if (row.pair >= 0 ? renewed_.pair_now[row.pair] < 0
                      : renewed_.all || renewed_.blocks[row.source_block] || renewed_.blocks[row.block])
      return false;
    kept_.assign(candidates.begin() + row.begin, candidates.begin() + row.begin + row.count);
    for (ContactCandidate& candidate : kept_)
      candidate.target = static_cast<std::uint32_t>(static_cast<int>(candidate.target) + shift(row.block)) &
                         last_contact_triangle;
    return true;
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
    row.source_block = block(source);
    row.block = block(static_cast<int>(found_[first].target));
    row.pair = number_of(work_.rigid_pairs.all, row.source_block, row.block);
    if (kind_ == Contact::edge)
      row.reach = static_cast<float>(
          margins_.known(row.source_block, row.block) +
          (row.pair >= 0 ? work_.rigid_pairs.all[row.pair].skin
                         : work_.travel.skin[row.source_block] + work_.travel.skin[row.block]));
    place(row, &found_[first], end - first);
    return end;
  }

  void place(ContactRow row, const ContactCandidate* targets, std::uint32_t count) {
    row.fragment = work_.fragments.number_of_triangle[source_triangle(static_cast<int>(targets->target))];
    row.several_blocks = std::any_of(targets, targets + count, [&](const ContactCandidate& target) {
      return block(static_cast<int>(target.target)) != row.block;
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
  asleep.source_block.resize(rows.size());
  asleep.block.resize(rows.size());
  asleep.hindered.assign((rows.size() + contact_rows_per_chunk - 1) / contact_rows_per_chunk, 0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    asleep.recheck_distance[r] = rows[r].pair >= 0        ? std::numeric_limits<float>::infinity()
                                 : rows[r].several_blocks ? 0
                                                          : rows[r].recheck_distance;
    asleep.hindered[r / contact_rows_per_chunk] |= static_cast<std::uint64_t>(rows[r].hindered)
                                                   << (r % contact_rows_per_chunk);
    asleep.source_block[r] = rows[r].source_block;
    asleep.block[r] = rows[r].block;
  }
  sort_by_pair(rows, work.rigid_pairs.all.size(), asleep.of_pairs);
}

} // namespace cdem
