// Mass scaling: just the inertia that the time step asks for, no weight, and a ledger that still closes.
#include "libcdem/integrate/mass_scaling.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/results/energy.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/going_on.hpp"

#include <numeric>

using namespace testing;
using geom::Vec3;

namespace {

// A cube of 1 m whose top layer of elements is a tenth of the others high.
geom::TetMesh cube_with_slivers() {
  geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {4, 4, 4});
  for (Vec3& x : mesh.nodes)
    if (x.z() > 0.7 && x.z() < 0.8)
      x.z() = 0.975;
  return mesh;
}

cdem::RunOptions scaled_to(double step, std::int64_t steps) {
  cdem::RunOptions options;
  options.steps = steps;
  options.mass_scaling.step = step;
  return options;
}

double sum(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

} // namespace

TEST_CASE("mass scaling: the step is the stable one of a node with its least mass", "[mass_scaling]") {
  const double k = 3e9, step = 2e-5, damping = GENERATE(0.0, 1e-6, 1e-4);
  const double frequency2 = k / cdem::least_mass(k, damping, step);
  CHECK(cdem::stable_time_step(frequency2, damping * frequency2) == Approx(step).epsilon(1e-12));
}

TEST_CASE("mass scaling: only nodes that need it get mass, and just enough", "[mass_scaling]") {
  const System s(build({meshed("cube", cube_with_slivers())}));
  const std::vector<double> rows = cdem::all_row_sums(s.model);
  const double step = 2 * cdem::stable_time_step(s.model);
  const std::vector<double> moving = cdem::scaled_masses(s.model, rows, step);
  int raised = 0;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const double own = cdem::stable_time_step(rows[i] / s.model.node_mass[i], 0);
    if (own >= step) {
      CHECK(moving[i] == s.model.node_mass[i]);
      continue;
    }
    CHECK(cdem::stable_time_step(rows[i] / moving[i], 0) == Approx(step).epsilon(1e-12));
    CHECK(s.model.node_position[i].z() > 0.9);
    ++raised;
  }
  CHECK(raised > 0);
  const cdem::AddedMass added = cdem::added_mass(s.model, moving);
  CHECK(added.share == Approx(sum(moving) / sum(s.model.node_mass) - 1).epsilon(1e-9));
  CHECK(added.body == 0);
  CHECK(added.body_share == Approx(added.share).epsilon(1e-12));
}

