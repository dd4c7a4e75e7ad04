// Bonded blocks with bonds = "cohesive": one mesh, whose joints carry exactly the uniform traction and break at T.
#include "libcdem/bond/fragments.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/fracture/star_blocks.hpp"
#include "libcdem/join_blocks.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

geom::Assembly cells(int count) {
  geom::VoronoiOptions options;
  options.size = {1, 0.8, 1.2};
  options.count = count;
  options.seed = 2;
  return geom::voronoi(options);
}

geom::Assembly wall() {
  geom::BrickOptions options;
  options.size = {2, 0.25, 1};
  options.brick = {0.5, 0.25, 0.25};
  return geom::bricks(options);
}

cdem::BodySpec joined(geom::Assembly shape, double zone_size = 0) {
  cdem::BodySpec spec = body("rock", std::move(shape));
  spec.element = cdem::Element::finite_volume;
  spec.joint.tensile_strength = 2e6;
  spec.joint.cohesion = 50e6;
  spec.bonding.kind = cdem::BondKind::cohesive;
  spec.bonding.stiffness_ratio = 1;
  spec.zone_size = zone_size;
  cdem::join_blocks(spec);
  return spec;
}

void free_all(System& s) {
  cdem::Freed freed = cdem::split_nodes(s.model, s.state, std::vector<char>(s.model.node_position.size(), 1));
  s.adopt(std::move(freed.model), std::move(freed.state));
}

// A tension that grows evenly: the body stretches with it at a constant velocity, and no wave disturbs the stress.
struct Stretched {
  Stretched(const geom::Assembly& shape, const Mat3& per_pascal, double strength)
      : s(build({joined(shape)})), rate(strength / duration) {
    s.conditions.tractions = on_six_sides(rate * per_pascal);
    for (cdem::Traction& traction : s.conditions.tractions)
      traction.amplitude = [](double time) { return time; };
    const cdem::Elastic m = rock();
    const Mat3 strain =
        ((1 + m.poissons_ratio) * per_pascal - m.poissons_ratio * per_pascal.trace() * Mat3::Identity()) /
        m.youngs_modulus;
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
      s.state.velocity[i] = node(rate * strain * s.model.node_position[i]);
  }
  void until(double part) {
    cdem::RunOptions options;
    options.duration = part * duration - s.state.time;
    s.run(options);
  }
  std::int64_t broken() const { return s.log.broken_tension + s.log.broken_shear; }

  static constexpr double duration = 2e-3; // s, until the strength
  System s;
  double rate; // Pa/s
};

} // namespace

TEST_CASE("joined blocks: under a uniform stress every joint carries its traction, freed or not",
          "[joined][patch]") {
  const auto [shape, zone] = GENERATE(values<std::pair<geom::Assembly, double>>(
      {{cells(20), 0}, {cells(60), 0}, {cells(200), 0}, {wall(), 0}, {cells(20), 0.2}, {wall(), 0.12}}));
  Mat3 gradient;
  gradient << 4e-7, 1e-7, -2e-7, 1e-7, -3e-7, 1e-7, -2e-7, 1e-7,
      2e-7; // the areas are those of now: second order
  System s(build({joined(shape, zone)}));
  const Mat3 stress = hooke(rock(), gradient);
  for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
    s.state.displacement[i] = node(gradient * s.model.node_position[i]);
  for (int t = 0; t < static_cast<int>(s.model.tets.size()); ++t)
    set_mesh_stress(s.model, s.state, t,
                    {stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2), stress(0, 2)});
  free_all(s);
  CHECK_FALSE(s.model.mesh.sides.empty());
  // Balance at every copy of every node: all that is left are the tractions of the outer faces.
  std::vector<Vec3> left = s.net_forces();
  double scale = 0;
  for (const cdem::OuterFace& face : s.model.outer_faces) {
    scale = std::max(scale, face.area * stress.norm());
    cdem::each_face_node(s.model, face,
                         [&](int node, double area) { left[node] += area * stress * face.normal; });
  }
  double worst = 0;
  for (const Vec3& f : left)
    worst = std::max(worst, f.norm());
  CHECK(worst < 1e-6 * scale);
}

