// An observer who looks at the model between steps changes no bit of what follows.
#include "libcdem/results/snapshot.hpp"
#include "libcdem/simulation.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

namespace {

class Onlooker : public cdem::Observer {
public:
  // The stage offers a look ten times a second: whoever waits that long at each question gets one each time.
  bool stop_requested() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(110));
    return false;
  }
  bool wants_view() override { return true; }
  void view(const cdem::Snapshot& snapshot) override {
    ++views;
    tets = snapshot.tets.size();
    time = snapshot.time;
  }

  int views = 0;
  std::size_t tets = 0;
  double time = 0;
};

// A box that falls on another and breaks.
cdem::Simulation falling(const std::shared_ptr<cdem::Observer>& observer) {
  cdem::Elastic material;
  material.youngs_modulus = 1e8;
  material.poissons_ratio = 0.2;
  material.density = 2500;
  cdem::Joint joint;
  joint.cohesion = 4e4;
  joint.friction_angle = 0.6;
  joint.tensile_strength = 2e4;
  cdem::Joint friction;
  friction.bonded = false;
  friction.friction_angle = 0.6;
  cdem::ModelSpec spec;
  for (const char* name : {"floor", "block"}) {
    cdem::BodySpec body;
    body.name = name;
    body.material = material;
    body.joint = joint;
    body.meshes = {geom::box_mesh({1, 1, 1}, {2, 2, 2})};
    body.bonding.everywhere = true;
    spec.bodies.push_back(body);
  }
  for (geom::Vec3& x : spec.bodies[1].meshes[0].nodes)
    x += geom::Vec3(0.2, 0.1, 1.001);
  spec.default_contact = friction;
  cdem::Simulation model(spec, 1, observer);
  model.fix({cdem::Selection::side("z-")});
  model.gravity({{0, 0, -10}});
  model.initial_velocity(cdem::Selection::of_body("block"), {0, 0, -5});
  return model;
}

} // namespace

TEST_CASE("looking at a model while it runs changes no bit of it") {
  cdem::RunOptions run;
  run.steps = 300;
  const auto onlooker = std::make_shared<Onlooker>();
  cdem::Simulation seen = falling(onlooker), alone = falling(nullptr);
  seen.run(run);
  alone.run(run);
  CHECK(onlooker->views > 5);
  CHECK(onlooker->tets == 96); // of both boxes
  CHECK(onlooker->time > 0);
  CHECK(seen.counts().broken_tension + seen.counts().broken_shear + seen.contacts().acting > 0);
  CHECK(seen.state_hash() == alone.state_hash());
}
