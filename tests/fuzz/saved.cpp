// Saved states and checkpoints. Those of a model are changes of a whole one: 4 bytes say where, 4 what stands there.
#include "tests/fuzz/targets.hpp"

#include "libcdem/checkpoint/archive.hpp"
#include "libcdem/checkpoint/file.hpp"
#include "libcdem/simulation.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "lua/binding/replay/journal.hpp"

#include <cstring>
#include <memory>

namespace fuzz {

namespace {

struct Stopper final : cdem::Observer {
  int polls = 0, stop_at = 1 << 30;
  bool stop_requested() override { return ++polls >= stop_at; }
};

struct Saver final : cdem::CheckpointWriter {
  cdem::Simulation* simulation = nullptr;
  std::string saved;
  void marked() override {}
  bool wanted() override { return false; }
  void write(bool) override { saved = simulation->save(); }
};

cdem::Elastic rock() {
  cdem::Elastic rock;
  rock.youngs_modulus = 1e7;
  rock.poissons_ratio = 0.2;
  rock.density = 2000;
  return rock;
}

cdem::Joint weak() {
  cdem::Joint joint;
  joint.cohesion = 1e3;
  joint.tensile_strength = 1e3;
  joint.friction_angle = 0.5;
  return joint;
}

// A bonded mesh below blocks that move far.
cdem::Simulation pile_of_two(const std::shared_ptr<Stopper>& observer) {
  cdem::ModelSpec spec;
  cdem::BodySpec ground, blocks;
  ground.name = "ground";
  ground.meshes = {geom::box_mesh({1, 1, 0.4}, {2, 2, 1})};
  ground.material = rock();
  ground.joint = weak();
  ground.bonding.everywhere = true;
  blocks = ground;
  blocks.name = "blocks";
  blocks.bonding = {};
  blocks.meshes.clear();
  blocks.element = cdem::Element::finite_volume;
  geom::Assembly halves = geom::grid({0.4, 0.4, 0.4}, {2, 1, 1});
  for (geom::Polyhedron& block : halves.blocks)
    for (geom::Vec3& x : block.vertices)
      x += geom::Vec3(0.3, 0.3, 0.4);
  blocks.shape = halves;
  spec.bodies = {ground, blocks};
  cdem::Joint law = weak();
  law.bonded = false;
  law.normal_stiffness = 1e8;
  spec.pairs = {{"ground", "blocks", law}, {"blocks", "blocks", law}};
  cdem::Simulation s(spec, 1, observer);
  cdem::Fix fix;
  fix.on = cdem::Selection::side("z-");
  s.fix(fix);
  cdem::Gravity gravity;
  gravity.acceleration = {1, 0, -9};
  s.gravity(gravity);
  return s;
}

struct Base {
  std::shared_ptr<Stopper> observer = std::make_shared<Stopper>();
  cdem::Simulation simulation = pile_of_two(observer);
  std::string saved;
};

void run(cdem::Simulation& s) {
  cdem::RunOptions options;
  options.steps = 300;
  s.run(options);
}

Base make_base(bool changed) {
  Base base;
  cdem::Simulation s = pile_of_two(base.observer);
  if (changed)
    s.make_rigid(cdem::Selection::of_body("blocks"));
  Saver saver;
  saver.simulation = &s;
  s.set_checkpoint_writer(&saver);
  base.observer->stop_at = base.observer->polls + 16;
  try {
    run(s);
  } catch (const cdem::Interrupted&) {
  }
  base.saved = saver.saved;
  return base;
}

std::string changed(const std::string& saved, const std::string& bytes) {
  std::string forged = saved;
  constexpr std::size_t head = 24; // says which model it is
  for (Draw draw(bytes); draw.any();) {
    const std::size_t at = head + draw.word() % (saved.size() - head - 4);
    const std::uint32_t value = draw.word();
    std::memcpy(&forged[at], &value, sizeof value);
  }
  return forged;
}

void use(Base& base) {
  base.observer->polls = 0;
  base.observer->stop_at = 2;
  base.simulation.counts();
  base.simulation.snapshot("");
  run(base.simulation);
}

} // namespace

void saved_file(const std::string& bytes) {
  const std::string path = as_file("any.cdem", bytes);
  for (const auto kind : {cdem::SavedKind::state, cdem::SavedKind::checkpoint})
    try {
      cdem::read_saved(path, kind);
    } catch (const cdem::FileError&) { // refused
    }
}

void state(const std::string& bytes) {
  static const std::string saved = make_base(false).saved;
  static Base base;
  base.simulation.restore_state(changed(saved, bytes));
  use(base);
}

void cut_model(const std::string& bytes) {
  static const std::string saved = make_base(true).saved;
  Base base; // made anew, as a model that is taken changes it
  base.simulation.restore(changed(saved, bytes));
  use(base);
}

void journal(const std::string& bytes) {
  cdem::script::Journal journal;
  journal.load(bytes);
  while (journal.replaying()) {
    journal.peek();
    journal.take();
  }
}

} // namespace fuzz
