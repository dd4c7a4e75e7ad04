// A body that shatters: what is searched for and looked at only around what broke or moved changes no bit, and it can be
// left and gone on with in the middle.
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/going_on.hpp"

#include "libcdem/first_model.hpp"
#include "libcdem/results/energy.hpp"

#include <algorithm>

using namespace testing;

namespace {

cdem::ModelSpec cube_on_floor(cdem::Element floor = cdem::Element::rigid) {
  cdem::Joint weak = rock_joint();
  weak.tensile_strength = 5e6;
  weak.cohesion = 8e6;
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  const auto standing = [](const geom::Vec3& size, const std::array<int, 3>& cells, double z, double jitter) {
    geom::TetMesh mesh = geom::box_mesh(size, cells, jitter);
    for (geom::Vec3& x : mesh.nodes)
      x += geom::Vec3(-0.5 * size.x(), -0.5 * size.y(), z);
    return mesh;
  };
  cdem::ModelSpec spec;
  spec.bodies = {meshed("cube", standing({0.2, 0.2, 0.2}, {3, 3, 3}, 1e-4, 0.15), everywhere, rock(), weak),
                 meshed("floor", standing({0.6, 0.6, 0.1}, {3, 3, 1}, -0.1, 0), {}, rock())};
  spec.bodies[1].element = floor;
  spec.pairs = {{"cube", "cube", friction(30)}, {"cube", "floor", friction(30)}};
  return spec;
}

constexpr double speed = 20; // m/s

struct Outcome {
  std::uint64_t hash = 0;
  std::int64_t handed_over = 0;
  std::int64_t contacts = 0, pairs = 0; // at most, of all kinds and of tetrahedra of the cube
};

std::int64_t pairs_of(const System& s) {
  return std::count_if(s.state.contacts.begin(), s.state.contacts.end(),
                       [](const cdem::Contact& c) { return c.kind == cdem::Contact::tets; });
}

Outcome shatter(int threads, bool looks_at_all, bool anew_every_200_steps = false) {
  System s(cdem::first_model(cube_on_floor()));
  s.threads = threads;
  s.hold(body_of("floor"), "xyz");
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 0)
      s.state.velocity[i] = node({1, 0, -speed});
  cdem::RunOptions options;
  options.steps = 3000;
  options.looks_at_all_contacts = looks_at_all;
  Outcome outcome;
  options.callback_every = 50;
  options.callback = [&] {
    outcome.contacts = std::max(outcome.contacts, static_cast<std::int64_t>(s.state.contacts.size()));
    outcome.pairs = std::max(outcome.pairs, pairs_of(s));
  };
  std::optional<cdem::RestartPoint> restart_point; // where a stage can be left
  cdem::run({s.model, s.state, s.conditions, s.log, s.last_good, s.observer, s.threads, 1, nullptr,
             anew_every_200_steps ? &restart_point : nullptr},
            options);
  outcome.hash = cdem::hash(s.state);
  for (const cdem::FaceStateBatch& faces : s.state.faces)
    outcome.handed_over += std::count(std::begin(faces.handed_over), std::end(faces.handed_over), 1);
  return outcome;
}

} // namespace

TEST_CASE("shattering: what is skipped changes no bit, nor do threads or a search anew",
          "[contact][fracture]") {
  const Outcome all = shatter(1, true);
  CHECK(all.handed_over > 20);
  INFO("handed " << all.handed_over << " contacts " << all.contacts << " pairs " << all.pairs);
  CHECK(all.contacts > 60);
  CHECK(all.pairs > 20);
  CHECK(shatter(2, false).hash == all.hash);
  CHECK(shatter(4, false, true).hash == all.hash);
}

TEST_CASE("shattering: contacts stand by their keys after each step, whichever rank has found them",
          "[contact][fracture][ranks]") {
  System s(cdem::first_model(cube_on_floor(cdem::Element::finite_volume)));
  s.hold(body_of("floor"), "xyz");
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 0)
      s.state.velocity[i] = node({1, 0, -speed});
  std::int64_t unsorted = 0;
  std::int64_t most = 0, pairs = 0;
  cdem::RunOptions options;
  options.steps = 2500;
  options.callback_every = 5;
  options.callback = [&] {
    const std::vector<cdem::Contact>& all = s.state.contacts;
    const auto stands_before = [](const cdem::Contact& a, const cdem::Contact& b) { return key(a) < key(b); };
    unsorted += std::is_sorted(all.begin(), all.end(), stands_before) ? 0 : 1;
    most = std::max(most, static_cast<std::int64_t>(all.size()));
    pairs = std::max(pairs, pairs_of(s));
  };
  s.run(options);
  CHECK(unsorted == 0);
  INFO("most " << most << " pairs " << pairs);
  CHECK(most > 60);
  CHECK(pairs > 20);
}

TEST_CASE("checkpoint: a body that shatters goes on to the same bits", "[checkpoint][fracture]") {
  const auto build = [](int threads, std::shared_ptr<cdem::Observer> observer = nullptr) {
    cdem::Simulation s(cube_on_floor(), threads, std::move(observer));
    s.fix(fixed(cdem::Selection::of_body("floor")));
    s.initial_velocity(cdem::Selection::of_body("cube"), {1, 0, -speed});
    return s;
  };
  const auto solve = [](cdem::Simulation& s, int) {
    cdem::RunOptions options;
    options.steps = 900;
    const cdem::RunResult r = s.run(options);
    return Figures{static_cast<double>(r.steps), r.time, r.time_step};
  };
  check_going_on(build, solve, {20, 40});
}
