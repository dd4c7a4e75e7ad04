// Joint sets: orientation and spacing of the cut faces, against their definitions.
#include "libgeom/assembly/builders.hpp"
#include "tests/libgeom/assembly_laws.hpp"
#include "tests/libgeom/degree.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace geom;
using testing::degree;

namespace {

// Upward unit normals and offsets of all faces that do not lie on the box's sides.
std::vector<Plane> joint_faces(const Assembly& assembly) {
  const Box box = bounding_box(assembly);
  std::vector<Plane> planes;
  for (const Polyhedron& block : assembly.blocks)
    for (int f = 0; f < static_cast<int>(block.faces.size()); ++f) {
      Vec3 n = face_normal(block, f);
      const Vec3 c = face_centroid(block, f);
      const bool outside =
          ((c - box.min).cwiseAbs().minCoeff() < 1e-9) || ((box.max - c).cwiseAbs().minCoeff() < 1e-9);
      if (outside)
        continue;
      if (n.z() < 0)
        n = -n;
      planes.push_back({n, n.dot(c)});
    }
  return planes;
}

double dip(const Plane& p) {
  return std::atan2(p.normal.head<2>().norm(), p.normal.z());
}
double dip_direction(const Plane& p) { // clockwise from north (+y), 0..2 pi
  const double a = std::atan2(p.normal.x(), p.normal.y());
  return a < 0 ? a + 360 * degree : a;
}

Assembly cube() {
  return grid({1, 1, 1}, {1, 1, 1});
}

double sum_of_squares(const std::vector<double>& x, double mean) {
  double sum = 0;
  for (double v : x)
    sum += (v - mean) * (v - mean);
  return sum;
}

// Distances between successive planes, from the sorted offsets of faces that share a normal.
std::vector<double> gaps(const Assembly& assembly) {
  std::vector<double> offsets;
  for (const Plane& p : joint_faces(assembly))
    offsets.push_back(p.offset);
  std::sort(offsets.begin(), offsets.end());
  std::vector<double> result;
  for (std::size_t i = 1; i < offsets.size(); ++i)
    if (offsets[i] - offsets[i - 1] > 1e-9)
      result.push_back(offsets[i] - offsets[i - 1]);
  return result;
}

} // namespace

TEST_CASE("level joints a quarter apart cut a unit cube into four") {
  JointSet set;
  set.spacing = 0.25;
  const Assembly a = cut_by_joints(cube(), {set});
  REQUIRE(a.blocks.size() == 4);
  for (const Polyhedron& block : a.blocks)
    CHECK(mass_properties(block).volume == Approx(0.25).epsilon(1e-13));
}

TEST_CASE("a joint dips to the side it is told to: east is +x, north is +y") {
  JointSet set;
  set.dip = 30 * degree;
  set.spacing = 0.2;
  for (const auto& [direction, downhill] :
       {std::pair{0.0, Vec3(0, 1, 0)}, std::pair{90.0, Vec3(1, 0, 0)}, std::pair{180.0, Vec3(0, -1, 0)},
        std::pair{270.0, Vec3(-1, 0, 0)}}) {
    set.dip_direction = direction * degree;
    const Vec3 line = std::cos(set.dip) * downhill - std::sin(set.dip) * Vec3::UnitZ(); // lies in the joint
    const auto faces = joint_faces(cut_by_joints(cube(), {set}));
    CHECK(faces.size() > 4);
    for (const Plane& p : faces)
      CHECK(std::abs(p.normal.dot(line)) < 1e-12);
  }
}

TEST_CASE("without scatter every cut face has the set's dip and dip direction, and the planes its spacing") {
  JointSet set;
  for (const auto& [d, dd] : {std::pair{35.0, 120.0}, std::pair{80.0, 355.0}, std::pair{10.0, 200.0}}) {
    set.dip = d * degree;
    set.dip_direction = dd * degree;
    set.spacing = 0.13;
    const Assembly a = cut_by_joints(grid({2, 1, 1}, {1, 1, 1}, {10, 20, 30}), {set});
    const auto faces = joint_faces(a);
    REQUIRE(faces.size() > 10);
    for (const Plane& p : faces) {
      CHECK(dip(p) == Approx(set.dip).margin(1e-9));
      CHECK(dip_direction(p) == Approx(set.dip_direction).margin(1e-9));
    }
    for (double gap : gaps(a))
      CHECK(gap == Approx(0.13).margin(0.013)); // shifted clear of vertices by at most 0.05 of the spacing
    CHECK(testing::total_volume(a) == Approx(2).epsilon(1e-12));
  }
}

