#include "libcdem/fracture/faces_to_look_at.hpp"

#include "libcdem/parallel/simd.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cdem {
namespace {

// Places of the two tets of faces among the stresses, of eight faces, and what is left of their strength; lanes from `count`
// on repeat the last one.
struct SlotsOfFaces {
  int count = 0;
  int face[lanes];
  SlotsOfTets tets;
  double left[lanes];
};

// Whether the mean stress of the two tets of each face is beyond a bound: a bit each.
CDEM_INLINE void beyond_kernel(const SlotsOfFaces* eights, std::size_t count, const StressBatch* stress,
                               const UtilisationBound* bounds, std::size_t bound_count,
                               std::uint8_t* beyond) {
  using simd::Oct;
  for (std::size_t i = 0; i < count; ++i) {
    const SlotsOfFaces& at = eights[i];
    Oct s[6];
    for (int c = 0; c < 6; ++c)
      for (int lane = 0; lane < lanes; ++lane)
        s[c][lane] = 0.5 * (stress[at.tets.a[lane] / lanes].component[c][at.tets.a[lane] % lanes] +
                            stress[at.tets.b[lane] / lanes].component[c][at.tets.b[lane] % lanes]);
    for (Oct& component : s)
      component /= simd::load(at.left);
    unsigned bits = 0;
    for (std::size_t k = 0; k < bound_count; ++k)
      if (simd::any(simd::below<Oct>(Oct{}, bounds[k].coarsely_beyond(s))))
        bits |= simd::bits_of(simd::below<Oct>(Oct{}, bounds[k].beyond(s)));
    beyond[i] = static_cast<std::uint8_t>(bits);
  }
}

// A bit for each face of the batch beside a tet that may be at its strength.
unsigned faces_near(const SlotsOfTets& at, const NearStrength& near) {
  static_assert(NearStrength::may_crack == 1);
  unsigned bits = 0;
  for (int lane = 0; lane < lanes; ++lane)
    bits |= ((near.bits[at.a[lane] / lanes] | near.bits[at.b[lane] / lanes]) & NearStrength::may_crack)
            << lane;
  return bits;
}

// A bit for each face of the batch whose springs may use the rest of what `due_at` leaves to its tets.
unsigned faces_pulled(const NearStrength& near, std::int64_t batch, double harmless) {
  const double most = (1 - due_at) * harmless / most_of_traction;
  unsigned bits = 0;
  for (int lane = 0; lane < lanes; ++lane)
    bits |= static_cast<unsigned>(near.pull2[batch * lanes + lane] > most * most) << lane;
  return bits;
}

void add_slots(int face, const SlotsOfTets& at, double left, std::vector<SlotsOfFaces>& near) {
  if (near.empty() || near.back().count == lanes)
    near.emplace_back();
  SlotsOfFaces& last = near.back();
  last.face[last.count] = face;
  last.tets.a[last.count] = at.a[face % lanes];
  last.tets.b[last.count] = at.b[face % lanes];
  last.left[last.count++] = left;
}

// Those of the faces whose stress is beyond a bound.
void add_beyond(const FacesOfChunk& of, std::vector<SlotsOfFaces>& near, std::vector<int>& faces) {
  thread_local std::vector<std::uint8_t> beyond;
  if (near.empty())
    return;
  SlotsOfFaces& last = near.back();
  for (int lane = last.count; lane < lanes; ++lane) {
    last.tets.a[lane] = last.tets.a[last.count - 1];
    last.tets.b[lane] = last.tets.b[last.count - 1];
    last.left[lane] = last.left[last.count - 1];
  }
  beyond.resize(near.size());
  const std::vector<UtilisationBound>& bounds = of.watch.strength_bounds(of.index);
  simd::best<beyond_kernel>(near.data(), near.size(), of.state.stress.data(), bounds.data(), bounds.size(),
                            beyond.data());
  for (std::size_t i = 0; i < near.size(); ++i)
    each_lane(beyond[i], [&](int lane) {
      if (lane < near[i].count)
        faces.push_back(near[i].face[lane]);
    });
}

} // namespace

std::vector<int> faces_to_look_at(const FacesOfChunk& of, const LoadedFacets& facets,
                                  const NearStrength& near_strength) {
  thread_local std::vector<SlotsOfFaces> near;
  thread_local std::vector<int> cracking;
  near.clear();
  cracking.clear();
  std::vector<int> faces;
  const std::int64_t first = of.number(0);
  const double harmless = of.watch.harmless_stress(of.index);
  // Some faces may have a plane of their own.
  const bool has_joints = !of.body.bonding.everywhere || !of.body.region_laws.joints.empty();
  for (int begin = 0; begin < of.chunk.faces; begin += lanes) {
    const std::int64_t batch = of.batch(begin);
    const FaceStateBatch& state = of.state.faces[batch];
    const SlotsOfTets& slots = of.watch.slots_at(batch);
    const unsigned used = (1u << std::min(of.chunk.faces - begin, lanes)) - 1,
                   resumed = faces_in(state, FaceStage::resumed),
                   hold = (faces_in(state, FaceStage::holding) | resumed) & used;
    each_lane(faces_in(state, FaceStage::cracking) & used, [&](int lane) {
      __builtin_prefetch(&of.state.cohesive[first + begin + lane].damage);
      cracking.push_back(begin + lane);
    });
    const unsigned pulled = has_joints ? faces_pulled(near_strength, batch, harmless) | resumed : 0;
    each_lane(hold != 0 ? hold & (faces_near(slots, near_strength) | pulled) : 0, [&](int lane) {
      const int face = begin + lane;
      if (facets.contain(face))
        return;
      const bool resumes = (resumed >> lane & 1u) != 0;
      const double pull =
          has_joints ? most_of_traction * std::sqrt(near_strength.pull2[first + face]) / harmless : 0;
      const double left = (resumes ? 1 - damage_of(of.state.cohesive[first + face]) : 1) - pull;
      // The bounds of a curve are not in proportion to what is left.
      if (!(left > 0) || (resumes && of.rock(face).curve.on()))
        faces.push_back(face);
      else
        add_slots(face, slots, left, near);
    });
  }
  std::copy_if(cracking.begin(), cracking.end(), std::back_inserter(faces),
               [&](int face) { return may_end(of.state.cohesive[first + face]); });
  std::copy_if(facets.faces().begin(), facets.faces().end(), std::back_inserter(faces),
               [&](int face) { return holds(of.stage(face)); });
  add_beyond(of, near, faces);
  std::sort(faces.begin(), faces.end());
  return faces;
}

} // namespace cdem
