// A heap of tetrahedra that two plates crush: the pieces of a body of which every bond is broken press on each other about as bodies
// that were never bonded do, which other contacts act on.
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {
namespace rubble {

constexpr double side = 0.3, pressed_by = 0.02; // m
constexpr double speed = 1;                     // m/s, of the upper plate

cdem::Elastic stone() {
  cdem::Elastic m = rock();
  m.youngs_modulus = 1e9;
  return m;
}

cdem::BodySpec plate(const std::string& name, double from) {
  geom::TetMesh box = geom::box_mesh({3 * side, 3 * side, 0.1}, {2, 2, 1});
  for (Vec3& x : box.nodes)
    x += Vec3(-side, -side, from);
  cdem::BodySpec spec = meshed(name, std::move(box), {}, stone());
  spec.element = cdem::Element::rigid;
  return spec;
}

cdem::EnergyLedger crush(System& s) {
  for (const bool lower : {true, false}) {
    cdem::Fix fix;
    fix.on = body_of(lower ? "lower" : "upper");
    fix.velocity = Vec3(0, 0, lower ? 0 : -speed);
    s.conditions.fixes.push_back(fix);
  }
  cdem::RunOptions options;
  options.duration = pressed_by / speed;
  s.run(options);
  return cdem::energy(s.model, s.state);
}

System one_body(const geom::TetMesh& mesh, const cdem::Joint& rough) {
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  System s(
      build({meshed("rubble", mesh, everywhere, stone(), rough), plate("lower", -0.1), plate("upper", side)},
            {{"rubble", "rubble", rough}, {"rubble", "lower", rough}, {"rubble", "upper", rough}}));
  each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    cdem::slips_of(s.state, batch);
    for (auto& point : s.state.faces[batch].mode)
      point[lane] = static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
  });
  return s;
}

System many_bodies(const geom::TetMesh& mesh, const cdem::Joint& rough) {
  std::vector<cdem::BodySpec> bodies;
  for (const geom::Tet& tet : mesh.tets) {
    geom::TetMesh single;
    for (const int node : tet)
      single.nodes.push_back(mesh.nodes[node]);
    single.tets = {{0, 1, 2, 3}};
    single.region = {0};
    bodies.push_back(meshed("stone " + std::to_string(bodies.size()), single, {}, stone()));
  }
  bodies.push_back(plate("lower", -0.1));
  bodies.push_back(plate("upper", side));
  std::vector<cdem::PairSpec> pairs;
  for (std::size_t i = 0; i + 2 < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j)
      pairs.push_back({bodies[i].name, bodies[j].name, rough});
  return System(build(bodies, pairs));
}

} // namespace rubble
} // namespace

TEST_CASE("rubble: pieces of a body resist being crushed as bodies that were never bonded do",
          "[contact][fracture][rubble]") {
  const geom::TetMesh mesh = unstructured({rubble::side, rubble::side, rubble::side}, 0.15);
  const cdem::Joint rough = friction(20);
  System body = rubble::one_body(mesh, rough), bodies = rubble::many_bodies(mesh, rough);
  const cdem::EnergyLedger one = rubble::crush(body), many = rubble::crush(bodies);
  INFO("work " << one.external << " and " << many.external << " J, energy open by " << one.balance_error()
               << " and " << many.balance_error());
  CHECK(one.external > 0.7 * many.external);
  CHECK(one.external < 1.15 * many.external);
  CHECK(one.balance_error() < 2e-3);
}
