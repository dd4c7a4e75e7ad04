// Cutting and removing blocks: every field goes over to the new model.
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/random_cuts.hpp"
#include "tests/libcdem/system.hpp"

#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <set>

using namespace testing;
using geom::Vec3;

namespace {

// A wall that moves, with broken, slipped and open bonds.
System battered_wall() {
  geom::VoronoiOptions cells;
  cells.size = {1, 1, 0.3};
  cells.count = 20;
  cdem::Joint joint = rock_joint();
  joint.cohesion = joint.tensile_strength = 1e5;
  System s(build({body("wall", geom::voronoi(cells), rock(), joint)}));
  s.hold(cdem::Selection::side("y-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("y+"), {1e6, -2e6, 0})};
  for (std::size_t b = 0; b < s.state.initial_stress.size(); ++b)
    s.state.initial_stress[b][0] = 100.0 * static_cast<double>(b + 1);
  cdem::RunOptions options;
  options.steps = 400;
  s.run(options);
  REQUIRE(s.log.breaks.size() > 20);
  return s;
}

template <class T>
bool same_bits(const T* a, const T* b, int count) {
  return std::memcmp(a, b, sizeof(T) * static_cast<std::size_t>(count)) == 0;
}

} // namespace

TEST_CASE("blocks that are not cut keep id, displacement, velocity and stress bit for bit", "[carry]") {
  System s = battered_wall();
  const cdem::Model old = s.model;
  const cdem::State from = s.state;
  cut_at_random(s, {2, 5, 11}, 4);
  REQUIRE(s.model.blocks.size() == old.blocks.size() + 3);

  std::map<std::int64_t, int> old_block;
  for (int b = 0; b < static_cast<int>(old.blocks.size()); ++b)
    old_block[old.blocks[b].id] = b;
  int kept = 0;
  for (std::size_t b = 0; b < s.model.blocks.size(); ++b) {
    const cdem::Block& now = s.model.blocks[b];
    const auto found = old_block.find(now.id);
    if (found == old_block.end())
      continue;
    ++kept;
    const cdem::Block& before = old.blocks[found->second];
    const int nodes = now.node_end - now.node_begin;
    REQUIRE(nodes == before.node_end - before.node_begin);
    CHECK(same_bits(&s.model.node_position[now.node_begin], &old.node_position[before.node_begin], nodes));
    CHECK(same_bits(&s.state.displacement[now.node_begin], &from.displacement[before.node_begin], nodes));
    CHECK(same_bits(&s.state.velocity[now.node_begin], &from.velocity[before.node_begin], nodes));
    for (int tet = now.tet_begin; tet < now.tet_end; ++tet)
      CHECK(s.state.initial_stress[tet] == from.initial_stress[before.tet_begin + tet - now.tet_begin]);
    CHECK(now.generation == before.generation);
    CHECK(now.parent == before.parent);
  }
  CHECK(kept == static_cast<int>(old.blocks.size()) - 3);
  CHECK(s.state.time == from.time);
  CHECK(s.state.step == from.step);
  CHECK(s.state.velocity_lag == from.velocity_lag);
  CHECK(same_bits(&s.state.spent, &from.spent, 1));
}

TEST_CASE("bonds between blocks that are not cut keep mode, preload and slip bit for bit", "[carry]") {
  System s = battered_wall();
  const cdem::Model old = s.model;
  const cdem::State from = s.state;
  cut_at_random(s, {2, 5, 11}, 4);
  std::map<std::int64_t, const cdem::Interface*> before;
  for (const cdem::Interface& face : old.interfaces)
    before[face.id] = &face;
  int kept = 0, broken = 0;
  for (const cdem::Interface& now : s.model.interfaces) {
    const auto found = before.find(now.id);
    if (found == before.end())
      continue;
    const cdem::Interface& was = *found->second;
    ++kept;
    const int points = now.point_end - now.point_begin;
    REQUIRE(points == was.point_end - was.point_begin);
    CHECK(same_bits(&s.state.bond_mode[now.point_begin], &from.bond_mode[was.point_begin], points));
    CHECK(same_bits(&s.state.bond_offset[now.point_begin], &from.bond_offset[was.point_begin], points));
    CHECK(now.kn == was.kn);
    broken += from.bond_mode[was.point_begin] != 0;
  }
  CHECK(kept > 20);
  CHECK(broken > 0);
}

TEST_CASE("parts of a cut block inherit its field where it is linear, and its broken faces", "[carry]") {
  System s(build({body("rock", geom::grid({1, 1, 1}, {2, 2, 2}))}));
  geom::Mat3 gradient, spin;
  gradient << 1e-3, 2e-3, 0, -1e-3, 5e-4, 3e-4, 0, 1e-3, -2e-3;
  spin << 0, -1, 2, 1, 0, 3, -2, -3, 0;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i) {
    s.state.displacement[i] = node(gradient * s.model.node_position[i]);
    s.state.velocity[i] = node(Vec3(1, 2, 3) + spin * s.model.node_position[i]);
  }
  // One interface broken and slipped as a whole.
  const cdem::Interface broken = s.model.interfaces[0];
  for (int p = broken.point_begin; p < broken.point_end; ++p) {
    s.state.bond_mode[p] = 2;
    s.state.bond_offset[p] = Vec3(1e-5, 2e-5, 3e-5);
  }
  const cdem::Model old = s.model;
  cut_at_random(s, all_blocks(s.model), 8);

  double displacement = 0, velocity = 0, volume = 0;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i) {
    displacement =
        std::max(displacement, (vec(s.state.displacement[i]) - gradient * s.model.node_position[i]).norm());
    velocity = std::max(velocity,
                        (vec(s.state.velocity[i]) - Vec3(1, 2, 3) - spin * s.model.node_position[i]).norm());
  }
  CHECK(displacement < 1e-12 * gradient.norm());
  CHECK(velocity < 1e-12 * spin.norm());

