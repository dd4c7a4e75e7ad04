// Voronoi assemblies: they fill the box, match face by face, and depend on the seed alone.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libgeom/assembly_laws.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace geom;

namespace {

double shortest_edge(const Assembly& assembly) {
  double shortest = 1e300;
  for (const Polyhedron& block : assembly.blocks)
    for (const auto& [from, to] : edges(block))
      shortest = std::min(shortest, (block.vertices[from] - block.vertices[to]).norm());
  return shortest;
}

void check_fills_box(const VoronoiOptions& o) {
  const Assembly cells = voronoi(o);
  REQUIRE(cells.blocks.size() == static_cast<std::size_t>(o.count));
  for (const Polyhedron& block : cells.blocks)
    CHECK_NOTHROW(validate(block));
  const double box = o.size.prod();
  CHECK(testing::total_volume(cells) == Approx(box).epsilon(1e-10));
  CHECK(bounding_box(cells).min == o.origin);
  CHECK(bounding_box(cells).max == Vec3(o.origin + o.size));
  const double surface = testing::box_surface(o.size);
  CHECK(testing::loose_area(cells, surface, 1e-9 * std::cbrt(box / o.count)) <
        1e-10 * testing::box_surface(o.size) * 10);
  // Where faces match, neighbours share their corners to the last bit.
  for (const SharedFace& s : shared_faces(cells.blocks, 1e-9 * std::cbrt(box / o.count))) {
    const auto corners = [&](int block, int face) {
      std::vector<std::array<double, 3>> list;
      for (int v : cells.blocks[block].faces[face].loop) {
        const Vec3& x = cells.blocks[block].vertices[v];
        list.push_back({x.x(), x.y(), x.z()});
      }
      std::sort(list.begin(), list.end());
      return list;
    };
    CHECK(corners(s.block_a, s.face_a) == corners(s.block_b, s.face_b));
  }
}

} // namespace

TEST_CASE("Voronoi blocks fill the box and their faces match corner by corner") {
  VoronoiOptions o;
  o.size = {1, 2, 0.5};
  o.origin = {3, -1, 2};
  o.count = 300;
  for (int relaxations : {0, 1, 10}) {
    o.relaxations = relaxations;
    check_fills_box(o);
  }
}

TEST_CASE("Voronoi blocks of a millimetre and of a kilometre fill their box") {
  VoronoiOptions o;
  o.count = 50;
  for (double size : {1e-3, 1e3}) {
    o.size = size * Vec3(1, 1, 1);
    o.seed = 4;
    check_fills_box(o);
  }
}

TEST_CASE("a flat and a long box are filled too") {
  VoronoiOptions o;
  o.count = 60;
  o.size = {1, 1, 0.01};
  check_fills_box(o);
  o.size = {100, 1, 1};
  check_fills_box(o);
}

TEST_CASE("one Voronoi block is the box") {
  VoronoiOptions o;
  o.count = 1;
  o.size = {2, 3, 4};
  const Assembly a = voronoi(o);
  REQUIRE(a.blocks.size() == 1);
  CHECK(a.blocks[0].vertices.size() == 8);
  CHECK(testing::total_volume(a) == Approx(24).epsilon(1e-15));
}

TEST_CASE("extruded Voronoi blocks are prisms through the thickness") {
  VoronoiOptions o;
  o.size = {3, 1, 0.1};
  o.origin = {0, 0, -5};
  o.count = 200;
  o.extruded = true;
  check_fills_box(o);
  for (const Polyhedron& block : voronoi(o).blocks) {
    int ends = 0;
    for (int f = 0; f < static_cast<int>(block.faces.size()); ++f) {
      const double nz = std::abs(face_normal(block, f).z());
      CHECK((nz < 1e-14 || std::abs(nz - 1) < 1e-14));
      ends += nz > 0.5;
    }
    CHECK(ends == 2);
    for (const Vec3& x : block.vertices) {
      CHECK((x.z() == -5 || x.z() == -5 + 0.1));
      const Vec3 opposite(x.x(), x.y(), x.z() == -5 ? -5 + 0.1 : -5);
      CHECK(std::count(block.vertices.begin(), block.vertices.end(), opposite) == 1);
    }
  }
}

TEST_CASE("no Voronoi edge is much shorter than a block") {
  VoronoiOptions o;
  o.count = 1000;
  for (int relaxations : {0, 3}) {
    o.relaxations = relaxations;
    o.extruded = false;
    o.size = {1, 1, 1};
    CHECK(shortest_edge(voronoi(o)) > 0.999e-3 * std::cbrt(1.0 / o.count));
    o.extruded = true;
    o.size = {1, 1, 0.03};
    CHECK(shortest_edge(voronoi(o)) > 0.999e-2 * std::sqrt(1.0 / o.count));
  }
}

TEST_CASE("Lloyd's relaxation makes the blocks more equal") {
  const auto scatter = [](int relaxations) {
    VoronoiOptions o;
    o.count = 200;
    o.relaxations = relaxations;
    double squares = 0;
    for (const Polyhedron& block : voronoi(o).blocks)
      squares += std::pow(mass_properties(block).volume * o.count - 1, 2);
    return std::sqrt(squares / o.count);
  };
  CHECK(scatter(0) > 0.3); // a Poisson-Voronoi diagram has 0.42
  CHECK(scatter(10) < 0.5 * scatter(0));
}

TEST_CASE("the same seed gives the same Voronoi blocks, another seed others") {
  VoronoiOptions o;
  o.count = 40;
  const Assembly a = voronoi(o), b = voronoi(o);
  o.seed = 2;
  const Assembly c = voronoi(o);
  for (std::size_t i = 0; i < a.blocks.size(); ++i)
    CHECK(a.blocks[i].vertices == b.blocks[i].vertices);
  CHECK(a.blocks[0].vertices != c.blocks[0].vertices);
}
