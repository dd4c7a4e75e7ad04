// Sections through blocks, joints alone, arrows and crosses: places and lengths against what the shape and the field say.
#include "libcdem/vtk/block_marks.hpp"
#include "libcdem/vtk/section.hpp"
#include "libgeom/core/error.hpp"
#include "tests/vtk/sample.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace cdem;
using geom::Vec3;

namespace {

double area(const Snapshot& s) { // of all triangles
  double sum = 0;
  for (const geom::Triangle& t : s.surface)
    sum += 0.5 * (s.points[t[1]] - s.points[t[0]]).cross(s.points[t[2]] - s.points[t[0]]).norm();
  return sum;
}

// 3 x 2 blocks of 1 m, u = (2, 1, 0) x 1e-3 x.
Snapshot stretched() {
  Snapshot s = sample::blocks(sample::grid(3, 2, 3, 2), 1);
  SnapshotField u{"displacement", "m", 3, {}};
  for (const Vec3& x : s.points)
    u.values.insert(u.values.end(), {2e-3 * x.x(), 1e-3 * x.x(), 0});
  s.point_fields.push_back(u);
  SnapshotField stress{"stress", "Pa", 6, {}};
  for (std::size_t t = 0; t < s.tets.size(); ++t)
    stress.values.insert(stress.values.end(), {-4e6, 1e6, 0, 0, 0, 0});
  s.cell_fields.push_back(stress);
  return s;
}

double length(const Polyline& line) {
  return (line.points.back() - line.points.front()).norm();
}

} // namespace

TEST_CASE("a section has the area of the cut, seen from both sides, and linear fields on it", "[section]") {
  const Snapshot all = stretched();
  const Vec3 oblique(1, 0, 1);
  for (const auto& [plane, wanted] : {std::pair<CutPlane, double>{{{0, 0, 0.3}, {0, 0, 5}}, 6},
                                      {{{1.7, 0, 0}, {1, 0, 0}}, 2},
                                      {{{2, 0, 0.5}, oblique}, 2 * std::sqrt(2.)}}) {
    CAPTURE(plane.normal);
    const Snapshot cut = section_of(all, plane);
    CHECK(area(cut) == Approx(2 * wanted));
    const std::vector<double>& u = cut.point_fields.back().values;
    REQUIRE(u.size() == 3 * cut.points.size());
    for (std::size_t i = 0; i < cut.points.size(); ++i) {
      CHECK(std::abs((cut.points[i] - plane.point).dot(plane.normal)) < 1e-12);
      CHECK(u[3 * i] == Approx(2e-3 * cut.points[i].x()).margin(1e-15));
    }
  }
  // The blocks' edges in it: the outlines of six unit squares.
  const Snapshot flat = section_of(all, {{0, 0, 0.3}, {0, 0, 1}});
  double edges = 0;
  for (const auto& e : flat.block_edges)
    edges += (flat.points[e[1]] - flat.points[e[0]]).norm();
  CHECK(edges == Approx(24));
  CHECK_THROWS_AS(section_of(all, {{0, 0, 7}, {0, 0, 1}}), geom::InputError);
}

TEST_CASE("a section along faces of blocks has no holes, though their nodes lie on it only within rounding",
          "[section]") {
  Snapshot all = stretched();
  for (std::size_t i = 0; i < all.points.size(); ++i)
    all.points[i].x() += i % 3 == 0 ? 1e-15 : -1e-15;
  for (const double x : {1., 2.}) {
    const Snapshot cut = section_of(all, {{x, 0, 0}, {1, 0, 0}});
    CHECK(area(cut) == Approx(2 * 2.));
    double edges = 0;
    for (const auto& e : cut.block_edges)
      edges += (cut.points[e[1]] - cut.points[e[0]]).norm();
    CHECK(edges == Approx(8)); // the outlines of two unit squares
  }
}