TEST_CASE("vertical joints reach through the whole assembly") {
  JointSet set;
  set.dip = 90 * degree;
  set.dip_direction = 90 * degree;
  set.spacing = 0.5;
  const Assembly a = cut_by_joints(grid({10, 1, 1}, {3, 1, 1}), {set});
  CHECK(testing::total_volume(a) == Approx(10).epsilon(1e-12));
  for (const Polyhedron& block : a.blocks)
    CHECK(bounding_box(block).size().x() < 0.5 * 1.1);
}

TEST_CASE("joint sets that cut blocks of a grid leave no gaps") {
  const Vec3 size(1, 1, 1);
  JointSet steep, flat;
  steep.dip = 60 * degree;
  steep.dip_direction = 75 * degree;
  steep.spacing = 0.23;
  flat.dip = 15 * degree;
  flat.dip_direction = 250 * degree;
  flat.spacing = 0.31;
  flat.spacing_scatter = 0.2;
  flat.dip_scatter = 3 * degree;
  flat.direction_scatter = 5 * degree;
  const Assembly a = cut_by_joints(grid(size, {3, 3, 3}), {steep, flat});
  CHECK(a.blocks.size() > 100);
  for (const Polyhedron& block : a.blocks)
    CHECK_NOTHROW(validate(block));
  CHECK(testing::total_volume(a) == Approx(1).epsilon(1e-12));
  // Overlaps narrower than the tolerance are not reported.
  CHECK(testing::loose_area(a, testing::box_surface(size), 1e-12) < 1e-9);
}

TEST_CASE("the spacing keeps its mean and gets its scatter") {
  JointSet set;
  set.dip_direction = 45 * degree;
  set.spacing = 0.01;
  set.spacing_scatter = 0.2;
  std::vector<double> all;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (double gap : gaps(cut_by_joints(grid({1, 1, 10}, {1, 1, 1}), {set}, seed)))
      all.push_back(gap / 0.01);
  const double n = static_cast<double>(all.size());
  double mean = 0;
  for (double gap : all)
    mean += gap / n;
  CHECK(n > 4500);
  CHECK(mean == Approx(1).margin(5 * 0.2 / std::sqrt(n)));
  CHECK(std::sqrt(sum_of_squares(all, 1) / n) == Approx(0.2).margin(5 * 0.2 / std::sqrt(2 * n)));
}

TEST_CASE("dip and dip direction scatter about their means") {
  JointSet set;
  set.dip = 40 * degree;
  set.dip_direction = 100 * degree;
  set.spacing = 0.05;
  set.dip_scatter = 2 * degree;
  set.direction_scatter = 4 * degree;
  std::vector<double> dips, directions;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    // Crossing planes cut each other's faces: count each plane once.
    std::vector<double> seen;
    for (const Plane& p : joint_faces(cut_by_joints(cube(), {set}, seed)))
      if (std::none_of(seen.begin(), seen.end(), [&](double d) { return std::abs(d - dip(p)) < 1e-9; })) {
        seen.push_back(dip(p));
        dips.push_back(dip(p));
        directions.push_back(dip_direction(p));
      }
  }
  const double n = static_cast<double>(dips.size());
  REQUIRE(n > 400);
  for (const auto& [values, mean, deviation] :
       {std::tuple{dips, set.dip, set.dip_scatter},
        std::tuple{directions, set.dip_direction, set.direction_scatter}}) {
    double sum = 0;
    for (double v : values)
      sum += v;
    CHECK(sum / n == Approx(mean).margin(5 * deviation / std::sqrt(n)));
    CHECK(std::sqrt(sum_of_squares(values, mean) / n) ==
          Approx(deviation).margin(5 * deviation / std::sqrt(2 * n)));
  }
}

TEST_CASE("joints near the vertices of a block are shifted: no part is a sliver") {
  // Planes at 0.2002, 0.4004 ... pass the grid's corners by 0.001 block sizes and are brought onto them or
  // clear.
  JointSet set;
  set.spacing = 0.2002;
  const Assembly a = cut_by_joints(grid({1, 1, 1}, {5, 5, 5}), {set});
  for (const Polyhedron& block : a.blocks)
    CHECK(bounding_box(block).size().z() > 0.0019);
  CHECK(testing::total_volume(a) == Approx(1).epsilon(1e-13));
}

