// Faces inside a region of a mesh, or between two, with a joint of their own.
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/two_halves.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double weak = 1e6; // Pa

cdem::Joint weaker(cdem::Joint joint) {
  joint.tensile_strength = weak;
  joint.cohesion = 2 * weak;
  joint.friction_angle = 20 * degree;
  return joint;
}

cdem::BodySpec halves(cdem::BondKind kind, std::pair<int, int> regions) {
  const bool is_cohesive = kind == cdem::BondKind::cohesive;
  cdem::Bonding bonding = cohesive();
  bonding.kind = kind;
  bonding.stiffness_ratio = is_cohesive ? 1 : 10;
  cdem::Joint joint = concrete_joint(is_cohesive ? cdem::Softening::linear : cdem::Softening::none);
  cdem::BodySpec body = meshed("block", two_halves(2), bonding, concrete(), joint);
  body.region_laws.joints = {weaker(joint)};
  body.region_laws.regions = {regions};
  return body;
}

// Pulls along z until something breaks, and somewhat further. peak: mean traction at the end, Pa.
System pulled(const cdem::BodySpec& body, double& peak) {
  System s(build({body}));
  for (const double end : {-1.0, 1.0}) {
    cdem::Fix lead = fixed(cdem::Selection::side(end < 0 ? "z-" : "z+"), "z");
    lead.velocity = 0.002 * end * Vec3::UnitZ();
    s.conditions.fixes.push_back(lead);
  }
  // All of it moves as it does at this rate: no wave runs through. In the time that one takes to the ends the stress
  // rises by 2 %.
  const double rate = 0.004 / (2 * half), nu = concrete().poissons_ratio;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
    const Vec3 x = s.model.node_position[i] - Vec3(side / 2, side / 2, half);
    s.state.velocity[i] = node(rate * Vec3(-nu * x.x(), -nu * x.y(), x.z()));
  }
  cdem::RunOptions options;
  options.steps = 1 << 30;
  options.callback_every = 10;
  options.callback = [&] {
    const std::vector<Vec3> forces = s.net_forces();
    double sum = 0;
    for (std::size_t i = 0; i < forces.size(); ++i)
      if (s.model.node_position[i].z() > 2 * half - 1e-9)
        sum -= forces[i].z();
    peak = std::max(peak, sum / area);
  };
  options.stop = [&] { return s.log.breaks.size() > 5; };
  s.run(options);
  return s;
}

} // namespace

TEST_CASE("region joints: a weak face between two regions breaks there, at its own strength", "[regions]") {
  const cdem::BondKind kind = GENERATE(cdem::BondKind::springs, cdem::BondKind::cohesive);
  double peak = 0;
  const System s = pulled(halves(kind, {0, 1}), peak);
  REQUIRE(s.log.broken_tension > 0);
  for (const cdem::BreakRow& row : s.log.breaks)
    CHECK(row.place.z() == Approx(half));
  INFO((kind == cdem::BondKind::springs ? "springs" : "cohesive"));
  CHECK(peak == Approx(weak).epsilon(0.03));
}

TEST_CASE("region joints: a weak region breaks inside", "[regions]") {
  const cdem::BondKind kind = GENERATE(cdem::BondKind::springs, cdem::BondKind::cohesive);
  double peak = 0;
  const System s = pulled(halves(kind, {1, 1}), peak);
  REQUIRE_FALSE(s.log.breaks.empty());
  for (const cdem::BreakRow& row : s.log.breaks)
    CHECK(row.place.z() > half + 1e-6);
}

TEST_CASE("region joints: faces of other regions have the body's joint to the last bit", "[regions]") {
  const cdem::Model model = build({halves(cdem::BondKind::springs, {0, 1})});
  int own = 0, others = 0;
  cdem::each_face(model.mesh, [&](const cdem::MeshChunk& chunk, std::int64_t batch, int lane) {
    const cdem::FaceLaw law = cdem::face_law(model, chunk, batch, lane);
    double z = 0;
    for (const int node : face_nodes(model.mesh, chunk, batch, lane).a)
      z += model.node_position[node].z() / 3;
    const bool between = std::abs(z - half) < 1e-9;
    ++(between ? own : others);
    CHECK(law.tensile_strength == (between ? weak : 3e6));
    CHECK(law.cohesion == (between ? 2 * weak : 6e6));
    CHECK(law.tan_friction == Approx(std::tan((between ? 20 : 30) * degree)).epsilon(1e-14));
  });
  CHECK(own == 8); // two triangles of each of the four squares
  CHECK(others > 100);
}

TEST_CASE("region joints: wrong input is refused", "[regions][input]") {
  const auto refused = [](const auto& change, const char* says) {
    cdem::BodySpec body = halves(cdem::BondKind::cohesive, {0, 1});
    change(body);
    cdem::ModelSpec spec;
    spec.bodies = {body};
    CHECK_THROWS_WITH(cdem::Simulation(spec, 1, nullptr), Catch::Contains(says));
  };
  refused(
      [](auto& b) {
        b.region_laws.regions[0] = {0, 2};
      },
      "region_joints[1] = 3: must be regions of the mesh");
  refused([](auto& b) { b.region_laws.regions[0] = {-1, 1}; }, "region_joints[1] = 0");
  refused(
      [](auto& b) {
        b.region_laws.regions.push_back({0, 1});
        b.region_laws.joints.push_back(b.joint);
      },
      "region_joints[2] = {1, 2}: must be given once");
  refused(
      [](auto& b) {
        b.bonding.everywhere = false;
        b.bonding.between_regions = true;
        b.region_laws.regions[0] = {1, 1};
      },
      "regions whose faces are bonded");
  refused([](auto& b) { b.region_laws.joints[0] = friction(30); }, "region_joints[1] = a contact");
  refused([](auto& b) { b.region_laws.joints[0].tensile_strength = 0; }, "tensile_strength");
  refused([](auto& b) { b.region_laws.joints[0].fracture_energy_1 = 1e-4; }, "fracture_energy_1");
  refused([](auto& b) { b.bonding.kind = cdem::BondKind::springs; }, "bonds");
  refused(
      [](auto& b) {
        for (std::size_t t = 0; t < b.meshes[0].tets.size(); ++t)
          if (b.meshes[0].region[t] == 1 && t % 2 == 0)
            b.meshes[0].region[t] = 1;
        b.meshes.push_back(placed(two_halves(1), geom::Mat3::Identity(), {2, 0, 0}));
        for (int& region : b.meshes[1].region)
          region += 2;
        b.region_laws.regions[0] = {1, 2};
      },
      "regions that share faces");
}
