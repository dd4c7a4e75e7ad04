// The Hilbert curve, the order of meshes along it, and the box of tets.
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/order.hpp"
#include "libgeom/mesh/tet_quality.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

using namespace geom;

namespace {

// Largest distance between numbers of nodes in one tet, averaged: what a cache has to span.
double spread(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets)
    sum += *std::max_element(t.begin(), t.end()) - *std::min_element(t.begin(), t.end());
  return sum / static_cast<double>(mesh.tets.size());
}

// The same mesh with tets and nodes in a random order.
TetMesh shuffled(const TetMesh& mesh) {
  const auto mixed = [](std::size_t n, std::uint64_t seed) {
    std::vector<std::pair<double, int>> keys;
    keys.reserve(n);
    for (std::size_t i = 0; i < n; ++i)
      keys.emplace_back(uniform(seed, i, 0), static_cast<int>(i));
    std::sort(keys.begin(), keys.end());
    std::vector<int> out;
    out.reserve(n);
    for (const auto& [key, i] : keys)
      out.push_back(i);
    return out;
  };
  return reordered(mesh, {mixed(mesh.tets.size(), 1), mixed(mesh.nodes.size(), 2)});
}

} // namespace

TEST_CASE("named faces keep their names where a mesh is put into another order") {
  TetMesh mesh = box_mesh({1, 1, 1}, {4, 3, 2}, 0.1);
  mesh.named["top"] = faces_on_side(mesh, outer_faces(mesh), "z+");
  REQUIRE(mesh.named["top"].size() == 24);
  for (const TetMesh& other : {shuffled(mesh), ordered(mesh)})
    CHECK(other.named.at("top") == faces_on_side(other, outer_faces(other), "z+"));
}

TEST_CASE("the Hilbert curve visits each cell of a cube once, each step to a neighbour") {
  // The first 8^3 places of the curve fill the cube of 8 cells at its start, whose corner is the origin.
  std::map<std::uint64_t, Vec3> place;
  for (std::uint32_t i = 0; i < 8; ++i)
    for (std::uint32_t j = 0; j < 8; ++j)
      for (std::uint32_t k = 0; k < 8; ++k)
        place[hilbert_index({i, j, k})] = {double(i), double(j), double(k)};
  REQUIRE(place.size() == 512);
  CHECK(place.begin()->first == 0);
  CHECK(place.rbegin()->first == 511);
  for (auto a = place.begin(), b = std::next(a); b != place.end(); ++a, ++b)
    REQUIRE((a->second - b->second).lpNorm<1>() == 1);
}

TEST_CASE("an order is a permutation, and reordering keeps the mesh") {
  TetMesh mesh = box_mesh({1, 2, 3}, {4, 3, 5}, 0.1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.region[t] = static_cast<int>(t); // a name for each tet
  const MeshOrder order = hilbert_order(mesh);
  for (const auto& [list, count] :
       {std::pair{order.tets, mesh.tets.size()}, std::pair{order.nodes, mesh.nodes.size()}}) {
    std::vector<int> sorted = list, all(count);
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0);
    CHECK(sorted == all);
  }
  const std::vector<int> place = inverse(order.tets);
  const TetMesh out = reordered(mesh, order);
  validate(out, "reordered");
  for (std::size_t t = 0; t < out.tets.size(); ++t) {
    REQUIRE(out.region[t] == order.tets[t]);
    REQUIRE(place[out.region[t]] == static_cast<int>(t));
    for (std::size_t c = 0; c < 4; ++c)
      REQUIRE(out.nodes[out.tets[t][c]] == mesh.nodes[mesh.tets[order.tets[t]][c]]);
  }
}

TEST_CASE("nodes are numbered as the tets first touch them") {
  const TetMesh mesh = ordered(box_mesh({1, 1, 1}, {5, 5, 5}));
  int next = 0;
  for (const Tet& t : mesh.tets)
    for (const int node : t) {
      REQUIRE(node <= next);
      next += node == next;
    }
  CHECK(next == static_cast<int>(mesh.nodes.size()));
}

TEST_CASE("the order depends on the shape alone, not on how a mesh was numbered") {
  const TetMesh mesh = box_mesh({1, 1.3, 0.9}, {6, 7, 5}, 0.15); // with jitter no two centroids share a cell
  const TetMesh a = ordered(mesh), b = ordered(shuffled(mesh));
  CHECK(a.tets == b.tets);
  CHECK(a.nodes == b.nodes);
}

