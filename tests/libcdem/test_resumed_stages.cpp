// Stages of several loops, settle and critical_flow, that were left in the middle go on to the same bits and results.
#include "tests/libcdem/going_on.hpp"

#include "libgeom/mesh/box_mesh.hpp"

using namespace testing;
using geom::Vec3;

namespace {

// Cubes over a rigid floor, one of them turned, at this x.
cdem::Simulation dropped_at(double x, int threads, std::shared_ptr<cdem::Observer> observer) {
  const double side = 0.5;
  const auto cube = [&](const Vec3& centre, double turn) {
    geom::TetMesh mesh = geom::box_mesh(Vec3::Constant(side), {2, 2, 2});
    for (Vec3& node : mesh.nodes)
      node = rotation({0, 1, 0}, turn) * (node - Vec3::Constant(0.5 * side)) + centre;
    return mesh;
  };
  cdem::Elastic soft = rock(); // large steps
  soft.youngs_modulus = 2e8;
  return units_over_floor(geom::box_mesh({2, 1, 0.5}, {4, 2, 1}),
                          {cube({0.6, 0.5, 0.5 + 0.25 + 0.05}, 0), cube({x, 0.5, 0.5 + 0.4}, 20 * degree)},
                          soft, threads, std::move(observer));
}

cdem::Simulation dropped(int threads, std::shared_ptr<cdem::Observer> observer) {
  return dropped_at(1.4, threads, std::move(observer));
}

Figures settle(cdem::Simulation& s, bool rigid, double max_time) {
  cdem::SettleOptions options;
  options.kinetic_energy_ratio = 1e-4;
  options.rigid = rigid;
  options.max_time = max_time;
  const cdem::SettleResult r = s.settle(options);
  Figures figures{double(r.converged), r.kinetic_ratio, r.peak_kinetic,
                  double(r.steps),     r.time,          double(r.made_rigid)};
  for (const cdem::SettlePhase& phase : r.phases)
    for (const double x : {double(phase.steps), phase.time, phase.kinetic_ratio})
      figures.push_back(x);
  return figures;
}

// With gravity the search has three parts.
cdem::Simulation column(int threads, std::shared_ptr<cdem::Observer> observer, bool heavy) {
  cdem::Simulation s = bonded_column({2, 2, 6}, threads, std::move(observer));
  if (heavy)
    s.gravity(gravity({3, 0, -9.81}));
  return s;
}

Figures search(cdem::Simulation& s, bool hold) {
  cdem::CriticalFlowOptions options;
  options.flow.direction = {1, 0, 0};
  options.hold = hold;
  options.pressure_rate = hold ? 2e7 : 5e7;
  options.hold_periods = 0.5;
  const cdem::CriticalFlowResult r = s.critical_flow(options);
  Figures figures{double(r.reason),
                  r.pressure,
                  r.velocity,
                  r.time,
                  r.period,
                  r.compliance,
                  r.broken_area,
                  r.place.x(),
                  r.first_break_pressure,
                  r.first_break_velocity,
                  r.first_break_place.z(),
                  double(r.broken_tension),
                  double(r.broken_shear),
                  double(r.steps),
                  double(r.fragments.size()),
                  r.fragments.at(0).volume};
  for (const cdem::CriticalFlowSample& sample : r.curve)
    for (const double x :
         {sample.time, sample.pressure, sample.velocity, sample.displacement, double(sample.broken)})
      figures.push_back(x);
  return figures;
}

// Of a whole solution: how many looks there are, one every 16 steps of a loop.
template <class Build, class Solve>
int all_looks(const Build& build, const Solve& solve) {
  auto observer = std::make_shared<Stopper>();
  cdem::Simulation s = build(1, observer);
  solve(s, 0);
  return observer->polls;
}

// The first look, and those at these parts of all of them.
template <class Build, class Solve>
std::vector<int> places(const Build& build, const Solve& solve, const std::vector<double>& parts) {
  const int looks = all_looks(build, solve);
  std::vector<int> at{1};
  for (const double part : parts)
    at.push_back(static_cast<int>(part * looks));
  return at;
}

} // namespace

