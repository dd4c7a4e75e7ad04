// Laws of the overlap of two faces: area, first moment, interpolation, and the points on matching faces.
#include "libgeom/mesh/star_mesh.hpp"
#include "libgeom/query/face_overlap.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace geom;
using testing::Draws;

namespace {

// A convex polygon in the plane, meshed as a face of a star block: nodes = corners, then the area centroid.
struct Fan {
  std::vector<Vec3> nodes;
  std::vector<Triangle> triangles;
};

std::vector<Vec3> random_polygon(Draws& draws) { // counter-clockwise seen from +z, z = 0
  const Polyhedron p = testing::random_block(draws);
  const int f = static_cast<int>(draws.uniform(0, static_cast<double>(p.faces.size())));
  const Vec3 normal = face_normal(p, f), e1 = normal.unitOrthogonal(), e2 = normal.cross(e1);
  const double angle = draws.uniform(0, 6.28), scale = draws.uniform(0.5, 2);
  const Eigen::Rotation2Dd turn(angle);
  const Eigen::Vector2d shift(draws.uniform(-0.3, 0.3), draws.uniform(-0.3, 0.3));
  std::vector<Vec3> corners;
  for (int v : p.faces[f].loop) {
    const Vec3 d = p.vertices[v] - face_centroid(p, f);
    const Eigen::Vector2d x = scale * (turn * Eigen::Vector2d(e1.dot(d), e2.dot(d))) + shift;
    corners.emplace_back(x.x(), x.y(), 0);
  }
  return corners;
}

Polyhedron prism(const std::vector<Vec3>& polygon) { // height 1 below z = 0; the polygon is face 0
  Polyhedron p;
  p.vertices = polygon;
  const int n = static_cast<int>(polygon.size());
  PolyhedronFace top, bottom;
  for (int i = 0; i < n; ++i) {
    p.vertices.push_back(polygon[i] - Vec3::UnitZ());
    top.loop.push_back(i);
    bottom.loop.push_back(2 * n - 1 - i);
  }
  for (int i = 0; i < n; ++i)
    p.vertices[n + i] = polygon[i] - Vec3::UnitZ();
  p.faces = {top, bottom};
  for (int i = 0; i < n; ++i)
    p.faces.push_back({{i, n + i, n + (i + 1) % n, (i + 1) % n}});
  return p;
}

Fan fan_of(const std::vector<Vec3>& polygon, bool from_below = false) {
  Fan fan;
  fan.nodes = polygon;
  fan.nodes.push_back(face_centroid(prism(polygon), 0));
  const int n = static_cast<int>(polygon.size());
  for (int i = 0; i < n; ++i)
    if (from_below)
      fan.triangles.push_back({n, (i + 1) % n, i});
    else
      fan.triangles.push_back({n, i, (i + 1) % n});
  return fan;
}

void move(Fan& fan, const Mat3& q, const Vec3& shift) {
  for (Vec3& x : fan.nodes)
    x = q * x + shift;
}

// Area and centroid of the common polygon, by cutting the prism over one with the sides of the other.
std::pair<double, Vec3> common(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  Polyhedron p = prism(a);
  for (std::size_t i = 0; i < b.size(); ++i) {
    const Vec3 along = b[(i + 1) % b.size()] - b[i];
    const Cut halves = cut(p, Plane::through(b[i], along.cross(Vec3::UnitZ())));
    if (!halves.below)
      return {0, Vec3::Zero()};
    p = halves.below->shape;
  }
  const MassProperties m = mass_properties(p);
  return {m.volume, m.centroid + 0.5 * Vec3::UnitZ()};
}

template <typename Field>
double at(const std::vector<Vec3>& nodes, const std::array<int, 3>& n, const std::array<double, 3>& w,
          Field field) {
  return w[0] * field(nodes[n[0]]) + w[1] * field(nodes[n[1]]) + w[2] * field(nodes[n[2]]);
}

struct Worst {
  double area = 0, moment = 0, interpolation = 0, weights = 0, tiling = 0, point_tiling = 0;
};

void take_in(Worst& worst, const FaceOverlap& o, const Fan& a, const Fan& b, double area,
             const Vec3& centroid) {
  const auto linear = [](const Vec3& x) { return 0.3 * x.x() - 1.7 * x.y() + 0.9 * x.z() + 0.2; };
  double sum = 0, tiles = 0, field = 0;
  Vec3 moment = Vec3::Zero();
  for (const OverlapPoint& p : o.points) {
    sum += p.area;
    moment += p.area * p.position;
    const double on_a = at(a.nodes, p.nodes_a, p.weights_a, linear),
                 on_b = at(b.nodes, p.nodes_b, p.weights_b, linear);
    worst.interpolation = std::max(
        {worst.interpolation, std::abs(on_a - linear(p.position)), std::abs(on_b - linear(p.position))});
    field += p.area * on_b;
    for (const auto& w : {p.weights_a, p.weights_b})
      worst.weights = std::max({worst.weights, std::abs(w[0] + w[1] + w[2] - 1), -w[0], -w[1], -w[2]});
  }
  for (const Triangle& t : o.triangles)
    tiles += 0.5 * (o.points[t[1]].position - o.points[t[0]].position)
                       .cross(o.points[t[2]].position - o.points[t[0]].position)
                       .norm();
  worst.area = std::max({worst.area, std::abs(o.area - area), std::abs(sum - area)});
  worst.tiling = std::max(worst.tiling, std::abs(tiles - area));
  worst.moment =
      std::max({worst.moment, (moment - area * centroid).norm(), std::abs(field - area * linear(centroid))});
}

const std::vector<Vec3> rectangle{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};

} // namespace

