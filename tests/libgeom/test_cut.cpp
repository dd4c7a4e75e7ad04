// Laws of the level-set cut (Han 2010 eqs 18-20).
#include "libgeom/polyhedron/cut.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace geom;
using testing::Draws;

namespace {

struct Broken {
  double volume = 0;    // largest relative error of the summed volumes
  double closure = 0;   // largest |sum n A| over the surface
  long wrong_euler = 0; // parts with V - E + F != 2
  long parts = 0;
};

// Cuts `cases` random blocks by eight random planes each and keeps the worst of every law.
Broken cut_at_random(int cases, const Vec3& offset) {
  Broken worst;
  for (int i = 0; i < cases; ++i) {
    Draws draws{7, static_cast<std::uint64_t>(i)};
    Polyhedron start = testing::random_block(draws, 4);
    for (Vec3& x : start.vertices)
      x += offset;
    const double volume = mass_properties(start).volume;
    std::vector<Polyhedron> parts{start};
    for (int k = 0; k < 8; ++k) {
      const Plane plane = Plane::through(draws.point(bounding_box(start)), draws.direction());
      std::vector<Polyhedron> next;
      for (const Polyhedron& part : parts) {
        const Cut halves = cut(part, plane);
        if (halves.above)
          next.push_back(halves.above->shape);
        if (halves.below)
          next.push_back(halves.below->shape);
      }
      parts = std::move(next);
    }
    double sum = 0;
    for (const Polyhedron& part : parts) {
      sum += mass_properties(part).volume;
      worst.closure = std::max(worst.closure, testing::closure(part) / testing::surface_area(part));
      worst.wrong_euler += testing::euler(part) != 2;
    }
    worst.volume = std::max(worst.volume, std::abs(sum - volume) / volume);
    worst.parts += static_cast<long>(parts.size());
  }
  return worst;
}

double volume(const std::optional<Part>& part) {
  return part ? mass_properties(part->shape).volume : 0;
}

const Polyhedron unit_cube = make_box({0, 0, 0}, {1, 1, 1});

void check_parents(const Polyhedron& whole, const Part& part) {
  REQUIRE(part.parent_face.size() == part.shape.faces.size());
  for (std::size_t f = 0; f < part.parent_face.size(); ++f)
    if (part.parent_face[f] != cut_face) {
      const int parent = part.parent_face[f];
      CHECK((face_normal(part.shape, static_cast<int>(f)) - face_normal(whole, parent)).norm() < 1e-12);
      const Plane plane = Plane::through(face_centroid(whole, parent), face_normal(whole, parent));
      CHECK(std::abs(plane.level(face_centroid(part.shape, static_cast<int>(f)))) < 1e-12);
    }
}

} // namespace

TEST_CASE("random cuts keep the volume, close every part and keep Euler's formula") {
  const Broken worst = cut_at_random(10000, Vec3::Zero());
  CHECK(worst.parts > 100000);
  CHECK(worst.volume < 1e-12);
  CHECK(worst.closure < 1e-12);
  CHECK(worst.wrong_euler == 0);
}

TEST_CASE("random cuts a million block sizes from the origin keep the volume to 1e-9") {
  const Broken worst = cut_at_random(1000, {1e6, -1e6, 1e6});
  CHECK(worst.volume < 1e-9);
  CHECK(worst.closure < 1e-9);
  CHECK(worst.wrong_euler == 0);
}

TEST_CASE("every part of a random cut is a valid block, its faces lie in their parents") {
  for (std::uint64_t i = 0; i < 300; ++i) {
    Draws draws{8, i};
    const Polyhedron p = testing::random_block(draws);
    const Plane plane = Plane::through(draws.point(bounding_box(p)), draws.direction());
    const Cut halves = cut(p, plane);
    for (const auto& [part, side] : {std::pair{halves.above, 1.0}, std::pair{halves.below, -1.0}})
      if (part) {
        CHECK_NOTHROW(validate(part->shape));
        check_parents(p, *part);
        for (const Vec3& x : part->shape.vertices)
          CHECK(side * plane.level(x) > -1e-15);
      }
  }
}

