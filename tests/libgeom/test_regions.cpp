// Regions of meshes from other programs: physical groups, volumes, element sets.
#include "libgeom/mesh/read_mesh.hpp"
#include "tests/support/refusal.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace geom;
using Catch::Matchers::Contains;

namespace {

// Three tets in a row over the nodes 1 to 6. In format 2.2 each has a physical group and a volume.
std::string msh2(const std::array<std::array<int, 2>, 3>& group_and_volume) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 7 \"rock\"\n3 9 \"ore\"\n"
                     "$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n6 2 1 1\n"
                     "$EndNodes\n$Elements\n3\n";
  const char* const corners[] = {"1 2 3 4", "2 3 4 5", "2 5 4 6"};
  for (int i = 0; i < 3; ++i)
    text += std::to_string(i + 1) + " 4 2 " + std::to_string(group_and_volume[i][0]) + " " +
            std::to_string(group_and_volume[i][1]) + " " + corners[i] + "\n";
  return text + "$EndElements\n";
}

struct Read {
  TemporaryFolder folder;
  MeshFile operator()(const std::string& name, const std::string& text,
                      const std::string& regions = "") const {
    std::ofstream(folder / name) << text;
    return read_mesh_file(folder / name, regions);
  }
};

const std::vector<int> two_and_one{0, 0, 1};

} // namespace

TEST_CASE("regions are the physical groups where there are several, or else the volumes", "[mesh]") {
  const Read read;
  // One volume in two groups, element by element.
  const MeshFile by_element = read("a.msh", msh2({{{7, 1}, {7, 1}, {9, 1}}}));
  CHECK(by_element.mesh.region == two_and_one);
  CHECK_THAT(by_element.told, Contains("2 regions by \"physical\"") && Contains("rock") && Contains("ore"));
  // Three volumes in two groups.
  const std::string grouped = msh2({{{7, 1}, {7, 2}, {9, 3}}});
  CHECK(read("a.msh", grouped).mesh.region == two_and_one);
  CHECK_THAT(read("a.msh", grouped).told, Contains("\"volumes\", which regions = NAME takes instead"));
  CHECK(read("a.msh", grouped, "volumes").mesh.region == std::vector<int>{0, 1, 2});
  // One group, three volumes: the blocks of a rock.
  CHECK(read("a.msh", msh2({{{7, 1}, {7, 2}, {7, 3}}})).mesh.region == std::vector<int>{0, 1, 2});
  CHECK(read("a.msh", msh2({{{7, 1}, {7, 1}, {7, 1}}})).told.empty());
  CHECK_THAT(testing::refusal([&] { read("a.msh", grouped, "material"); }),
             Contains("regions = \"material\": must be one of \"physical\", \"volumes\""));
}

TEST_CASE("regions of format 4.1 are its physical groups too", "[mesh]") {
  const Read read;
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 7 \"rock\"\n3 9 "
      "\"ore\"\n$EndPhysicalNames\n"
      "$Entities\n0 0 0 3\n1 0 0 0 1 1 1 1 7 0\n2 0 0 0 1 1 1 1 7 0\n3 0 0 0 2 1 1 1 9 0\n$EndEntities\n"
      "$Nodes\n1 6 1 6\n3 1 0 6\n1\n2\n3\n4\n5\n6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n2 1 1\n$EndNodes\n"
      "$Elements\n3 3 1 3\n3 1 4 1\n1 1 2 3 4\n3 2 4 1\n2 2 3 4 5\n3 3 4 1\n3 2 5 4 6\n$EndElements\n";
  CHECK(read("a.msh", text).mesh.region == two_and_one);
  CHECK(read("a.msh", text, "volumes").mesh.region == std::vector<int>{0, 1, 2});
}

TEST_CASE("regions of an Abaqus file are its solid sections, or else its element sets", "[mesh]") {
  const Read read;
  const std::string mesh =
      "*Heading\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1\n6, 2, 1, 1\n"
      "*Element, type=C3D4, elset=One\n11, 1, 2, 3, 4\n12, 2, 3, 4, 5\n"
      "*ELEMENT, TYPE=C3D4, ELSET=Two\n13, 2, 5, 4, 6\n";
  CHECK(read("a.inp", mesh).mesh.region == two_and_one);
  const std::string sections =
      "*Elset, elset=Left\n11\n*Elset, elset=Right, generate\n12, 13, 1\n"
      "*Solid Section, elset=Left, material=a\n*Solid Section, elset=Right, material=b\n";
  CHECK(read("a.inp", mesh + sections).mesh.region == std::vector<int>{0, 1, 1});
  CHECK(read("a.inp", mesh + sections, "sets").mesh.region == two_and_one);
  CHECK_THAT(testing::refusal([&] { read("a.inp", mesh + "*Element, type=C3D10\n"); }),
             Contains("must be C3D4"));
  CHECK_THAT(testing::refusal([&] { read("a.inp", mesh + "*Element, type=C3D4\n14, 1, 2, 3, 99\n"); }),
             Contains("node 99 is not there"));
}
