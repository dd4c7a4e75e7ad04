// Walls made of open surfaces: volumes and sides beside closed forms.
#include "libgeom/mesh/shell_mesh.hpp"
#include "libgeom/mesh/triangle_distance.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using Catch::Matchers::Contains;
using testing::refusal;

namespace {

// A drum: n flat sides of a pipe of radius r along y, from y = 0 to 2. Normals point outwards.
Surface drum(int n, double r, const Vec3& centre = Vec3::Zero()) {
  Surface s;
  for (int i = 0; i < n; ++i)
    for (const double y : {0., 2.})
      s.points.push_back(centre + Vec3(r * std::cos(2 * M_PI * i / n), y, r * std::sin(2 * M_PI * i / n)));
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % n);
    s.triangles.push_back({a, a + 1, b + 1});
    s.triangles.push_back({a, b + 1, b});
  }
  return s;
}

Surface sheet() {
  return {{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

double area(int n, double r) { // m2, of a polygon about a circle of radius r
  return n * r * r * std::tan(M_PI / n);
}

} // namespace

TEST_CASE("a flat sheet becomes a box behind its front") {
  const TetMesh above = shell_mesh(sheet(), 0.25, {});
  CHECK_NOTHROW(validate(above, "shell"));
  CHECK(volume(above) == Approx(3 * 2 * 0.25));
  CHECK(bounding_box(above).min.z() == Approx(-0.25));
  CHECK(bounding_box(above).max.z() == 0);
  const TetMesh below = shell_mesh(sheet(), 0.25, Vec3(1, 1, -5));
  CHECK(bounding_box(below).min.z() == 0);
  CHECK(bounding_box(below).max.z() == Approx(0.25));
  CHECK(open_edges(surface_of(above)).empty());
}

TEST_CASE("the wall of a drum is as thick as it was asked for, inside and outside") {
  const int n = 40;
  const double r = 1, t = 0.1, inner = r * std::cos(M_PI / n); // to the middles of its sides
  const Vec3 centre(3e3, -2e3, 100);
  const TetMesh outside = shell_mesh(drum(n, r, centre), t, centre + Vec3(0, 1, 0));
  CHECK(volume(outside) == Approx(2 * (area(n, inner + t) - area(n, inner))).epsilon(1e-9));
  const TetMesh inside = shell_mesh(drum(n, r, centre), t, {}); // its normals point outwards: the front
  CHECK(volume(inside) == Approx(2 * (area(n, inner) - area(n, inner - t))).epsilon(1e-9));
}

TEST_CASE("triangles that point different ways are turned alike, and parts to the front each by itself") {
  Surface mixed = drum(12, 1);
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 3)
    std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  CHECK(volume(shell_mesh(mixed, 0.1, Vec3(0, 1, 0))) ==
        Approx(volume(shell_mesh(drum(12, 1), 0.1, Vec3(0, 1, 0)))));
  Surface two = sheet(); // two sheets that face each other
  for (const Vec3& x : sheet().points)
    two.points.push_back(x + Vec3(0, 0, 1));
  two.triangles.push_back({4, 5, 6});
  two.triangles.push_back({4, 6, 7});
  const Box box = bounding_box(shell_mesh(two, 0.25, Vec3(1, 1, 0.5)));
  CHECK(box.min.z() == Approx(-0.25));
  CHECK(box.max.z() == Approx(1.25));
}

TEST_CASE("an edge of two walls keeps their thickness on both sides of the bend") {
  // A gutter of two sheets at a right angle: the back is a larger gutter.
  const Surface gutter{{{-1, 0, 1}, {0, 0, 0}, {1, 0, 1}, {-1, 3, 1}, {0, 3, 0}, {1, 3, 1}},
                       {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}};
  const double t = 0.1, side = std::sqrt(2.);
  // Two prisms of length 3 whose cross-sections are side by t, and what the corner adds or lacks.
  CHECK(volume(shell_mesh(gutter, t, Vec3(0, 1, 5))) == Approx(3 * (2 * side * t + t * t)));
  CHECK(volume(shell_mesh(gutter, t, Vec3(0, 1, -5))) == Approx(3 * (2 * side * t - t * t)));
}

TEST_CASE("surfaces that make no wall are refused", "[input]") {
  CHECK_THAT(refusal([] { shell_mesh(sheet(), 0, {}); }), Contains("thickness"));
  CHECK_THAT(refusal([] { shell_mesh(drum(12, 1), 1.2, {}); }),
             Contains("thickness = 1.2") && Contains("folds at"));
  CHECK_THAT(refusal([] {
               shell_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}, 0.1, {});
             }),
             Contains("no triangles"));
  Surface strip; // Moebius
  const int n = 9;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    for (const double w : {-0.2, 0.2})
      strip.points.push_back(Vec3((1 + w * std::cos(a / 2)) * std::cos(a),
                                  (1 + w * std::cos(a / 2)) * std::sin(a), w * std::sin(a / 2)));
  }
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    strip.triangles.push_back({a, b, d});
    strip.triangles.push_back({a, d, c});
  }
  CHECK_THAT(refusal([&] { shell_mesh(strip, 0.01, {}); }), Contains("one-sided at"));
}
