// When a crack begins follows from the stress of its face alone: not from the rate, the step or the numbering.
#include "libcdem/bond/fragments.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/going_on.hpp"

#include <catch2/catch.hpp>

#include <numeric>
#include <random>
#include <set>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double long_side = 0.1, short_side = 0.02; // m

// A bar without Poisson's effect, stretched uniformly from the start: no wave runs through.
System stretched_bar(double rate, const geom::TetMesh& mesh, cdem::Softening softening) {
  cdem::BodySpec body = concrete_body(mesh, softening);
  body.material.poissons_ratio = 0;
  System s(build({body}));
  const double length = s.model.box.max.x();
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node({rate * (s.model.node_position[i].x() - length / 2), 0, 0});
  lead_apart(s.conditions.fixes, rate * length);
  return s;
}

int pieces_of(const System& s) {
  const std::vector<int> of_nodes = cdem::fragments_of_nodes(s.model, s.state);
  return static_cast<int>(std::set<int>(of_nodes.begin(), of_nodes.end()).size());
}

} // namespace

TEST_CASE("begin cracks: a bar breaks at its strength at any rate and step", "[cohesive][breaking]") {
  const double rate = GENERATE(1.0, 10.0, 100.0), safety = GENERATE(0.9, 0.2);
  System s = stretched_bar(rate, geom::box_mesh({long_side, short_side, short_side}, {10, 2, 2}),
                           cdem::Softening::none);
  double first = 0, most = 0;
  cdem::RunOptions options;
  options.steps = 1 << 30;
  options.safety = safety;
  options.callback_every = 1;
  options.callback = [&] {
    const double traction = end_traction(s, short_side * short_side);
    most = std::max(most, traction);
    bool broken = false;
    cdem::each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
      broken = broken || !cdem::holds(s.state.faces[batch].stage[lane]);
    });
    if (first == 0 && broken)
      first = traction;
  };
  options.stop = [&] { return first > 0; };
  s.run(options);
  INFO("rate " << rate << ", safety " << safety << ", first " << first / tension << ", most "
               << most / tension);
  CHECK(first == Approx(tension).epsilon(0.02));
  CHECK(most == Approx(tension).epsilon(0.02));
}

// On the mesh of 0.14 m no cut through the bar has only faces within 45 degrees of its section.
TEST_CASE("begin cracks: a bar one tet across parts at its strength, however its faces lie",
          "[cohesive][breaking]") {
  const double edge = GENERATE(0.14, 0.12), width = 0.14;
  System s = stretched_bar(0.1, unstructured({1, width, width}, edge), cdem::Softening::linear);
  double most = 0;
  cdem::RunOptions options;
  options.duration = 3e-3;
  options.callback_every = 1;
  options.callback = [&] { most = std::max(most, end_traction(s, width * width)); };
  s.run(options);
  const double taken = cdem::energy(s.model, s.state).breaking / (energy_1 * width * width); // cuts
  INFO("edge " << edge << ", most " << most / tension << ", pieces " << pieces_of(s) << ", " << taken
               << " cuts, left " << end_traction(s, width * width) / tension);
  CHECK(most == Approx(tension).epsilon(0.02));
  CHECK(pieces_of(s) >= 2);
  CHECK(taken > 0.9 * (pieces_of(s) - 1));
  CHECK(taken < 1.5 * (pieces_of(s) - 1)); // it does not flow
}

