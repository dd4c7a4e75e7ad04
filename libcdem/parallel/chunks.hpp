// Work split into chunks whose number depends on the model only, never on the threads: a sum over chunks in order has
// the same bits for every thread count.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace cdem {

struct Range {
  std::int64_t begin = 0, end = 0;
  std::int64_t size() const { return end - begin; }
};

// [0, n) in pieces of about `grain`, at least one piece when n > 0.
inline std::vector<Range> split(std::int64_t n, std::int64_t grain) {
  std::vector<Range> ranges;
  for (std::int64_t begin = 0; begin < n; begin += grain)
    ranges.push_back({begin, std::min(n, begin + grain)});
  return ranges;
}

// body(chunk) for every chunk, on `threads` threads; one barrier at the end.
template <class Body>
void for_chunks(std::int64_t chunks, [[maybe_unused]] int threads, const Body& body) {
#ifdef _OPENMP // seen without it only by those that include this header and never call
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1 && chunks > 1)
#endif
  for (std::int64_t chunk = 0; chunk < chunks; ++chunk)
    body(chunk);
}

// The same for these chunks.
template <class Body>
void for_chunks(Range chunks, int threads, const Body& body) {
  for_chunks(chunks.size(), threads, [&](std::int64_t i) { body(chunks.begin + i); });
}

} // namespace cdem
