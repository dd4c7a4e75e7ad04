#include "libcdem/contact/narrow_phase/rows_asleep.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"
#include "libcdem/parallel/instruction_set.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Marks the rows that do not sleep.
CDEM_INLINE void awake_kernel(const double* travelled, const RowsAsleep& rows, std::uint64_t* awake) {
  const auto count = static_cast<std::int64_t>(rows.mover.size());
  const float* const recheck = rows.recheck_distance.data();
  const int *const source = rows.source_mover.data(), *const mover = rows.mover.data();
  for (std::int64_t begin = 0; begin < count; begin += contact_rows_per_chunk) {
    const std::int64_t end = std::min(count, begin + contact_rows_per_chunk);
    std::uint64_t bits = 0;
    for (std::int64_t r = begin; r < end; ++r)
      bits |= static_cast<std::uint64_t>(travelled[source[r]] + travelled[mover[r]] >= recheck[r])
              << (r - begin);
    *awake++ = bits;
  }
}

// Edges that sleep only as long as no contact stands around.
void wake_hindered(const ContactWork& work, RowsAsleep& rows) {
  for (std::size_t chunk = 0; chunk < rows.hindered.size(); ++chunk)
    for (std::uint64_t bits = rows.hindered[chunk]; bits != 0; bits &= bits - 1) {
      const std::size_t r = chunk * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      if (work.mover_edges_touched[rows.source_mover[r]] && work.mover_edges_touched[rows.mover[r]])
        rows.awake[chunk] |= bits & -bits;
    }
}

void wake_all(RowsAsleep& rows) {
  const std::size_t count = rows.mover.size();
  for (std::size_t chunk = 0; chunk < rows.awake.size(); ++chunk)
    rows.awake[chunk] = ~std::uint64_t{0} >> (contact_rows_per_chunk -
                                              std::min<std::size_t>(contact_rows_per_chunk,
                                                                    count - chunk * contact_rows_per_chunk));
}

} // namespace

void find_awake(const ContactWork& work, RowsAsleep& rows) {
  rows.awake.resize((rows.mover.size() + contact_rows_per_chunk - 1) / contact_rows_per_chunk);
  simd::best<awake_kernel>(work.travelled.data(), rows, rows.awake.data());
  wake_hindered(work, rows);
  if (work.looks_at_all)
    wake_all(rows);
}

bool sleeps_on(const ContactWork& work, const ContactRow& row, float& recheck_distance) {
  if (row.allowed <= 0)
    return false;
  constexpr double worth_while = 0.05; // of what it was allowed
  const double left = row.allowed - gone_since(work, row.source_mover, row.mover, row.drifts, row.swings);
  if (left < worth_while * row.allowed)
    return false;
  recheck_distance = rounded_down(work.travelled[row.source_mover] + work.travelled[row.mover] + left);
  return true;
}

void fall_asleep(const ContactWork& work, int blocks, ContactRow& row, float& recheck_distance) {
  recheck_distance = row.recheck_distance;
  const int a = row.source_mover, b = row.mover;
  row.allowed = 0;
  if (a < blocks || b < blocks)
    return;
  const double left = row.recheck_distance - work.travelled[a] - work.travelled[b];
  if (left <= 0 || std::isinf(left))
    return;
  row.allowed = rounded_down(left);
  row.swings = static_cast<float>(work.swing[a] + work.swing[b]);
  for (int axis = 0; axis < 3; ++axis)
    row.drifts[axis] = static_cast<float>(work.drift[b][axis] - work.drift[a][axis]);
}

} // namespace cdem