TEST_CASE("begin cracks: a body with other numbers breaks in the same way", "[cohesive][breaking]") {
  const geom::TetMesh mesh = unstructured({long_side, 2 * short_side, 2 * short_side}, 0.015);
  geom::TetMesh shuffled = mesh;
  std::mt19937 draw(5);
  std::vector<int> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), draw);
  for (std::size_t i = 0; i < number.size(); ++i)
    shuffled.nodes[number[i]] = mesh.nodes[i];
  for (geom::Tet& tet : shuffled.tets)
    tet = {number[tet[1]], number[tet[2]], number[tet[0]], number[tet[3]]};
  std::shuffle(shuffled.tets.begin(), shuffled.tets.end(), draw);
  const auto broken = [&](const geom::TetMesh& of) {
    System s(build({concrete_body(of)}));
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
      const double side = s.model.node_position[i].x() > long_side / 2 ? 1 : -1;
      s.state.velocity[i] = node({side * 0.9, 0.1, 0.1 * side});
    }
    cdem::RunOptions options;
    options.steps = 30;
    options.safety = 0.3;
    s.run(options);
    std::int64_t cracked = 0;
    cdem::each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
      cracked += cdem::holds(s.state.faces[batch].stage[lane]) ? 0 : 1;
    });
    return std::pair(cracked, cdem::energy(s.model, s.state).kinetic);
  };
  const auto [cracked, kinetic] = broken(mesh);
  const auto [cracked_then, kinetic_then] = broken(shuffled);
  CHECK(cracked > 20);
  CHECK(cracked == cracked_then);
  CHECK(kinetic == Approx(kinetic_then).epsilon(1e-6));
}

TEST_CASE("begin cracks: a notch along faces of a cohesive body carries nothing", "[cohesive][breaking]") {
  cdem::ModelSpec spec;
  spec.bodies = {concrete_body(geom::box_mesh({0.2, 0.1, 0.1}, {4, 2, 2}))};
  cdem::Simulation s(spec, 1, nullptr);
  const int bonds = 8 * 3; // two triangles of each of four squares
  CHECK(s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0.1, 0, 0}, {1, 0, 0}))) == bonds);
  CHECK(s.counts().contacts == bonds);
  CHECK(s.counts().broken_tension + s.counts().broken_shear == 0);
  CHECK(s.fragments().size() == 2);
  CHECK_THROWS_WITH(s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0.11, 0, 0}, {1, 0, 0}))),
                    Catch::Contains("of a cohesive body whole faces"));
}

TEST_CASE("begin cracks: a notch closed by pressure, with shear that friction holds, disturbs no balance",
          "[cohesive][breaking][initial_stress]") {
  const auto softening = GENERATE(cdem::Softening::none, cdem::Softening::linear);
  const bool stress_first = GENERATE(true, false);
  const double pressure = 5e6, shear = GENERATE(1e6, 3e6); // Pa; friction of 30 degrees holds 2.9e6
  const std::array<double, 6> stress{-pressure, -3e6, -4e6, shear, 0, 0};
  cdem::ModelSpec spec;
  spec.bodies = {concrete_body(geom::box_mesh({0.2, 0.1, 0.1}, {4, 2, 2}), softening)};
  cdem::Simulation s(spec, 1, nullptr);
  for (const cdem::Traction& traction : on_six_sides(symmetric(-pressure, -3e6, -4e6, shear, 0, 0)))
    s.traction(traction);
  const auto notch = [&] {
    s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0.1, 0, 0}, {1, 0, 0})));
  };
  if (!stress_first)
    notch();
  s.initial_stress(cdem::Selection::everything(), stress);
  if (stress_first)
    notch();
  CHECK(s.energy().balance_error() < 1e-12);
  cdem::RunOptions options;
  options.steps = 100;
  s.run(options);
  const double strained = 0.2 * pressure / concrete().youngs_modulus; // m, by which the body is compressed
  INFO("moved " << s.max("displacement.magnitude").value << " of " << strained);
  if (shear < pressure * std::tan(30 * degree)) {
    CHECK(s.max("displacement.magnitude").value < 1e-9 * strained);
    CHECK(std::abs(s.energy().breaking) < 1e-12);
  } else {
    CHECK(s.max("displacement.magnitude").value > 0.1 * strained); // it slides
  }
  CHECK(s.energy().balance_error() < 3e-3);
}

