// The process zone E' G_I / T^2 beside the faces of meshes and blocks.
#include "libcdem/results/process_zone.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

using namespace testing;

namespace {

constexpr double length = 30e9 / (1 - 0.04) * 100 / 9e12; // m, of concrete with concrete_joint

cdem::BodySpec bar(double edge, cdem::Softening softening = cdem::Softening::linear) {
  return meshed("bar", unstructured({0.6, 0.25, 0.25}, edge), cohesive(), concrete(),
                concrete_joint(softening));
}

} // namespace

TEST_CASE("process zone: of a cohesive body, beside its faces, freed or not", "[process_zone]") {
  const double edge = GENERATE(0.06, 0.12);
  const auto zones = cdem::process_zones(build({bar(edge)}));
  REQUIRE(zones.size() == 1);
  CHECK(zones[0].of == "\"bar\"");
  CHECK(zones[0].length == Approx(length).epsilon(1e-12));
  CHECK(zones[0].face_size > 0.7 * edge);
  CHECK(zones[0].face_size < 1.3 * edge);
  CHECK(zones[0].largest_face_size == Approx(0.88 * length / 3).epsilon(1e-12)); // 0.102 m
  CHECK(zones[0].faces_in_zone() == Approx(0.88 * length / zones[0].face_size).epsilon(1e-12));
  CHECK(zones[0].resolved() == (zones[0].face_size <= 0.88 * length / 3));
}

TEST_CASE("process zone: faces of equal triangles are as long as their edge", "[process_zone]") {
  // Two regular tetrahedra of edge 0.1 on one face.
  geom::TetMesh mesh;
  const double h = 0.1 * std::sqrt(2.0 / 3), r = 0.1 / std::sqrt(3.0);
  for (int i = 0; i < 3; ++i)
    mesh.nodes.emplace_back(r * std::cos(i * 2 * pi / 3), r * std::sin(i * 2 * pi / 3), 0);
  mesh.nodes.emplace_back(0, 0, h);
  mesh.nodes.emplace_back(0, 0, -h);
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.region = {0, 0};
  const auto zones = cdem::process_zones(
      build({meshed("pair", mesh, cohesive(), concrete(), concrete_joint(cdem::Softening::linear))}));
  REQUIRE(zones.size() == 1);
  CHECK(zones[0].face_size == Approx(0.1).epsilon(1e-12));
}

TEST_CASE("process zone: brittle bodies have none, laws of regions one each", "[process_zone]") {
  CHECK(cdem::process_zones(build({bar(0.12, cdem::Softening::none)})).empty());
  cdem::BodySpec body = bar(0.1);
  for (std::size_t t = 0; t < body.meshes[0].tets.size(); ++t) {
    double x = 0;
    for (const int node : body.meshes[0].tets[t])
      x += body.meshes[0].nodes[node].x() / 4;
    body.meshes[0].region[t] = x > 0.3;
  }
  body.region_laws.joints = {body.joint};
  body.region_laws.joints[0].fracture_energy_1 *= 4;
  body.region_laws.regions = {{0, 1}};
  const auto zones = cdem::process_zones(build({body}));
  REQUIRE(zones.size() == 2);
  for (const cdem::ProcessZone& zone : zones)
    CHECK(zone.length == Approx(zone.of == "\"bar\"" ? length : 4 * length).epsilon(1e-12));
  CHECK((zones[0].of == "\"bar\", regions 1 and 2" || zones[1].of == "\"bar\", regions 1 and 2"));
}

TEST_CASE("process zone: between blocks, by the square of the face's area", "[process_zone]") {
  cdem::Joint joint = concrete_joint(cdem::Softening::linear);
  const auto zones =
      cdem::process_zones(build({body("row", geom::grid({0.4, 0.1, 0.2}, {4, 1, 1}), concrete(), joint)}));
  REQUIRE(zones.size() == 1);
  CHECK(zones[0].length == Approx(length).epsilon(1e-12));
  CHECK(zones[0].face_size == Approx(std::sqrt(0.1 * 0.2)).epsilon(1e-12));
}
