// Softening in models: the energy that separation takes is an input, whatever the blocks; the ledger
// balances; damage survives a cut.
#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/simulation.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "tests/libcdem/softening_joint.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace cdem;
using geom::Vec3;
using testing::softening_joint;

namespace {

constexpr double face_side = 0.1, height = 0.02; // m, of the face between the two bodies; of each body

Elastic elastic_rock(double youngs_modulus = 30e9) {
  Elastic m;
  m.youngs_modulus = youngs_modulus;
  m.poissons_ratio = 0.2;
  m.density = 2500;
  return m;
}

// Two slabs of n x n x 1 blocks on top of each other, tied by the joint; bonds inside them do not break.
Simulation two_slabs(const Joint& joint, int blocks, double youngs_modulus = 30e9) {
  Joint strong;
  strong.cohesion = strong.tensile_strength = 1e12;
  ModelSpec spec;
  BodySpec lower{"lower", geom::grid({face_side, face_side, height}, {blocks, blocks, 1}),
                 elastic_rock(youngs_modulus), strong};
  BodySpec upper{"upper", geom::grid({face_side, face_side, height}, {blocks, blocks, 1}, {0, 0, height}),
                 elastic_rock(youngs_modulus), strong};
  lower.element = upper.element = Element::small_strain;
  spec.bodies = {lower, upper};
  spec.pairs = {{"lower", "upper", joint}};
  return Simulation(spec, 1, nullptr);
}

Fix held(const std::string& on, std::array<bool, 3> axes, Vec3 displacement = Vec3::Zero()) {
  Fix fix;
  fix.on = Selection::side(on);
  fix.axes = axes;
  fix.displacement = displacement;
  return fix;
}

// The top face led to `end` in equal steps, each relaxed.
void lead(Simulation& s, std::array<bool, 3> axes, const Vec3& start, const Vec3& end, int steps) {
  RelaxOptions o;
  o.residual = 1e-5;
  for (int i = 1; i <= steps; ++i) {
    s.fix(held("z+", axes, start + (end - start) * i / steps));
    REQUIRE(s.relax(o).converged);
  }
}

constexpr std::array<bool, 3> all_axes{true, true, true};

} // namespace