TEST_CASE("joined blocks: an even tension breaks and parts them at T, however many there are", "[joined]") {
  const int count = GENERATE(20, 60);
  const Mat3 pull = GENERATE(values<Mat3>({Mat3::Identity(), symmetric(0, 0, 1, 0, 0, 0)}));
  const double strength = 2e6;
  Stretched cells_of(cells(count), pull, strength);
  cells_of.until(0.98);
  CHECK(cells_of.broken() == 0);
  CHECK(stress_error(cells_of.s, 0.98 * strength * pull) < 1e-3);
  // Uniaxial: the faces nearest to square to the axis are first, and the cells part along others.
  cells_of.until(pull(0, 0) > 0 ? 1.02 : 1.1);
  CHECK(cells_of.broken() > 0);
  if (pull(0, 0) > 0)
    CHECK(cdem::fragments_of_nodes(cells_of.s.model, cells_of.s.state) !=
          std::vector<int>(cells_of.s.model.node_position.size(), 0));
}

TEST_CASE("joined blocks: short edges do not set the time step", "[joined]") {
  cdem::BodySpec apart = body("rock", cells(60));
  apart.element = cdem::Element::finite_volume;
  const auto step = [](System s) {
    cdem::RunOptions options;
    options.steps = 1;
    s.run(options);
    return s.state.time;
  };
  CHECK(step(System(build({joined(cells(60))}))) > step(System(build({apart}))));
}

TEST_CASE("joined blocks: glued faces hold, named joints have their own strength", "[joined]") {
  geom::PlaneCutOptions glue, seam;
  glue.glued = true;
  seam.name = "seam";
  geom::Assembly shape = geom::cut_by_plane(geom::grid({1, 1, 2}, {1, 1, 1}),
                                            geom::Plane::through({0, 0, 0.6}, {0, 0.2, 1}), glue);
  shape = geom::cut_by_plane(shape, geom::Plane::through({0, 0, 1.4}, {0.2, 0, 1}), seam);
  cdem::BodySpec spec = body("rock", shape);
  spec.element = cdem::Element::finite_volume;
  spec.bonding.kind = cdem::BondKind::cohesive;
  spec.bonding.stiffness_ratio = 1;
  spec.set_joints["seam"] = spec.joint;
  spec.set_joints["seam"].tensile_strength = 1e6;
  cdem::join_blocks(spec);
  CHECK(spec.region_laws.regions.size() == 2);
  System s(build({spec}));
  free_all(s);
  std::map<double, double> area; // m2, by tensile strength, Pa
  each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    area[s.model.mesh.strength[batch].tensile_strength[lane]] += 3 * s.model.mesh.faces[batch].area[lane];
  });
  CHECK(area[1e6] == Approx(std::sqrt(1 + 0.04)));
  CHECK(area.rbegin()->first > 1e12); // glued
  CHECK(area.rbegin()->second == Approx(std::sqrt(1 + 0.04)));
}

TEST_CASE("joined blocks: a cut or a body whose joint is glued never breaks", "[joined]") {
  geom::PlaneCutOptions cut;
  cut.name = "seam";
  cdem::BodySpec spec = body("rock", geom::cut_by_plane(geom::grid({1, 1, 2}, {1, 1, 2}),
                                                        geom::Plane::through({0, 0, 0.6}, {0, 0.2, 1}), cut));
  spec.element = cdem::Element::finite_volume;
  spec.bonding.kind = cdem::BondKind::cohesive;
  spec.bonding.stiffness_ratio = 1;
  (GENERATE(true, false) ? spec.joint : spec.set_joints["seam"]) = cdem::glued_joint();
  const bool all = spec.joint.glued;
  cdem::join_blocks(spec);
  System s(build({spec}));
  free_all(s);
  double held = 0; // m2
  each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    const double strength = s.model.mesh.strength.empty()
                                ? s.model.bodies[0].joint.tensile_strength
                                : s.model.mesh.strength[batch].tensile_strength[lane];
    held += strength > 1e12 ? 3 * s.model.mesh.faces[batch].area[lane] : 0;
  });
  CHECK(held == Approx(std::sqrt(1 + 0.04) + (all ? 1 : 0)));
}

