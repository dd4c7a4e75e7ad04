#include "libcdem/bond/spring_kernel.hpp"

#include "libcdem/bond/interface_turn.hpp"
#include "libcdem/joint/spring_law.hpp"

namespace cdem {
namespace {

using simd::Oct;
using Triples = Triple<Oct>;
using Mask = decltype(Oct{} < Oct{});

// Part of its strength below which no spring breaks, whatever the rounding; above it the law of one spring decides.
constexpr double margin = 0.98;
constexpr int numbers = 9; // of a rotation

CDEM_INLINE Triples load(const double (&p)[3][lanes]) {
  return {simd::load(p[0]), simd::load(p[1]), simd::load(p[2])};
}

CDEM_INLINE Triples gather(const Node* nodes, const int (&index)[lanes]) {
  const simd::Vec v = simd::gather(nodes, index);
  return {v.x, v.y, v.z};
}

// x, y, z of eight triples of numbers that follow each other.
CDEM_INLINE Triples load_triples(const geom::Vec3* from) {
  const double* const p = from->data();
  Triples t{};
  for (int lane = 0; lane < lanes; ++lane) {
    t.x[lane] = p[3 * lane];
    t.y[lane] = p[3 * lane + 1];
    t.z[lane] = p[3 * lane + 2];
  }
  return t;
}

CDEM_INLINE void store_triples(geom::Vec3* to, const Triples& t) {
  double* const p = to->data();
  for (int lane = 0; lane < lanes; ++lane) {
    p[3 * lane] = t.x[lane];
    p[3 * lane + 1] = t.y[lane];
    p[3 * lane + 2] = t.z[lane];
  }
}

CDEM_INLINE bool any(const Mask& mask) {
  const auto four =
      __builtin_shufflevector(mask, mask, 0, 1, 2, 3) | __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return (four[0] | four[1] | four[2] | four[3]) != 0;
}

CDEM_INLINE unsigned bits(const Mask& mask) {
  unsigned bits = 0;
  for (int lane = 0; lane < lanes; ++lane)
    bits |= static_cast<unsigned>(mask[lane] != 0) << lane;
  return bits;
}

CDEM_INLINE TurnedSide<Oct> side_of(const Node* u, const int (&node)[3][lanes],
                                    const double (&edge)[2][3][lanes], const double (&along)[2][lanes]) {
  const Triples u0 = gather(u, node[0]);
  return {load(edge[0]) + (gather(u, node[1]) - u0), load(edge[1]) + (gather(u, node[2]) - u0),
          simd::load(along[0]), simd::load(along[1])};
}

CDEM_INLINE void rotation_kernel(const FrameBatch* batches, std::int64_t count, const Node* u, double* to) {
  for (std::int64_t i = 0; i < count; ++i, to += numbers * lanes) {
    const FrameBatch& f = batches[i];
    const Rotation<Oct> r =
        rotation_of(side_of(u, f.node_a, f.edge_a, f.along_a), side_of(u, f.node_b, f.edge_b, f.along_b),
                    Axes<Oct>{load(f.axes[0]), load(f.axes[1]), load(f.axes[2])});
    const Triples column[3] = {r.x, r.y, r.z};
    for (int lane = 0; lane < lanes; ++lane)
      for (int k = 0; k < 3; ++k) {
        to[numbers * lane + 3 * k] = column[k].x[lane];
        to[numbers * lane + 3 * k + 1] = column[k].y[lane];
        to[numbers * lane + 3 * k + 2] = column[k].z[lane];
      }
  }
}

CDEM_INLINE Rotation<Oct> rotations_of(const SpringBatch& batch, const SpringsOfBatch& springs) {
  Triples column[3] = {};
  for (int lane = 0; lane < lanes; ++lane) {
    const double* const r = springs.rotation + numbers * (batch.interface[lane] - springs.first_interface);
    for (int k = 0; k < 3; ++k) {
      column[k].x[lane] = r[3 * k];
      column[k].y[lane] = r[3 * k + 1];
      column[k].z[lane] = r[3 * k + 2];
    }
  }
  return {column[0], column[1], column[2]};
}

CDEM_INLINE Triples jumps_of(const SpringBatches& all, const SpringBatch& batch, const Node* u) {
  if (batch.ends < 0)
    return gather(u, batch.node_b) - gather(u, batch.node_a);
  const SpringEnds& ends = all.ends[static_cast<std::size_t>(batch.ends)];
  Triples j{};
  for (int k = 0; k < 3; ++k)
    j = j + (simd::load(ends.weight_b[k]) * gather(u, ends.node_b[k]) -
             simd::load(ends.weight_a[k]) * gather(u, ends.node_a[k]));
  return j;
}

CDEM_INLINE void spring_kernel(const SpringBatches& all, const SpringBatch& batch,
                               const SpringsOfBatch& given, unsigned& left, double& friction) {
  const SpringsOfBatch springs = given;
  const bool turns = batch.turns && springs.rotation;
  Rotation<Oct> rotation{};
  Triples j = jumps_of(all, batch, springs.displacement);
  if (batch.apart >= 0)
    j = j + load(all.apart[static_cast<std::size_t>(batch.apart)].apart);
  if (turns) {
    rotation = rotations_of(batch, springs);
    j = turned_back(rotation, j);
  }
  const Triples n = load(batch.normal), offset = load_triples(springs.offset), stretch = j - offset;
  const Oct kn = simd::load(batch.kn), ks = simd::load(batch.ks), tan = simd::load(batch.tan_friction);
  const Oct open = dot(stretch, n);
  const Triples shear = stretch - open * n;
  const Oct normal_force = kn * open, shear2 = ks * ks * dot(shear, shear);
  Mask contact{};
  for (int lane = 0; lane < lanes; ++lane)
    contact[lane] = springs.mode[lane] == static_cast<std::uint8_t>(BondMode::intact) ? 0 : -1;
  Mask leaves{};
  if (springs.breaking) {
    const Oct strength = shear_strength<Oct>(margin * simd::load(batch.cohesion), margin * tan, normal_force);
    leaves = ~contact & ((normal_force >= margin * simd::load(batch.tensile_strength)) | (strength <= Oct{}) |
                         (shear2 >= strength * strength));
  }
  left = bits(leaves);
  Triples force = normal_force * n + ks * shear;
  if (any(contact)) {
    const Oct one = Oct{} + 1.0;
    HeldByContact<Oct> held = held_by_contact<Oct>(kn, ks, tan, open, root(dot(shear, shear)));
    held = {contact ? held.normal : one, contact ? held.shear : one};
    const Triples slip = (one - held.shear) * shear;
    if (any((held.shear < one) & ~leaves)) {
      const Triples before = load_triples(springs.force), shear_before = before - dot(before, n) * n;
      const Triples shear_after = (held.shear * ks) * shear;
      const Oct lost = 0.5 * dot(shear_before + shear_after, slip);
      for (int lane = 0; lane < lanes; ++lane)
        if (contact[lane] != 0)
          friction += lost[lane];
      store_triples(springs.offset, offset + slip);
    }
    force = (held.normal * normal_force) * n + (held.shear * ks) * shear;
  }
  if (left != 0) { // their forces of the step before are still asked for
    const Triples before = load_triples(springs.force);
    force = {leaves ? before.x : force.x, leaves ? before.y : force.y, leaves ? before.z : force.z};
  }
  store_triples(springs.force, force);
  if (springs.acting)
    store_triples(springs.acting, turns ? turned(rotation, force) : force);
}

} // namespace

void interface_rotations(const SpringBatches& batches, Range frames, const Node* displacement,
                         double* rotation) {
  simd::best<rotation_kernel>(batches.frames.data() + frames.begin, frames.size(), displacement, rotation);
}

unsigned plain_springs(const SpringBatches& all, const SpringBatch& batch, const SpringsOfBatch& springs,
                       double& friction) {
  unsigned left = 0;
  simd::best<spring_kernel>(all, batch, springs, left, friction);
  return left;
}

} // namespace cdem
