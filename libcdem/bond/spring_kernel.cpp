#include "libcdem/bond/spring_kernel.hpp"

#include "libcdem/bond/interface_turn.hpp"
#include "libcdem/joint/spring_law.hpp"

#include <algorithm>

namespace cdem {
namespace {

using simd::Mask;
using simd::Oct;
using Triples = Triple<Oct>;

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
  Oct a, b, c;
  std::memcpy(&a, from->data(), sizeof a);
  std::memcpy(&b, from->data() + lanes, sizeof b);
  std::memcpy(&c, from->data() + 2 * lanes, sizeof c);
  const Oct x = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0),
            y = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0),
            z = __builtin_shufflevector(a, b, 2, 5, 8, 11, 14, 0, 0, 0);
  return {__builtin_shufflevector(x, c, 0, 1, 2, 3, 4, 5, 10, 13),
          __builtin_shufflevector(y, c, 0, 1, 2, 3, 4, 8, 11, 14),
          __builtin_shufflevector(z, c, 0, 1, 2, 3, 4, 9, 12, 15)};
}

CDEM_INLINE void store_triples(geom::Vec3* to, const Triples& t) {
  const Oct a = __builtin_shufflevector(t.x, t.y, 0, 8, 0, 1, 9, 0, 2, 10),
            b = __builtin_shufflevector(t.x, t.y, 0, 3, 11, 0, 4, 12, 0, 5),
            c = __builtin_shufflevector(t.x, t.y, 13, 0, 6, 14, 0, 7, 15, 0);
  const Oct out[3] = {__builtin_shufflevector(a, t.z, 0, 1, 8, 3, 4, 9, 6, 7),
                      __builtin_shufflevector(b, t.z, 10, 1, 2, 11, 4, 5, 12, 7),
                      __builtin_shufflevector(c, t.z, 0, 13, 2, 3, 14, 5, 6, 15)};
  std::memcpy(to->data(), out, sizeof out);
}

CDEM_INLINE unsigned bits(const Mask& mask) {
  unsigned bits = 0;
  if (!simd::any(mask))
    return bits;
  for (int lane = 0; lane < lanes; ++lane)
    bits |= static_cast<unsigned>(mask[lane] != 0) << lane;
  return bits;
}

