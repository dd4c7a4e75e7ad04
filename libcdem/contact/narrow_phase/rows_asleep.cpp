#include "libcdem/contact/narrow_phase/rows_asleep.hpp"

#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/parallel/instruction_set.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

CDEM_INLINE void awake_kernel(const double* travelled, const float* recheck, const int* source,
                              const int* block, std::int64_t count, std::uint64_t* awake) {
  for (std::int64_t begin = 0; begin < count; begin += contact_rows_per_chunk) {
    const std::int64_t end = std::min(count, begin + contact_rows_per_chunk);
    std::uint64_t bits = 0;
    for (std::int64_t r = begin; r < end; ++r)
      bits |= static_cast<std::uint64_t>(travelled[source[r]] + travelled[block[r]] >= recheck[r])
              << (r - begin);
    *awake++ = bits;
  }
}

void wake(RowsAsleep& rows, std::size_t row) {
  rows.awake[row / contact_rows_per_chunk] |= std::uint64_t{1} << (row % contact_rows_per_chunk);
}

// Wakes those of a pair that are due. Returns until when none is, m of what it has moved; 0: one has been woken.
double wake_due(const RigidPair& pair, std::size_t p, RowsAsleep& rows) {
  const RowsOfPairs& of_pairs = rows.of_pairs;
  bool any = false;
  float next = std::numeric_limits<float>::infinity();
  for (int i = of_pairs.begin[p]; i < of_pairs.begin[p + 1]; ++i)
    if (pair.moved >= of_pairs.until[i]) {
      wake(rows, of_pairs.row[i]);
      any = true;
    } else {
      next = std::min(next, of_pairs.until[i]);
    }
  return any ? 0 : next;
}

// Semi-springs of two blocks that a plane parts touch nothing. Rows of edges tell by their fans.
void wake_pair(const Model& model, const State& state, ContactWork& work, std::size_t p) {
  RigidPair& pair = work.rigid_pairs.all[p];
  update_motion(work.rigid_pairs, pair);
  if (pair.moved >= pair.next[Contact::spring]) {
    const double apart = parted_by(model, state, work, pair);
    pair.next[Contact::spring] =
        apart > 0 ? pair.from + apart : wake_due(pair, p, work.rows[Contact::spring].asleep);
  }
  if (pair.moved >= pair.next[Contact::edge])
    pair.next[Contact::edge] = wake_due(pair, p, work.rows[Contact::edge].asleep);
  const double left = std::min(pair.next[0], pair.next[1]) - pair.moved;
  pair.look_at = left > 0 ? path_of(work.rigid_pairs, pair) + left : 0;
}

// Edges that sleep only as long as no contact stands around.
void wake_hindered(ContactWork& work, RowsAsleep& rows) {
  for (std::size_t chunk = 0; chunk < rows.hindered.size(); ++chunk)
    for (std::uint64_t bits = rows.hindered[chunk]; bits != 0; bits &= bits - 1) {
      const std::size_t r = chunk * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      if (!work.edges_touched.blocks[rows.source_block[r]] || !work.edges_touched.blocks[rows.block[r]])
        continue;
      rows.awake[chunk] |= bits & -bits;
      if (const int p = work.rows[Contact::edge].all[r].pair; p >= 0) {
        RigidPair& pair = work.rigid_pairs.all[p];
        update_motion(work.rigid_pairs, pair);
        pair.next[Contact::edge] = pair.look_at = 0; // it may sleep less long than before
      }
    }
}

void wake_all(RowsAsleep& rows) {
  const std::size_t count = rows.block.size();
  for (std::size_t chunk = 0; chunk < rows.awake.size(); ++chunk)
    rows.awake[chunk] = ~std::uint64_t{0} >> (contact_rows_per_chunk -
                                              std::min<std::size_t>(contact_rows_per_chunk,
                                                                    count - chunk * contact_rows_per_chunk));
}

} // namespace

void find_awake(const Model& model, const State& state, ContactWork& work) {
  for (ContactRows& of_kind : work.rows) {
    RowsAsleep& rows = of_kind.asleep;
    rows.awake.resize((rows.block.size() + contact_rows_per_chunk - 1) / contact_rows_per_chunk);
    // Those of which the two blocks have travelled by the recheck distance together: a bit each.
    simd::best<awake_kernel>(work.travel.travelled.data(), rows.recheck_distance.data(),
                             rows.source_block.data(), rows.block.data(),
                             static_cast<std::int64_t>(rows.block.size()), rows.awake.data());
  }
  for (std::size_t p = 0; p < work.rigid_pairs.all.size(); ++p)
    if (work.options.looks_at_all ||
        path_of(work.rigid_pairs, work.rigid_pairs.all[p]) >= work.rigid_pairs.all[p].look_at)
      wake_pair(model, state, work, p);
  for (ContactRows& rows : work.rows) {
    wake_hindered(work, rows.asleep);
    if (work.options.looks_at_all)
      wake_all(rows.asleep);
  }
}

} // namespace cdem
