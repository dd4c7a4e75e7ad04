// Stiffness damping of joints: a stiff block on a soft joint swings with beta w / 2 of critical damping, the ledger closes,
// and the stable step holds.
#include "libcdem/procedure/run.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;

namespace {

constexpr double soft = 1e8; // Pa/m, of the joint

System block_on_block(double beta, bool bonded) {
  cdem::Joint joint;
  joint.bonded = bonded;
  joint.cohesion = joint.tensile_strength = 1e9;
  joint.friction_angle = 40 * degree;
  joint.normal_stiffness = joint.shear_stiffness = soft;
  joint.stiffness_damping = beta;
  cdem::BodySpec spec = body("blocks", geom::grid({1, 1, 2}, {1, 1, 2}), rock(), joint);
  spec.element = cdem::Element::finite_volume;
  System s(build({spec}));
  s.hold(cdem::Selection::in_box({{-1, -1, -1}, {2, 2, 0.9}}), "xyz");
  s.conditions.fixes.push_back(fixed(cdem::Selection::side("z-")));
  return s;
}

} // namespace

TEST_CASE("a joint's stiffness damping takes beta w / 2 of critical damping", "[damping][joint]") {
  const double w = std::sqrt(soft / rock().density), ratio = 0.05;
  System s = block_on_block(2 * ratio / w, true);
  s.hold(cdem::Selection::in_box({{-1, -1, -1}, {2, 2, 0.99}}), "xyz"); // all of the lower block but its top
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (s.model.blocks[cdem::block_of(s.model, static_cast<int>(i))].mass.centroid.z() > 1)
      s.state.velocity[i].z = 1e-3;
  const double before = cdem::energy(s.model, s.state).total();
  cdem::RunOptions options;
  const double periods = 4;
  options.duration = periods * 2 * pi / w;
  s.run(options);
  const cdem::EnergyLedger after = cdem::energy(s.model, s.state);
  CHECK(std::log(before / (after.total() - after.damping)) ==
        Approx(2 * ratio * 2 * pi * periods).epsilon(0.03));
  CHECK(after.total() == Approx(before).epsilon(2e-3));
}

TEST_CASE("a contact's damping never pulls, and the shortened stable step holds", "[damping][joint]") {
  const double w = std::sqrt(soft / rock().density);
  System s = block_on_block(2 / w, false);
  CHECK(cdem::stable_time_step(s.model) < cdem::stable_time_step(block_on_block(0, false).model));
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (s.model.blocks[cdem::block_of(s.model, static_cast<int>(i))].mass.centroid.z() > 1)
      s.state.velocity[i].z = 1e-3; // flies off
  cdem::RunOptions options;
  options.duration = 0.05;
  s.run(options);
  double momentum = 0, mass = 0;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (s.model.blocks[cdem::block_of(s.model, static_cast<int>(i))].mass.centroid.z() > 1) {
      momentum += s.model.node_mass[i] * s.state.velocity[i].z;
      mass += s.model.node_mass[i];
    }
  CHECK(momentum / mass == Approx(1e-3).epsilon(1e-6));
}

TEST_CASE("friction acts on the weight that the dashpots of a joint bear", "[damping][joint][friction]") {
  const double slope = 45 * degree, friction = 40 * degree, g = 9.81;
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = friction;
  joint.stiffness_damping = 1e-3;
  cdem::Elastic soft_rock = rock();
  soft_rock.youngs_modulus = 1e10;
  soft_rock.poissons_ratio = 0.2;
  soft_rock.density = 2600;
  cdem::BodySpec base = body("base", geom::grid({6, 2, 1}, {1, 1, 1}, {-2, -1, -1}), soft_rock),
                 block = body("block", geom::grid({2, 2, 1}, {1, 1, 1}, {-1, -1, 0}), soft_rock);
  base.element = block.element = cdem::Element::finite_volume;
  System s(build({base, block}, {{"base", "block", joint}}));
  s.conditions.fixes.push_back(fixed(cdem::Selection::of_body("base")));
  s.conditions.gravity = gravity({g * std::sin(slope), 0, -g * std::cos(slope)});
  const auto speed_after = [&](double duration) { // m/s
    cdem::RunOptions options;
    options.duration = duration;
    s.run(options);
    double momentum = 0, mass = 0;
    for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
      if (s.model.blocks[cdem::block_of(s.model, static_cast<int>(i))].body == 1) {
        momentum += s.model.node_mass[i] * s.state.velocity[i].x;
        mass += s.model.node_mass[i];
      }
    return momentum / mass;
  };
  const double before = speed_after(0.05), gained = speed_after(0.15) - before,
               law = g * (std::sin(slope) - std::tan(friction) * std::cos(slope));
  // The sole chatters: 1.5 times the law's. With friction on the elastic force alone it is 3.2 times.
  CHECK(gained / 0.15 < 2 * law);
  CHECK(gained / 0.15 > 0.95 * law);
}
