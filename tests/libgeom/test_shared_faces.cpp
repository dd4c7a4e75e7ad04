// Shared faces of assemblies: counts from formulas, areas from the surface balance.
#include "libgeom/assembly/assembly.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libgeom/assembly_laws.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>

using namespace geom;

namespace {

void replace_by_cut(std::vector<Polyhedron>& blocks, int block, const Plane& plane) {
  Cut halves = cut(blocks[block], plane);
  REQUIRE((halves.above && halves.below));
  blocks[block] = halves.above->shape;
  blocks.push_back(halves.below->shape);
}

bool same(const SharedFace& a, const SharedFace& b) {
  return a.block_a == b.block_a && a.face_a == b.face_a && a.block_b == b.block_b && a.face_b == b.face_b;
}

} // namespace

TEST_CASE("a grid of nx ny nz blocks shares 3 nx ny nz - nx ny - ny nz - nz nx faces") {
  for (const auto& [nx, ny, nz] :
       {std::array{1, 1, 1}, std::array{2, 1, 1}, std::array{5, 4, 3}, std::array{7, 7, 7}}) {
    const Assembly a = grid({0.7, 0.3, 1.1}, {nx, ny, nz}, {3, -2, 1});
    CHECK(a.blocks.size() == static_cast<std::size_t>(nx * ny * nz));
    CHECK(shared_faces(a.blocks, 1e-9).size() ==
          static_cast<std::size_t>(3 * nx * ny * nz - nx * ny - ny * nz - nz * nx));
  }
}

TEST_CASE("a grid's shared faces are found a million block sizes from the origin, and turned") {
  Assembly a = grid({4, 4, 4}, {4, 4, 4}, {1e6, -2e6, 1e6});
  CHECK(shared_faces(a.blocks, 1e-12).size() == 144);
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (Polyhedron& block : a.blocks)
    for (Vec3& x : block.vertices)
      x = q * x;
  CHECK(shared_faces(a.blocks, 1e-12).size() == 144);
}

TEST_CASE("the faces of a shared pair look at each other in one plane") {
  const Assembly a = grid({1, 1, 1}, {3, 3, 3});
  for (const SharedFace& s : shared_faces(a.blocks, 1e-9)) {
    CHECK(s.block_a < s.block_b);
    const Polyhedron &p = a.blocks[s.block_a], &q = a.blocks[s.block_b];
    CHECK((face_normal(p, s.face_a) + face_normal(q, s.face_b)).norm() < 1e-14);
    CHECK((face_centroid(p, s.face_a) - face_centroid(q, s.face_b)).norm() < 1e-14);
  }
}

TEST_CASE("after a cut one face meets many") {
  std::vector<Polyhedron> blocks{make_box({0, 0, 0}, {1, 1, 1}), make_box({1, 0, 0}, {2, 1, 1})};
  // Parts of block 0 are cut by z = 1/4, 1/2, 3/4: four of them look at the one face x = 1 of block 1.
  replace_by_cut(blocks, 0, Plane::through({0, 0, 0.5}, {0, 0, 1}));
  replace_by_cut(blocks, 0, Plane::through({0, 0, 0.75}, {0, 0, 1}));
  replace_by_cut(blocks, 2, Plane::through({0, 0, 0.25}, {0, 0, 1}));
  const auto shared = shared_faces(blocks, 1e-9);
  CHECK(shared.size() == 4 + 3);
  long on_block_1 = 0;
  for (const SharedFace& s : shared)
    on_block_1 += (s.block_a == 1 && s.face_a == 0) || (s.block_b == 1 && s.face_b == 0);
  CHECK(on_block_1 == 4);
}

