#include "libcdem/bond/spring_forces.hpp"

#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/interface_turn.hpp"
#include "libcdem/bond/spring_kernel.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>

namespace cdem {
namespace {

CDEM_INLINE geom::Vec3 jump_at(const BondPoint& p, const Node* u) {
  if (p.one_to_one)
    return vec(u[p.node_b[0]]) - vec(u[p.node_a[0]]);
  geom::Vec3 j = geom::Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    j += p.weight_b[k] * vec(u[p.node_b[k]]) - p.weight_a[k] * vec(u[p.node_a[k]]);
  return j;
}

CDEM_INLINE geom::Vec3 jump_at(const Model& model, std::int64_t p, const Node* u) {
  const geom::Vec3 j = jump_at(model.points[p], u);
  return model.point_apart.empty() ? j : geom::Vec3(j + model.point_apart[p]);
}

// A bond that softens, up to its separation; a contact from the next step on.
void softening_spring(const BondPoint& point, State& state, BondWork& work, std::int64_t p,
                      const geom::Vec3& stretch, SpringSums& sums, bool grows) {
  const SofteningLaw& law = work.softening[point.interface];
  const geom::Vec3 before = work.stretch[p];
  work.stretch[p] = stretch;
  double& damage = state.bond_damage[p];
  const Triple<double> normal = triple(point.normal), slip = triple(state.bond_slip[p]);
  const SofteningResponse<double> r =
      softening_response<double>(law, normal, triple(stretch), damage, slip, grows);
  const geom::Vec3 traction = vec(r.traction);
  work.spring_force[p] = point.area * traction;
  if (r.damage == 0)
    return;
  const SofteningLoss<double> loss =
      softening_loss<double>(law, normal, triple(before), damage, slip, triple(stretch), r);
  sums.friction += point.area * loss.friction;
  sums.breaking += point.area * loss.breaking;
  if (r.damage > damage) {
    sums.losses.push_back({point.interface, {}});
    sums.losses.back().energy.add(point.area * loss.breaking,
                                  shear_share<double>(law, normal, triple(stretch)));
  }
  damage = r.damage;
  state.bond_slip[p] = vec(r.slip);
  if (r.separated) {
    const BondMode mode = mode_of(r);
    state.bond_mode[p] = static_cast<std::uint8_t>(mode);
    state.bond_offset[p] += vec(r.slip);
    state.bond_slip[p].setZero();
    const double normal_traction = traction.dot(point.normal);
    sums.broken.push_back(
        {static_cast<int>(p), mode, normal_traction, (traction - normal_traction * point.normal).norm()});
  }
}

// N, of a spring that is a contact: what its dashpot adds to its normal force, and what friction feels beside that force.
struct BesideNormal {
  double viscous = 0, felt = 0;
};

// A spring whose joint has a law, broken or never bonded; broke: just now. What it loses is the work of its own traction
// by the trapezoidal rule less the change of what it stores.
void law_spring(const BondPoint& point, State& state, BondWork& work, std::int64_t p,
                const geom::Vec3& jump_now, bool broke, const BesideNormal& beside, SpringSums& sums) {
  const InterfaceLaw& own = work.laws[point.interface];
  JointHistory& history = state.joint_history[p];
  geom::Vec3& offset = state.bond_offset[p];
  const geom::Vec3 traction_before = work.spring_force[p] / point.area, stretch_before = work.stretch[p],
                   jump_before = stretch_before + offset;
  const double stored_before =
      broke ? stored_in_spring(own.spring.kn, own.spring.ks, point.normal, traction_before)
            : joint_stored(*own.law, own.spring, point.normal, stretch_before, history.parted);
  const JointResponse r =
      joint_response(*own.law, own.spring, point.normal, jump_now, offset, history,
                     {-beside.viscous / point.area, (beside.felt - beside.viscous) / point.area});
  const geom::Vec3 stretch = jump_now - r.offset;
  const double lost =
      0.5 * (traction_before + r.traction).dot(jump_now - jump_before) -
      (joint_stored(*own.law, own.spring, point.normal, stretch, r.history.parted) - stored_before);
  offset = r.offset;
  history = r.history;
  work.stretch[p] = stretch;
  work.spring_force[p] = point.area * r.traction;
  if (!broke) {
    sums.friction += point.area * lost;
    return;
  }
  sums.breaking += point.area * lost;
  sums.losses.push_back({point.interface, {}});
  sums.losses.back().energy.add(
      point.area * lost, state.bond_mode[p] == static_cast<std::uint8_t>(BondMode::broken_shear) ? 1 : 0);
}

// One spring at the relative displacement j of its two sides, in undeformed directions. special: some joint of the
// model softens or has a law; a model of plain brittle bonds pays nothing for the others.
template <bool special>
CDEM_INLINE void update_spring(const BondPoint& point, const Interface& interface, State& state,
                               BondWork& work, std::int64_t p, const geom::Vec3& j, SpringSums& sums,
                               bool breaking, const BesideNormal& beside) {
  const geom::Vec3& n = point.normal;
  const SpringStrength& strength = work.strength[point.interface];
  const geom::Vec3 stretch = j - state.bond_offset[p];
  const SpringStretch<double> parts = parts_of(triple(stretch), triple(n));
  const double open = parts.open;
  const geom::Vec3 shear = vec(parts.shear);
  bool broke = false;
  if (is_intact(state.bond_mode[p])) {
    if constexpr (special)
      if (!work.softening.empty() && work.softening[point.interface].softens) {
        softening_spring(point, state, work, p, stretch, sums, breaking && interface.may_break);
        return;
      }
    if (breaking && interface.may_break) {
      const double normal_traction = interface.kn * open, shear_traction = interface.ks * shear.norm();
      const BondMode mode = breaks(strength, normal_traction, shear_traction);
      broke = mode != BondMode::intact;
      if (broke) {
        state.bond_mode[p] = static_cast<std::uint8_t>(mode);
        sums.broken.push_back({static_cast<int>(p), mode, normal_traction, shear_traction});
      }
    }
    if (!broke) {
      work.spring_force[p] =
          vec(spring_force<double>(point.kn_area, point.ks_area, triple(n), parts, {1, 1}));
      if constexpr (special)
        if (!work.laws.empty())
          work.stretch[p] = stretch;
      return;
    }
  }
  if constexpr (special)
    if (!work.laws.empty() && work.laws[point.interface].law) {
      law_spring(point, state, work, p, j, broke, beside, sums);
      return;
    }
  // Contact: the spring was never bonded or has broken, at the latest just now.
  const HeldByContact<double> held =
      held_by_contact<double>(point.kn_area, point.ks_area, strength.tan_friction, open,
                              root(dot(parts.shear, parts.shear)), beside.felt);
  const Triple<double> slip = (1 - held.shear) * parts.shear;
  const geom::Vec3 before = work.spring_force[p];
  if (held.shear < 1)
    state.bond_offset[p] += vec(slip);
  work.spring_force[p] = vec(spring_force(point.kn_area, point.ks_area, triple(n), parts, held));
  if (!broke) {
    sums.friction += lost_by_slip(point.ks_area, triple(n), parts, held, triple(before), slip);
    return;
  }
  const geom::Vec3 after = work.spring_force[p], normal_before = before.dot(n) * n,
                   normal_after = after.dot(n) * n;
  const double taken = lost_energy(point.ks_area, before - normal_before, after - normal_after, shear) +
                       lost_energy(point.kn_area, normal_before, normal_after, open * n);
  sums.breaking += taken;
  sums.losses.push_back({point.interface, {}});
  sums.losses.back().energy.add(
      taken, state.bond_mode[p] == static_cast<std::uint8_t>(BondMode::broken_shear) ? 1 : 0);
}

// N, what water does to side a: it pushes the faces apart.
geom::Vec3 water_force(const State& state, const BondPoint& point, std::int64_t p) {
  if (state.water_pressure.empty())
    return geom::Vec3::Zero();
  return -state.water_pressure[p] * point.area * point.normal;
}

// What the springs of a chunk share.
struct SpringsOfChunk {
  const Model& model;
  State& state;
  BondWork& work;
  SpringSums& sums;
  bool breaking, acts_otherwise, damped, advances; // advances: the means of contacts, in time
};

// Relative displacement at which the contact in a spring carries nothing, m.
geom::Vec3 contact_offset(const State& state, std::int64_t p) {
  return state.bond_slip.empty() ? state.bond_offset[p] : state.bond_offset[p] + state.bond_slip[p];
}

// Stiffness damping of the springs of an interface, s: a bond has that of its joint, a contact at least what the step asks
// for.
double damping_of_joint(const BondWork& work, int interface) {
  return work.damping.empty() ? 0 : work.damping[interface];
}
double damping_of_contact(const BondWork& work, int interface) {
  return std::max(damping_of_joint(work, interface), work.contact_damping);
}

// Part of the time of means that passes in a step.
double passed_of_means(const BondWork& work, int interface) {
  return std::min(1.0, work.damping_step * work.rest_rate[interface]);
}

// rate: m/s, of its stretch; zero without dashpots. Advances the means that friction follows.
template <bool special>
BesideNormal beside_normal(const SpringsOfChunk& c, std::int64_t p, const geom::Vec3& rate,
                           const geom::Vec3& stretch) {
  const BondPoint& point = c.model.points[p];
  const BondWork& work = c.work;
  if (is_intact(c.state.bond_mode[p]))
    return {};
  const Triple<double> n = triple(point.normal);
  const double open = dot(triple(stretch), n);
  double normal_force = point.kn_area * open;
  if constexpr (special)
    if (!work.laws.empty() && work.laws[point.interface].law) {
      const InterfaceLaw& own = work.laws[point.interface];
      normal_force =
          -point.area * joint_pressure(*own.law, own.spring, open, c.state.joint_history[p].parted);
    }
  const double viscous = c.damped ? viscous_along<double>(damping_of_contact(work, point.interface),
                                                          point.kn_area, dot(triple(rate), n), normal_force)
                                  : 0;
  return {viscous, felt_beside<double>(normal_force, viscous, passed_of_means(work, point.interface),
                                       c.state.usual_force[p], c.state.rested[p])};
}

// Stiffness damping of a spring that holds or presses, beside its own force, N, in undeformed directions. A damaged bond is
// a bond, and a contact with its share D. rate: m/s, of its stretch; j: m, its relative displacement; offset_before:
// contact_offset before this step; beside: beside_normal before this step.
template <bool special>
geom::Vec3 viscous_force(const SpringsOfChunk& c, std::int64_t p, const geom::Vec3& rate, const geom::Vec3& j,
                         const geom::Vec3& offset_before, const BesideNormal& beside) {
  const BondPoint& point = c.model.points[p];
  const BondWork& work = c.work;
  const double of_joint = damping_of_joint(work, point.interface),
               beta = damping_of_contact(work, point.interface), kn = point.kn_area, ks = point.ks_area;
  const Triple<double> n = triple(point.normal);
  const auto viscous = [&](double viscous_normal, double left, bool sticks) {
    return geom::Vec3(viscous_normal * point.normal +
                      vec(viscous_across<double>(beta, ks, n, triple(rate), left, sticks)));
  };
  if constexpr (special)
    if (!is_intact(c.state.bond_mode[p]) && !work.laws.empty() && work.laws[point.interface].law) {
      const InterfaceLaw& own = work.laws[point.interface];
      const geom::Vec3& force = work.spring_force[p];
      const double normal_force = force.dot(point.normal),
                   pressure = std::max(0.0, -(normal_force + beside.felt) / point.area),
                   strength = joint_strength(*own.law, own.spring, pressure, c.state.joint_history[p].path),
                   shear = (force - normal_force * point.normal).norm();
      return viscous(beside.viscous, std::max(0.0, point.area * strength - shear),
                     normal_force < 0 && c.state.bond_offset[p] == offset_before);
    }
  const auto of_bond = [&](double share) {
    const double part = share * of_joint;
    return vec(spring_force<double>(part * kn, part * ks, n, parts_of(triple(rate), n), {1, 1}));
  };
  const double broken = broken_share(c.state, p);
  if (broken == 0)
    return of_bond(1);
  const SpringStretch<double> parts = parts_of(triple(geom::Vec3(j - offset_before)), n);
  const double tan = work.strength[point.interface].tan_friction,
               length = root(dot(parts.shear, parts.shear)), normal_force = kn * parts.open;
  // The friction of the contact of a bond that softens is that of its law.
  const double along = broken < 1 ? viscous_along<double>(beta, kn, dot(triple(rate), n), normal_force)
                                  : beside.viscous,
               in_friction = broken < 1 ? 0 : beside.felt;
  const geom::Vec3 of_contact = viscous(
      along, friction_left<double>(ks, tan, normal_force + in_friction, length),
      normal_force < 0 && !(held_by_contact<double>(kn, ks, tan, parts.open, length, in_friction).shear < 1));
  return broken == 1 ? of_contact : of_bond(1 - broken) + broken * of_contact;
}

// One spring of any kind; rotation: of its interface.
template <bool special>
void one_spring(const SpringsOfChunk& c, std::int64_t p, const geom::Mat3& rotation) {
  const BondPoint& point = c.model.points[p];
  const Interface& interface = c.model.interfaces[point.interface];
  State& state = c.state;
  BondWork& work = c.work;
  const Node* const u = state.displacement.data();
  if (released(state, interface)) {
    work.spring_force[p].setZero();
    work.acting_force[p].setZero();
    if (!state.water_pressure.empty() && state.water_pressure[p] > 0)
      work.acting_force[p] = rotation * water_force(state, point, p);
    return;
  }
  const Rotation<double> turn{triple(rotation.col(0)), triple(rotation.col(1)), triple(rotation.col(2))};
  const geom::Vec3 offset_before = contact_offset(state, p),
                   j = vec(turned_back(turn, triple(jump_at(c.model, p, u))));
  const geom::Vec3 rate = c.damped ? vec(turned_back(turn, triple(jump_at(point, state.velocity.data()))))
                                   : geom::Vec3(geom::Vec3::Zero());
  const BesideNormal beside =
      c.advances ? beside_normal<special>(c, p, rate, j - offset_before) : BesideNormal();
  update_spring<special>(point, interface, state, work, p, j, c.sums, c.breaking, beside);
  if (!c.acts_otherwise)
    return;
  geom::Vec3 acting = work.spring_force[p] + water_force(state, point, p);
  if (c.damped) {
    // Damping takes in a step the mean of its forces before and after it, times the motion.
    geom::Vec3& viscous = work.viscous[p];
    const geom::Vec3 before = viscous;
    viscous = viscous_force<special>(c, p, rate, j, offset_before, beside);
    acting += viscous;
    c.sums.damping += (0.5 * work.damping_step) * dot(triple(before + viscous), triple(rate));
  }
  work.acting_force[p] = vec(turned(turn, triple(acting)));
}

bool some_released(const Model& model, const State& state, const SpringBatch& batch) {
  if (!batch.turns)
    return false;
  for (int lane = 0; lane < batch.count; ++lane)
    if (released(state, model.interfaces[batch.interface[lane]]))
      return true;
  return false;
}

// Turned interfaces of a chunk, worked out eight at a time.
struct Rotations {
  std::vector<double> numbers; // nine of each, column by column
  int first = 0;               // interface