TEST_CASE("random faces: areas, first moments and linear fields are exact on both sides") {
  Worst worst;
  int overlapping = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Draws draws{21, i};
    const auto pa = random_polygon(draws), pb = random_polygon(draws);
    const Fan a = fan_of(pa), b = fan_of(pb, true);
    const auto [area, centroid] = common(pa, pb);
    const FaceOverlap o = overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-12);
    take_in(worst, o, a, b, area, centroid);
    overlapping += area > 0;
  }
  CHECK(overlapping > 1500); // the law was put to the test
  CHECK(worst.area <
        2e-12); // of faces of size 1: rounding over the band in which a node counts as on an edge
  CHECK(worst.tiling < 2e-12);
  CHECK(worst.moment < 4e-12);
  CHECK(worst.interpolation < 1e-11);
  CHECK(worst.weights < 1e-12);
}

TEST_CASE("faces cut from one another by a random line match exactly where they touch") {
  // One side is a whole face, the other its two halves after a cut: collinear edges and T-junctions
  // everywhere.
  Worst worst;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Draws draws{22, i};
    const auto whole = random_polygon(draws);
    const Vec3 inside = draws.uniform(0.05, 0.95) * (whole[0] - whole[2]) + whole[2];
    const Vec3 line = Eigen::AngleAxisd(draws.uniform(0, 3.14), Vec3::UnitZ()) * Vec3::UnitX();
    const Cut halves = cut(prism(whole), Plane::through(inside, line));
    const Fan a = fan_of(whole);
    double sum = 0;
    for (const auto& part : {halves.above, halves.below}) {
      if (!part)
        continue;
      std::vector<Vec3> piece;
      for (int v : part->shape.faces[0].loop)
        piece.push_back(part->shape.vertices[v]);
      const Fan b = fan_of(piece, true);
      const FaceOverlap o = overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-10);
      take_in(worst, o, a, b, face_area(part->shape, 0), face_centroid(part->shape, 0));
      sum += o.area;
    }
    CHECK(sum == Approx(face_area(prism(whole), 0)).epsilon(1e-11));
  }
  CHECK(worst.area < 2e-12);
  CHECK(worst.moment < 2e-10);
  CHECK(worst.interpolation < 2e-10);
}

TEST_CASE("matching rectangles give their four corners with A/6 and their centre with A/3") {
  const Fan a = fan_of(rectangle), b = fan_of(rectangle, true);
  const FaceOverlap o = overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-9);
  REQUIRE(o.points.size() == 5);
  CHECK(o.triangles.size() == 4);
  CHECK(o.area == Approx(6).epsilon(1e-15));
  for (const OverlapPoint& p : o.points) {
    CHECK(p.weights_a == std::array<double, 3>{1, 0, 0});
    CHECK(p.weights_b == std::array<double, 3>{1, 0, 0});
    CHECK(p.position == a.nodes[p.nodes_a[0]]);
    CHECK(p.position == b.nodes[p.nodes_b[0]]);
    CHECK(p.area == Approx(p.nodes_a[0] == 4 ? 2.0 : 1.0).epsilon(1e-15));
  }
}