TEST_CASE("blocks that meet in an edge, a vertex or not at all share no face") {
  const Polyhedron cube = make_box({0, 0, 0}, {1, 1, 1});
  CHECK(shared_faces({cube, make_box({1, 1, 0}, {2, 2, 1})}, 1e-9).empty());
  CHECK(shared_faces({cube, make_box({1, 1, 1}, {2, 2, 2})}, 1e-9).empty());
  CHECK(shared_faces({cube, make_box({1.001, 0, 0}, {2, 1, 1})}, 1e-9).empty());
  CHECK(shared_faces({cube, make_box({1, 1 - 1e-10, 0}, {2, 2, 1})}, 1e-9)
            .empty()); // narrower than the tolerance
  CHECK(shared_faces({cube, make_box({1, 1 - 1e-8, 0}, {2, 2, 1})}, 1e-9).size() == 1);
  CHECK(shared_faces({}, 1e-9).empty());
}

TEST_CASE("faces in one plane that look the same way are not shared") {
  CHECK(
      shared_faces({make_box({0, 0, 0}, {1, 1, 1}), make_box({0.5, 0.2, 0.2}, {1, 0.8, 0.8})}, 1e-9).empty());
}

TEST_CASE("a long thin block shares a face with each of many small ones") {
  std::vector<Polyhedron> blocks = grid({100, 1, 1}, {100, 1, 1}).blocks;
  blocks.push_back(make_box({0, 0, -0.01}, {100, 1, 0}));
  CHECK(shared_faces(blocks, 1e-9).size() == 99 + 100);
}

TEST_CASE("asking for changed blocks gives the pairs of all blocks that have one of them") {
  std::vector<Polyhedron> blocks = grid({1, 1, 1}, {4, 4, 4}).blocks;
  testing::Draws draws{1, 1};
  for (int i = 0; i < 10; ++i) {
    const int block = static_cast<int>(draws.uniform(0, 64));
    replace_by_cut(blocks, block, Plane::through(mass_properties(blocks[block]).centroid, draws.direction()));
  }
  std::vector<char> changed(blocks.size(), 0);
  for (int i = 0; i < 6; ++i)
    changed[static_cast<std::size_t>(draws.uniform(0, 74))] = 1;
  std::vector<SharedFace> expected;
  for (const SharedFace& s : shared_faces(blocks, 1e-9))
    if (changed[s.block_a] || changed[s.block_b])
      expected.push_back(s);
  const auto found = shared_faces(blocks, changed, 1e-9);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    CHECK(same(found[i], expected[i]));
  CHECK(shared_faces(blocks, std::vector<char>(blocks.size(), 0), 1e-9).empty());
}

TEST_CASE("the shared faces of blocks refined twice over at random cover all inner faces") {
  // As refinement does: three parallel planes through a block, kept clear of its vertices; parts are cut
  // again.
  for (const auto& [offset, tolerance] : {std::pair{0.0, 1e-10}, std::pair{1e4, 1e-8}}) {
    Assembly a = grid({1, 1, 1}, {3, 3, 3}, Vec3::Constant(offset));
    testing::Draws draws{41, 1};
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t i = 0, n = a.blocks.size(); i < n; ++i) {
        if (draws.uniform(0, 1) < 0.4)
          continue;
        const MassProperties m = mass_properties(a.blocks[i]);
        const double h = std::cbrt(m.volume);
        const Vec3 normal = draws.direction();
        std::vector<Polyhedron> parts{a.blocks[i]};
        for (double at : {-0.25, 0.0, 0.25}) {
          const Plane plane = shifted_clear_of_vertices(
              parts.back(), Plane::through(m.centroid + at * h * normal, normal), 0.01 * h);
          Cut halves = cut(parts.back(), plane);
          if (halves.above && halves.below) {
            parts.back() = halves.below->shape;
            parts.push_back(halves.above->shape);
          }
        }
        a.blocks[i] = parts[0];
        a.blocks.insert(a.blocks.end(), parts.begin() + 1, parts.end());
      }
    CHECK(a.blocks.size() > 150);
    for (const Polyhedron& block : a.blocks)
      CHECK_NOTHROW(validate(block));
    CHECK(testing::total_volume(a) == Approx(1).epsilon(0.1 * tolerance));
    CHECK(testing::loose_area(a, 6, tolerance) < 1000 * tolerance);
  }
}