TEST_CASE("mass scaling: the weight stays that of the true mass", "[mass_scaling]") {
  System s(build({meshed("cube", cube_with_slivers())}));
  s.hold(cdem::Selection::side("z-"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options = scaled_to(4 * cdem::stable_time_step(s.model), 3000);
  options.local_damping = 0.5;
  const cdem::RunResult result = s.run(options);
  CHECK(result.scaled.added_share > 0.01);
  double reaction = 0;
  const std::vector<Vec3> forces = s.net_forces();
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (s.model.node_position[i].z() < 1e-9)
      reaction -= forces[i].z();
  CHECK(reaction == Approx(9.81 * sum(s.model.node_mass)).epsilon(1e-3));
}

TEST_CASE("mass scaling: a body that moves keeps its balance of energy through scaled and unscaled stages",
          "[mass_scaling]") {
  System s(build({meshed("cube", cube_with_slivers())}));
  const double step = 3 * cdem::stable_time_step(s.model);
  s.hold(cdem::Selection::side("z-"), "xyz");
  s.conditions.gravity = gravity({0, 5, -1000});
  cdem::RunOptions unscaled;
  unscaled.steps = 50;
  for (int stage = 0; stage < 3; ++stage) {
    const double before = cdem::kinetic_energy(s.model, s.state), spent = s.state.spent.fictitious;
    cdem::RunOptions options = scaled_to(step, 120);
    bool more = false;
    options.callback_every = 1;
    options.callback = [&] {
      if (more)
        return;
      more = true;
      CHECK(sum(cdem::moving_mass(s.model, s.state)) > 1.01 * sum(s.model.node_mass));
      if (before > 0)
        CHECK(s.state.spent.fictitious < spent);
    };
    s.run(options);
    CHECK(more);
    CHECK(s.state.moving_mass.empty());
    CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-3);
    s.run(unscaled);
    CHECK(cdem::energy(s.model, s.state).balance_error() < 2e-3); // a step of another length costs as much
  }
}

TEST_CASE(
    "mass scaling: a factor is over the step of the true masses, and the step is kept where nodes are freed",
    "[mass_scaling][cohesive]") {
  const Vec3 size(0.6, 0.25, 0.25);
  const auto peak = [&](double factor) {
    System s(build({meshed("bar", unstructured(size, 0.12), cohesive(), concrete(),
                           concrete_joint(cdem::Softening::linear))}));
    lead_apart(s.conditions.fixes, 0.03);
    const double stable = cdem::stable_time_step(s.model);
    cdem::RunOptions options;
    options.duration = 2.3e-3; // the strength is reached at 2 ms, by stairs of 0.08 T, later with more mass
    options.mass_scaling.factor = factor;
    double most = 0;
    options.callback_every = 1;
    options.callback = [&] { most = std::max(most, end_traction(s, size.y() * size.z())); };
    const cdem::RunResult result = s.run(options);
    CHECK_FALSE(s.model.mesh.sides.empty());
    if (factor > 0) {
      CHECK(result.time_step == Approx(0.9 * factor * stable).epsilon(1e-12));
      CHECK(result.scaled.body == "bar");
      CHECK(result.scaled.added_share > 0);
      CHECK(result.scaled.kinetic_share > 0);
      CHECK(result.scaled.kinetic_share < 0.05);
    } else {
      CHECK(result.time_step < 0.7 * stable);
    }
    CHECK(cdem::energy(s.model, s.state).balance_error() < 5e-3);
    return most;
  };
  const double with = peak(1.2), without = peak(0);
  CHECK(with == Approx(without).epsilon(0.02));
}

TEST_CASE("mass scaling: a stage left in the middle goes on to the same bits", "[mass_scaling][resume]") {
  const auto build_bar = [](int threads, std::shared_ptr<cdem::Observer> observer) {
    cdem::ModelSpec spec;
    spec.bodies = {meshed("bar", unstructured({0.6, 0.25, 0.25}, 0.12), cohesive(), concrete(),
                          concrete_joint(cdem::Softening::linear))};
    cdem::Simulation s(spec, threads, std::move(observer));
    std::vector<cdem::Fix> leads;
    lead_apart(leads, 0.03);
    for (const cdem::Fix& lead : leads)
      s.fix(lead);
    return s;
  };
  const auto solve = [](cdem::Simulation& s, int done) {
    Figures figures;
    cdem::RunOptions options;
    options.duration = 3e-3;
    options.mass_scaling.factor = 1.5;
    if (done == 0) {
      const cdem::RunResult result = s.run(options);
      figures = {result.scaled.added_share, result.scaled.kinetic_share, result.time_step};
    }
    figures.push_back(s.energy().total());
    return figures;
  };
  check_going_on(build_bar, solve, {8, 14});
}

TEST_CASE("mass scaling: a cube settles on a rigid floor with its true weight", "[mass_scaling][rigid]") {
  cdem::ModelSpec spec;
  geom::TetMesh cube = cube_with_slivers(), floor = geom::box_mesh({3, 3, 0.5}, {2, 2, 1});
  for (Vec3& x : floor.nodes)
    x += Vec3(-1, -1, -0.5);
  spec.bodies = {meshed("cube", cube), meshed("floor", floor)};
  spec.pairs = {{"cube", "floor", friction(30)}};
  cdem::Simulation s(spec, 1, nullptr);
  s.make_rigid(cdem::Selection::of_body("floor"));
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity());
  cdem::RunOptions options = scaled_to(0, 8000);
  options.mass_scaling = {0, 4}; // the factor
  options.local_damping = 0.5;
  const cdem::RunResult result = s.run(options);
  CHECK(result.scaled.added_share > 0.01);
  const double weight = 9.81 * rock().density * (1 + 3 * 3 * 0.5); // N, of the floor too
  CHECK(s.reaction(cdem::Selection::of_body("floor")).z() == Approx(weight).epsilon(1e-4));
}

TEST_CASE("mass scaling: wrong input is refused", "[mass_scaling][input]") {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("cube", geom::box_mesh({1, 1, 1}, {2, 2, 2}))};
  cdem::Simulation s(spec, 1, nullptr);
  const auto refused = [&](cdem::MassScaling scaling, double time_step, const char* says) {
    cdem::RunOptions options;
    options.steps = 1;
    options.mass_scaling = scaling;
    options.time_step = time_step;
    CHECK_THROWS_WITH(s.run(options), Catch::Contains(says));
  };
  refused({-1, 0}, 0, "mass_scaling.step = -1");
  refused({0, 0.5}, 0, "mass_scaling.factor = 0.5");
  refused({1e-5, 2}, 0, "not both");
  refused({1e-5, 0}, 1e-6, "leave time_step out");
  s.make_rigid(cdem::Selection::everything());
  refused({1e-5, 0}, 0, "all bodies are rigid");
}
