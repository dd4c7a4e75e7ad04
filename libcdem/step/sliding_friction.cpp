#include "libcdem/step/sliding_friction.hpp"

#include "libcdem/bond/bond_work.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/response/block_motion.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/state/state.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace cdem {
namespace {

// A hop lasts for fewer looks; a body that is thrown flies for longer.
constexpr double looks_of_a_hop = 10;

// Share of its friction from which a sole slides: until it is there for the first time, soles stick and give elastically.
constexpr double used_up = 0.98;

bool deforms(const Model& model, int block) {
  return model.blocks[block].rigid < 0;
}

// Where two blocks press on each other. What acts on the first and how it moves past the second, in space.
struct Touch {
  int source = 0, target = 0;
  geom::Vec3 place = geom::Vec3::Zero(), normal = geom::Vec3::Zero();
  double pressed = 0, tan_friction = 0;  // N, 1
  geom::Vec3 shear = geom::Vec3::Zero(); // N
  geom::Vec3 past = geom::Vec3::Zero();  // m/s
};

Touch of_contact(const Model& model, const State& state, const Contact& c) {
  const ContactLaw law = law_of(model, c);
  const ContactArms arms = arms_of(model, state, c);
  Touch t;
  std::tie(t.source, t.target) = blocks_of(model, c);
  for (int i = 0; i < 4; ++i)
    if (arms.on_source[i] != 0)
      t.place += arms.on_source[i] * place_of(model, state, arms.source[i]);
  t.normal = c.normal;
  t.pressed = std::max(0.0, normal_force(c, law));
  t.tan_friction = law.tan_friction;
  t.shear = c.shear;
  t.past = velocity_past(state, arms);
  return t;
}

// A spring that is a contact, with what its dashpot bears. turn: of its interface.
Touch of_spring(const Model& model, const State& state, const BondWork& bonds, int p,
                const geom::Mat3& turn) {
  const BondPoint& point = model.points[p];
  const Interface& interface = model.interfaces[point.interface];
  geom::Vec3 force = bonds.spring_force[p]; // N, on side a
  if (!bonds.viscous.empty())
    force += bonds.viscous[p];
  const double normal = force.dot(point.normal);
  Touch t;
  t.source = interface.block_a;
  t.target = interface.block_b;
  for (int i = 0; i < 3; ++i) {
    t.place += point.weight_a[i] * place_of(model, state, point.node_a[i]);
    t.past += point.weight_a[i] * velocity_of(state, point.node_a[i]) -
              point.weight_b[i] * velocity_of(state, point.node_b[i]);
  }
  t.normal = turn * point.normal;
  t.pressed = std::max(0.0, -normal);
  t.tan_friction = bonds.strength[point.interface].tan_friction;
  t.shear = turn * (force - normal * point.normal);
  return t;
}

} // namespace

void SlidingFriction::look(const Model& model, const State& state, const BondWork& bonds,
                           const std::vector<char>& broken) {
  const double time = state.time - std::exchange(seen, state.time); // s
  if (std::exchange(blocks, model.blocks.size()) != model.blocks.size())
    of_blocks.clear(); // they have other numbers
  std::map<int, BlockMotion> motions;
  const auto motion_of_block = [&](int block) -> const BlockMotion& {
    const auto [entry, fresh] = motions.try_emplace(block);
    if (fresh)
      entry->second = motion_of(model, state, model.blocks[block]);
    return entry->second;
  };
  const auto velocity = [&](int block, const geom::Vec3& place) -> geom::Vec3 {
    const BlockMotion& motion = motion_of_block(block);
    return motion.velocity + motion.spin.cross(place - motion.centroid);
  };
  struct Now {
    Sums sums;
    double pressed = 0;                  // N s
    geom::Vec3 way = geom::Vec3::Zero(); // N s m
  };
  std::map<std::array<int, 2>, Now> now;
  const auto add = [&](const Touch& t) -> Sums& {
    const auto along = [&](const geom::Vec3& v) -> geom::Vec3 { return v - v.dot(t.normal) * t.normal; };
    const geom::Vec3 v = along(velocity(t.source, t.place) - velocity(t.target, t.place)), w = along(t.past);
    const double normal = time * t.pressed, limit = t.tan_friction * normal;
    Now& of_pair = now[std::array<int, 2>{std::min(t.source, t.target), std::max(t.source, t.target)}];
    of_pair.pressed += normal;
    of_pair.way += (t.source < t.target ? normal : -normal) * time * v;
    Sums& sums = of_pair.sums;
    sums.law += (t.source < t.target ? limit : -limit) * v;
    sums.done -= time * t.shear.dot(v);
    sums.path += limit * v.norm();
    sums.slip += normal * v.squaredNorm();
    sums.contact += normal * v.dot(w);
    sums.span +=
        limit * std::cbrt(std::min(model.blocks[t.source].mass.volume, model.blocks[t.target].mass.volume));
    return sums;
  };
  for (const Contact& c : state.contacts) {
    if (c.kind == Contact::tets || !(c.effective_penetration() > 0))
      continue;
    const auto [source, target] = blocks_of(model, c);
    if (source != target && !broken[source] && !broken[target] &&
        (deforms(model, source) || deforms(model, target)))
      add(of_contact(model, state, c));
  }
  for (const Interface& interface : model.interfaces) {
    const int number = static_cast<int>(&interface - model.interfaces.data());
    if (released(state, interface) || (!bonds.laws.empty() && bonds.laws[number].law) ||
        !(deforms(model, interface.block_a) || deforms(model, interface.block_b)))
      continue;
    geom::Mat3 turn = geom::Mat3::Zero(); // until a spring asks for it
    for (int p = interface.point_begin; p < interface.point_end; ++p) {
      if (is_intact(state.bond_mode[p]) || bonds.spring_force[p].isZero(0))
        continue;
      if (turn.isZero(0))
        turn = interface_rotation(model, state.displacement.data(), interface);
      add(of_spring(model, state, bonds, p, turn)).joint = true;
    }
  }
  for (const auto& [pair, found] : now) {
    const Sums& sums = found.sums;
    if (!std::isfinite(sums.path) || !(found.pressed > 0) ||
        (of_blocks.count(pair) == 0 && sums.done < used_up * sums.path))
      continue;
    Sums& all = of_blocks[pair];
    if (all.time == 0)
      all.size = std::cbrt(std::min(model.blocks[pair[0]].mass.volume, model.blocks[pair[1]].mass.volume));
    else if (const double open = state.time - time - all.end; open > 0 && open < looks_of_a_hop * time)
      all.hops += open;
    if (sums.path > 0.01 * all.path)
      ++all.looks;
    all.law += sums.law;
    all.done += sums.done;
    all.path += sums.path;
    all.slip += sums.slip;
    all.contact += sums.contact;
    all.span += sums.span;
    all.time += time;
    all.end = state.time;
    all.way += found.way / found.pressed;
    all.turned += time * (motion_of_block(pair[0]).spin - motion_of_block(pair[1]).spin);
    all.joint = all.joint || sums.joint;
  }
}

} // namespace cdem