TEST_CASE("pulling two slabs apart dissipates G_I x area, whatever the block size") {
  const int blocks = GENERATE(1, 2, 4);
  const Joint joint = softening_joint(GENERATE(Softening::linear, Softening::exponential));
  Simulation s = two_slabs(joint, blocks);
  s.fix(held("z-", all_axes));
  lead(s, all_axes, Vec3::Zero(), {0, 0, 6e-4}, 12);
  CHECK(s.counts().broken_tension > 0);
  CHECK(s.counts().broken_shear == 0);
  CHECK(s.counts().damaged == 0);
  CHECK(s.energy().breaking == Approx(joint.fracture_energy_1 * face_side * face_side).epsilon(0.02));
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("shearing two pressed slabs dissipates G_II x area beyond friction, whatever the block size") {
  const int blocks = GENERATE(1, 2, 4);
  const Joint joint = softening_joint(GENERATE(Softening::linear, Softening::exponential));
  const double pressure = 4e6, end = 7e-4;
  Simulation s = two_slabs(joint, blocks);
  s.fix(held("z-", all_axes));
  Fix guided = held("z+", {true, true, false});
  guided.displacement.reset();
  s.fix(guided);
  s.traction({Selection::side("z+"), Vec3(0, 0, -pressure), {}});
  RelaxOptions o;
  o.residual = 1e-6;
  REQUIRE(s.relax(o).converged);
  lead(s, {true, true, false}, Vec3::Zero(), {end, 0, 0}, 120);
  // Last a crawl: a relaxation that stops a moving slab lets it swing back a little from the limit of
  // friction.
  lead(s, {true, true, false}, {end, 0, 0}, {end + 2e-6, 0, 0}, 5);
  const double area = face_side * face_side, friction = pressure * std::tan(joint.friction_angle);
  CHECK(s.counts().broken_shear > 0);
  CHECK(s.counts().broken_tension == 0);
  CHECK(s.energy().breaking == Approx(joint.fracture_energy_2 * area).epsilon(0.02));
  CHECK(s.reaction(Selection::side("z+")).x() == Approx(friction * area).epsilon(0.01)); // friction is left
  const double shear_modulus = 30e9 / 2.4, sheared = friction * 2 * height / shear_modulus; // m, of the slabs
  CHECK(s.energy().friction == Approx(friction * area * (end + 2e-6 - sheared)).epsilon(0.02));
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("opening and slipping at one ratio dissipates what the mixed law says, whatever the block size") {
  const int blocks = GENERATE(1, 2, 4);
  Joint joint = softening_joint(GENERATE(Softening::linear, Softening::exponential));
  // Springs far softer than the slabs, so that the bonds see the ratio of the top's motion.
  const double k = 1e11;
  joint.normal_stiffness = joint.shear_stiffness = k;
  joint.friction_angle = 0;
  Simulation s = two_slabs(joint, blocks, 3e13);
  s.fix(held("z-", all_axes));
  const double d = std::sqrt(0.5);

  const double half = joint.softening == Softening::linear ? 0.5 : 0.2 - 1 / (std::exp(5.0) - 1);
  const double w1 = (50 - 1e12 / (2 * k)) / (1e6 * half), w2 = (200 - 4e12 / (2 * k)) / (2e6 * half);
  const double e0 = 1e6 / (k * d); // tension is met first: 1e6 Pa against a shear strength of 2e6 Pa
  lead(s, all_axes, Vec3::Zero(), 1.1 * (e0 + 1 / std::hypot(d / w1, d / w2)) * Vec3(d, 0, d), 40);
  const double energy = 0.5 * k * e0 * e0 + half * k * e0 / std::hypot(d / w1, d / w2);
  CHECK(s.counts().damaged == 0);
  CHECK(s.counts().intact == s.counts().bonds - s.counts().broken_tension - s.counts().broken_shear);
  CHECK(s.energy().breaking == Approx(energy * face_side * face_side).epsilon(0.02));
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("unloading and reloading a softening bond takes nothing and the books stay balanced") {
  Simulation s = two_slabs(softening_joint(Softening::exponential), 2);
  s.fix(held("z-", all_axes));
  const Vec3 opened(0, 0, 6e-5);
  lead(s, all_axes, Vec3::Zero(), opened, 4);
  const double breaking = s.energy().breaking, force = s.reaction(Selection::side("z+")).z();
  REQUIRE(s.counts().damaged > 0);
  REQUIRE(force > 0);
  lead(s, all_axes, opened, 0.5 * opened, 1);
  CHECK(s.reaction(Selection::side("z+")).z() == Approx(0.5 * force).epsilon(0.01));
  lead(s, all_axes, 0.5 * opened, Vec3::Zero(), 1);
  CHECK(std::abs(s.reaction(Selection::side("z+")).z()) < 1e-3 * force);
  lead(s, all_axes, Vec3::Zero(), 0.9 * opened, 1); // short of where it was: the relaxation swings a little
  CHECK(s.energy().breaking == Approx(breaking).epsilon(1e-3));
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("without breaking a softening bond keeps its damage and answers along its secant") {
  Simulation s = two_slabs(softening_joint(Softening::linear), 1);
  s.fix(held("z-", all_axes));
  lead(s, all_axes, Vec3::Zero(), {0, 0, 5e-5}, 4);
  const double force = s.reaction(Selection::side("z+")).z(), breaking = s.energy().breaking;
  RelaxOptions o;
  o.breaking = false;
  s.fix(held("z+", all_axes, {0, 0, 1e-4}));
  REQUIRE(s.relax(o).converged);
  CHECK(s.reaction(Selection::side("z+")).z() == Approx(2 * force).epsilon(0.01));
  CHECK(s.energy().breaking == Approx(breaking).epsilon(1e-9));
}

TEST_CASE("the real-time step keeps the books of softening as the relaxation does") {
  Simulation s = two_slabs(softening_joint(Softening::linear), 1);
  s.fix(held("z-", all_axes));
  Fix pulled = held("z+", all_axes);
  pulled.displacement.reset();
  pulled.velocity = Vec3(0, 0, 0.05);
  s.fix(pulled);
  RunOptions o;
  o.duration = 3e-4 / 0.05;
  s.run(o);
  CHECK(s.counts().broken_tension == s.counts().bonds);
  CHECK(s.energy().breaking == Approx(50 * face_side * face_side).epsilon(0.02));
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("the bond field damage runs from 0 to 1 and a block's is the mean over its bonds") {
  Simulation s = two_slabs(softening_joint(Softening::linear), 1);
  const auto field = [&](const Snapshot& shot) {
    for (const SnapshotField& f : shot.bonds.point_fields)
      if (f.name == "damage")
        return f.values;
    return std::vector<double>{};
  };
  s.fix(held("z-", all_axes));
  const std::vector<double> whole = field(s.snapshot("at first"));
  REQUIRE_FALSE(whole.empty());
  CHECK(*std::max_element(whole.begin(), whole.end()) == 0);
  lead(s, all_axes, Vec3::Zero(), {0, 0, 5e-5}, 4);
  const Snapshot shot = s.snapshot("half way");
  const std::vector<double> damage = field(shot);
  REQUIRE(static_cast<std::int64_t>(damage.size()) == s.counts().bonds);
  const auto [low, high] = std::minmax_element(damage.begin(), damage.end());
  CHECK(*low > 0);
  CHECK(*high < 1);
  for (const SnapshotField& f : shot.cell_fields)
    if (f.name == "damage") {
      CHECK(f.values.front() > *low);
      CHECK(f.values.front() < *high);
    }
}

TEST_CASE("a cut carries damage and slip over to the springs that take the place of the old ones") {
  const Joint joint = softening_joint(Softening::linear);
  ModelSpec spec;
  Model frame;
  frame.bodies = {{"lower", elastic_rock(), joint}};
  frame.joints = {joint};
  frame.pair_joint[{0, 0}] = 0;
  std::vector<BlockSeed> seeds;
  for (const double z : {0.0, height}) {
    BlockSeed seed;
    seed.shape = geom::grid({face_side, face_side, height}, {1, 1, 1}, {0, 0, z}).blocks[0];
    seeds.push_back(std::move(seed));
  }
  const Model model = build_model(frame, std::move(seeds), default_traits);
  State state = initial_state(model);
  REQUIRE(state.bond_damage.size() == model.points.size());
  // Damage and slip that tell the points apart.
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const Vec3& x = model.point_position[p];
    state.bond_damage[p] = 0.1 + 4 * x.x() + 2 * x.y();
    state.bond_slip[p] = Vec3(x.y(), x.x(), 0) * 1e-3;
  }
  geom::Cut halves =
      geom::cut(model.blocks[1].shape, geom::Plane::through({0.03, 0.05, 0.03}, Vec3::UnitX()));
  REQUIRE(halves.above);
  REQUIRE(halves.below);
  std::vector<Successor> successors{whole_block(model, 0)};
  for (const geom::Part& part : {*halves.below, *halves.above}) {
    Successor half;
    half.old_block = 1;
    half.whole = false;
    half.shape = part.shape;
    half.old_face = part.parent_face;
    successors.push_back(std::move(half));
  }
  const Rebuilt cut = rebuild(model, state, std::move(successors), {}, MayBreak::all);
  REQUIRE(cut.state.bond_damage.size() == cut.model.points.size());
  int carried = 0, fresh = 0;
  for (std::size_t p = 0; p < cut.model.points.size(); ++p) {
    const bool on_cut = cut.model.interfaces[cut.model.points[p].interface].origin == InterfaceOrigin::cut;
    (on_cut ? fresh : carried)++;
    if (on_cut) {
      CHECK(cut.state.bond_damage[p] == 0);
      continue;
    }
    // The old spring nearest to it, found again by its place.
    double nearest = 1e9, damage = 0;
    Vec3 slip;
    for (std::size_t q = 0; q < model.points.size(); ++q) {
      const double distance = (model.point_position[q] - cut.model.point_position[p]).norm();
      if (distance < nearest) {
        nearest = distance;
        damage = state.bond_damage[q];
        slip = state.bond_slip[q];
      }
    }
    CHECK(cut.state.bond_damage[p] == damage);
    CHECK(cut.state.bond_slip[p] == slip);
  }
  CHECK(carried > 0);
  CHECK(fresh > 0);
}

TEST_CASE("a brittle model keeps no damage arrays") {
  Joint joint = softening_joint(Softening::none);
  joint.fracture_energy_1 = joint.fracture_energy_2 = 0;
  Model frame;
  frame.bodies = {{"one", elastic_rock(), joint}};
  frame.joints = {joint};
  frame.pair_joint[{0, 0}] = 0;
  std::vector<BlockSeed> seeds(2);
  for (int i = 0; i < 2; ++i)
    seeds[i].shape = geom::grid({face_side, face_side, height}, {1, 1, 1}, {0, 0, i * height}).blocks[0];
  const Model model = build_model(frame, std::move(seeds), default_traits);
  REQUIRE_FALSE(model.points.empty());
  CHECK(initial_state(model).bond_damage.empty());
  CHECK(initial_state(model).bond_slip.empty());
}

TEST_CASE("a fracture energy below what the springs store at their strength is refused with the least that "
          "will do") {
  Joint joint = softening_joint(Softening::linear);
  joint.fracture_energy_1 = 1e-3;
  joint.thickness = 1e-3; // kn = 30e9 / 1e-3 = 3e13 Pa/m, sigma_t^2 / 2 kn = 0.01667 J/m2
  CHECK_THROWS_WITH(two_slabs(joint, 1), Catch::Matchers::Contains("fracture_energy_1 = 0.001") &&
                                             Catch::Matchers::Contains("at least 0.0167 J/m2"));
}

namespace {

// Two blocks that move far, on each other, tied by a joint that softens. Both ends are held; the upper one moves.
struct TiedBlocks {
  explicit TiedBlocks(const Vec3& size) : s(spec(size), 1, nullptr), area(size.x() * size.y()) {
    s.fix(held("z-", all_axes));
    s.fix(held("z+", all_axes));
  }
  // The upper end goes on by so much, m, at the usual step. Returns its force over the area, Pa.
  Vec3 move(const Vec3& way, double speed) {
    Fix lead = held("z+", all_axes);
    lead.displacement.reset();
    lead.velocity = speed * way.normalized();
    s.fix(lead);
    RunOptions o;
    o.duration = way.norm() / speed;
    s.run(o);
    return s.reaction(Selection::side("z+")) / area;
  }
  static ModelSpec spec(const Vec3& size) {
    Elastic straight = elastic_rock();
    straight.poissons_ratio = 0;
    ModelSpec spec;
    spec.bodies = {{"blocks", geom::grid(size, {1, 1, 2}), straight, softening_joint(Softening::linear)}};
    return spec;
  }
  Simulation s;
  double area; // m2
};

} // namespace

TEST_CASE("a softening bond between blocks that move far closes and opens again at the usual step",
          "[softening][dry_joints]") {
  TiedBlocks blocks({0.1, 0.1, 0.2});
  const double speed = 0.01; // m/s
  const Vec3 opened(0, 0, 5e-5), pressed(0, 0, -2e-5);
  const double held = blocks.move(opened, speed).z(), breaking = blocks.s.energy().breaking;
  REQUIRE(blocks.s.counts().damaged == blocks.s.counts().bonds);
  REQUIRE(held > 0);
  const Elastic rock = elastic_rock();
  const double wave = 2 * speed *
                      std::sqrt(rock.youngs_modulus * rock.density), // Pa, of the end that turns back
      stiffness = rock.youngs_modulus / 0.2;                         // Pa/m, of the blocks
  CHECK(blocks.move(pressed - opened, speed).z() == Approx(stiffness * pressed.z()).margin(2 * wave));
  CHECK(blocks.move(0.95 * opened - pressed, speed).z() == Approx(0.95 * held).margin(wave));
  CHECK(blocks.s.energy().breaking == Approx(breaking).epsilon(0.03));
  CHECK(blocks.s.energy().kinetic < 0.01 * breaking);
  CHECK(blocks.s.energy().balance_error() < 1e-3);
}

TEST_CASE("a softening bond between blocks that move far takes G_II as it slips at the usual step",
          "[softening][dry_joints]") {
  TiedBlocks blocks({0.2, 0.2, 0.1});
  blocks.move({3e-4, 0, 0}, 0.05);
  CHECK(blocks.s.counts().broken_shear == blocks.s.counts().bonds);
  CHECK(blocks.s.energy().breaking == Approx(200 * blocks.area).epsilon(0.02));
  CHECK(blocks.s.energy().balance_error() < 1e-3);
}