TEST_CASE("matching faces whose nodes agree to rounding only still match node by node, wherever their loops "
          "start") {
  for (std::uint64_t i = 0; i < 500; ++i) {
    Draws draws{23, i};
    auto polygon = random_polygon(draws);
    Fan a = fan_of(polygon);
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    Fan b = fan_of(polygon, true);
    const Mat3 q = Eigen::AngleAxisd(draws.uniform(0, 3), draws.direction()).toRotationMatrix();
    const Vec3 shift = draws.uniform(0, 1000) * draws.direction();
    move(a, q, shift);
    move(b, q, shift);
    for (Vec3& x : b.nodes)
      x += 1e-11 * draws.direction();
    const FaceOverlap o = overlap(a.nodes, a.triangles, b.nodes, b.triangles, q * Vec3::UnitZ(), 1e-9);
    REQUIRE(o.points.size() == a.nodes.size());
    for (const OverlapPoint& p : o.points) {
      CHECK(p.weights_a == std::array<double, 3>{1, 0, 0});
      CHECK(p.weights_b == std::array<double, 3>{1, 0, 0});
      CHECK((a.nodes[p.nodes_a[0]] - b.nodes[p.nodes_b[0]]).norm() < 1e-10);
    }
  }
}

TEST_CASE("on a mirror-symmetric pair of faces the points and areas are mirror-symmetric") {
  const std::vector<Vec3> left{{0, 0, 0}, {0.7, 0.1, 0}, {0.9, 0.8, 0}, {0.1, 1, 0}};
  const std::vector<Vec3> other{{0.2, -0.2, 0}, {1, 0.3, 0}, {0.3, 0.7, 0}};
  const auto mirrored = [](std::vector<Vec3> polygon) {
    for (Vec3& x : polygon)
      x.x() = -x.x();
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
  };
  const auto points = [](const Fan& a, const Fan& b, double sign) {
    std::vector<std::array<double, 3>> list;
    for (const OverlapPoint& p :
         overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-9).points)
      list.push_back({sign * p.position.x(), p.position.y(), p.area});
    std::sort(list.begin(), list.end());
    return list;
  };
  const auto here = points(fan_of(left), fan_of(other, true), 1);
  const auto there = points(fan_of(mirrored(left)), fan_of(mirrored(other), true), -1);
  REQUIRE(here.size() == there.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    for (int k = 0; k < 3; ++k)
      CHECK(here[i][k] == Approx(there[i][k]).margin(1e-14));
}

TEST_CASE("faces that touch in a line or lie apart have no overlap") {
  std::vector<Vec3> beside = rectangle, apart = rectangle;
  for (Vec3& x : beside)
    x.x() += 3;
  for (Vec3& x : apart)
    x.y() += 10;
  const Fan a = fan_of(rectangle);
  for (const auto& polygon : {beside, apart}) {
    const Fan b = fan_of(polygon, true);
    const FaceOverlap o = overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-9);
    CHECK(o.points.empty());
    CHECK(o.triangles.empty());
    CHECK(o.area == 0);
  }
}

TEST_CASE("a sliver against a large face keeps its area and its linear fields") {
  Worst worst;
  for (double width : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const std::vector<Vec3> sliver{
        {0.1, 0.2, 0}, {2.7, 0.3, 0}, {2.7, 0.3 + width, 0}, {0.1, 0.2 + width, 0}};
    const Fan a = fan_of(rectangle), b = fan_of(sliver, true);
    const FaceOverlap o = overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-12);
    take_in(worst, o, a, b, 2.6 * width, {1.4, 0.25 + width / 2, 0});
    CHECK(o.area == Approx(2.6 * width).epsilon(1e-6));
  }
  CHECK(worst.area < 1e-14);
  CHECK(worst.moment < 1e-14);
  CHECK(worst.interpolation < 1e-14);
}

TEST_CASE("the overlap turns and moves with the faces, also a million sizes away") {
  for (std::uint64_t i = 0; i < 200; ++i) {
    Draws draws{24, i};
    Fan a = fan_of(random_polygon(draws)), b = fan_of(random_polygon(draws), true);
    const double here = overlap(a.nodes, a.triangles, b.nodes, b.triangles, Vec3::UnitZ(), 1e-9).area;
    const Mat3 q = Eigen::AngleAxisd(draws.uniform(0, 3), draws.direction()).toRotationMatrix();
    const Vec3 shift = 1e6 * draws.direction();
    move(a, q, shift);
    move(b, q, shift);
    const double there = overlap(a.nodes, a.triangles, b.nodes, b.triangles, q * Vec3::UnitZ(), 1e-9).area;
    CHECK(there == Approx(here).margin(2e-8));
  }
}