TEST_CASE("begin cracks: a notch in a body under tension is free of traction", "[cohesive][breaking]") {
  cdem::ModelSpec spec;
  spec.bodies = {concrete_body(geom::box_mesh({0.2, 0.1, 0.1}, {4, 2, 2}))};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  s.initial_stress(cdem::Selection::everything(), {1e6, 0, 0, 0, 0, 0});
  s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0.1, 0, 0}, {1, 0, 0})));
  cdem::RelaxOptions options;
  options.residual = 1e-3;
  s.relax(options);
  CHECK(std::abs(s.reaction(cdem::Selection::side("x-")).x()) < 0.01 * 1e6 * 0.01);
}

// Two arms with a joint between them are led apart across it (double cantilever beam), or bent together beside a wall (end-loaded
// split): the crack grows by opening alone or by slip alone, from one cell of the mesh to the next.
TEST_CASE("begin cracks: a crack that grows along a joint takes its fracture energy", "[cohesive][energy]") {
  const bool opens = GENERATE(true, false);
  const double height = 0.12, width = 0.02, cell = 0.02;
  const double length = opens ? 0.3 : 0.6, notch = opens ? 0.1 : 0.36;
  geom::TetMesh mesh = geom::box_mesh({length, height, width}, {static_cast<int>(length / cell + 0.5), 6, 1});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double y = 0;
    for (const int node : mesh.tets[t])
      y += mesh.nodes[node].y() / 4;
    mesh.region[t] = y > height / 2;
  }
  cdem::Bonding bonding = cohesive();
  bonding.everywhere = false;
  bonding.between_regions = true;
  cdem::BodySpec body = meshed("arms", mesh, bonding, concrete(), concrete_joint(cdem::Softening::linear, 0));
  body.material.poissons_ratio = 0;
  body.joint.fracture_energy_2 = energy_1;
  cdem::ModelSpec spec;
  spec.bodies = {body};
  cdem::Simulation s(spec, 1, nullptr);
  const auto within = [](const Vec3& min, const Vec3& max) { return cdem::Selection::in_box({min, max}); };
  s.break_bonds(within({-1, height / 2 - 1e-6, -1}, {notch + 1e-6, height / 2 + 1e-6, 1}), true);
  s.fix(fixed(cdem::Selection::side("z-"), "z"));
  const cdem::Selection upper = within({-1e-6, height - 1e-6, -1}, {1e-6, 1, 1}),
                        lower = within({-1e-6, -1e-6, -1}, {1e-6, 1e-6, 1}),
                        led = opens ? upper : cdem::Selection::side("x-");
  if (opens) {
    s.fix(fixed(lower, "xy"));
    s.fix(fixed(upper, "x"));
  } else {
    s.fix(fixed(cdem::Selection::side("x+"), "xy"));
  }
  struct Grown {
    double area = 0, taken = 0;
  };
  std::vector<Grown> grown; // each time that the crack is larger
  for (int i = 0; i <= 40; ++i) {
    cdem::Fix lead = fixed(led, "y");
    lead.displacement = Vec3(0, opens ? 1e-4 + 1e-5 * i : 6e-4 + 5e-5 * i, 0);
    s.release(led, {false, true, false});
    s.fix(lead);
    cdem::RelaxOptions options;
    options.residual = 1e-3;
    s.relax(options);
    const cdem::Cracks cracks = s.cracks().all();
    if (grown.empty() || cracks.broken() > grown.back().area)
      grown.push_back({cracks.broken(), s.energy().breaking});
  }
  REQUIRE(grown.size() > 5);
  const double area = grown.back().area - grown[1].area, taken = grown.back().taken - grown[1].taken;
  INFO((opens ? "opens" : "slides") << ", cells " << area / (cell * width) << ", taken over G A "
                                    << taken / (energy_1 * area));
  CHECK(area > 2 * cell * width);
  CHECK(taken == Approx(energy_1 * area).epsilon(0.1));
}