TEST_CASE("the same seed gives the same joints, another seed others, no sets change nothing") {
  JointSet set;
  set.spacing = 0.2;
  set.spacing_scatter = 0.3;
  const Assembly a = cut_by_joints(cube(), {set}, 7), b = cut_by_joints(cube(), {set}, 7),
                 c = cut_by_joints(cube(), {set}, 8);
  REQUIRE(a.blocks.size() == b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i)
    CHECK(a.blocks[i].vertices == b.blocks[i].vertices);
  CHECK((a.blocks.size() != c.blocks.size() || a.blocks[0].vertices != c.blocks[0].vertices));
  CHECK(cut_by_joints(cube(), {}).blocks.size() == 1);
  CHECK(cut_by_joints({}, {set}).blocks.empty());
}

TEST_CASE("a set of one plane runs through its origin, or through the middle of the blocks") {
  JointSet set;
  set.dip = 40 * degree;
  set.dip_direction = 90 * degree;
  set.spacing = 0.1;
  set.count = 1;
  const Vec3 normal(std::sin(set.dip), 0, std::cos(set.dip));
  for (const Vec3& through : {Vec3(0.5, 0.5, 0.5), Vec3(0.4, 0.2, 0.7)}) {
    if (through != Vec3(0.5, 0.5, 0.5))
      set.origin = through;
    const auto faces = joint_faces(cut_by_joints(cube(), {set}));
    REQUIRE(faces.size() == 2);
    for (const Plane& p : faces)
      CHECK(p.offset == Approx(normal.dot(through)).margin(1e-9));
  }
}

TEST_CASE("planes of a set with an origin stand on both sides of it, one spacing apart") {
  JointSet set;
  set.spacing = 0.1;
  set.origin = Vec3(0, 0, 0.42);
  set.count = 3;
  CHECK(cut_by_joints(cube(), {set}).blocks.size() == 4);
  for (const Plane& p : joint_faces(cut_by_joints(cube(), {set})))
    CHECK(std::abs(p.offset - 0.42) < 0.1 + 1e-9);
  set.count.reset(); // all that cross: 0.02 to 0.92
  CHECK(cut_by_joints(cube(), {set}).blocks.size() == 11);
  set.origin = Vec3(0, 0, 5); // beside the blocks: the planes go on to them
  CHECK(cut_by_joints(cube(), {set}).blocks.size() == 10);
}

TEST_CASE("the part of the faces that belongs to a set is its persistence, the same on both sides") {
  JointSet across, along;
  across.dip = along.dip = 90 * degree;
  along.dip_direction = 90 * degree;
  across.spacing = along.spacing = 0.05;
  JointSet level;
  level.spacing = 0.2;
  level.name = "level";
  level.persistence = 0.6;
  const Assembly a = cut_by_joints(cube(), {level, across, along}, 3);
  std::int64_t up = 0, down = 0, bridges = 0;
  for (const Polyhedron& block : a.blocks)
    for (int f = 0; f < static_cast<int>(block.faces.size()); ++f) {
      const double z = face_normal(block, f).z(), at = face_centroid(block, f).z();
      if (std::abs(z) < 0.9 || at < 1e-9 || at > 1 - 1e-9)
        continue;
      if (block.faces[f].cut.empty())
        ++bridges;
      else
        ++(z > 0 ? up : down);
    }
  CHECK(up == down);
  const auto all = static_cast<double>(up + down + bridges);
  REQUIRE(all > 2000);
  // Standard deviation of the share of n = all / 2 draws.
  CHECK(static_cast<double>(up + down) / all == Approx(0.6).margin(4 * std::sqrt(0.24 / (0.5 * all))));
}

TEST_CASE(
    "sets that cannot be are refused: no persistence, bridges without a name, an origin whose planes miss") {
  const auto refused = [](const JointSet& set) {
    return testing::refusal([&] { cut_by_joints(cube(), {set}); });
  };
  JointSet set;
  set.spacing = 0.2;
  set.persistence = 0;
  CHECK_THAT(refused(set), Catch::Matchers::Contains("persistence = 0: must be > 0 and <= 1"));
  set.persistence = 0.5;
  CHECK_THAT(refused(set), Catch::Matchers::Contains("give the set a name"));
  set.name = "level";
  set.count = 0;
  CHECK_THAT(refused(set), Catch::Matchers::Contains("count = 0: must be at least 1"));
  set.count = 2;
  set.origin = Vec3(0, 0, 5);
  CHECK_THAT(refused(set), Catch::Matchers::Contains("such that a plane of the set crosses the blocks"));
}
