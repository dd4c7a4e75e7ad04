// Whether a place is inside a surface, told by the triangles that hold its nearest place: at sharp corners and where
// bonds part the edges of tets.
#include "libcdem/contact/geometry/nearest.hpp"

#include "libgeom/core/random.hpp"

#include <catch2/catch.hpp>

using cdem::Corners;
using geom::Vec3;

namespace {

Vec3 draw(std::uint64_t id, std::uint64_t first) {
  return {geom::uniform(7, id, first), geom::uniform(7, id, first + 1), geom::uniform(7, id, first + 2)};
}

using Tet = std::array<Vec3, 4>;

std::array<Corners, 4> faces_of(const Tet& x) { // counter-clockwise seen from outside
  return {{{x[0], x[2], x[1]}, {x[0], x[1], x[3]}, {x[1], x[2], x[3]}, {x[2], x[0], x[3]}}};
}

// With its tip at the origin, 1 long; base: how wide at its end.
Tet needle(std::uint64_t id, double base) {
  Tet x{Vec3(0, 0, 0), Vec3(1, base, 0), Vec3(1, -0.5 * base, 0.8 * base), Vec3(1, -0.5 * base, -0.8 * base)};
  for (int i = 1; i < 4; ++i)
    x[i] += 0.2 * base * (draw(id, 20 + 3 * static_cast<std::uint64_t>(i)) - Vec3::Constant(0.5));
  return x;
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).dot((c - a).cross(d - a)) / 6;
}

bool inside(const Tet& x, const Vec3& p) { // by its barycentric weights
  return volume(p, x[1], x[2], x[3]) > 0 && volume(x[0], p, x[2], x[3]) > 0 &&
         volume(x[0], x[1], p, x[3]) > 0 && volume(x[0], x[1], x[2], p) > 0;
}

// parted: m, by which each face has moved away from where its edges meet the others', at most.
struct Told {
  int right = 0, wrong = 0, inside = 0;
};
Told told_by_nearest(double base, double parted, double gives) {
  constexpr double size = 1;
  Told told;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const Tet x = needle(i / 100, base);
    REQUIRE(volume(x[0], x[1], x[2], x[3]) > 0);
    // Half of them close around the tip.
    const double near = i % 2 == 0 ? 0.05 : 0.3;
    const Vec3 p = Vec3(i % 2 == 0 ? 0 : 0.8, 0, 0) + near * (draw(i, 0) - Vec3::Constant(0.5));
    cdem::Nearest nearest;
    std::uint64_t face = 0;
    for (Corners corners : faces_of(x)) {
      const Vec3 shift = parted * (draw(i / 100, 40 + 3 * face++) - Vec3::Constant(0.5));
      for (Vec3& corner : corners)
        corner += shift;
      const Vec3 normal = cdem::unit_normal(corners);
      take_nearer(nearest, cdem::nearest_of(static_cast<int>(face), p, corners, normal), corners, normal,
                  size, gives);
    }
    if (nearest.distance2 < 1e-6)
      continue; // too near to tell from what is parted
    const bool expected = inside(x, p);
    ++(nearest.inside() == expected ? told.right : told.wrong);
    told.inside += expected ? 1 : 0;
  }
  REQUIRE(told.inside > 20);
  REQUIRE(told.right > 2000);
  return told;
}

} // namespace

TEST_CASE("nearest: a needle is told from what is around its tip", "[contact][nearest]") {
  CHECK(told_by_nearest(0.1, 0, cdem::same_place_at_least).wrong == 0);
}

TEST_CASE("nearest: tets whose edges part by what bonds give are told from what is around them",
          "[contact][nearest]") {
  constexpr double gives = 3e-4, parted = 0.3 * gives;
  CHECK(told_by_nearest(0.5, parted, gives).wrong == 0);
  CHECK(told_by_nearest(0.5, parted, cdem::same_place_at_least).wrong > 0); // a face alone may be wrong
}

TEST_CASE(
    "nearest: at the mouth of a crack a place in the solid beside it is inside, one in the crack is not",
    "[contact][nearest]") {
  // A block z < 0 with a wedge cut into it along y, mouth at x = +-0.1, tip at z = -1: its four faces.
  const double mouth = 0.1;
  const auto strip = [](const Vec3& a, const Vec3& b) { // from a to b, seen from outside to the left of +y
    const Vec3 along(0, 2, 0);
    return std::array<Corners, 2>{{{a - along, b - along, b + along}, {a - along, b + along, a + along}}};
  };
  const Vec3 left(-mouth, 0, 0), right(mouth, 0, 0), tip(0, 0, -1);
  std::vector<Corners> faces;
  for (const auto& pair :
       {strip(Vec3(-2, 0, 0), left), strip(left, tip), strip(tip, right), strip(right, Vec3(2, 0, 0))})
    faces.insert(faces.end(), pair.begin(), pair.end());
  REQUIRE(cdem::unit_normal(faces[0]).z() > 0);
  int in_crack = 0, in_solid = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const Vec3 spread = draw(i, 0) - Vec3::Constant(0.5);
    const Vec3 p(0.6 * spread.x(), spread.y(), 0.4 * spread.z());
    cdem::Nearest nearest;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const Vec3 normal = cdem::unit_normal(faces[f]);
      take_nearer(nearest, cdem::nearest_of(static_cast<int>(f), p, faces[f], normal), faces[f], normal, 1,
                  cdem::same_place_at_least);
    }
    if (nearest.distance2 < 1e-10)
      continue;
    const bool solid = p.z() < 0 && std::abs(p.x()) > mouth * (1 + p.z());
    CHECK(nearest.inside() == solid);
    in_solid += solid ? 1 : 0;
    in_crack += !solid && p.z() < 0 ? 1 : 0;
  }
  CHECK(in_solid > 500);
  CHECK(in_crack > 200);
}

TEST_CASE(
    "nearest: what stands over the triangle that holds its nearest place is not inside, whatever others say",
    "[contact][nearest]") {
  // The triangle, and beside the place the edges of three that look the other way, parted from it by a little.
  const double over = 1e-3, parted = 1e-6;
  const Vec3 spring(0, 0, over);
  std::vector<Corners> triangles{{Vec3(1, 0, 0), Vec3(-0.5, 0.9, 0), Vec3(-0.5, -0.9, 0)}};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * M_PI * i / 3;
    const Vec3 out(std::cos(angle), std::sin(angle), 0), along(-out.y(), out.x(), 0);
    triangles.push_back({parted * out + along, out, parted * out - along});
    REQUIRE(cdem::unit_normal(triangles.back()).z() < -0.99);
  }
  cdem::Nearest nearest;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 normal = cdem::unit_normal(triangles[t]);
    take_nearer(nearest, cdem::nearest_of(static_cast<int>(t), spring, triangles[t], normal), triangles[t],
                normal, 1, true);
  }
  CHECK(nearest.target == 0);
  CHECK(nearest.outward.dot(nearest.from) < 0); // the others are more
  CHECK_FALSE(nearest.inside());
}