namespace {

// Blocks in a row along x, held at x-. `part`: of the end load at which beam theory has the tensile strength at the worst corner
// of the first joint, in the plane at this angle to y.
struct Cantilever {
  Cantilever(const Vec3& size, int blocks, double angle, double modulus = rock().youngs_modulus,
             cdem::Softening softening = cdem::Softening::none)
      : s(build({spec_of(size, blocks, modulus, softening)})), direction(0, std::cos(angle), std::sin(angle)),
        arm(size.x() * (1 - 1.0 / blocks)), area(size.y() * size.z()) {
    at_strength =
        strength * area / 6 / arm / (std::abs(direction.y()) / size.y() + std::abs(direction.z()) / size.z());
    s.conditions.fixes = {fixed(cdem::Selection::side("x-"))};
  }
  static cdem::BodySpec spec_of(const Vec3& size, int blocks, double modulus, cdem::Softening softening) {
    cdem::BodySpec spec = body("rock", geom::grid(size, {blocks, 1, 1}));
    spec.material.youngs_modulus = modulus;
    spec.element = cdem::Element::finite_volume;
    spec.joint.tensile_strength = strength;
    spec.joint.cohesion = 50e6;
    spec.joint.softening = softening;
    if (softening != cdem::Softening::none) {
      spec.joint.fracture_energy_1 = 1000;
      spec.joint.fracture_energy_2 = 1e6;
    }
    spec.bonding.kind = cdem::BondKind::cohesive;
    spec.bonding.stiffness_ratio = 1;
    cdem::join_blocks(spec);
    return spec;
  }
  // drawn: Pa, along the row, which lessens the bending the joint bears.
  bool stands(double part, double drawn = 0) {
    s.conditions.forces = {
        {cdem::Selection::side("x+"),
         part * (1 - drawn / strength) * at_strength * direction + Vec3(drawn * area, 0, 0),
         {}}};
    return is_stable(s);
  }
  static bool is_stable(System& s) {
    cdem::RelaxOptions options;
    options.residual = 1e-4;
    options.stop_on_failure = true;
    return cdem::relax(s.next_stage(), options).verdict == cdem::Verdict::stable &&
           s.log.broken_tension + s.log.broken_shear == 0;
  }

  static constexpr double strength = 2e6;
  System s;
  Vec3 direction;
  double arm, area, at_strength = 0; // m, m2, N
};

} // namespace

TEST_CASE("joined blocks: a joint cracks by bending at the strength of its worst corner", "[joined][bent]") {
  const Vec3 size = GENERATE(Vec3(1, 0.5, 0.5), Vec3(4, 0.5, 0.5), Vec3(0.2, 0.2, 0.3));
  const double angle = GENERATE(0.0, 45.0, 200.0) * degree, modulus = GENERATE(5e9, 70e9);
  CAPTURE(size.x(), angle, modulus);
  Cantilever beam(size, 2, angle, modulus);
  CHECK(beam.stands(0.96));
  CHECK_FALSE(beam.stands(1.04));
}

TEST_CASE("joined blocks: force and moment act together, in rows of blocks too", "[joined][bent]") {
  const double pull = GENERATE(-4e6, 1e6);
  Cantilever beam({1.6, 0.4, 0.4}, GENERATE(2, 4), 90 * degree);
  CHECK(beam.stands(0.5, pull));
  CHECK(beam.stands(0.96, pull));
  CHECK_FALSE(beam.stands(1.04, pull));
}

TEST_CASE("joined blocks: a lintel of eight cracks at its load", "[joined][bent]") {
  System s(build({Cantilever::spec_of({4, 0.5, 0.5}, 8, 30e9, cdem::Softening::none)}));
  const auto edge = [](double x) {
    return cdem::Selection::where(
        [x](const Vec3& at) { return std::abs(at.x() - x) < 1e-6 && at.z() < 1e-6; }, "edge");
  };
  s.conditions.fixes = {fixed(edge(0)), fixed(edge(4), "yz")};
  const auto stands = [&](double part) {
    const double load = part * Cantilever::strength * 0.25 / 6 * 8 / 16; // q L^2 / 8 = T d^2 / 6
    s.conditions.tractions = {traction(cdem::Selection::side("z+"), {0, 0, -load})};
    return Cantilever::is_stable(s);
  };
  CHECK(stands(0.95));
  CHECK_FALSE(stands(1.05));
}

