// Joints of finite size: what discs cut, and tables of discs.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/discs.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libgeom/assembly_laws.hpp"
#include "tests/libgeom/degree.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>

using namespace geom;
using Catch::Matchers::Contains;
using testing::degree;

namespace {

Disc level_disc(const Vec3& centre, double radius, std::int64_t id = 1) {
  return {id, centre, 0, 0, radius, "fracture"};
}

// Area of the faces of each name, counted once for both sides; "" without the outside of the box.
std::map<std::string, double> areas(const Assembly& a) {
  std::map<std::string, double> sum;
  const Box box = bounding_box(a);
  for (const Polyhedron& block : a.blocks)
    for (int f = 0; f < static_cast<int>(block.faces.size()); ++f) {
      const Vec3 c = face_centroid(block, f);
      if ((c - box.min).minCoeff() > 1e-9 && (box.max - c).minCoeff() > 1e-9)
        sum[block.faces[f].cut] += 0.5 * face_area(block, f);
    }
  return sum;
}

std::string refusal_of_discs(const std::string& text) {
  try {
    read_discs(text, "dfn.csv");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

const std::string head = "id,x,y,z,dip,dip_direction,radius,set\n";

} // namespace

TEST_CASE("a disc cuts the blocks it reaches and no others", "[discs]") {
  const Assembly grid10 = grid({10, 10, 1}, {10, 10, 1});
  const Assembly cut = cut_by_discs(grid10, {level_disc({5, 5, 0.5}, 1.9)});
  std::size_t reached = 0; // cells whose nearest point is nearer than 1.9 m
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      const double dx = std::max({i - 5.0, 0.0, 5.0 - (i + 1)}), dy = std::max({j - 5.0, 0.0, 5.0 - (j + 1)});
      reached += std::hypot(dx, dy) < 1.9;
    }
  CHECK(cut.blocks.size() == 100 + reached);
  double volume = 0;
  for (const Polyhedron& block : cut.blocks)
    volume += mass_properties(block).volume;
  CHECK(volume == Approx(100));
}

TEST_CASE("faces in the disc belong to its set, those beyond are bridges without a name", "[discs]") {
  const Assembly cut = cut_by_discs(grid({10, 10, 1}, {50, 50, 1}), {level_disc({5, 5, 0.5}, 3)});
  auto sum = areas(cut);
  CHECK(sum["fracture"] == Approx(3.14159265 * 9).epsilon(0.02));
  CHECK(sum.count("") == 1);
}

TEST_CASE("discs dip towards their dip direction and leave what they do not reach whole", "[discs]") {
  Disc disc{7, {1, 1, 1}, 60 * degree, 90 * degree, 0.9, "east"};
  const Assembly cut = cut_by_discs(grid({2, 2, 2}, {1, 1, 1}), {disc});
  REQUIRE(cut.blocks.size() == 2);
  for (int f = 0; f < static_cast<int>(cut.blocks[0].faces.size()); ++f)
    if (cut.blocks[0].faces[f].cut == "east") {
      const Vec3 n = face_normal(cut.blocks[0], f) * (face_normal(cut.blocks[0], f).z() > 0 ? 1 : -1);
      CHECK(n.x() == Approx(std::sin(60 * degree)));
      CHECK(n.y() == Approx(0).margin(1e-12));
    }
  disc.centre = {5, 5, 5};
  CHECK(cut_by_discs(grid({2, 2, 2}, {1, 1, 1}), {disc}).blocks.size() == 1);
}

TEST_CASE("the order in which discs are given does not matter, and an id twice is refused", "[discs]") {
  const Disc a = level_disc({1, 1, 0.7}, 0.8, 1);
  Disc b = level_disc({1, 1, 1.2}, 3, 2);
  b.dip = 50 * degree;
  const Assembly one = cut_by_discs(grid({2, 2, 2}, {2, 2, 2}), {a, b}),
                 other = cut_by_discs(grid({2, 2, 2}, {2, 2, 2}), {b, a});
  REQUIRE(one.blocks.size() == other.blocks.size());
  for (std::size_t i = 0; i < one.blocks.size(); ++i)
    CHECK(one.blocks[i].vertices == other.blocks[i].vertices);
  CHECK_THROWS_WITH(cut_by_discs(grid({2, 2, 2}, {1, 1, 1}), {a, a}), Contains("disc 1: given twice"));
}

TEST_CASE("two discs near each other cut off exactly what lies between them with no clearance", "[discs]") {
  // Planes that meet in one line at an angle: the wedges between them have h L^2 / 2 each, h the slope of the second.
  const double slope = 1e-3, half = 2, width = 3;
  const Assembly block = grid({2 * half, width, 4}, {1, 1, 1});
  std::vector<Disc> discs{{1, {half, width / 2, 2}, 0, 90 * degree, 50, "a"},
                          {2, {half, width / 2, 2}, std::atan(slope), 90 * degree, 50, "a"}};
  MovedCuts moved;
  const Assembly exact = cut_by_discs(block, discs, 0, &moved);
  REQUIRE(exact.blocks.size() == 4);
  CHECK(moved.count == 0);
  std::vector<double> volumes;
  for (const Polyhedron& part : exact.blocks)
    volumes.push_back(mass_properties(part).volume);
  std::sort(volumes.begin(), volumes.end());
  for (int i : {0, 1})
    CHECK(volumes[static_cast<std::size_t>(i)] == Approx(slope * half * half / 2 * width).epsilon(1e-9));
  // With one, the second goes on to the face that is there already, and says how far it went.
  discs[1].dip = 0;
  discs[1].centre.z() += 1e-4;
  const Assembly apart = cut_by_discs(block, discs, 0.01, &moved);
  CHECK(apart.blocks.size() == 2);
  CHECK(moved.count == 1);
  CHECK(moved.farthest == Approx(1e-4));
  CHECK_THROWS_WITH(cut_by_discs(block, discs, -1), Contains("clearance = -1"));
}

TEST_CASE("tables of discs are read by the names of their columns", "[discs]") {
  const auto discs = read_discs("set,id,z,y,x,radius,dip,dip_direction\nbedding,3,30,20,10,1.5,45,180\n\n"
                                "\"faults\" , 4, 1,2,3, 2,90,360\r\n",
                                "dfn.csv");
  REQUIRE(discs.size() == 2);
  CHECK(discs[0].centre == Vec3(10, 20, 30));
  CHECK(discs[0].dip == Approx(45 * degree));
  CHECK(discs[0].set == "bedding");
  CHECK(discs[1].set == "faults");
  CHECK(discs[1].id == 4);
}

TEST_CASE("tables of discs that are damaged or hostile are refused in one line", "[discs]") {
  CHECK_THAT(refusal_of_discs(""), Contains("file \"dfn.csv\": is empty"));
  CHECK_THAT(refusal_of_discs(head), Contains("no disc"));
  CHECK_THAT(refusal_of_discs("id,x,y,z,dip,radius,set\n1,1,1,1,1,1,a\n"),
             Contains("no column \"dip_direction\""));
  CHECK_THAT(refusal_of_discs("id,id,x,y,z,dip,dip_direction,radius,set\n"),
             Contains("more than one column \"id\""));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,30\n"), Contains("line 2 has 5 values: must be 8"));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,91,0,1,a\n"),
             Contains("line 2, column \"dip\": \"91\": must be a number from 0 to 90"));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,30,-1,1,a\n"), Contains("column \"dip_direction\": \"-1\""));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,30,0,0,a\n"), Contains("column \"radius\": \"0\""));
  CHECK_THAT(refusal_of_discs(head + "1,nan,0,0,30,0,1,a\n"), Contains("column \"x\": \"nan\""));
  CHECK_THAT(refusal_of_discs(head + "1,1e300,0,0,30,0,1,a\n"), Contains("column \"x\": \"1e300\""));
  CHECK_THAT(refusal_of_discs(head + "1,0x,0,0,30,0,1,a\n"), Contains("column \"x\": \"0x\""));
  CHECK_THAT(refusal_of_discs(head + "1.5,0,0,0,30,0,1,a\n"),
             Contains("column \"id\": \"1.5\": must be a whole number"));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,30,0,1,\n"), Contains("column \"set\": an empty cell"));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,30,0,1," + std::string(100000, 'a') + "\n"),
             Contains("1 to 64 letters"));
  CHECK_THAT(refusal_of_discs(head + "1,0,0,0,30,0,1,a\n1,1,1,1,30,0,1,a\n"),
             Contains("line 3, column \"id\": \"1\""));
  CHECK_THAT(refusal_of_discs(std::string("\0\1\2\n", 4)), Contains("bytes that are no text"));
}
