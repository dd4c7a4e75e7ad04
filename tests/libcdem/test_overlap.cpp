// The volume that blocks occupy at once, against boxes moved into each other by a known distance.
#include "libcdem/results/overlap.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::BodySpec block(const char* name, const Vec3& min, const Vec3& max) {
  cdem::BodySpec body{name, {}, rock(), friction(30)};
  body.shape.blocks = {geom::make_box(min, max)};
  return body;
}

void move(System& s, int block, const Vec3& by) {
  for (int n = s.model.blocks[block].node_begin; n < s.model.blocks[block].node_end; ++n)
    s.state.displacement[n] = cdem::node(by);
}

} // namespace

TEST_CASE("overlap of blocks is the volume of their common part", "[overlap]") {
  System s(build({block("a", {0, 0, 0}, {1, 1, 1}), block("b", {2, 0, 0}, {3, 1, 1}),
                  block("c", {5, 0, 0}, {6, 1, 1})}));
  CHECK(cdem::overlap(s.model, s.state).volume == 0);
  CHECK(cdem::overlap(s.model, s.state).pairs == 0);
  move(s, 1, {-1.1, 0.5, 0.25}); // 0.1 x 0.5 x 0.75 in a
  const cdem::Overlap one = cdem::overlap(s.model, s.state);
  CHECK(one.volume == Approx(0.1 * 0.5 * 0.75));
  CHECK(one.pairs == 1);
  CHECK(one.largest_a == "\"a\"");
  CHECK(one.largest_b == "\"b\"");
  CHECK((one.place - Vec3(0.95, 0.75, 0.625)).norm() < 1e-12);
  move(s, 2, {-5 - 0.999, 0, 0}); // a thousandth of a
  const cdem::Overlap two = cdem::overlap(s.model, s.state);
  CHECK(two.pairs == 2);
  CHECK(two.volume == Approx(0.1 * 0.5 * 0.75 + 0.001));
}

TEST_CASE("overlap of a turned block with a mesh is that of their shapes", "[overlap]") {
  cdem::BodySpec mesh{"mesh", {}, rock(), {}};
  mesh.meshes = {geom::box_mesh({1, 1, 1}, {3, 2, 2})};
  System s(build({block("b", {2, 0, 0}, {3, 1, 1}), mesh}));
  // An edge of b, turned by 45 degrees about z, stands 0.1 m deep in the side x+ of the mesh.
  const geom::Mat3 turn = rotation({0, 0, 1}, 45 * degree);
  for (int n = s.model.blocks[0].node_begin; n < s.model.blocks[0].node_end; ++n) {
    const Vec3& x = s.model.node_position[n];
    const Vec3 to = turn * (x - Vec3(2.5, 0.5, 0.5)) + Vec3(0.9 + std::sqrt(0.5), 0.5, 0.5);
    s.state.displacement[n] = cdem::node(to - x);
  }
  const cdem::Overlap found = cdem::overlap(s.model, s.state);
  CHECK(found.pairs == 1);
  CHECK(found.volume == Approx(0.1 * 0.1).epsilon(1e-9));
}

TEST_CASE("overlap with a block that is dented is less by the dent", "[overlap]") {
  cdem::BodySpec soft = block("a", {0, 0, 0}, {1, 1, 1});
  soft.element = cdem::Element::finite_volume;
  System s(build({soft, block("b", {2, -1, -1}, {4, 2, 2})}));
  move(s, 1, {-1.5, 0, 0}); // covers a from x = 0.5 on
  CHECK(cdem::overlap(s.model, s.state).volume == Approx(0.5));
  int dented = 0;
  for (int n = s.model.blocks[0].node_begin; n < s.model.blocks[0].node_end; ++n)
    if ((s.model.node_position[n] - Vec3(1, 0.5, 0.5)).norm() < 1e-12) { // the centre of a face
      s.state.displacement[n] = cdem::node({-0.3, 0, 0});
      ++dented;
    }
  REQUIRE(dented == 1);
  CHECK(cdem::overlap(s.model, s.state).volume == Approx(0.5 - 0.3 / 3));
}

TEST_CASE("overlap of two boxes that lie askew is found wherever their corners and faces nearly meet",
          "[overlap]") {
  // A cube on a cube, shifted by a step that rounding may take for none, and turned by as little.
  for (const double depth : {1e-3, 1e-6, 1e-8})
    for (const double off : {0.0, 1e-9, 1e-8, 1e-7, 0.3})
      for (const double turn : {0.0, 1e-10, 1e-9, 1e-8}) {
        INFO("depth " << depth << ", shifted by " << off << ", turned by " << turn);
        System s(build({block("a", {0, 0, 0}, {1, 1, 1}), block("b", {2, 0, 0}, {3, 1, 1})}));
        const geom::Mat3 by = rotation({0.2, 0.3, 1}, turn);
        for (int n = s.model.blocks[1].node_begin; n < s.model.blocks[1].node_end; ++n) {
          const Vec3& x = s.model.node_position[n];
          s.state.displacement[n] = cdem::node(by * (x - Vec3(2, 0, 0)) + Vec3(1 - depth, off, 0) - x);
        }
        CHECK(cdem::overlap(s.model, s.state).volume ==
              Approx(depth * (1 - off)).epsilon(1e-6).margin(turn + 1e-9));
      }
}

TEST_CASE("overlap of a body with itself is that of its tetrahedra", "[overlap][fracture]") {
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  System s(build({meshed("mesh", geom::box_mesh({2, 1, 1}, {2, 2, 2}), everywhere)}));
  CHECK(cdem::overlap(s.model, s.state).volume == 0);
  for (const geom::Tet& tet : s.model.tets) {
    double x = 0;
    for (const int n : tet)
      x += s.model.node_position[n].x() / 4;
    if (x > 1)
      for (const int n : tet)
        s.state.displacement[n] = cdem::node({-0.1, 0.05, 0});
  }
  const cdem::Overlap found = cdem::overlap(s.model, s.state);
  CHECK(found.volume == Approx(0.1 * 0.95));
  CHECK(found.pairs == 1);
  CHECK(found.largest_a == found.largest_b);
}