TEST_CASE("joined blocks: blocks are as slender when they are turned", "[joined][bent]") {
  const double angle = GENERATE(0.0, 45.0, 110.0) * degree;
  cdem::BodySpec spec = body("rock", geom::rotated(geom::grid({4, 0.5, 0.5}, {2, 1, 1}), {1, 2, 3}, angle));
  spec.element = cdem::Element::finite_volume;
  spec.bonding.kind = cdem::BondKind::cohesive;
  spec.bonding.stiffness_ratio = 1;
  cdem::join_blocks(spec);
  const cdem::StarBlocks stars = cdem::star_blocks(build({spec}));
  REQUIRE(stars.shape.size() == 2);
  CHECK(stars.shape[0] == Approx(0.25));
  CHECK(stars.shape[1] == Approx(0.25));
}

// The points of the four triangles of a facet bear at most 2.5 times the moment of first cracking: all but the two that are
// pressed are at the strength. The fully plastic moment is 3 times.
TEST_CASE("joined blocks: a tough joint bears more moment than a brittle one", "[joined][bent]") {
  Cantilever beam({1, 0.5, 0.5}, 2, 0, 30e9, cdem::Softening::linear);
  CHECK(beam.stands(0.96));
  CHECK(beam.stands(1.5));
  CHECK(beam.stands(2.2));
  CHECK_FALSE(beam.stands(2.6));
}

TEST_CASE("joined blocks: a bent joint cracks at its strength at any rate and step", "[joined][bent]") {
  const auto [duration, safety] =
      GENERATE(values<std::pair<double, double>>({{0.1, 0.8}, {0.4, 0.8}, {0.1, 0.4}}));
  Cantilever beam({1, 0.5, 0.5}, 2, 45 * degree);
  beam.s.conditions.forces = {{cdem::Selection::side("x+"), beam.at_strength * beam.direction,
                               [duration = duration](double time) { return time / duration; }}};
  cdem::RunOptions options;
  options.safety = safety;
  options.duration = 0.96 * duration;
  beam.s.run(options);
  CHECK(beam.s.log.broken_tension == 0);
  options.duration = 0.08 * duration;
  beam.s.run(options);
  CHECK(beam.s.log.broken_tension > 0);
}

// Its parts are loaded unevenly: the middle of the joint has no stress.
TEST_CASE("joined blocks: a bent joint stays freed as a whole while its blocks are loaded",
          "[joined][bent]") {
  Cantilever beam({1, 0.5, 0.5}, 2, 0);
  CHECK(beam.stands(0.6));
  const auto freed = [&] {
    return std::count(beam.s.model.mesh.freed.begin(), beam.s.model.mesh.freed.end(), 1);
  };
  const auto before = freed();
  CHECK(before == 10);
  cdem::RunOptions options;
  options.duration = 0.05;
  beam.s.run(options);
  CHECK(freed() == before);
  CHECK(energy(beam.s.model, beam.s.state).kinetic < 1e-4 * energy(beam.s.model, beam.s.state).elastic);
}

TEST_CASE("joined blocks: what cannot be one mesh is refused with the reason", "[joined][input]") {
  const auto refused = [](const auto& change, const char* says) {
    cdem::BodySpec spec = body("rock", wall());
    spec.element = cdem::Element::finite_volume;
    spec.bonding.kind = cdem::BondKind::cohesive;
    change(spec);
    CHECK_THROWS_WITH(cdem::join_blocks(spec), Catch::Contains(says));
  };
  refused([](auto& b) { b.element = cdem::Element::small_strain; }, "small_strain");
  refused([](auto& b) { b.joint.bonded = false; }, "a contact");
  refused([](auto& b) { b.joint_at = [](const Vec3&) { return rock_joint(); }; }, "a function");
  refused([](auto& b) { b.set_joints["none"] = rock_joint(); }, "none of its cuts has a name");
}
