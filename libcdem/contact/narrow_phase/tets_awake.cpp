#include "libcdem/contact/narrow_phase/tets_awake.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"
#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/narrow_phase/rows_asleep.hpp"
#include "libcdem/parallel/chunks.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// A pair that may move by less than this share of what it was allowed at its last check is checked again.
constexpr double worth_while = 0.05;
constexpr std::int64_t tets_per_chunk = 64;

bool sleeps_on(const ContactWork& work, TetPairs& pairs, std::size_t p) {
  const PairMotion& motion = pairs.motion[p];
  if (motion.allowed <= 0)
    return false;
  const int a = pairs.a[p], b = pairs.b[p];
  const double left = motion.allowed - gone_since(work, a, b, motion.drifts, motion.swings);
  if (left < worth_while * motion.allowed)
    return false;
  pairs.until[p] = rounded_down(work.travelled[a] + work.travelled[b] + left);
  return true;
}

TetPlanes planes_now(const Model& model, const State& state, const TetShape& shape) {
  TetPlanes planes;
  for (int i = 0; i < 4; ++i)
    planes.x[i] = place_of(model, state, shape.nodes[i]);
  for (int k = 0; k < 4; ++k) {
    const auto& corners = shape.corners[k];
    planes.normal[k] = unit_normal({planes.x[corners[0]], planes.x[corners[1]], planes.x[corners[2]]});
  }
  return planes;
}

void find_contact_begin(const Model& model, const State& state, TetPairs& pairs) {
  pairs.contact_begin.assign(model.surface.triangles.size() + 1, 0);
  for (const Contact& c : state.contacts) {
    if (c.kind != Contact::spring)
      break;
    ++pairs.contact_begin[c.source / 3 + 1];
  }
  for (std::size_t t = 1; t < pairs.contact_begin.size(); ++t)
    pairs.contact_begin[t] += pairs.contact_begin[t - 1];
}

} // namespace

void find_tets_awake(const Model& model, const State& state, ContactWork& work, int threads) {
  if (!work.tet_pairs || work.tet_pairs->count() == 0)
    return;
  TetPairs& pairs = *work.tet_pairs;
  find_awake(work.travelled.data(), pairs.until.data(), pairs.a.data(), pairs.b.data(), pairs.count(),
             pairs.awake.data());
  if (work.looks_at_all)
    for (std::size_t p = 0; p < pairs.count(); ++p)
      if (pairs.until[p] < std::numeric_limits<float>::infinity())
        pairs.awake[p / contact_rows_per_chunk] |= std::uint64_t{1} << (p % contact_rows_per_chunk);
  for (const int m : pairs.movers_awake)
    pairs.in_awake[m] = 0;
  pairs.movers_awake.clear();
  const auto add = [&](int m) {
    if (!pairs.in_awake[m])
      pairs.movers_awake.push_back(m);
    pairs.in_awake[m] = 1;
  };
  for (std::size_t word = 0; word < pairs.awake.size(); ++word)
    for (std::uint64_t bits = pairs.awake[word]; bits != 0; bits &= bits - 1) {
      const std::size_t p = word * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      if (!work.looks_at_all && sleeps_on(work, pairs, p)) {
        pairs.awake[word] ^= bits & -bits;
        continue;
      }
      add(pairs.a[p]);
      add(pairs.b[p]);
    }
  const auto n = static_cast<std::int64_t>(pairs.movers_awake.size());
  for_chunks((n + tets_per_chunk - 1) / tets_per_chunk, threads, [&](std::int64_t chunk) {
    for (std::int64_t i = chunk * tets_per_chunk; i < std::min(n, (chunk + 1) * tets_per_chunk); ++i) {
      const int m = pairs.movers_awake[i];
      pairs.now[m] = planes_now(model, state, pairs.shape[m]);
    }
  });
  find_contact_begin(model, state, pairs);
}

void fall_asleep(const ContactWork& work, TetPairs& pairs, std::size_t p, double until) {
  const int a = pairs.a[p], b = pairs.b[p];
  PairMotion& motion = pairs.motion[p];
  motion.allowed = rounded_down(until);
  pairs.until[p] = until > 0 ? rounded_down(work.travelled[a] + work.travelled[b] + until) : 0;
  if (until <= 0)
    return;
  motion.swings = static_cast<float>(work.swing[a] + work.swing[b]);
  for (int axis = 0; axis < 3; ++axis)
    motion.drifts[axis] = static_cast<float>(work.drift[b][axis] - work.drift[a][axis]);
}

void order_found(std::size_t n_triangles, TetPairs& pairs) {
  std::vector<int> begin(n_triangles + 1, 0);
  for (const ContactChunk& chunk : pairs.found)
    for (const Contact& c : chunk.contacts)
      ++begin[c.source / 3 + 1];
  for (std::size_t t = 1; t < begin.size(); ++t)
    begin[t] += begin[t - 1];
  pairs.ordered.resize(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  const auto contact = [&](const PlaceOfFound& at) -> const Contact& {
    return pairs.found[at.chunk].contacts[at.number];
  };
  for (std::size_t chunk = 0; chunk < pairs.found.size(); ++chunk)
    for (std::size_t i = 0; i < pairs.found[chunk].contacts.size(); ++i) {
      const auto t = pairs.found[chunk].contacts[i].source / 3;
      int place = next[t]++; // those of one triangle are few
      for (; place > begin[t] &&
             order_of(pairs.found[chunk].contacts[i]) < order_of(contact(pairs.ordered[place - 1]));
           --place)
        pairs.ordered[place] = pairs.ordered[place - 1];
      pairs.ordered[place] = {static_cast<int>(chunk), static_cast<int>(i)};
    }
}

} // namespace cdem
