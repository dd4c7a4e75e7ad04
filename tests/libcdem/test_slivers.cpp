// Slivers shorten the stable step: by how much is what the model allows without them.
#include "libcdem/procedure/run.hpp"
#include "libcdem/results/slivers.hpp"
#include "libgeom/assembly/assembly.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::BodySpec plates(const std::vector<double>& thickness) {
  cdem::BodySpec body{"plates", {}, rock(), friction(30)};
  double x = 0;
  for (const double t : thickness) {
    body.shape.blocks.push_back(geom::make_box({x, 0, 0}, {x + t, 1, 1}));
    x += t + 1;
  }
  return body;
}

cdem::BodySpec meshed_parts(std::vector<geom::TetMesh> meshes) {
  cdem::BodySpec body{"meshes", {}, rock(), {}};
  body.meshes = std::move(meshes);
  return body;
}

} // namespace

TEST_CASE("slivers among blocks: their step, and that of the others", "[slivers]") {
  const cdem::Model with = build({plates({1, 1, 0.02, 0.8, 0.9, 0.01})}),
                    without = build({plates({1, 1, 0.8, 0.9})});
  const auto found = cdem::find_slivers(with);
  REQUIRE(found.size() == 1);
  CHECK(found[0].body == "plates");
  CHECK_FALSE(found[0].elements);
  CHECK(found[0].count == 2);
  CHECK(found[0].of == 6);
  CHECK(found[0].step == cdem::stable_time_step(with));
  CHECK(found[0].other_step == Approx(cdem::stable_time_step(without)).epsilon(1e-12));
  CHECK(found[0].worst == with.blocks.back().id);
  // The least height of a plate's tets is that of a face's centre above an edge of the face and the centroid.
  CHECK(found[0].height_over_size == Approx(0.005 * 0.5 / std::hypot(0.5, 0.005) / std::cbrt(0.01)));
  CHECK(cdem::find_slivers(without).empty());
}

TEST_CASE("slivers among the tetrahedra of a mesh", "[slivers]") {
  geom::TetMesh flat = geom::box_mesh({1, 1, 1}, {4, 4, 4});
  for (Vec3& x : flat.nodes) // the top layer is 0.025 m thick
    if (x.z() > 0.7 && x.z() < 0.8)
      x.z() = 0.975;
  const auto found = cdem::find_slivers(build({meshed_parts({flat})}));
  REQUIRE(found.size() == 1);
  CHECK(found[0].elements);
  CHECK(found[0].of == static_cast<std::int64_t>(flat.tets.size()));
  CHECK(found[0].count == found[0].of / 4);
  CHECK(found[0].place.z() > 0.975);
  CHECK(found[0].other_step > 2 * found[0].step);
  CHECK(cdem::find_slivers(build({meshed_parts({geom::box_mesh({1, 1, 1}, {4, 4, 4})})})).empty());
}

TEST_CASE("rigid blocks have no slivers", "[slivers]") {
  cdem::BodySpec body = plates({1, 1, 1, 0.01});
  body.element = cdem::Element::rigid;
  CHECK(cdem::find_slivers(build({body})).empty());
}
