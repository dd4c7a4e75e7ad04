// A stage takes what the stage before knew of contacts (step/kept_work.hpp): it looks for nothing again, and no bit changes.
#include "libcdem/step/kept_work.hpp"

#include "libcdem/contact/data/tet_contacts.hpp"
#include "libcdem/step/stage.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

using namespace testing;
using geom::Mat3;

namespace {

// A cube of weak concrete that hits a rigid floor.
struct Fall : System {
  explicit Fall(bool keeps) : System(parts()), keeps_(keeps) {
    conditions.gravity = gravity();
    hold(body_of("floor"), "xyz");
    const cdem::Block& cube = model.blocks[1];
    for (int node = cube.node_begin; node < cube.node_end; ++node)
      state.velocity[node].z = -6;
  }

  void run(std::int64_t steps, bool from_end, bool breaking) {
    cdem::RunOptions options;
    options.steps = steps;
    options.breaking = breaking;
    cdem::StageContext context = next_stage();
    const std::optional<cdem::RestartPoint> end = end_;
    if (from_end) {
      state = last_good;
      context.from = &*end;
    }
    context.restart_point = &end_;
    context.kept = keeps_ ? &kept : nullptr;
    cdem::run(context, options);
  }

  std::shared_ptr<cdem::KeptWork> kept;

private:
  static cdem::Model parts() {
    cdem::Joint weak = concrete_joint(cdem::Softening::none);
    weak.tensile_strength = 1.7e5;
    weak.cohesion = 4.4e5;
    cdem::Bonding springs = cohesive();
    springs.kind = cdem::BondKind::springs;
    cdem::BodySpec floor =
        meshed("floor", box_at({1, 1, 0.2}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.101}), {}, soft_rock());
    floor.element = cdem::Element::rigid;
    return build({floor, meshed("cube", unstructured({0.3, 0.3, 0.3}, 0.15), springs, soft_rock(), weak)},
                 {{"floor", "cube", friction(30)}, {"cube", "cube", friction(30)}});
  }

  bool keeps_;
  std::optional<cdem::RestartPoint> end_;
};

} // namespace

TEST_CASE("a run that goes on takes the contacts of the run before, and any stage the pairs of tetrahedra "
          "that it knows",
          "[run][contact][breaking]") {
  Fall one(true), other(false);
  const auto run = [&](std::int64_t steps, bool from_end, bool breaking = false) {
    for (Fall* fall : {&one, &other})
      fall->run(steps, from_end, breaking);
    CHECK(cdem::hash(one.state) == cdem::hash(other.state));
  };
  run(150, false, true);
  CHECK(one.log.broken_tension + one.log.broken_shear > 20);
  run(61, true); // no face is left to contact in the steps that follow, which are no multiple of 20
  REQUIRE(one.kept);
  REQUIRE(one.kept->end);
  REQUIRE(one.kept->tet_contacts);
  CHECK(!other.kept);
  const std::shared_ptr<cdem::TetContacts> pairs = one.kept->tet_contacts;
  const std::int64_t searches = one.kept->end->contact.search.count;
  for (int i = 0; i < 3; ++i)
    run(1, true);
  REQUIRE(one.kept->end);
  CHECK(one.kept->end->contact.search.count == searches);
  CHECK(one.kept->tet_contacts == pairs);
  for (Fall* fall : {&one, &other})
    fall->conditions.gravity->acceleration *= 2;
  run(5, false);
  CHECK(one.kept->tet_contacts == pairs);
  // Nothing is known of another model.
  for (Fall* fall : {&one, &other})
    fall->model.node_mass.back() *= 2;
  run(5, false);
  CHECK(one.kept->tet_contacts != pairs);
}

TEST_CASE(
    "a stage keeps the pairs of tetrahedra where it passes a restart point, and one that goes on from there "
    "without them gets the same bits",
    "[run][contact][breaking]") {
  constexpr int before = 150, beyond = 5;
  Fall one(true), other(false);
  for (Fall* fall : {&one, &other})
    fall->run(before, false, true);
  one.run(cdem::watch_every - before + beyond, true, false);
  other.run(cdem::watch_every - before, true, false);
  other.run(beyond, true, false);
  CHECK(cdem::hash(one.state) == cdem::hash(other.state));
  REQUIRE(one.kept);
  REQUIRE(one.kept->tet_contacts);
  CHECK(one.kept->tet_contacts->steps > 2 * beyond); // since they were found
}
