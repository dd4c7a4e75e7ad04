// Clipping blocks by surfaces: volumes of both sides, no gaps, and what is refused.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/clip.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/core/rotation.hpp"
#include "libgeom/solid/facets.hpp"
#include "libgeom/solid/read_surface.hpp"
#include "tests/libgeom/assembly_laws.hpp"
#include "tests/libgeom/degree.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

using namespace geom;
using Catch::Matchers::Contains;
using testing::pi;
using testing::refusal;
using testing::total_volume;

namespace {

void add_faces(Surface& surface, const Polyhedron& shape) {
  const int first = static_cast<int>(surface.points.size());
  surface.points.insert(surface.points.end(), shape.vertices.begin(), shape.vertices.end());
  for (const PolyhedronFace& face : shape.faces)
    for (std::size_t i = 2; i < face.loop.size(); ++i)
      surface.triangles.push_back({first + face.loop[0], first + face.loop[i - 1], first + face.loop[i]});
}

Surface surface_of(const Polyhedron& shape) {
  Surface surface;
  add_faces(surface, shape);
  return surface;
}

Polyhedron turned_box(const Vec3& size, const Vec3& centre) {
  Polyhedron box = make_box(-0.5 * size, 0.5 * size);
  const Mat3 q = rotation_about(Vec3(1, 2, 3).normalized(), 0.7).toRotationMatrix();
  for (Vec3& x : box.vertices)
    x = centre + q * x;
  return box;
}

// Heights over a grid of points, two triangles to a cell.
template <class Height>
Surface terrain(double from, double to, int n, const Height& height) {
  Surface surface;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = from + (to - from) * i / n, y = from + (to - from) * j / n;
      surface.points.emplace_back(x, y, height(x, y));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      surface.triangles.push_back({a, b, b + 1});
      surface.triangles.push_back({a, b + 1, a + 1});
    }
  return surface;
}

// Below a surface of triangles over the square, down to z = 0: exact, since each prism's volume is area times mean height.
double volume_below(const Surface& surface) {
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    sum += 0.5 * std::abs((b - a).cross(c - a).z()) * (a.z() + b.z() + c.z()) / 3;
  }
  return sum;
}

void check_blocks(const Assembly& assembly) {
  for (const Polyhedron& block : assembly.blocks)
    CHECK_NOTHROW(validate(block));
}

Clipped clipped(const Assembly& assembly, const Surface& surface, ClipSide keep, double tolerance = 0) {
  return clip(assembly, surface, {keep, tolerance, ""});
}

} // namespace

TEST_CASE("clipping by a turned box leaves its volume, and the rest outside", "[clip]") {
  VoronoiOptions cells;
  cells.size = {10, 10, 10};
  cells.count = 200;
  const Surface tool = surface_of(turned_box({4, 5, 3}, {5, 5, 5}));
  for (const Assembly& rock :
       {grid({10, 10, 10}, {1, 1, 1}), grid({10, 10, 10}, {7, 6, 5}), voronoi(cells)}) {
    const Clipped inside = clipped(rock, tool, ClipSide::inside),
                  outside = clipped(rock, tool, ClipSide::outside),
                  both = clipped(rock, tool, ClipSide::both);
    CHECK(total_volume(inside.assembly) == Approx(60).epsilon(1e-9));
    CHECK(total_volume(outside.assembly) == Approx(940).epsilon(1e-9));
    CHECK(both.assembly.blocks.size() == inside.assembly.blocks.size() + outside.assembly.blocks.size());
    check_blocks(both.assembly);
    CHECK(testing::loose_area(both.assembly, testing::box_surface({10, 10, 10}), 1e-7) < 1e-5);
  }
}

TEST_CASE("a convex tool leaves one piece of a block inside", "[clip]") {
  const Clipped inside =
      clipped(grid({10, 10, 10}, {1, 1, 1}), surface_of(turned_box({4, 5, 3}, {5, 5, 5})), ClipSide::inside);
  CHECK(inside.assembly.blocks.size() == 1);
  CHECK(inside.cut_blocks == 1);
}

TEST_CASE("walls along faces of blocks, and faces in one plane, cut nothing that is whole", "[clip]") {
  const Assembly rock = grid({6, 6, 6}, {6, 6, 6});
  Surface shaft = surface_of(make_box({1, 2, 0}, {4, 4, 6}));
  const Clipped inside = clipped(rock, shaft, ClipSide::inside);
  CHECK(inside.cut_blocks == 0);
  CHECK(inside.assembly.blocks.size() == 36);
  add_faces(shaft, make_box({5, 5, 5}, {6, 6, 6}));
  CHECK(clipped(rock, shaft, ClipSide::outside).assembly.blocks.size() == 216 - 37);
}

