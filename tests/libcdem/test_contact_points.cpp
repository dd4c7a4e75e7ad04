// Contacts as results: what carries a block that rests is its weight.
#include "libcdem/results/contact_points.hpp"
#include "libcdem/simulation.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using Catch::Matchers::WithinRel;
using geom::Vec3;

TEST_CASE("contact points carry the weight of a block at rest, and the friction that holds it", "[contact]") {
  cdem::Elastic rock;
  rock.youngs_modulus = 1e9;
  rock.poissons_ratio = 0.2;
  rock.density = 2500;
  cdem::Joint friction;
  friction.bonded = false;
  friction.friction_angle = 0.6;
  cdem::ModelSpec spec;
  spec.bodies.push_back({"floor", geom::grid({3, 3, 0.5}, {1, 1, 1}, {-1, -1, -0.5}), rock, friction});
  spec.bodies.push_back({"block", geom::grid({1, 1, 1}, {1, 1, 1}, {0, 0, 1e-4}), rock,
                         friction}); // above it, not bonded to it
  spec.default_contact = friction;
  for (cdem::BodySpec& body : spec.bodies)
    body.element = cdem::Element::rigid;
  cdem::Simulation model(spec, 1, nullptr);
  REQUIRE(!model.model().surface.empty());
  CHECK(cdem::contact_points(model.model(), model.state()).empty());
  model.fix({cdem::Selection::of_body("floor")});
  const double push = 2; // m/s2, sideways: less than friction holds
  model.gravity({{push, 0, -10}});
  cdem::RunOptions run;
  run.duration = 0.3;
  run.local_damping = 0.7;
  model.run(run);
  const std::vector<cdem::ContactPoint> points = cdem::contact_points(model.model(), model.state());
  REQUIRE(points.size() >= 3);
  Vec3 on_block = Vec3::Zero();
  for (const cdem::ContactPoint& point : points) {
    CHECK(point.depth > 0);
    CHECK(std::abs(point.place.z()) < 1e-3); // in the plane where they touch
    CHECK(point.source_body != point.target_body);
    CHECK(point.shear.norm() <= std::tan(friction.friction_angle) * point.normal.norm() * (1 + 1e-9));
    on_block += (point.source_body == 1 ? 1 : -1) * (point.normal + point.shear);
  }
  CHECK_THAT(on_block.z(), WithinRel(2500. * 10, 1e-3));
  CHECK_THAT(on_block.x(), WithinRel(-2500. * push, 1e-3));
}