TEST_CASE("along the curve the nodes of a tet are near each other in memory") {
  const TetMesh mesh = shuffled(box_mesh({1, 1, 1}, {20, 20, 20}));
  // Nodes in random order: the range of four uniform numbers is 3/5 of their number on average.
  CHECK(spread(mesh) == Approx(0.6 * 9261).epsilon(0.02));
  // A tet lies within a cell; all but a few cells are inside a sub-cube of 4 x 4 x 4, 125 nodes.
  CHECK(spread(ordered(mesh)) < 0.15 * spread(mesh));
}

TEST_CASE("a box of tets has 6 to a cell, fills the box and is conforming") {
  const TetMesh mesh = box_mesh({1, 2, 3}, {2, 3, 4});
  validate(mesh, "box");
  CHECK(mesh.tets.size() == 6 * 2 * 3 * 4);
  CHECK(mesh.nodes.size() == 3 * 4 * 5);
  CHECK(volume(mesh) == Approx(6).epsilon(1e-14));
  for (const Tet& t : mesh.tets)
    CHECK(volume({mesh.nodes, {t}, {0}}) == Approx(6. / (6 * 24)).epsilon(1e-12));
  double area = 0;
  const auto faces = outer_faces(mesh);
  for (const char* side : {"x-", "x+", "y-", "y+", "z-", "z+"})
    area += measure(mesh, faces, faces_on_side(mesh, faces, side)).area;
  CHECK(area == Approx(2 * (2 + 6 + 3)));
  CHECK(faces.size() == 2 * 2 * (2 * 3 + 3 * 4 + 4 * 2)); // none inside
}

TEST_CASE("jitter moves inner nodes only, keeps every tet upright and repeats with its seed") {
  const TetMesh flat = box_mesh({1, 1, 1}, {4, 4, 4});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const TetMesh mesh = box_mesh({1, 1, 1}, {4, 4, 4}, max_box_jitter, seed);
    CHECK(quality(mesh).min_volume > 0);
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Vec3 x = flat.nodes[n], d = mesh.nodes[n] - x;
      const bool inside = (x.array() > 0).all() && (x.array() < 1).all();
      REQUIRE((d.norm() > 0) == inside);
      REQUIRE(d.cwiseAbs().maxCoeff() <= max_box_jitter / 4);
    }
  }
  CHECK(box_mesh({1, 1, 1}, {4, 4, 4}, 0.1, 3).nodes == box_mesh({1, 1, 1}, {4, 4, 4}, 0.1, 3).nodes);
  CHECK(box_mesh({1, 1, 1}, {4, 4, 4}, 0.1, 3).nodes != box_mesh({1, 1, 1}, {4, 4, 4}, 0.1, 4).nodes);
}

TEST_CASE("at the jitter of 1/6 a tet of the box can be made flat, hence the limit below it") {
  // Corners 0, 1, 3, 7 of a cell move along (1, -1, 1) by 1/6 each way on every axis.
  const Vec3 step = Vec3(1, -1, 1) / 6;
  const std::vector<Vec3> corners{Vec3(0, 0, 0) + step, Vec3(1, 0, 0) - step, Vec3(1, 1, 0) + step,
                                  Vec3(1, 1, 1) - step};
  CHECK(volume({corners, {{0, 1, 2, 3}}, {0}}) == Approx(0).margin(1e-15));
  CHECK(max_box_jitter < 1. / 6);
}

TEST_CASE("boxes of tets that cannot be are refused") {
  CHECK_THROWS_WITH(box_mesh({1, 1, 1}, {0, 1, 1}), "divisions = 0: must be three whole numbers from 1");
  CHECK_THROWS_WITH(box_mesh({1, 1, 1}, {1, 1, 1}, 0.2), "jitter = 0.2: must be from 0 to 0.16");
  CHECK_THROWS_AS(box_mesh({1, -1, 1}, {1, 1, 1}), InputError);
  CHECK_THROWS_WITH(box_mesh({1, 1, 1}, {1000, 1000, 1000}),
                    Catch::Contains("such that there are at most 20 million tetrahedra"));
}
