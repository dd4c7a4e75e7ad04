// Rock taken out by degrees: its forces stay as loads and fall (load/excavation.hpp).
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/going_on.hpp"
#include "tests/support/refusal.hpp"

#include "libcdem/ranks/ranks.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

constexpr double pressure = 2e6; // Pa

cdem::Excavation by(double relaxed, double over = 0) {
  cdem::Excavation excavation;
  excavation.relaxed = relaxed;
  excavation.over = over;
  return excavation;
}

// A bar of six blocks along x under pressure between fixed ends. The last but one is to be dug out: four stay on a side.
struct Bar {
  cdem::Element element = cdem::Element::small_strain;
  Vec3 origin = Vec3::Zero();

  cdem::Selection dug() const {
    return cdem::Selection::in_box({origin + Vec3(0.8, -1, -1), origin + Vec3(1, 1, 1)});
  }
  cdem::Simulation operator()(int threads = 1,
                              const std::shared_ptr<cdem::Observer>& observer = nullptr) const {
    cdem::BodySpec spec = body("rock", geom::grid({1.2, 0.1, 0.1}, {6, 1, 1}, origin));
    spec.element = element;
    cdem::ModelSpec model;
    model.bodies = {spec};
    cdem::Simulation s(model, threads, observer);
    s.initial_stress(cdem::Selection::everything(), {-pressure, 0, 0, 0, 0, 0});
    for (const char* side : {"x-", "x+"})
      s.fix(fixed(cdem::Selection::side(side), "x"));
    s.fix(fixed(cdem::Selection::side("y-"), "y"));
    s.fix(fixed(cdem::Selection::side("z-"), "z"));
    return s;
  }
  double end(const cdem::Simulation& s) const { // m, of the bar that stays
    return s.mean("displacement.x",
                  cdem::Selection::on_plane(geom::Plane::through(origin + Vec3(0.8, 0, 0), {1, 0, 0})));
  }
};

// What ranks.sh compares.
void note_hash(const cdem::Simulation& s) {
  const std::uint64_t hash = s.state_hash(); // all ranks
  const char* const file = std::getenv("CDEM_NOTE_HASHES");
  if (file && cdem::ranks().leads())
    std::ofstream(file, std::ios::app) << "excavation: stage " << s.stage() << ' ' << hash << '\n';
}

void relax(cdem::Simulation& s) {
  cdem::RelaxOptions options;
  options.residual = 1e-8;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  note_hash(s);
}

cdem::RunOptions lasting(double time) {
  cdem::RunOptions options;
  options.duration = time;
  options.breaking = false;
  return options;
}

// A square tunnel to be dug out of rock under all-round stress.
cdem::Simulation square(std::shared_ptr<cdem::Observer> observer = nullptr) {
  cdem::Simulation s = simulation(geom::grid({0.7, 0.1, 0.7}, {7, 1, 7}, {-0.35, 0, -0.35}), rock(),
                                  rock_joint(), std::move(observer));
  s.initial_stress(cdem::Selection::everything(), {-pressure, 0, -pressure, 0, 0, 0});
  for (const char* side : {"x-", "x+", "z-", "z+"})
    s.fix(fixed(cdem::Selection::side(side), side[0] == 'x' ? "x" : "z"));
  for (const char* side : {"y-", "y+"})
    s.fix(fixed(cdem::Selection::side(side), "y"));
  return s;
}

const cdem::Selection core = cdem::Selection::in_box({{-0.06, -1, -0.06}, {0.06, 1, 0.06}});

double closure(const cdem::Simulation& s) { // m, of the walls left and right
  return s.at("displacement.x", {-0.051, 0.05, 0}) - s.at("displacement.x", {0.051, 0.05, 0});
}

struct Listener final : cdem::Observer {
  std::vector<std::string> warnings;
  void warning(const std::string& line) override { warnings.push_back(line); }
};

} // namespace

TEST_CASE("nothing moves while all forces of an excavation are kept", "[excavation]") {
  const Bar bar{GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume), {1e5, -2e5, 300}};
  cdem::Simulation s = bar();
  CHECK(s.remove(bar.dug(), by(0)) == 1);
  relax(s);
  CHECK(s.max("displacement.magnitude").value < 1e-9 * pressure / rock().youngs_modulus);
  s.run(lasting(1e-3));
  CHECK(s.max("displacement.magnitude").value < 1e-9 * pressure / rock().youngs_modulus);
}

