// Zoned blocks: blocks with a finer mesh inside. Inside they are a continuum that bends as beams do, between each other
// they stay blocks: bonded, sliding, cut and removed as those with star meshes are.
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::BodySpec zoned(std::string name, geom::Assembly shape, double zone_size,
                     const cdem::Elastic& material = rock(), const cdem::Joint& joint = rock_joint()) {
  cdem::BodySpec spec = body(std::move(name), std::move(shape), material, joint);
  spec.element = cdem::Element::finite_volume;
  spec.zone_size = zone_size;
  return spec;
}

geom::Assembly cells(int count) {
  geom::VoronoiOptions options;
  options.count = count;
  return geom::voronoi(options);
}

// A cantilever of `blocks` blocks in a row, held at x = 0, a shear stress on its end.
struct Deflection {
  double measured, exact; // m
};
Deflection deflection(int blocks, double zone_size) {
  const double height = 0.8, width = 0.3, length = 3.2, shear_stress = 1e4, ratio = 0.02;
  cdem::ModelSpec spec;
  cdem::Joint joint = rock_joint();
  joint.thickness_ratio = ratio;
  spec.bodies = {
      zoned("beam", geom::grid({length, height, width}, {blocks, 1, 1}), zone_size, rock(), joint)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  s.traction(traction(cdem::Selection::side("x+"), {0, shear_stress, 0}));
  cdem::RelaxOptions options;
  options.breaking = false;
  options.residual = 1e-5;
  REQUIRE(s.relax(options).converged);
  const cdem::Elastic m = rock();
  const double area = height * width, p = shear_stress * area, inertia = width * std::pow(height, 3) / 12;
  const double young = m.youngs_modulus, shear = m.shear_modulus();
  // Timoshenko, k after Cowper 1966; the joints at x_i turn by M L / E I and slide by P L / G A.
  const double k = 10 * (1 + m.poissons_ratio) / (12 + 11 * m.poissons_ratio);
  double exact = p * std::pow(length, 3) / (3 * young * inertia) + p * length / (k * shear * area);
  const double thickness = ratio * std::cbrt(length / blocks * area);
  for (int i = 1; i < blocks; ++i) {
    const double arm = length * (blocks - i) / blocks;
    exact += p * arm * arm * thickness / (young * inertia) + p * thickness / (shear * area);
  }
  return {s.mean("displacement.y", cdem::Selection::side("x+")), exact};
}

// Rock pressed in a plate, Han 2010 example 4.1, coarse, of zoned blocks.
cdem::Simulation pressed_plate(double zone_size) {
  cdem::ModelSpec spec;
  spec.bodies = {zoned("plate", geom::grid({0.3, 0.3, 0.03}, {3, 3, 1}), zone_size)};
  cdem::Simulation s(spec, 1, nullptr);
  for (const char* side : {"z-", "z+"})
    s.fix(fixed(cdem::Selection::side(side), "z"));
  s.fix(fixed(cdem::Selection::side("y-")));
  s.fix(fixed(cdem::Selection::side("y+"), "xz"));
  s.traction(traction(cdem::Selection::side("y+"), {0, -30e6, 0}));
  cdem::RelaxOptions elastic;
  elastic.breaking = false;
  REQUIRE(s.relax(elastic).converged);
  return s;
}

} // namespace

TEST_CASE("zoned blocks whose faces and zones do not match carry a uniform stress uniformly",
          "[zones][patch]") {
  // Strains of 1e-5, hardly large. Tension in all directions: loads that press on a free body would turn it.
  const geom::Mat3 stress = 1e5 * symmetric(3, 2, 1, 0.5, -0.7, 0.9);
  const geom::Assembly upper = geom::rotated(geom::grid({1, 1.2, 0.8}, {1, 1, 1}, {0.1, -0.3, 1}), {0, 0, 1},
                                             25 * degree, {0.5, 0.5, 0});
  System s(build({zoned("below", geom::grid({1, 1, 1}, {1, 1, 1}), 0.3), zoned("above", upper, 0.22)},
                 {{"below", "above", rock_joint()}}));
  REQUIRE(s.model.interfaces.size() == 1);
  for (const cdem::Block& block : s.model.blocks)
    REQUIRE(block.node_end - block.node_begin > 60);
  s.load_all_faces(stress);
  REQUIRE(s.relax(1e-8).converged);
  CHECK(stress_error(s, stress) < 1e-4);
  CHECK(traction_error(s, stress) < 1e-4);
}

TEST_CASE("zoned blocks that have turned as a whole feel nothing", "[zones]") {
  System s(build({zoned("rock", cells(10), 0.3)}));
  const geom::Mat3 turn = rotation({1, 2, -0.5}, 130 * degree);
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.displacement[i] =
        node(turn * s.model.node_position[i] + Vec3(3, -20, 7) - s.model.node_position[i]);
  double largest = 0;
  for (const Vec3& f : s.net_forces())
    largest = std::max(largest, f.norm());
  CHECK(largest < 1e-10 * rock().youngs_modulus);
}