TEST_CASE("resume: settling goes on in its rigid and in its deformable phase", "[checkpoint]") {
  const auto solve = [](cdem::Simulation& s, int done) {
    REQUIRE(done == 0); // its stage has not ended
    return settle(s, true, 5);
  };
  cdem::Simulation probe = dropped(1, nullptr);
  const Figures whole = solve(probe, 0);
  REQUIRE(whole.size() == 6 + 2 * 3); // both phases
  REQUIRE(whole[6] > 400);
  REQUIRE(whole[9] > 400);
  const double rigid = whole[6] / (whole[6] + whole[9]);
  check_going_on(dropped, solve,
                 places(dropped, solve, {0.5 * rigid, rigid + 0.01, rigid + 0.5 * (1 - rigid), 0.99}));
}

TEST_CASE("resume: settling of units that deform from the start goes on in its free fall and after it",
          "[checkpoint]") {
  const auto solve = [](cdem::Simulation& s, int) { return settle(s, false, 0.12); };
  cdem::Simulation probe = dropped(1, nullptr);
  const Figures whole = solve(probe, 0);
  REQUIRE(whole.size() == 6 + 2 * 3);
  REQUIRE(whole[6] > 230); // steps of the free fall
  check_going_on(dropped, solve, places(dropped, solve, {0.5, 0.95}));
}

TEST_CASE("resume: settling goes on where one unit has left the model, and tells of it once",
          "[checkpoint]") {
  const auto beside_the_floor = [](int threads, std::shared_ptr<cdem::Observer> observer) {
    return dropped_at(2.5, threads, std::move(observer));
  };
  const auto solve = [](cdem::Simulation& s, int) {
    Figures figures = settle(s, true, 5);
    REQUIRE(s.log().escapes.size() == 1);
    figures.push_back(static_cast<double>(s.log().escapes[0].step));
    return figures;
  };
  cdem::Simulation probe = beside_the_floor(1, nullptr);
  const Figures whole = solve(probe, 0);
  CHECK(whole[0] == 1);             // converged
  REQUIRE(whole.back() < whole[6]); // it left in the rigid phase
  const double part = whole.back() / (whole[6] + whole[9]);
  check_going_on(beside_the_floor, solve, places(beside_the_floor, solve, {0.5 * part, part + 0.01, 0.99}));
}

TEST_CASE("resume: a search for the critical flow goes on in each of its parts", "[checkpoint]") {
  const bool hold = GENERATE(true, false), heavy = hold;
  const auto build = [&](int threads, std::shared_ptr<cdem::Observer> observer) {
    return column(threads, std::move(observer), heavy);
  };
  const auto solve = [&](cdem::Simulation& s, int) { return search(s, hold); };
  cdem::Simulation probe = build(1, nullptr);
  solve(probe, 0);
  REQUIRE(probe.log().breaks.size() > 10);
  check_going_on(build, solve, places(build, solve, {0.2, 0.45, 0.7, 0.97}));
}

TEST_CASE("resume: a stage that was left can be left again where its next loop begins", "[checkpoint]") {
  cdem::Simulation whole = dropped(1, nullptr);
  const Figures figures = settle(whole, true, 5);
  // From each checkpoint to the next.
  std::string saved;
  int rounds = 0;
  for (;; ++rounds) {
    REQUIRE(rounds < 100);
    auto observer = std::make_shared<Stopper>();
    observer->stop_at = 26; // 416 steps
    cdem::Simulation s = dropped(1, observer);
    Saver saver;
    saver.simulation = &s;
    s.set_checkpoint_writer(&saver);
    if (!saved.empty())
      s.restore(saved);
    Figures these;
    try {
      these = settle(s, true, 5);
    } catch (const cdem::Interrupted&) {
      saved = saver.saved;
      continue;
    }
    CHECK(these == figures);
    CHECK(s.state_hash() == whole.state_hash());
    break;
  }
  CHECK(rounds > 2);
}
