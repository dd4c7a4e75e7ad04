// Which tetrahedron holds a place: by the grid as by looking at each of them.
#include "libcdem/model/unit_order.hpp"
#include "libcdem/results/tet_at_place.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/random.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// The first tetrahedron that holds the place, of all in the order of their blocks; -1: none.
int looked_for(const cdem::Model& model, const Vec3& place) {
  for (const int b : cdem::blocks_by_id(model))
    for (int t = model.blocks[b].tet_begin; t < model.blocks[b].tet_end; ++t) {
      const auto x = [&](int k) { return model.node_position[model.tets[t][k]]; };
      geom::Mat3 edges;
      edges << x(1) - x(0), x(2) - x(0), x(3) - x(0);
      const Vec3 w = edges.inverse() * (place - x(0));
      if (std::min(1 - w.sum(), w.minCoeff()) >= -1e-6)
        return t;
    }
  return -1;
}

cdem::Model blocks_beside_a_mesh(const Vec3& away) {
  geom::VoronoiOptions cells;
  cells.count = 30;
  cells.size = {1, 0.5, 0.7};
  cells.origin = away;
  geom::TetMesh mesh = unstructured({0.6, 0.5, 0.4}, 0.2);
  for (Vec3& x : mesh.nodes)
    x += away + Vec3(1, 0, 0); // face to face with the blocks
  cdem::BodySpec blocks = body("cells", geom::voronoi(cells), rock());
  blocks.element = cdem::Element::finite_volume;
  return build({blocks, meshed("mesh", mesh, {}, rock())}, {{"cells", "mesh", friction(30)}});
}

} // namespace

TEST_CASE("a place on a face that two bodies share is found in both", "[results]") {
  const cdem::Model model = blocks_beside_a_mesh({0, 0, 0});
  const cdem::TetsByPlace tets(model);
  for (const Vec3& place : {Vec3(1, 0.2, 0.2), Vec3(0.9, 0.2, 0.2), Vec3(1.1, 0.2, 0.2)}) {
    const auto at = tets.find(model, place);
    REQUIRE(at);
    const int body = model.blocks[at->block].body;
    const auto other = tets.find_beside(model, place, body);
    REQUIRE(other.has_value() == (place.x() == 1));
    if (other)
      CHECK(model.blocks[other->block].body == 1 - body);
  }
}

TEST_CASE("a place is found in the first tetrahedron that holds it, inside, on faces and at nodes",
          "[results]") {
  const Vec3 away = GENERATE(Vec3(0, 0, 0), Vec3(4e5, -2e5, 3e3));
  const cdem::Model model = blocks_beside_a_mesh(away);
  const cdem::TetsByPlace tets(model);
  int found = 0, outside = 0;
  const auto check = [&](const Vec3& place) {
    const int by_hand = looked_for(model, place);
    const auto at = tets.find(model, place);
    INFO(place.transpose());
    REQUIRE((at ? at->tet : -1) == by_hand);
    (at ? found : outside) += 1;
    if (!at)
      return;
    CHECK(model.tet_block[at->tet] == at->block);
    Vec3 again = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
      again += at->weight[k] * model.node_position[model.tets[at->tet][k]];
    CHECK((again - place).norm() < 1e-9 * (1 + away.norm()));
  };
  for (int i = 0; i < 1000; ++i)
    check(away + Vec3(-0.1 + 1.8 * geom::uniform(5, i, 0), -0.1 + 0.7 * geom::uniform(5, i, 1),
                      -0.1 + 0.9 * geom::uniform(5, i, 2)));
  for (std::size_t i = 0; i < model.node_position.size(); i += 3)
    check(model.node_position[i]);
  for (std::size_t t = 0; t < model.tets.size(); t += 5) // middles of edges and of faces
    for (int k = 2; k <= 3; ++k) {
      Vec3 middle = Vec3::Zero();
      for (int corner = 0; corner < k; ++corner)
        middle += model.node_position[model.tets[t][corner]] / k;
      check(middle);
    }
  CHECK(found > 500);
  CHECK(outside > 100);
  CHECK_FALSE(tets.find(model, away + Vec3(1e9, 0, 0)));
  CHECK_FALSE(tets.find(model, Vec3::Constant(std::nan(""))));
}
