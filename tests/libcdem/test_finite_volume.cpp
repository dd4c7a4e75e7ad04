// The finite-volume tetrahedron alone and in bodies: constant stress, large rotation, the same bits on any threads.
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/state/state.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/stage.hpp"

#include <catch2/catch.hpp>

using namespace testing;

namespace {

geom::TetMesh irregular_box(int n) {
  return geom::box_mesh({1, 0.8, 1.2}, {n, n, n}, 0.15);
}

cdem::Bonding everywhere(double beta) {
  cdem::Bonding bonding;
  bonding.everywhere = true;
  bonding.stiffness_ratio = beta;
  return bonding;
}

geom::Mat3 some_stress() {
  geom::Mat3 s;
  s << 2e5, 4e5, -1e5, 4e5, -3e5, 2e5, -1e5, 2e5, 5e5;
  return s;
}

// Holds the model against rigid motion without a reaction: at the corner nodes of the first outer triangle.
void hold_rigid_motion(System& s) {
  s.hold(at_place({0, 0, 0}), "xyz");
  s.hold(at_place({1, 0, 0}), "yz");
  s.hold(at_place({0, 0.8, 0}), "z");
}

} // namespace

TEST_CASE("finite volume: a linear displacement gives Hooke's stress in every tet", "[patch][mesh]") {
  System s(build({meshed("unit", irregular_box(3))}));
  geom::Mat3 gradient;
  gradient << 2e-11, 5e-11, -1e-11, -3e-11, 4e-11, 2e-11, 1e-11, -2e-11, 6e-11;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.displacement[i] = s.state.velocity[i] = node(gradient * s.model.node_position[i]);
  cdem::Workspace work(s.model, s.state, s.conditions);
  work.strain_step = 1;
  for (std::size_t c = 0; c < s.model.mesh.chunks.size(); ++c)
    cdem::mesh_forces(s.model, s.state, work, static_cast<std::int64_t>(c), false);
  CHECK(stress_error(s, hooke(rock(), gradient)) < 1e-10);
}

TEST_CASE("finite volume: a uniform load gives a uniform stress, nodes shared", "[patch][mesh]") {
  System s(build({meshed("unit", irregular_box(3))}));
  hold_rigid_motion(s);
  const geom::Mat3 stress = 1e-3 * some_stress(); // strains of 1e-8: the geometry stays as it is
  s.load_all_faces(stress);
  CHECK(s.relax(1e-10).converged);
  CHECK(stress_error(s, stress) < 1e-6);
}

TEST_CASE("finite volume: with every face bonded the error of the stress falls like 1 / beta",
          "[patch][mesh]") {
  const auto error = [](double beta) {
    System s(build({meshed("unit", irregular_box(2), everywhere(beta))}));
    REQUIRE(s.model.node_position.size() == 4 * s.model.tets.size());
    hold_rigid_motion(s);
    s.load_all_faces(some_stress());
    CHECK(s.relax(1e-6).converged);
    return stress_error(s, some_stress());
  };
  const double coarse = error(10), fine = error(100);
  INFO("errors " << coarse << " and " << fine);
  CHECK(coarse / fine > 7);
}

TEST_CASE("finite volume: one slow turn about a skew axis far from the origin keeps the stress",
          "[spin][mesh]") {
  const int steps = 20000;
  geom::TetMesh mesh = irregular_box(1);
  const geom::Vec3 away(1000, -500, 200), axis = geom::Vec3(1, 2, -0.5).normalized();
  for (geom::Vec3& x : mesh.nodes)
    x += away;
  System s(build({meshed("unit", mesh)}));
  const bool prestressed = GENERATE(false, true);
  if (prestressed)
    for (cdem::StressBatch& batch : s.state.stress)
      for (int c = 0; c < 6; ++c)
        for (double& lane : batch.component[c])
          lane = cdem::tensor(some_stress())[c];
  const geom::Vec3 centre = away + geom::Vec3(0.5, 0.4, 0.6);
  cdem::Workspace work(s.model, s.state, s.conditions);
  const auto turned = [&](double angle, const geom::Vec3& x) {
    return geom::Vec3(centre + Eigen::AngleAxisd(angle, axis) * (x - centre));
  };
  // Kinematics imposed exactly: the nodes step along the chords of their circles.
  const double dt = 1e-3;
  for (int step = 1; step <= steps; ++step) {
    for (std::size_t i = 0; i < s.model.node_position.size(); ++i) {
      const geom::Vec3& x = s.model.node_position[i];
      const geom::Vec3 now = turned(2 * pi * step / steps, x),
                       before = turned(2 * pi * (step - 1) / steps, x);
      s.state.displacement[i] = node(now - x);
      s.state.velocity[i] = node((now - before) / dt);
    }
    work.strain_step = dt;
    cdem::mesh_forces(s.model, s.state, work, 0, false);
  }
  const geom::Mat3 expected = prestressed ? some_stress() : geom::Mat3::Zero().eval();
  for (int t = 0; t < static_cast<int>(s.model.tets.size()); ++t) {
    const double error = (tet_stress(s, t) - expected).norm();
    CHECK(error < (prestressed ? 1e-5 * some_stress().norm() : 1e-9 * rock().youngs_modulus));
  }
}