  void work_out(const SpringBatches& batches, Range interfaces, const Node* displacement) {
    const Range frames{interfaces.begin / lanes, (interfaces.end + lanes - 1) / lanes};
    first = static_cast<int>(frames.begin * lanes);
    numbers.resize(static_cast<std::size_t>(frames.size() * lanes * 9));
    interface_rotations(batches, frames, displacement, numbers.data());
  }
  geom::Mat3 of(int interface) const {
    return Eigen::Map<const geom::Mat3>(numbers.data() + 9 * (interface - first));
  }
};

// What the next chunk reads that none before it has read.
ReadAhead reads_of(const SpringsOfChunk& c, std::int64_t chunk) {
  ReadAhead ahead;
  if (chunk >= static_cast<std::int64_t>(c.model.point_chunks.size()))
    return ahead;
  const Range points = c.model.point_chunks[chunk], nodes = c.work.batches.nodes[chunk];
  const std::int64_t first = c.work.batches.first[chunk];
  ahead.add(c.state.displacement.data() + nodes.begin, nodes.size());
  ahead.add(c.work.batches.springs.data() + first, c.work.batches.first[chunk + 1] - first);
  ahead.add(c.state.bond_offset.data() + points.begin, points.size());
  ahead.add(c.work.spring_force.data() + points.begin, points.size());
  return ahead;
}

template <bool special>
void forces_of_springs(std::int64_t chunk, const SpringsOfChunk& c) {
  thread_local Rotations rotations;
  const Range range = c.model.point_chunks[chunk];
  State& state = c.state;
  const SpringBatches& batches = c.work.batches;
  const bool turns = !batches.frames.empty();
  const std::vector<char>& idle = c.work.idle.batch;
  if (!idle.empty() && std::find(idle.begin() + batches.first[chunk], idle.begin() + batches.first[chunk + 1],
                                 char{0}) == idle.begin() + batches.first[chunk + 1])
    return;
  if (turns)
    rotations.work_out(batches,
                       {c.model.points[range.begin].interface, c.model.points[range.end - 1].interface + 1},
                       state.displacement.data());
  const bool plain = state.water_pressure.empty() && !(c.damped && !c.work.damping.empty());
  const ContactsInTime contacts{c.work.rest_rate.data(),
                                state.usual_force.data(),
                                state.rested.data(),
                                c.work.contact_damping,
                                c.work.damping_step,
                                state.velocity.data(),
                                c.damped ? c.work.viscous.data() : nullptr};
  ReadAhead ahead = reads_of(c, chunk + 1);
  ahead.spread(batches.first[chunk + 1] - batches.first[chunk]);
  std::int64_t p = range.begin;
  for (std::int64_t b = batches.first[chunk]; b < batches.first[chunk + 1]; ++b) {
    const SpringBatch& batch = batches.springs[b];
    if (!idle.empty() && idle[b]) {
      p += batch.count;
      ahead.some();
      continue;
    }
    unsigned one_by_one = (1u << batch.count) - 1;
    if (plain && batch.plain && batch.count == lanes && !some_released(c.model, state, batch)) {
      SpringsOfBatch springs;
      springs.displacement = state.displacement.data();
      springs.rotation = turns ? rotations.numbers.data() : nullptr;
      springs.first_interface = rotations.first;
      springs.mode = state.bond_mode.data() + p;
      springs.offset = state.bond_offset.data() + p;
      springs.force = c.work.spring_force.data() + p;
      springs.acting = c.acts_otherwise ? c.work.acting_force.data() + p : nullptr;
      springs.breaking = c.breaking;
      springs.contacts = c.advances ? &contacts : nullptr;
      springs.first = p;
      SpringSpent spent{c.sums.friction, c.sums.damping};
      one_by_one = plain_springs(batches, batch, springs, spent);
      c.sums.friction = spent.friction;
      c.sums.damping = spent.damping;
    }
    for (int lane = 0; one_by_one != 0; ++lane, one_by_one >>= 1u)
      if (one_by_one & 1u) {
        const int interface = batch.interface[lane];
        const bool turned = c.model.interfaces[interface].frame >= 0;
        one_spring<special>(c, p + lane,
                            turned ? rotations.of(interface) : geom::Mat3(geom::Mat3::Identity()));
      }
    p += batch.count;
    ahead.some();
  }
}

} // namespace

geom::Vec3 jump(const Model& model, const std::vector<Node>& displacement, int point) {
  return jump_at(model, point, displacement.data());
}

double broken_share(const State& state, std::int64_t p) {
  return !is_intact(state.bond_mode[p]) ? 1 : state.bond_damage.empty() ? 0 : state.bond_damage[p];
}

bool released(const State& state, const Interface& interface) {
  return interface.frame >= 0 && state.released[interface.frame] != 0;
}

void spring_forces(const Model& model, State& state, BondWork& work, std::int64_t chunk, bool breaking) {
  SpringSums& sums = work.sums[chunk];
  sums.friction = sums.breaking = sums.damping = 0;
  sums.broken.clear();
  sums.losses.clear();
  const SpringsOfChunk springs{model,
                               state,
                               work,
                               sums,
                               breaking,
                               !work.acting_force.empty(),
                               work.damping_step > 0 && !work.viscous.empty(),
                               work.damping_step > 0};
  if (state.bond_damage.empty() && state.joint_history.empty())
    forces_of_springs<false>(chunk, springs);
  else
    forces_of_springs<true>(chunk, springs);
}

double catch_up(const Model& model, State& state, BondWork& work, const Interface& interface) {
  SpringSums sums;
  const SpringsOfChunk springs{model, state, work, sums, false, !work.acting_force.empty(), false, false};
  const bool special = !state.bond_damage.empty() || !state.joint_history.empty();
  const geom::Mat3 rotation = interface_rotation(model, state.displacement.data(), interface);
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    special ? one_spring<true>(springs, p, rotation) : one_spring<false>(springs, p, rotation);
  return sums.friction;
}

void start_spring_forces(const Model& model, const State& state, BondWork& work) {
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p)
    work.spring_force[p] = model.points[p].area * traction(model, state, p);
  for (std::size_t p = 0; p < work.stretch.size(); ++p)
    work.stretch[p] = local_jump(model, state.displacement, static_cast<int>(p)) - state.bond_offset[p];
}

void rest_contacts(const Model& model, State& state) {
  for (std::size_t p = 0; p < model.points.size(); ++p)
    if (!is_intact(state.bond_mode[p])) {
      const BondPoint& point = model.points[p];
      state.usual_force[p] =
          std::max(0.0, -point.area * traction(model, state, static_cast<int>(p)).dot(point.normal));
      state.rested[p] = state.usual_force[p] > 0 ? 1 : 0;
    }
}

} // namespace cdem
