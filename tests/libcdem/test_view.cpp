// An observer who looks at the model between steps changes no bit of what follows.
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/results/snapshot.hpp"
#include "libcdem/simulation.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <cstdlib>
#include <fstream>
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
    add(snapshot.points.data(), snapshot.points.size());
    for (const auto* fields : {&snapshot.point_fields, &snapshot.cell_fields, &snapshot.bonds.point_fields})
      for (const cdem::SnapshotField& field : *fields)
        add(field.values.data(), field.values.size());
    tets = snapshot.tets.size();
    time = snapshot.time;
  }

  int views = 0;
  std::size_t tets = 0;
  double time = 0;
  std::uint64_t all_values = 14695981039346656037ull; // FNV-1a of all that was seen

private:
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); ++i)
      all_values = (all_values ^ bytes[i]) * 1099511628211ull;
  }
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

TEST_CASE("looking at a model while it runs changes no bit of it, and of several ranks the first sees all",
          "[ranks]") {
  cdem::RunOptions run;
  run.steps = 300;
  const auto onlooker = std::make_shared<Onlooker>();
  cdem::Simulation seen = falling(onlooker), alone = falling(nullptr);
  seen.run(run);
  alone.run(run);
  CHECK(seen.counts().broken_tension + seen.counts().broken_shear + seen.contacts().acting > 0);
  CHECK(seen.state_hash() == alone.state_hash());
  if (!cdem::ranks().leads()) {
    CHECK(onlooker->views == 0);
    return;
  }
  CHECK(onlooker->views > 5);
  CHECK(onlooker->tets == 96); // of both boxes
  CHECK(onlooker->time > 0);
  if (const char* const file = std::getenv("CDEM_NOTE_HASHES")) // what ranks.sh compares
    std::ofstream(file, std::ios::app)
        << "seen: " << onlooker->views << " times, " << onlooker->all_values << '\n';
}
