// Each body moves, breaks and touches as it does without those that it never meets: not a bit differs.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/tet_blocks.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>
#include <cstring>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

constexpr double time_step = 1e-5; // s

// So soft for its strength that cracked faces which still hold open and slide a long way.
cdem::Joint soft_joint() {
  cdem::Joint joint = concrete_joint(cdem::Softening::exponential);
  joint.tensile_strength = 1.7e5;
  joint.cohesion = 4.4e5;
  joint.fracture_energy_1 = 20;
  joint.fracture_energy_2 = 100;
  return joint;
}

enum class Stranger { none, harder, softer };

// A block that breaks on a floor, and another one, which breaks too, on a floor of its own far away.
System both_fall(cdem::BondKind kind, Stranger stranger) {
  std::vector<cdem::BodySpec> bodies;
  std::vector<cdem::PairSpec> pairs;
  const auto add = [&](const std::string& name, double x, double strength) {
    cdem::Joint joint = soft_joint();
    if (kind == cdem::BondKind::springs) {
      joint.softening = cdem::Softening::none;
      joint.fracture_energy_1 = joint.fracture_energy_2 = 0;
    }
    joint.tensile_strength *= strength;
    joint.cohesion *= strength;
    cdem::Bonding bonding = cohesive();
    bonding.kind = kind;
    const std::string floor = "floor of " + name;
    bodies.push_back(
        meshed(floor, box_at({2, 2, 0.2}, {2, 2, 1}, Mat3::Identity(), {x, 0, -0.101}), {}, soft_rock()));
    bodies.back().element = cdem::Element::rigid;
    bodies.push_back(meshed(name, placed(unstructured({0.4, 0.35, 0.3}, 0.2), Mat3::Identity(), {x, 0, 0}),
                            bonding, soft_rock(), joint));
    pairs.push_back({name, floor, friction(30)});
    pairs.push_back({name, name, friction(30)});
  };
  add("block", 0, 1);
  if (stranger != Stranger::none)
    add("stranger", 100, stranger == Stranger::harder ? 1.05 : 0.7);
  System s(build(bodies, pairs));
  for (std::size_t b = 0; b < bodies.size(); b += 2)
    s.hold(body_of(bodies[b].name.c_str()), "xyz");
  for (std::size_t b = 1; b < bodies.size(); b += 2)
    for (int i = s.model.blocks[b].node_begin; i < s.model.blocks[b].node_end; ++i)
      s.state.velocity[i] = node(b == 1 ? Vec3(1, 0.2, -6) : Vec3(2, 0.2, -5));
  return s;
}