CDEM_INLINE bool all_intact(const std::uint8_t* mode) {
  static_assert(static_cast<int>(BondMode::intact) == 0 && lanes == sizeof(std::uint64_t));
  std::uint64_t modes = 0;
  std::memcpy(&modes, mode, sizeof modes);
  return modes == 0;
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
                               const SpringsOfBatch& given, unsigned& left, SpringSpent& spent) {
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
  int place[lanes];
  for (int lane = 0; lane < lanes; ++lane)
    place[lane] = 2 * batch.interface[lane];
  const simd::Four normal = simd::gather_four(&all.interfaces.front().normal, place),
                   stiffness = simd::gather_four(&all.interfaces.front().stiffness, place);
  const Oct area = simd::load(batch.area), tan = normal.w;
  const Triples n = {normal.x, normal.y, normal.z}, offset = load_triples(springs.offset),
                before = load_triples(springs.force);
  const SpringStretch<Oct> stretch = parts_of<Oct>(j - offset, n);
  const Oct kn = stiffness.x * area, ks = stiffness.y * area, length2 = dot(stretch.shear, stretch.shear);
  const Oct normal_force = kn * stretch.open, shear2 = ks * ks * length2;
  Mask contact{};
  if (!all_intact(springs.mode))
    for (int lane = 0; lane < lanes; ++lane)
      contact[lane] = is_intact(springs.mode[lane]) ? 0 : -1;
  Mask leaves{};
  if (springs.breaking) {
    const Oct strength =
        shear_strength<Oct>(unbreakable_part * (area * stiffness.w), unbreakable_part * tan, normal_force);
    leaves =
        ~contact & (simd::at_most<Oct>(unbreakable_part * (area * stiffness.z), normal_force) |
                    simd::at_most<Oct>(strength, Oct{}) | simd::at_most<Oct>(strength * strength, shear2));
  }
  left = bits(leaves);
  const Oct none{}, one = none + 1.0;
  HeldByContact<Oct> held{one, one};
  Triples viscous{};
  if (simd::any(contact)) {
    const ContactsInTime in_time = springs.contacts ? *springs.contacts : ContactsInTime();
    geom::Vec3* const dashpots = in_time.viscous ? in_time.viscous + springs.first : nullptr;
    Triples rate{};
    Oct along{};
    if (dashpots) {
      const Triples rates = jumps_of(all, batch, in_time.velocity);
      rate = turns ? turned_back(rotation, rates) : rates;
      const Oct of_contact =
          viscous_along<Oct>(none + in_time.contact_damping, kn, dot(rate, n), normal_force);
      along = contact & ~leaves ? of_contact : none;
    }
    Oct felt = along;
    if (springs.contacts) {
      double *const usual_force = in_time.usual_force + springs.first, *const rested_for =
                                                                           in_time.rested + springs.first;
      Oct passed;
      for (int lane = 0; lane < lanes; ++lane)
        passed[lane] = std::min(1.0, in_time.damping_step * in_time.rest_rate[batch.interface[lane]]);
      const Oct usual_before = simd::load_wide<Oct>(usual_force),
                rested_before = simd::load_wide<Oct>(rested_for);
      Oct usual = usual_before, rested = rested_before;
      felt = felt_beside<Oct>(normal_force, along, passed, usual, rested);
      simd::store_wide<Oct>(usual_force, contact ? usual : usual_before);
      simd::store_wide<Oct>(rested_for, contact ? rested : rested_before);
    }
    held = held_by_contact<Oct>(kn, ks, tan, stretch.open, root(length2), felt);
    held = {contact ? held.normal : one, contact ? held.shear : one};
    const Mask slips = simd::below<Oct>(held.shear, one);
    if (simd::any(slips & ~leaves)) {
      const Triples slip = (one - held.shear) * stretch.shear;
      const Oct lost = lost_by_slip<Oct>(ks, n, stretch, held, before, slip);
      for (int lane = 0; lane < lanes; ++lane)
        if (contact[lane] != 0)
          spent.friction += lost[lane];
      store_triples(springs.offset, offset + slip);
    }
    if (dashpots) {
      const Mask here = contact & ~leaves, press = here & simd::below<Oct>(normal_force, none);
      const Triples viscous_before = load_triples(dashpots),
                    across = viscous_across<Oct>(
                        none + in_time.contact_damping, ks, n, rate,
                        friction_left<Oct>(ks, tan, normal_force + felt, root(length2)), press & ~slips);
      viscous = along * n + across;
      const Oct lost = (0.5 * in_time.damping_step) * dot(viscous_before + viscous, rate);
      for (int lane = 0; lane < lanes; ++lane)
        if (here[lane] != 0)
          spent.damping += lost[lane];
      store_triples(dashpots, chosen(here, viscous, viscous_before));
    }
  }
  // The forces of the step before are still asked for where springs leave.
  const Triples force = chosen(leaves, before, spring_force<Oct>(kn, ks, n, stretch, held));
  store_triples(springs.force, force);
  if (springs.acting)
    store_triples(springs.acting, turns ? turned(rotation, force + viscous) : force + viscous);
}

} // namespace

void interface_rotations(const SpringBatches& batches, Range frames, const Node* displacement,
                         double* rotation) {
  simd::best<rotation_kernel>(batches.frames.data() + frames.begin, frames.size(), displacement, rotation);
}

unsigned plain_springs(const SpringBatches& all, const SpringBatch& batch, const SpringsOfBatch& springs,
                       SpringSpent& spent) {
  unsigned left = 0;
  simd::best<spring_kernel>(all, batch, springs, left, spent);
  return left;
}

} // namespace cdem