  std::set<std::int64_t> ids;
  for (const cdem::Block& block : s.model.blocks) {
    volume += block.mass.volume;
    CHECK(ids.insert(block.id).second);
    CHECK(block.id >= old.next_id); // never one that was used before
    CHECK(block.generation == 1);
    CHECK(block.first_size == Approx(0.5));
    const auto parent = std::find_if(old.blocks.begin(), old.blocks.end(),
                                     [&](const cdem::Block& b) { return b.id == block.parent; });
    REQUIRE(parent != old.blocks.end());
    CHECK(geom::bounding_box(parent->shape).contains(block.mass.centroid));
  }
  CHECK(volume == Approx(1).epsilon(1e-12));

  // The broken face is split into several, all broken, all slipped; nothing else is.
  double area = 0;
  for (int p = 0; p < static_cast<int>(s.model.points.size()); ++p)
    if (s.state.bond_mode[p] == 2) {
      area += s.model.points[p].area;
      CHECK(s.state.bond_offset[p] == Vec3(1e-5, 2e-5, 3e-5));
    }
  CHECK(area == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("a cut of moving blocks keeps momentum and angular momentum, and gives no energy", "[carry]") {
  cdem::BodySpec spec = body("rock", geom::voronoi([] {
                               geom::VoronoiOptions cells;
                               cells.count = 6;
                               cells.origin = {20, -10, 5};
                               return cells;
                             }()));
  spec.element = cdem::Element::finite_volume;
  System s(build({spec}));
  const geom::Mat3 turn = rotation({1, 2, 0.5}, 0.8);
  const bool spins_alone = GENERATE(true, false);
  const Vec3 w(3, -1, 2), centre(20.5, -9.5, 5.5);
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i) {
    const Vec3 x = turn * (s.model.node_position[i] - centre) + centre;
    s.state.displacement[i] = node(x - s.model.node_position[i]);
    Vec3 v = Vec3(5, 1, -2) + w.cross(x - centre);
    if (!spins_alone) // it rings as well, in no smooth way
      v += 2 * Vec3(std::sin(40 * x.x()), std::cos(31 * x.y() + x.z()), std::sin(57 * x.z() * x.x()));
    s.state.velocity[i] = node(v);
  }
  const Momentum before = momentum(s, Places::present);
  const double energy = cdem::energy(s.model, s.state).kinetic;
  cut_at_random(s, all_blocks(s.model), 8);
  REQUIRE(s.model.blocks.size() > 6);
  const Momentum after = momentum(s, Places::present);
  CHECK((after.linear - before.linear).norm() < 1e-9 * before.linear.norm());
  CHECK((after.angular - before.angular).norm() < 1e-8 * before.angular.norm());
  const double left = cdem::energy(s.model, s.state).kinetic;
  CHECK(left < (1 + 1e-9) * energy);
  if (spins_alone)
    CHECK(left > (1 - 1e-8) * energy);
}

TEST_CASE(
    "removing what touches nothing leaves blocks and meshes, cracked ones too, to go on as they would have",
    "[carry]") {
  const auto scene = [] {
    cdem::Bonding springs;
    springs.everywhere = true;
    const geom::Mat3 upright = geom::Mat3::Identity();
    const auto box = [&](double x, double z) {
      return box_at({0.3, 0.3, 0.3}, {3, 3, 3}, upright, {x, 0, z});
    };
    std::vector<cdem::BodySpec> bodies{
        body("away", geom::grid({1, 1, 1}, {2, 1, 1}, {0, 20, 0})),
        body("blocks", geom::grid({0.3, 0.3, 0.3}, {2, 1, 1}, {0.9, -0.15, 0.0005})),
        meshed("floor", box_at({3, 1, 0.1}, {6, 2, 1}, upright, {0.5, 0, -0.05})),
        meshed("far mesh", box_at({1, 1, 1}, {1, 1, 1}, upright, {0, -20, 0})),
        meshed("cohesive", box(0, 0.1505), cohesive(), concrete(), concrete_joint(cdem::Softening::linear)),
        meshed("springs", box(0.5, 0.1505), springs, concrete(), concrete_joint(cdem::Softening::none)),
        meshed("whole", box(-0.4, 0.1505))};
    bodies[1].element = cdem::Element::finite_volume;
    bodies[2].element = cdem::Element::rigid;
    std::vector<cdem::PairSpec> pairs;
    for (const char* on : {"blocks", "cohesive", "springs", "whole"})
      pairs.push_back({on, "floor", friction(30)});
    System s(build(bodies, pairs));
    s.hold(body_of("floor"), "xyz");
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
      const cdem::Block& block = s.model.blocks[cdem::block_of(s.model, static_cast<int>(i))];
      if (block.rigid < 0 && std::abs(block.mass.centroid.y()) < 1)
        s.state.velocity[i] = {1, 0.5, -6, 0};
    }
    return s;
  };
  cdem::RunOptions options;
  options.steps = 400;
  options.time_step = 1e-6;
  System stays = scene(), loses = scene();
  stays.run(options);
  loses.run(options);
  const std::size_t cracks = loses.log.breaks.size();
  REQUIRE(cracks > 0);
  REQUIRE(!loses.state.contacts.empty());
  std::vector<cdem::Successor> left;
  for (int b = 0; b < static_cast<int>(loses.model.blocks.size()); ++b)
    if (std::abs(loses.model.blocks[b].mass.centroid.y()) < 1)
      left.push_back(cdem::whole_block(loses.model, b));
  cdem::Rebuilt r = cdem::rebuild(loses.model, loses.state, left, {}, cdem::MayBreak::all);
  REQUIRE(r.old_block.size() + 3 == loses.model.blocks.size());
  CHECK(r.state.contacts.size() == loses.state.contacts.size());
  loses.adopt(std::move(r.model), std::move(r.state));
  loses.last_good = loses.state;
  for (System* s : {&stays, &loses})
    s->run(options);
  CHECK(loses.log.breaks.size() > cracks);
  CHECK(loses.log.breaks.size() == stays.log.breaks.size());
  for (const cdem::Block& now : loses.model.blocks) {
    const auto same = std::find_if(stays.model.blocks.begin(), stays.model.blocks.end(),
                                   [&](const cdem::Block& b) { return b.id == now.id; });
    REQUIRE(same->node_end - same->node_begin == now.node_end - now.node_begin);
    INFO("body " << loses.model.bodies[now.body].name);
    double apart = 0; // m/s
    for (int i = 0; i < now.node_end - now.node_begin; ++i)
      apart = std::max(apart, (vec(loses.state.velocity[now.node_begin + i]) -
                               vec(stays.state.velocity[same->node_begin + i]))
                                  .norm());
    if (now.convex()) // not to the bit, why is open
      CHECK(apart < 1e-9 * 6);
    else
      for (const auto member : {&cdem::State::displacement, &cdem::State::velocity})
        CHECK(same_bits(&(loses.state.*member)[now.node_begin], &(stays.state.*member)[same->node_begin],
                        now.node_end - now.node_begin));
  }
}

TEST_CASE("the map from new to old blocks names the block each part lies in", "[carry]") {
  System s(build({body("rock", geom::grid({1, 1, 1}, {3, 2, 1}))}));
  std::vector<cdem::Successor> left;
  for (const int b : {0, 2, 3, 5})
    left.push_back(cdem::whole_block(s.model, b));
  const cdem::Rebuilt r = cdem::rebuild(s.model, s.state, left, {}, cdem::MayBreak::all);
  CHECK(r.old_block == std::vector<int>{0, 2, 3, 5});
  for (std::size_t b = 0; b < r.old_block.size(); ++b) {
    CHECK(r.model.blocks[b].id == s.model.blocks[r.old_block[b]].id);
    CHECK(r.model.blocks[b].mass.centroid == s.model.blocks[r.old_block[b]].mass.centroid);
  }
  CHECK(r.model.next_id >= s.model.next_id); // ids of removed blocks do not come back
}