TEST_CASE("finite volume: a body bonded everywhere has E / (1 + 1/beta) left", "[bonds][mesh]") {
  const double beta = GENERATE(3.0, 10.0, 30.0);
  System s(build({meshed("unit", geom::box_mesh({1, 1, 2}, {4, 4, 8}, 0.15), everywhere(beta))}));
  s.hold(cdem::Selection::side("z-"), "z");
  s.hold(at_place({0, 0, 0}), "xyz");
  s.hold(at_place({1, 0, 0}), "y");
  s.conditions.tractions.push_back(traction(cdem::Selection::side("z+"), {0, 0, 1e5}));
  CHECK(s.relax(1e-6).converged);
  const double uz = cdem::mean_value(s.model, s.state, "displacement.z", cdem::Selection::side("z+"));
  const double modulus = 1e5 * 2 / uz;
  INFO("E_eff / E = " << modulus / rock().youngs_modulus);
  CHECK(modulus == Approx(rock().youngs_modulus / (1 + 1 / beta)).epsilon(0.05));
}

TEST_CASE("finite volume: the same bits for 1, 2 and 4 threads", "[hash][mesh]") {
  std::uint64_t first = 0;
  // Chunks that share nodes, and enough small ones that four threads are worth their barriers.
  cdem::BodySpec unit = meshed("unit", geom::box_mesh({1, 1, 1}, {12, 12, 12}, 0.15), everywhere(3));
  for (int i = 0; i < 120; ++i) {
    geom::TetMesh crumb = geom::box_mesh({0.1, 0.1, 0.1}, {1, 1, 1});
    for (geom::Vec3& x : crumb.nodes)
      x += geom::Vec3(2 + 0.2 * i, 0.5, 0.5);
    unit.meshes.push_back(std::move(crumb));
  }
  const cdem::Model model = build({unit});
  for (const int threads : {1, 2, 4}) {
    System s(model);
    REQUIRE(cdem::useful_threads(s.model, threads) == threads);
    s.threads = threads;
    s.hold(cdem::Selection::side("z-"), "xyz");
    s.conditions.tractions.push_back(traction(cdem::Selection::side("z+"), {3e6, 0, 8e6}));
    cdem::RunOptions options;
    options.steps = 40;
    s.run(options);
    if (threads == 1) {
      first = cdem::hash(s.state);
      CHECK(s.log.broken_tension + s.log.broken_shear > 0);
    } else
      CHECK(cdem::hash(s.state) == first);
  }
}

TEST_CASE("finite volume: the energy balance closes, elastic and with breaking bonds", "[energy][mesh]") {
  const bool breaking = GENERATE(false, true);
  System s(build({meshed("unit", geom::box_mesh({1, 1, 2}, {3, 3, 6}, 0.15), everywhere(10))}));
  s.hold(cdem::Selection::side("z-"), "xyz");
  s.conditions.tractions.push_back(traction(cdem::Selection::side("z+"), {1e6, 0, 6e6}));
  cdem::RunOptions options;
  options.steps = 600;
  options.safety = 0.5;
  options.breaking = breaking;
  s.run(options);
  const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
  INFO("elastic " << ledger.elastic << " springs " << ledger.springs << " kinetic " << ledger.kinetic
                  << " breaking " << ledger.breaking << " friction " << ledger.friction << " external "
                  << ledger.external);
  if (breaking)
    CHECK(s.log.broken_tension > 0);
  CHECK(ledger.balance_error() < (breaking ? 1e-2 : 1e-3));
}
