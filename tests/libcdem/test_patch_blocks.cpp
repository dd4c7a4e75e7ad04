// Patch test of the blocks themselves: a linear displacement u = G x is reproduced exactly, with the uniform
// stress C : sym G, whatever the block's shape.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace testing;
using geom::Vec3;

namespace {

geom::Mat3 skew_gradient() {
  geom::Mat3 g;
  g << 3e-4, -1e-4, 2e-4, 5e-5, -4e-4, 1e-4, -2e-4, 3e-4, 1.5e-4;
  return g;
}

geom::Assembly irregular(bool voronoi) {
  if (voronoi) {
    geom::VoronoiOptions options;
    options.count = 40;
    options.relaxations = 0; // as irregular as it gets
    return geom::voronoi(options);
  }
  geom::JointSet steep{60 * degree, 130 * degree, 0.35, 0.2, 8 * degree, 8 * degree};
  geom::JointSet flat{15 * degree, 40 * degree, 0.3, 0.2, 8 * degree, 8 * degree};
  return geom::cut_by_joints(geom::grid({1, 1, 1}, {2, 1, 2}), {steep, flat}, 7);
}

// Every node but the blocks' centroids gets u = G x and keeps it; the centroids have to find it.
System stretched_from_outside(const geom::Assembly& shape, const geom::Mat3& gradient) {
  System s(build({body("rock", shape)}));
  std::set<int> centroids;
  for (const cdem::Block& block : s.model.blocks)
    centroids.insert(block.centroid_node());
  s.hold(cdem::Selection::everything(), "xyz");
  cdem::Fix release;
  release.release = true;
  release.on = cdem::Selection::where(
      [&m = s.model](const Vec3& x) {
        return std::any_of(m.blocks.begin(), m.blocks.end(),
                           [&](const cdem::Block& b) { return x == b.mass.centroid; });
      },
      "centroids");
  s.conditions.fixes.push_back(release);
  for (int i = 0; i < static_cast<int>(s.model.node_position.size()); ++i)
    if (centroids.count(i) == 0)
      s.state.displacement[i] = node(gradient * s.model.node_position[i]);
  s.relax(1e-14);
  return s;
}

} // namespace

TEST_CASE("a linear displacement on the faces of irregular star blocks gives uniform stress", "[patch]") {
  const bool voronoi = GENERATE(true, false);
  const geom::Assembly shape = irregular(voronoi);
  REQUIRE(shape.blocks.size() >= 30);
  const System s = stretched_from_outside(shape, skew_gradient());
  CHECK(stress_error(s, hooke(rock(), skew_gradient())) < 1e-10);
  for (const cdem::Block& block : s.model.blocks) {
    const Vec3 expected = skew_gradient() * block.mass.centroid;
    CHECK((vec(s.state.displacement[block.centroid_node()]) - expected).norm() <
          1e-10 * skew_gradient().norm());
  }
}

TEST_CASE("a small rigid motion of irregular blocks produces no force", "[patch]") {
  System s(build({body("rock", irregular(true))}));
  const Vec3 shift(0.1, -0.2, 0.3), turn(0.02, -0.01, 0.03);
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.displacement[i] = node(shift + turn.cross(s.model.node_position[i]));
  double largest = 0;
  for (const Vec3& f : s.net_forces())
    largest = std::max(largest, f.norm());
  // Against the force that the same displacements would need as strain: E times the turn on a unit face.
  CHECK(largest < 1e-12 * rock().youngs_modulus * turn.norm());
}
