// Checkpoints of models that were cut or changed hold the whole model. Whatever number in one is forged, it is taken or
// refused in one line; nothing crashes. Each try is made in a child process, so that a crash is a failed check.
#include "tests/libcdem/going_on.hpp"
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

using namespace testing;

namespace {

cdem::Joint weak_joint() {
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = 2e5;
  joint.cohesion = 6e5;
  return joint;
}

cdem::Simulation plate(const std::shared_ptr<cdem::Observer>& observer) {
  cdem::ModelSpec spec;
  spec.bodies = {{"plate", geom::grid({1, 1, 0.5}, {2, 2, 1}), rock(), rock_joint()}};
  cdem::Simulation s(spec, 1, observer);
  s.fix(fixed(cdem::Selection::side("y-")));
  s.traction(traction(cdem::Selection::side("y+"), {5e4, 1.5e5, 0}));
  return s;
}

// Two blocks beside the rest, with a joint by tables that holds water.
cdem::BodySpec with_table() {
  cdem::JointTable law;
  law.closing = {{-1e-4, -1e4}, {0, 0}, {1e-3, 1e6}};
  law.shear = {{0, 1e4}, {1e6, 8e5}};
  cdem::Joint joint;
  joint.bonded = false;
  joint.law = law;
  return {"table", geom::grid({0.4, 0.2, 0.2}, {2, 1, 1}, {2, 0, 0}), rock(), joint};
}

// A bonded mesh, convex blocks that move far and a rigid body, one above the other.
cdem::Simulation pile(const std::shared_ptr<cdem::Observer>& observer) {
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 20 * degree;
  law.normal_stiffness = 2e9;
  geom::TetMesh ground = geom::box_mesh({1, 1, 0.4}, {2, 2, 1}),
                hard = geom::box_mesh({0.4, 0.4, 0.4}, {1, 1, 1});
  for (geom::Vec3& x : hard.nodes)
    x += geom::Vec3(0.3, 0.3, 0.9);
  geom::VoronoiOptions cells;
  cells.size = {0.5, 0.5, 0.5};
  cells.count = 3;
  geom::Assembly blocks = geom::voronoi(cells);
  for (geom::Polyhedron& block : blocks.blocks)
    for (geom::Vec3& x : block.vertices)
      x += geom::Vec3(0.25, 0.25, 0.4);
  cdem::ModelSpec spec;
  spec.bodies = {
      meshed("ground", ground), {"blocks", blocks, rock(), weak_joint()}, meshed("hard", hard), with_table()};
  cdem::ResidualStrength residual;
  residual.friction = std::tan(20 * degree);
  residual.cohesion = 1e5;
  spec.bodies[1].joint.law = residual;
  spec.default_contact = law;
  spec.bodies[0].bonding.everywhere = true;
  spec.bodies[1].element = cdem::Element::finite_volume;
  spec.pairs = {
      {"ground", "blocks", law}, {"ground", "hard", law}, {"blocks", "hard", law}, {"blocks", "blocks", law}};
  cdem::Simulation s(spec, 1, observer);
  s.fix(fixed(cdem::Selection::side("z-")));
  s.gravity(gravity({1, 0, -9}));
  cdem::Water wets;
  wets.on = cdem::Selection::of_body("table");
  wets.pressure = [](const geom::Vec3&) { return 1e4; };
  s.water(wets);
  return s;
}

void run(cdem::Simulation& s) {
  cdem::RunOptions options;
  options.steps = 400;
  s.run(options);
}

// What a script may do with a model that was restored.
void use(cdem::Simulation& s) {
  s.counts();
  s.contacts();
  s.state_hash();
  s.snapshot("forged");
  run(s);
  s.snapshot("forged");
}

// Changes of four bytes at some places of `saved`, and of counts and indices one by one where they are many.
void forge(const std::string& saved, int times,
           cdem::Simulation (*build)(const std::shared_ptr<cdem::Observer>&)) {
  const auto observer = std::make_shared<Stopper>();
  cdem::Simulation fresh = build(observer);
  geom::ChildLimits limits;
  limits.memory = std::uint64_t{2} << 30;
  limits.seconds = 60;
  int taken = 0, refused = 0;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(times); ++i) {
    const auto draw = geom::philox({static_cast<std::uint32_t>(i), 0, 0, 0}, {7, 0});
    const std::size_t head = 24; // which model it is
    const std::size_t at = head + draw[0] % (saved.size() - head - 4);
    std::string forged = saved;
    std::uint32_t old = 0;
    std::memcpy(&old, &forged[at], sizeof old);
    const std::uint32_t values[] = {
        0xffffffffu, 0x7fffffffu, 0x80000000u, old + 1, old - 1, draw[2] % 256u, old ^ (1u << draw[3] % 32)};
    std::memcpy(&forged[at], &values[draw[1] % std::size(values)], sizeof old);
    INFO("four bytes at " << at << " of " << saved.size() << ", " << old << " made "
                          << values[draw[1] % std::size(values)]);
    const std::string said = geom::run_in_child("forged", limits, [&]() -> std::string {
      observer->polls = 0;
      observer->stop_at = 4;
      try {
        fresh.restore(forged);
        use(fresh);
      } catch (const cdem::Interrupted&) {
        return "taken";
      } catch (const cdem::SolutionError&) {
        return "taken";
      } catch (const std::bad_alloc&) {
        return "refused";
      } catch (const geom::InputError& error) {
        return std::string(error.what()).find('\n') == std::string::npos ? "refused" : error.what();
      }
      return "taken";
    });
    CHECK((said == "taken" || said == "refused"));
    ++(said == "taken" ? taken : refused);
  }
  CHECK(taken > 0);
  CHECK(refused > 0);
}

std::string left_midway(cdem::Simulation& s, Stopper& observer) {
  Saver saver;
  saver.simulation = &s;
  s.set_checkpoint_writer(&saver);
  observer.stop_at = observer.polls + 20;
  REQUIRE_THROWS_AS(run(s), cdem::Interrupted);
  return saver.saved;
}

} // namespace

TEST_CASE("checkpoint: a forged model of blocks that were cut is taken or refused, and never crashes",
          "[checkpoint]") {
  const auto observer = std::make_shared<Stopper>();
  cdem::Simulation s = plate(observer);
  s.relax({});
  cdem::RefineOptions refine;
  refine.tension_threshold = 6e6;
  refine.planes = 1;
  REQUIRE_FALSE(s.refine(refine).empty());
  forge(left_midway(s, *observer), 1000, plate);
}

TEST_CASE("checkpoint: a forged model of meshes and contacts that has changed is taken or refused, and never "
          "crashes",
          "[checkpoint]") {
  const auto observer = std::make_shared<Stopper>();
  cdem::Simulation s = pile(observer);
  REQUIRE(s.make_rigid(cdem::Selection::of_body("hard")) == 1);
  forge(left_midway(s, *observer), 1500, pile);
}