TEST_CASE("the cut face is the last of both parts and looks out of each") {
  const Plane plane = Plane::through({0.5, 0.4, 0.6}, {1, 2, 3});
  const Cut halves = cut(unit_cube, plane);
  REQUIRE((halves.above && halves.below));
  for (const auto& [part, side] : {std::pair{*halves.above, 1.0}, std::pair{*halves.below, -1.0}}) {
    REQUIRE(part.parent_face.back() == cut_face);
    REQUIRE(std::count(part.parent_face.begin(), part.parent_face.end(), cut_face) == 1);
    const int last = static_cast<int>(part.shape.faces.size()) - 1;
    CHECK((face_normal(part.shape, last) + side * plane.normal).norm() < 1e-14);
  }
  // A generic plane takes 3 cube corners off as a hexagon at most: here it crosses 5 or 6 edges; parts share
  // them.
  CHECK(halves.above->shape.faces.back().loop.size() == halves.below->shape.faces.back().loop.size());
}

TEST_CASE("a plane through four edges of a cube gives two prisms") {
  const Cut halves = cut(unit_cube, Plane::through({0.25, 0, 0}, {1, 0, 0}));
  CHECK(volume(halves.above) == Approx(0.75).epsilon(1e-15));
  CHECK(volume(halves.below) == Approx(0.25).epsilon(1e-15));
  CHECK(halves.above->shape.vertices.size() == 8);
  CHECK(halves.above->shape.faces.size() == 6);
}

TEST_CASE("a plane through two opposite edges of a cube shares their vertices") {
  const Cut halves = cut(unit_cube, Plane::through({0, 0, 0}, {1, -1, 0}));
  REQUIRE((halves.above && halves.below));
  for (const Part& part : {*halves.above, *halves.below}) {
    CHECK(mass_properties(part.shape).volume == Approx(0.5).epsilon(1e-15));
    CHECK(part.shape.vertices.size() == 6);
    CHECK(part.shape.faces.size() == 5);
    CHECK_NOTHROW(validate(part.shape));
  }
}

TEST_CASE("a plane through three corners takes a tetrahedron of a sixth off a cube") {
  const Cut halves = cut(unit_cube, Plane::through({1, 0, 0}, {1, 1, 1}));
  REQUIRE((halves.above && halves.below));
  CHECK(volume(halves.below) == Approx(1.0 / 6).epsilon(1e-15));
  CHECK(halves.below->shape.vertices.size() == 4);
  CHECK(halves.above->shape.vertices.size() == 7);
  CHECK(halves.above->shape.faces.size() == 7);
}

TEST_CASE("a plane through one corner and two edges shares that corner") {
  const Vec3 a(0, 0, 1), b(1, 0, 0.3), c(0, 1, 0.4);
  const Cut halves = cut(unit_cube, Plane::through(a, (b - a).cross(c - a)));
  REQUIRE((halves.above && halves.below));
  CHECK(volume(halves.above) + volume(halves.below) == Approx(1).epsilon(1e-15));
  const auto has_corner = [&](const Part& part) {
    return std::count(part.shape.vertices.begin(), part.shape.vertices.end(), a) == 1;
  };
  CHECK(has_corner(*halves.above));
  CHECK(has_corner(*halves.below));
}

TEST_CASE("a plane that only touches a face, an edge or a vertex leaves the block whole") {
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 2, 3)}) {
    const Cut below = cut(unit_cube, Plane::through({1, 1, 1}, normal));
    CHECK_FALSE(below.above);
    REQUIRE(below.below);
    CHECK(below.below->parent_face == std::vector<int>{0, 1, 2, 3, 4, 5});
    const Cut above = cut(unit_cube, Plane::through({0, 0, 0}, normal));
    CHECK_FALSE(above.below);
    REQUIRE(above.above);
    CHECK(above.above->shape.vertices == unit_cube.vertices);
  }
}

TEST_CASE("cutting a part again by the same plane leaves it whole") {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Draws draws{9, i};
    Polyhedron p = testing::random_block(draws);
    const Plane plane = Plane::through(draws.point(bounding_box(p)), draws.direction());
    const Cut halves = cut(p, plane);
    if (halves.above)
      CHECK_FALSE(cut(halves.above->shape, plane).below);
    if (halves.below)
      CHECK_FALSE(cut(halves.below->shape, plane).above);
  }
}