TEST_CASE("a bar relaxed by lambda moves lambda times its elastic answer, and ends as one dug at once",
          "[excavation][ranks]") {
  const Bar bar{GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume)};
  cdem::Simulation sudden = bar();
  sudden.remove(bar.dug());
  relax(sudden);
  const double whole = bar.end(sudden);
  // sigma / E over 0.8 m, and the joints between.
  CHECK(whole > 0.8 * pressure / rock().youngs_modulus);
  // To the strain, of whose square elements that move far take notice.
  const double exact = bar.element == cdem::Element::small_strain ? 1e-6 : 1e-4;
  cdem::Simulation s = bar();
  s.remove(bar.dug(), by(0.25));
  relax(s);
  CHECK(bar.end(s) == Approx(0.25 * whole).epsilon(exact));
  CHECK(s.relax_excavation(by(0.4)) > 0);
  relax(s);
  CHECK(bar.end(s) == Approx(0.4 * whole).epsilon(exact));
  CHECK_THAT(refusal([&] { s.relax_excavation(by(0.3)); }),
             Contains("relaxed = 0.3: must be more than 0.4, which is relaxed already"));
  s.relax_excavation(by(1));
  relax(s);
  CHECK(bar.end(s) == Approx(whole).epsilon(1e-6));
  CHECK(s.energy().balance_error() < 1e-3);
  CHECK(s.relax_excavation(by(1)) == 0); // nothing is left
}

TEST_CASE("walls of a tunnel close by lambda times their elastic answer, in one dig or two", "[excavation]") {
  cdem::Simulation sudden = square();
  sudden.remove(core);
  relax(sudden);
  const double whole = closure(sudden);
  REQUIRE(whole > 0);
  cdem::Simulation s = square();
  s.remove(core, by(0.4));
  relax(s);
  CHECK(closure(s) == Approx(0.4 * whole).epsilon(1e-4));
  // A neighbour too, all forces kept: nothing moves, though the core's are on the rock that goes.
  s.remove(cdem::Selection::in_box({{0.06, -1, -0.06}, {0.16, 1, 0.06}}), by(0));
  const double before = s.at("displacement.x", {-0.051, 0.05, 0});
  relax(s);
  CHECK(s.at("displacement.x", {-0.051, 0.05, 0}) == Approx(before).epsilon(1e-5));
  s.relax_excavation(by(1));
  relax(s);
  cdem::Simulation both = square();
  both.remove(cdem::Selection::in_box({{-0.06, -1, -0.06}, {0.16, 1, 0.06}}));
  relax(both);
  CHECK(s.at("displacement.x", {-0.051, 0.05, 0}) ==
        Approx(both.at("displacement.x", {-0.051, 0.05, 0})).epsilon(1e-5));
}

TEST_CASE("the forces of an excavation stay where the blocks that bear them are cut", "[excavation]") {
  cdem::Simulation sudden = square();
  sudden.remove(core);
  relax(sudden);
  cdem::Simulation s = square();
  s.remove(core, by(0));
  cdem::RefineOptions refine;
  refine.shear_threshold = 100e6; // all of them
  refine.planes = 1;
  const std::size_t cut = s.refine(refine).size();
  REQUIRE(cut == 48);
  relax(s);
  // Forces go to the nearest nodes of the parts: their sum stays, their places shift by part of a block.
  CHECK(std::abs(closure(s)) < 0.1 * closure(sudden));
  s.relax_excavation(by(1));
  relax(s);
  CHECK(closure(s) > 0.7 * closure(sudden));
}

TEST_CASE("a slow excavation in a run ends at the static answer without going beyond it",
          "[excavation][ranks]") {
  const Bar bar{GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume)};
  const double period =
      4 * 0.8 * std::sqrt(rock().density / rock().youngs_modulus); // s, of the first mode at least
  cdem::Simulation still = bar();
  still.remove(bar.dug());
  relax(still);
  const double whole = bar.end(still);
  const auto furthest = [&](const cdem::Excavation& excavation, double time) {
    cdem::Simulation s = bar();
    s.probe("end", "displacement.x", bar.origin + Vec3(0.799, 0.05, 0.05));
    s.remove(bar.dug(), excavation);
    if (excavation.over > 0) {
      s.run(lasting(0.5 * excavation.over));
      CHECK(bar.end(s) == Approx(0.5 * whole).epsilon(0.02));
    }
    s.run(lasting(time - 0.5 * excavation.over));
    note_hash(s);
    double most = 0;
    for (const cdem::HistoryRow& row : s.log().history)
      most = std::max(most, row.probes.at(0));
    if (excavation.over > 0)
      CHECK(s.energy().balance_error() < 1e-4);
    return most / whole;
  };
  CHECK(furthest(by(1, 60 * period), 62 * period) == Approx(1).epsilon(0.01));
  CHECK(furthest(by(1), 3 * period) > 1.7); // at once: the end swings through
}