TEST_CASE("a cantilever of zoned blocks bends by the beam formula, the better the finer its zones",
          "[zones][cantilever]") {
  const int blocks = GENERATE(1, 4);
  const Deflection coarse = deflection(blocks, 0.4), middle = deflection(blocks, 0.2),
                   fine = deflection(blocks, 0.1);
  INFO(blocks << " blocks: measured over exact " << coarse.measured / coarse.exact << " with zones of H/2, "
              << middle.measured / middle.exact << " of H/4, " << fine.measured / fine.exact << " of H/8");
  const auto error = [](const Deflection& d) { return std::abs(d.measured / d.exact - 1); };
  CHECK(error(middle) < 0.65 * error(coarse));
  CHECK(error(fine) < 0.5 * error(middle));
  CHECK(error(fine) < 0.06);
}

TEST_CASE("a zoned block slides on a slope by the law of friction, and stays where friction is enough",
          "[zones]") {
  const double slope = 30 * degree, phi = GENERATE(20.0, 35.0);
  const geom::Assembly upper = geom::grid({0.4, 0.4, 0.3}, {1, 1, 1}, {0.2, 0.3, 0});
  cdem::BodySpec plate = body("slope", geom::grid({4, 1, 0.3}, {1, 1, 1}, {0, 0, -0.3}));
  plate.element = cdem::Element::rigid;
  System s(build({plate, zoned("block", upper, 0.15, soft_rock())}, {{"slope", "block", friction(phi)}}));
  s.hold(body_of("slope"), "xyz");
  s.conditions.gravity = gravity(9.81 * Vec3(std::sin(slope), 0, -std::cos(slope)));
  const double start = centroid(s, 1).x();
  cdem::RunOptions options;
  options.duration = 0.6;
  options.local_damping =
      phi < 30 ? 0 : 0.3; // the weight is put on at once: without damping the block would hop
  s.run(options);
  const double acceleration = 9.81 * (std::sin(slope) - std::cos(slope) * std::tan(phi * degree));
  const double way = centroid(s, 1).x() - start;
  if (phi < 30)
    CHECK(way == Approx(0.5 * acceleration * 0.36).epsilon(0.02));
  else
    CHECK(std::abs(way) < 1e-3);
  CHECK(centroid(s, 1).z() == Approx(0.15).margin(2e-3));
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-2);
}