// A block with this velocity, m/s, that breaks on the floor. stranger: a coarse body stands far away.
System fallen(const Vec3& velocity, bool stranger) {
  std::vector<cdem::BodySpec> bodies = {
      meshed("floor", box_at({8, 4, 0.2}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.101}), {}, soft_rock()),
      meshed("block", unstructured({0.4, 0.35, 0.3}, 0.2), cohesive(), soft_rock(), soft_joint())};
  bodies[0].element = cdem::Element::rigid;
  if (stranger)
    bodies.push_back(meshed("stranger", box_at({0.6, 0.6, 0.6}, {1, 1, 1}, Mat3::Identity(), {100, 0, 0}), {},
                            soft_rock(1e6)));
  System s(build(bodies, {{"block", "floor", friction(30)}, {"block", "block", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  const cdem::Block& block = s.model.blocks[1];
  for (int i = block.node_begin; i < block.node_end; ++i)
    s.state.velocity[i] = node(velocity);
  return s;
}

using Nodes = std::vector<cdem::Node>;

Nodes moved(const System& s, int block) {
  const cdem::Block& b = s.model.blocks[block];
  return {s.state.displacement.begin() + b.node_begin, s.state.displacement.begin() + b.node_end};
}

void run(System& s, int steps, double step = time_step, bool looks_at_all = false) {
  cdem::RunOptions options;
  options.steps = steps;
  options.time_step = step;
  options.looks_at_all_contacts = looks_at_all;
  s.run(options);
}

bool same_bits(const Nodes& a, const Nodes& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(cdem::Node)) == 0;
}

// Bonded tetrahedra that break on a floor; far away stands a grid of blocks whose bonds hold.
System blocks_fallen(bool stranger) {
  const auto moving = [](const std::string& name, const geom::Assembly& shape, double strength,
                         double youngs_modulus) {
    cdem::Joint joint = soft_joint();
    joint.softening = cdem::Softening::none;
    joint.fracture_energy_1 = joint.fracture_energy_2 = 0;
    joint.tensile_strength *= strength;
    joint.cohesion *= strength;
    cdem::BodySpec spec = body(name, shape, soft_rock(youngs_modulus), joint);
    spec.element = cdem::Element::finite_volume;
    return spec;
  };
  std::vector<cdem::BodySpec> bodies = {
      meshed("floor", box_at({2, 2, 0.2}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.101}), {}, soft_rock()),
      moving("block", geom::tet_blocks(unstructured({0.4, 0.35, 0.3}, 0.2)), 1, 1e8)};
  bodies[0].element = cdem::Element::rigid;
  if (stranger)
    bodies.push_back(moving("stranger", geom::grid({0.4, 0.4, 0.4}, {2, 2, 1}, {100, 0, 0}), 100,
                            1e7)); // it does not decide the time step
  System s(build(bodies, {{"block", "floor", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (s.model.bodies[s.model.blocks[cdem::block_of(s.model, i)].body].name == "block")
      s.state.velocity[i] = node(Vec3(1, 0.2, -6));
  return s;
}

// Two bars that are drawn out, the second one, which is weaker, for itself.
System drawn_out(bool both) {
  std::vector<cdem::BodySpec> bodies = {
      meshed("bar", unstructured({0.4, 0.1, 0.1}, 0.1), cohesive(), soft_rock(), soft_joint())};
  if (both) {
    cdem::Joint weaker = soft_joint();
    weaker.tensile_strength *= 0.75;
    bodies.push_back(meshed("weaker", placed(unstructured({0.4, 0.1, 0.1}, 0.1), Mat3::Identity(), {0, 1, 0}),
                            cohesive(), soft_rock(), weaker));
  }
  System s(build(bodies));
  lead_apart(s.conditions.fixes, 0.2);
  return s;
}

} // namespace

TEST_CASE("strangers: a body that breaks does so as it would alone", "[contact][cohesive][breaking]") {
  const Vec3 velocity = GENERATE(Vec3(2, 0.2, -5), Vec3(0.5, 0.2, -7));
  System alone = fallen(velocity, false), beside = fallen(velocity, true);
  for (int stage = 0; stage < 24; ++stage) { // all that touches is looked for where a stage begins
    run(alone, 40);
    run(beside, 40);
    INFO("stage " << stage << ", contacts " << alone.state.contacts.size() << " and "
                  << beside.state.contacts.size());
    CHECK(same_bits(moved(alone, 1), moved(beside, 1)));
  }
  CHECK(alone.log.broken_tension + alone.log.broken_shear > 100);
}

TEST_CASE("strangers: blocks that break do so as they would alone", "[contact][bonds][breaking]") {
  System alone = blocks_fallen(false), beside = blocks_fallen(true);
  const auto of_block = [](const System& s) {
    Nodes nodes;
    for (const cdem::Block& block : s.model.blocks)
      if (s.model.bodies[block.body].name == "block")
        nodes.insert(nodes.end(), s.state.displacement.begin() + block.node_begin,
                     s.state.displacement.begin() + block.node_end);
    return nodes;
  };
  for (int stage = 0; stage < 8; ++stage) {
    run(alone, 60, 0.2 * time_step);
    run(beside, 60, 0.2 * time_step);
    INFO("stage " << stage << ", broken " << alone.log.breaks.size());
    CHECK(same_bits(of_block(alone), of_block(beside)));
  }
  CHECK(alone.log.breaks.size() > 20);
}

TEST_CASE("strangers: faces of a body are freed when one of its own is due", "[cohesive][breaking]") {
  System alone = drawn_out(false), beside = drawn_out(true);
  std::size_t freed_of_other = 0;
  for (int stage = 0; stage < 8; ++stage) {
    const std::size_t before = moved(beside, 1).size();
    run(alone, 40);
    run(beside, 40);
    freed_of_other += moved(beside, 1).size() - before;
    INFO("stage " << stage << ", nodes " << moved(alone, 0).size() << " and " << moved(beside, 0).size());
    CHECK(same_bits(moved(alone, 0), moved(beside, 0)));
  }
  CHECK(freed_of_other > 0);
}

TEST_CASE("strangers: bodies that break side by side do so as each alone", "[contact][cohesive][breaking]") {
  const auto kind = GENERATE(cdem::BondKind::cohesive, cdem::BondKind::springs);
  const auto stranger = GENERATE(Stranger::harder, Stranger::softer);
  System alone = both_fall(kind, Stranger::none), beside = both_fall(kind, stranger);
  const double step = kind == cdem::BondKind::springs ? 0.3 * time_step : time_step;
  for (int stage = 0; stage < 3; ++stage) {
    run(alone, 270, step);
    run(beside, 270, step);
    INFO("stage " << stage << ", broken " << alone.log.breaks.size() << " and " << beside.log.breaks.size());
    CHECK(same_bits(moved(alone, 1), moved(beside, 1)));
  }
  CHECK(alone.log.breaks.size() > 100);
  CHECK(beside.log.breaks.size() > alone.log.breaks.size() + 50);
}

// Strangers change when is searched. So a search must not decide which contacts there are.
TEST_CASE("strangers: what contact skips changes no bit where parts of one fragment overlap",
          "[contact][cohesive][breaking]") {
  const auto kind = GENERATE(cdem::BondKind::cohesive, cdem::BondKind::springs);
  System skipped = both_fall(kind, Stranger::none), all = both_fall(kind, Stranger::none);
  const double step = kind == cdem::BondKind::springs ? 0.3 * time_step : time_step;
  const cdem::Block& block = skipped.model.blocks[1];
  for (System* s : {&skipped, &all})
    for (int i = block.node_begin; kind == cdem::BondKind::cohesive && i < block.node_end; ++i)
      s->state.velocity[i] = node(Vec3(0, 0, -8));
  for (int stage = 0; stage < 3; ++stage) {
    run(skipped, 270, step);
    run(all, 270, step, true);
    INFO("stage " << stage << ", contacts " << skipped.state.contacts.size() << " and "
                  << all.state.contacts.size());
    CHECK(same_bits(moved(skipped, 1), moved(all, 1)));
  }
}