TEST_CASE("vertices within the tolerance count as on the plane") {
  const Cut halves = cut(unit_cube, Plane::through({0, 0, 0.001}, {0.001, -1, 0}), 0.01);
  REQUIRE_FALSE(halves.above); // all four vertices of the face y = 0 count as on
  const Cut diagonal = cut(unit_cube, Plane::through({0, 0.001, 0}, {1, -1, 0}), 0.01);
  REQUIRE((diagonal.above && diagonal.below));
  CHECK(diagonal.above->shape.vertices.size() == 6);
  CHECK(volume(diagonal.above) == Approx(0.5).epsilon(1e-15));
}

TEST_CASE("a coarse tolerance still gives closed parts that sum to the block") {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Draws draws{10, i};
    const Polyhedron p = testing::random_block(draws, 8);
    const Cut halves =
        cut(p, Plane::through(draws.point(bounding_box(p)), draws.direction()), draws.uniform(0, 0.1));
    for (const auto& part : {halves.above, halves.below})
      if (part) {
        CHECK(testing::closure(part->shape) < 1e-14);
        CHECK(testing::euler(part->shape) == 2);
      }
    // The snapped cut face may be warped by the tolerance; what one part gains there the other loses.
    if (halves.above && halves.below)
      CHECK(volume(halves.above) + volume(halves.below) ==
            Approx(mass_properties(p).volume).margin(0.1 * testing::surface_area(p)));
  }
}

TEST_CASE("blocks that share an edge are cut in the same point to the last bit") {
  const Polyhedron left = make_box({0, 0, 0}, {0.1, 0.1, 0.1}),
                   right = make_box({0.1, 0, 0}, {0.3, 0.1, 0.1});
  const Plane plane = Plane::through({0.1, 0.047, 0.031}, {0.3, 1, 0.7});
  const auto points_at = [&](const Polyhedron& p) {
    std::vector<std::array<double, 3>> points;
    const Cut halves = cut(p, plane);
    for (const Vec3& x : halves.above->shape.vertices)
      if (x.x() == 0.1)
        points.push_back({x.x(), x.y(), x.z()});
    std::sort(points.begin(), points.end());
    return points;
  };
  CHECK(points_at(left).size() >= 3);
  CHECK(points_at(left) == points_at(right));
}

TEST_CASE("a plane near a vertex is shifted clear of it or onto it") {
  const Plane near{Vec3::UnitX(), 0.004};
  CHECK(shifted_clear_of_vertices(unit_cube, near, 0.01).offset == Approx(0).margin(1e-15)); // onto the face
  CHECK(shifted_clear_of_vertices(unit_cube, {Vec3::UnitX(), 0.008}, 0.01).offset ==
        Approx(0.01).epsilon(1e-14));
  CHECK(shifted_clear_of_vertices(unit_cube, {Vec3::UnitX(), 0.993}, 0.01).offset ==
        Approx(0.99).epsilon(1e-14));
  CHECK(shifted_clear_of_vertices(unit_cube, {Vec3::UnitX(), 0.5}, 0.01).offset == 0.5); // clear: unchanged
  const Plane diagonal = Plane::through({0, 0, 0}, {1, -1, 0});
  CHECK(shifted_clear_of_vertices(unit_cube, diagonal, 0.01).offset ==
        diagonal.offset); // on vertices: unchanged
}

TEST_CASE("a shifted plane is clear of every vertex, and no nearer one is") {
  for (std::uint64_t i = 0; i < 500; ++i) {
    Draws draws{11, i};
    const Polyhedron p = testing::random_block(draws);
    const Plane plane = Plane::through(draws.point(bounding_box(p)), draws.direction());
    const double clearance = 0.03;
    const auto clear = [&](double offset, double slack) {
      return std::all_of(p.vertices.begin(), p.vertices.end(), [&](const Vec3& x) {
        const double level = std::abs(plane.normal.dot(x) - offset);
        return level < 1e-15 || level > clearance - slack;
      });
    };
    const double offset = shifted_clear_of_vertices(p, plane, clearance).offset;
    CHECK(clear(offset, 1e-14));
    const double shift = std::abs(offset - plane.offset);
    for (double d = 1e-4; d < shift - 1e-4; d += 1e-4) {
      CHECK_FALSE(clear(plane.offset + d, -1e-9));
      CHECK_FALSE(clear(plane.offset - d, -1e-9));
    }
  }
}