TEST_CASE("the hollow of a shell is outside", "[clip]") {
  // The solid between two boxes one within the other: parity takes the hole out.
  Surface shell = surface_of(turned_box({6, 6, 6}, {5, 5, 5}));
  add_faces(shell, turned_box({2, 3, 4}, {5, 5, 5}));
  const Clipped inside = clipped(grid({12, 12, 12}, {4, 3, 2}, {-1, -1, -1}), shell, ClipSide::inside);
  CHECK(total_volume(inside.assembly) == Approx(216 - 24).epsilon(1e-9));
  check_blocks(inside.assembly);
}

TEST_CASE("a rough terrain cuts exactly, with a tolerance in fewer pieces and no thin ones", "[clip]") {
  const auto hills = [](double x, double y) {
    return 5 + 1.5 * std::sin(0.7 * x) * std::cos(0.9 * y) + 0.2 * std::sin(3 * x + y);
  };
  const Surface ground = terrain(0, 10, 14, hills);
  const Assembly rock = grid({10, 10, 9}, {4, 4, 3});
  const double below = volume_below(ground);
  const Clipped exact = clipped(rock, ground, ClipSide::inside);
  CHECK(total_volume(exact.assembly) == Approx(below).epsilon(1e-9));
  CHECK(total_volume(clipped(rock, ground, ClipSide::outside).assembly) == Approx(900 - below).epsilon(1e-9));
  check_blocks(exact.assembly);
  const double tolerance = 0.15;
  const Clipped coarse = clipped(rock, ground, ClipSide::inside, tolerance);
  CHECK(std::abs(total_volume(coarse.assembly) - below) < tolerance * 100);
  CHECK(std::abs(total_volume(coarse.assembly) - below) < 0.02 * below);
  CHECK(coarse.assembly.blocks.size() < exact.assembly.blocks.size() / 2);
  CHECK(exact.thin > 0);
  CHECK(exact.thinnest < 0.05 * 3);
}

TEST_CASE("an open surface must reach over every block and have no hole", "[clip]") {
  const auto flat = [](double, double) { return 4.5; };
  const Assembly rock = grid({10, 10, 9}, {3, 3, 3});
  CHECK(total_volume(clipped(rock, terrain(0, 10, 5, flat), ClipSide::inside).assembly) ==
        Approx(450).epsilon(1e-9));
  CHECK_THAT(refusal([&] { clipped(rock, terrain(0, 9.5, 5, flat), ClipSide::inside); }),
             Contains("must reach over all of them"));
  Surface holed = terrain(-1, 11, 24, flat);
  holed.triangles.erase(holed.triangles.begin() + 300);
  CHECK_THAT(refusal([&] { clipped(rock, holed, ClipSide::inside); }), Contains("has a gap"));
  CHECK_THAT(refusal([&] {
               clipped(rock, terrain(-1, 11, 5, [](double, double) { return -1.0; }), ClipSide::inside);
             }),
             Contains("nothing is left"));
}

TEST_CASE("a cylinder is cut to within the tolerance, and told to need one", "[clip]") {
  const Solid tunnel = cylinder({5, -1, 5}, {0, 12, 0}, 3);
  CHECK_THAT(refusal([&] { facets(tunnel, 0); }), Contains("curved faces"));
  const double tolerance = 0.05;
  const Surface wall = facets(tunnel, tolerance / 2);
  CHECK(open_edges(wall).empty());
  const Clipped rock = clipped(grid({10, 10, 10}, {5, 2, 5}), wall, ClipSide::outside, tolerance / 2);
  CHECK(std::abs(1000 - total_volume(rock.assembly) - 90 * pi) < tolerance * 2 * pi * 3 * 10);
  check_blocks(rock.assembly);
  const Surface crate = facets(box({1, 2, 3}, {1, 1, 1}), 0);
  CHECK(open_edges(crate).empty());
  CHECK(total_volume(clipped(grid({10, 10, 10}, {3, 3, 3}), crate, ClipSide::inside).assembly) ==
        Approx(6).epsilon(1e-9));
}

TEST_CASE("faces that a clip makes are glued or joints as told, and keep its name", "[clip]") {
  ClipOptions options;
  options.glued = GENERATE(true, false);
  options.keep = ClipSide::both;
  options.name = "outline";
  const Clipped both = clip(grid({4, 4, 4}, {1, 1, 1}), surface_of(make_box({1, 1, 1}, {3, 3, 5})), options);
  CHECK(cut_names(both.assembly) == std::vector<std::string>{"outline"});
  for (const SharedFace& s : shared_faces(both.assembly.blocks, 1e-9)) {
    CHECK(both.assembly.blocks[s.block_a].faces[s.face_a].glued == options.glued);
    CHECK(both.assembly.blocks[s.block_b].faces[s.face_b].glued == options.glued);
  }
}