TEST_CASE("a run that is left while the forces of two excavations fall goes on to the same",
          "[excavation][checkpoint]") {
  const Bar bar;
  check_going_on(
      [&](int threads, const std::shared_ptr<cdem::Observer>& observer) {
        cdem::Simulation s = bar(threads, observer);
        s.remove(bar.dug(), by(1, 0.01));
        s.remove(cdem::Selection::in_box({{0.6, -1, -1}, {0.79, 1, 1}}), by(0.5, 0.002));
        return s;
      },
      [](cdem::Simulation& s, int done) {
        if (done < 1)
          s.run(lasting(0.003));
        s.run(lasting(0.01));
        return Figures{s.max("displacement.x").value};
      },
      {2, 20});
}

TEST_CASE("a run in parts ends in the same bits where an excavation has ended in it", "[excavation][run]") {
  std::vector<std::uint64_t> hashes;
  for (const std::vector<int>& parts : {std::vector{120}, {90, 30}}) { // steps
    cdem::Simulation s = Bar{}();
    s.gravity(gravity({0.1, -9.7, 0.3}));
    cdem::Traction traction;
    traction.on = cdem::Selection::side("y+");
    traction.stress = Vec3(1e5 / 3, -2e5 / 7, 0);
    s.traction(traction);
    s.remove(Bar{}.dug(), by(0.7, 20 * s.stable_time_step()));
    cdem::RunOptions options;
    options.time_step = 0.5 * s.stable_time_step();
    for (const int steps : parts) {
      options.steps = steps;
      s.run(options);
    }
    hashes.push_back(s.state_hash());
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("a body that loses its floor by degrees stays until the contact's force goes", "[excavation]") {
  cdem::ModelSpec spec;
  const auto element = GENERATE(cdem::Element::finite_volume, cdem::Element::rigid);
  spec.bodies = {
      meshed("plate", placed(geom::box_mesh({2, 1, 0.2}, {4, 2, 1}), geom::Mat3::Identity(), {0, 0, -0.2})),
      meshed("cube",
             placed(geom::box_mesh({0.4, 0.4, 0.4}, {2, 2, 2}), geom::Mat3::Identity(), {0.2, 0.2, 0}))};
  spec.bodies[1].element = element;
  spec.default_contact = friction(30);
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(body_of("plate")));
  s.gravity(gravity());
  cdem::SettleOptions settle;
  s.settle(settle);
  if (element == cdem::Element::rigid) {
    CHECK_THAT(refusal([&] { s.remove(body_of("plate"), by(0)); }),
               Contains("of body \"cube\" is rigid") && Contains("make_deformable"));
    CHECK(s.counts().blocks == 2);
    return;
  }
  CHECK(s.remove(body_of("plate"), by(0)) == 1);
  const double before = s.mean("velocity.z", body_of("cube"));
  s.run(lasting(0.05));
  CHECK(s.mean("velocity.z", body_of("cube")) == Approx(before).margin(0.01 * 9.81 * 0.05));
  s.relax_excavation(by(1));
  const double held = s.mean("velocity.z", body_of("cube"));
  s.run(lasting(0.05));
  CHECK(s.mean("velocity.z", body_of("cube")) == Approx(held - 9.81 * 0.05).epsilon(0.01));
}

TEST_CASE("what an excavation keeps is said where it cannot fall, and odd numbers are refused",
          "[excavation][input]") {
  auto listener = std::make_shared<Listener>();
  cdem::Simulation s = square(listener);
  CHECK_THAT(refusal([&] { s.remove(core, by(1.5)); }),
             Contains("relaxed = 1.5: must be a number from 0 to 1"));
  CHECK_THAT(refusal([&] { s.remove(core, by(1, -1)); }),
             Contains("over = -1: must be a finite number >= 0 s"));
  CHECK(s.counts().blocks == 49);
  s.remove(core, by(1, 0.5));
  relax(s);
  CHECK(closure(s) < 1e-9);
  REQUIRE(listener->warnings.size() == 1);
  CHECK_THAT(listener->warnings[0], Contains("fall until t = 0.5 s") && Contains("model:run"));
}