TEST_CASE("joints alone are their triangles, seen from both sides, with their own fields", "[section]") {
  Snapshot all = stretched();
  sample::add_interface(all, {1, 0}, {1, 2}, 1, BondMode::broken_shear, 2);
  const Snapshot joints = joints_of(all);
  CHECK(area(joints) == Approx(2 * 2));
  REQUIRE(joints.surface.size() == 2 * all.bonds.triangles.size());
  for (std::size_t t = 0; t < joints.surface.size(); t += 2) {
    const geom::Triangle &a = joints.surface[t], &b = joints.surface[t + 1];
    CHECK(std::set<int>(a.begin(), a.end()) == std::set<int>(b.begin(), b.end()));
    CHECK(a[1] == b[2]);
  }
  CHECK(joints.outline.empty());
  all.outline = {{0, 1}};
  const Snapshot within = joints_of(all);
  REQUIRE(within.outline.size() == 1);
  for (std::size_t end = 0; end < 2; ++end)
    CHECK(within.points[within.outline[0][end]] == all.points[all.outline[0][end]]);
  for (const SnapshotField& field : within.point_fields)
    CHECK(field.values.size() == within.points.size() * static_cast<std::size_t>(field.components));
}

TEST_CASE("arrows follow the displacement of each block, the longest is told", "[section]") {
  const Snapshot cut = section_of(stretched(), {{0, 0, 0.5}, {0, 0, 1}});
  const std::vector<Polyline> lines = displacement_arrows(cut, {});
  REQUIRE(lines.size() == 2 * 6);                   // a shaft and a head each
  CHECK(lines[0].label == "longest arrow 5.59 mm"); // sqrt(5) mm/m at x = 2.5
  double longest = 0;
  for (std::size_t i = 0; i < lines.size(); i += 2) {
    const Vec3 from = lines[i].points[0], along = lines[i].points[1] - from;
    CHECK(along.y() == Approx(0.5 * along.x()));
    longest = std::max(longest, along.norm());
  }
  for (std::size_t i = 0; i < lines.size(); i += 2) // as long as the displacement says
    CHECK(length(lines[i]) == Approx(longest * lines[i].points[0].x() / 2.5));
}

TEST_CASE("arrows and crosses are those of what `fit` shows, and so are the largest values that are told",
          "[section]") {
  Snapshot all = stretched();
  SnapshotField& stress = all.cell_fields.back();
  for (std::size_t t = 0; t < all.tets.size(); ++t)
    stress.values[6 * t] *= all.points[static_cast<std::size_t>(all.tets[t][0])].x() < 1.5 ? 1 : 10;
  PictureOptions options;
  options.fit = geom::Box{{0, 0, 5}, {1, 2, 5}}; // the left column, from the front at any depth
  const Snapshot cut = section_of(all, {{0, 0, 0.5}, {0, 0, 1}});
  const std::vector<Polyline> arrows = displacement_arrows(cut, options),
                              crosses = stress_crosses(cut, options);
  REQUIRE(arrows.size() == 2 * 2);
  CHECK(arrows[0].label == "longest arrow 1.12 mm"); // at x = 0.5
  REQUIRE(crosses.size() == 2 * 2);
  for (const Polyline& line : crosses)
    CHECK(0.5 * (line.points[0] + line.points[1]).x() == Approx(0.5));
  options.fit = geom::Box{{-5, 0, 0}, {-4, 1, 1}};
  CHECK(stress_crosses(cut, options).empty());
}

TEST_CASE("crosses stand along the principal stresses, in proportion", "[section]") {
  const Snapshot cut = section_of(stretched(), {{0, 0, 0.5}, {0, 0, 1}});
  const std::vector<Polyline> lines = stress_crosses(cut, {});
  REQUIRE(lines.size() == 2 * 6); // the third principal stress is 0
  std::set<std::string> labels;
  double along_x = 0, along_y = 0;
  for (const Polyline& line : lines) {
    labels.insert(line.label);
    const Vec3 d = line.points[1] - line.points[0];
    (std::abs(d.x()) > std::abs(d.y()) ? along_x : along_y) = d.norm();
  }
  CHECK(along_x == Approx(4 * along_y));
  CHECK(labels == std::set<std::string>{"", "pressure, at most 4 MPa", "tension, at most 1 MPa"});
}