TEST_CASE("zoned blocks that come apart fall, land and stay above the floor", "[zones]") {
  cdem::Joint weak = rock_joint();
  weak.cohesion = weak.tensile_strength = 2e3;
  cdem::BodySpec plate = body("floor", geom::grid({4, 4, 0.3}, {1, 1, 1}, {-1.5, -1.5, -0.3}));
  plate.element = cdem::Element::rigid;
  geom::VoronoiOptions options;
  options.count = 8;
  options.origin = {0, 0, 0.2};
  System s(build({plate, zoned("heap", geom::voronoi(options), 0.35, soft_rock(), weak)},
                 {{"floor", "heap", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions run;
  run.duration = 0.8;
  run.safety = 0.5;
  s.run(run);
  CHECK(std::count(s.state.released.begin(), s.state.released.end(), 1) > 2);
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-2);
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (s.model.blocks[cdem::block_of(s.model, static_cast<int>(i))].body == 1)
      CHECK(s.model.node_position[i].z() + s.state.displacement[i].z > -0.01);
}

TEST_CASE("zoned blocks end in the same bits for every number of threads", "[zones][threads]") {
  const auto hash_with = [](int threads) {
    cdem::Joint weak = rock_joint();
    weak.cohesion = weak.tensile_strength = 2e3;
    System s(build({zoned("cells", cells(6), 0.3, soft_rock(), weak)}));
    s.threads = threads;
    s.hold(cdem::Selection::side("x-"), "xyz");
    s.conditions.gravity = gravity();
    cdem::RunOptions options;
    options.duration = 0.05;
    s.run(options);
    return cdem::hash(s.state);
  };
  CHECK(hash_with(1) == hash_with(3));
}

TEST_CASE("zoned blocks are cut where they are near failure, and their parts are zoned too", "[zones][cut]") {
  cdem::Simulation s = pressed_plate(0.03);
  const double before = s.min("displacement.y").value;
  const auto tets = s.counts().tets;
  cdem::RefineOptions options;
  options.shear_threshold = 2e6;
  const auto cuts = s.refine(options);
  REQUIRE(cuts.size() > 1);
  CHECK(s.counts().blocks > 9);
  CHECK(s.counts().tets > tets);
  cdem::RelaxOptions elastic;
  elastic.breaking = false;
  REQUIRE(s.relax(elastic).converged);
  CHECK(s.min("displacement.y").value == Approx(before).epsilon(2e-2));
}

TEST_CASE("zoned blocks keep an initial stress, and close in on a hole cut into it", "[zones][cut]") {
  cdem::ModelSpec spec;
  spec.bodies = {zoned("rock", geom::grid({0.7, 0.1, 0.7}, {7, 1, 7}, {-0.35, 0, -0.35}), 0.06)};
  cdem::Simulation s(spec, 1, nullptr);
  s.initial_stress(cdem::Selection::everything(), {-2e6, 0, -2e6, 0, 0, 0});
  for (const char* side : {"x-", "x+"})
    s.fix(fixed(cdem::Selection::side(side), "x"));
  for (const char* side : {"z-", "z+"})
    s.fix(fixed(cdem::Selection::side(side), "z"));
  for (const char* side : {"y-", "y+"})
    s.fix(fixed(cdem::Selection::side(side), "y"));
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  CHECK(s.max("displacement.magnitude").value < 1e-12);
  CHECK(s.remove(cdem::Selection::in_box({{-0.06, -1, -0.06}, {0.06, 1, 0.06}})) == 1);
  REQUIRE(s.relax(options).converged);
  const double left = s.at("displacement.x", {-0.051, 0.05, 0}),
               right = s.at("displacement.x", {0.051, 0.05, 0});
  CHECK(left > 0.5 * 2e6 / rock().youngs_modulus * 0.05);
  CHECK(right == Approx(-left).epsilon(0.1)); // the zones are no mirror images
}

TEST_CASE("what is left when zoned blocks are removed keeps its zones and its state", "[zones][cut]") {
  cdem::Simulation s = pressed_plate(0.03);
  const double stress = s.mean("stress.yy", cdem::Selection::in_box({{0, 0, 0}, {0.1, 0.1, 0.03}}));
  const double corner = s.at("displacement.y", {0.01, 0.09, 0.015});
  CHECK(s.remove(cdem::Selection::in_box({{0.11, 0.11, -1}, {0.19, 0.19, 1}})) == 1);
  CHECK(s.counts().blocks == 8);
  CHECK(s.mean("stress.yy", cdem::Selection::in_box({{0, 0, 0}, {0.1, 0.1, 0.03}})) == stress);
  CHECK(s.at("displacement.y", {0.01, 0.09, 0.015}) == corner);
  cdem::RelaxOptions elastic;
  elastic.breaking = false;
  REQUIRE(s.relax(elastic).converged);
  CHECK(s.at("displacement.y", {0.15, 0.205, 0.015}) < s.at("displacement.y", {0.15, 0.095, 0.015}));
}

TEST_CASE("stress of a zoned block is that of its zones, on a side of those that end there", "[zones]") {
  cdem::ModelSpec spec;
  spec.bodies = {zoned("beam", geom::grid({2, 0.4, 0.4}, {1, 1, 1}), 0.13)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  s.traction(traction(cdem::Selection::side("x+"), {0, 0, -1e4}));
  cdem::RelaxOptions options;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  // Bending: tension above, compression below; on the end what pushes there.
  CHECK(s.at("stress.xx", {0.5, 0.2, 0.39}) > 1e4);
  CHECK(s.at("stress.xx", {0.5, 0.2, 0.01}) < -1e4);
  CHECK(s.mean("stress.xz", cdem::Selection::side("x+")) == Approx(-1e4).epsilon(0.35));
  CHECK(s.max("stress.xx", cdem::Selection::side("x+")).value < 0.5 * s.max("stress.xx").value);
}

TEST_CASE("a cut model of zoned blocks is saved and goes on to the same bits", "[zones][cut]") {
  const auto cut = [] {
    cdem::Simulation s = pressed_plate(0.04);
    cdem::RefineOptions options;
    options.shear_threshold = 2e6;
    s.refine(options);
    return s;
  };
  cdem::RunOptions on;
  on.steps = 50;
  cdem::Simulation s = cut();
  const std::string saved = s.save();
  s.run(on);
  cdem::Simulation again = pressed_plate(0.04);
  again.restore(saved);
  again.run(on);
  CHECK(again.state_hash() == s.state_hash());
}

TEST_CASE("zone sizes that cannot be are refused with what to do", "[zones]") {
  const auto refused = [](double size, cdem::Element element) {
    cdem::BodySpec spec = zoned("body", geom::grid({1, 1, 1}, {1, 1, 1}), size);
    spec.element = element;
    build({spec});
  };
  using Catch::Contains;
  CHECK_THROWS_WITH(refused(-1, cdem::Element::finite_volume),
                    Contains("zone_size = -1: must be a finite number > 0"));
  CHECK_THROWS_WITH(refused(0.005, cdem::Element::finite_volume),
                    Contains("zone_size = 0.005: must be such that no block has more than"));
  CHECK_THROWS_WITH(refused(0.3, cdem::Element::small_strain),
                    Contains("zone_size") && Contains("moves far"));
  cdem::BodySpec mesh = meshed("mesh", geom::box_mesh({1, 1, 1}, {1, 1, 1}));
  mesh.zone_size = 0.2;
  CHECK_THROWS_WITH(build({mesh}), Contains("zone_size") && Contains("convex blocks"));
}
