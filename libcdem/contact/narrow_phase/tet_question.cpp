#include "libcdem/contact/narrow_phase/tet_question.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"

#include <algorithm>
#include <limits>

namespace cdem {
namespace {

// Whether an old contact goes on: its pair may touch. One too far apart to be a pair is forgotten with other overlaps.
bool goes_on(const TetContacts& of, const Contact& c, bool forgets) {
  const int p = of.pair_of(static_cast<int>(c.source), c.target);
  return p >= 0 ? of.may_touch[p] != 0 : !forgets && c.reference_penetration > 0;
}

} // namespace

TetQuestion tet_question(const State& state, ContactWork& work) {
  TetContacts& of = *work.tet_contacts;
  find_awake(of.paths, of.near, of.awake);
  if (work.options.looks_at_all)
    for (std::size_t i = 0; i < of.near.count(); ++i)
      of.awake[i / contact_rows_per_chunk] |= std::uint64_t{1} << (i % contact_rows_per_chunk);
  TetQuestion question;
  question.asked.reserve(state.contacts.size());
  auto old = std::partition_point(state.contacts.begin(), state.contacts.end(),
                                  [](const Contact& c) { return c.kind != Contact::tets; });
  const auto tets_of = [](const Contact& c) { return std::pair<int, int>(c.source, c.target); };
  const bool forgets = forgets_overlaps(state, work);
  const auto keep_before = [&](const std::pair<int, int>& pair) {
    for (; old != state.contacts.end() && tets_of(*old) < pair; ++old)
      if ((of.fresh || forgets) && !goes_on(of, *old, forgets))
        question.ended.push_back(&*old);
      else
        question.asleep.emplace_back(question.asked.size(), &*old);
  };
  for (std::size_t word = 0; word < of.awake.size(); ++word)
    for (std::uint64_t bits = of.awake[word]; bits != 0; bits &= bits - 1) {
      const std::size_t near =
          word * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      const std::pair<int, int>& tets = of.tets_of_near[near];
      keep_before(tets);
      AskedPair asked{near};
      if (old != state.contacts.end() && tets_of(*old) == tets)
        asked.before = &*old++;
      question.asked.push_back(asked);
    }
  keep_before({std::numeric_limits<int>::max(), 0});
  return question;
}

} // namespace cdem
