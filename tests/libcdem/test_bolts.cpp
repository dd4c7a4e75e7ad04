// Bolts: the chain of steel and grout against hand calculations, and in rock with its energy.
#include "libcdem/bolt/chain.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/going_on.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double bolt_area = 5e-4, youngs_modulus = 200e9, grout = 1e9, length = 4;

cdem::Bolt a_bolt(int segments) {
  cdem::Bolt bolt;
  bolt.from = {0.5, 0.5, 0};
  bolt.to = {0.5, 0.5, length};
  bolt.segments = segments;
  bolt.area = bolt_area;
  bolt.youngs_modulus = youngs_modulus;
  bolt.grout_stiffness = grout;
  return bolt;
}

// As load/bolts.cpp lays it out, without a plate.
cdem::BoltChain chain_of(const cdem::Bolt& bolt) {
  cdem::BoltChain chain;
  const double l = bolt.length() / bolt.segments;
  chain.steel = bolt.youngs_modulus * bolt.area / l;
  chain.yield = bolt.yield_force;
  for (int i = 0; i <= bolt.segments; ++i) {
    const double part = i == 0 || i == bolt.segments ? 0.5 * l : l;
    chain.grout.push_back(bolt.grout_stiffness * part);
    chain.strength.push_back(bolt.grout_strength * part);
  }
  return chain;
}

// The rock opens by `gap` at the middle of the bolt: force in the steel there.
double bridged(const cdem::Bolt& bolt, double gap, cdem::ChainLoss* loss = nullptr) {
  const cdem::BoltChain chain = chain_of(bolt);
  std::vector<cdem::BoltNode> nodes(chain.grout.size());
  std::vector<double> rock(nodes.size());
  double force = 0, work = 0;
  constexpr int steps = 200;
  cdem::ChainLoss sum;
  for (int step = 1; step <= steps; ++step) {
    const std::vector<cdem::BoltNode> before = nodes;
    for (std::size_t i = 0; i < rock.size(); ++i)
      rock[i] = (i < rock.size() / 2 ? -0.5 : 0.5) * gap * step / steps;
    const cdem::ChainLoss taken = advance(chain, rock, nodes.data());
    sum.slip += taken.slip;
    sum.yield += taken.yield;
    force = nodes[rock.size() / 2 - 1].tension;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      work += 0.5 * (nodes[i].grout + before[i].grout) * (nodes[i].rock - before[i].rock);
  }
  const double stored = stored_energy(chain, nodes.data(), nodes.size());
  CHECK(stored + sum.slip + sum.yield == Approx(work).epsilon(1e-3));
  if (loss)
    *loss = sum;
  return force;
}

} // namespace

TEST_CASE("a bolt across a joint carries gap sqrt(EA k) / 2 tanh(L / 2 sqrt(k / EA))", "[bolts]") {
  // EA a'' = k (a - u) on both sides of the joint; each side is a spring of sqrt(EA k) tanh(half / l0).
  const double ea = youngs_modulus * bolt_area, l0 = std::sqrt(ea / grout), gap = 1e-3,
               expected = 0.5 * gap * std::sqrt(ea * grout) * std::tanh(0.5 * length / l0);
  CHECK(bridged(a_bolt(401), gap) == Approx(expected).epsilon(0.005));
}

TEST_CASE(
    "the steel of a bolt yields at area x yield stress, its grout slips at its strength times the length",
    "[bolts]") {
  cdem::ChainLoss loss;
  cdem::Bolt bolt = a_bolt(21);
  bolt.yield_force = 1e5;
  CHECK(bridged(bolt, 0.01, &loss) == Approx(1e5).epsilon(1e-4));
  CHECK(loss.yield > 0);
  bolt = a_bolt(21);
  bolt.grout_strength = 4e4; // pulled out of half its length
  CHECK(bridged(bolt, 0.05, &loss) == Approx(4e4 * 0.5 * length).epsilon(1e-3));
  CHECK(loss.slip > 0);
}

TEST_CASE("a chain unloads elastically and keeps what has yielded", "[bolts]") {
  cdem::BoltChain chain;
  chain.steel = 1e8;
  chain.yield = 1e5;
  chain.grout = {1e12, 1e12};
  chain.strength = {1e20, 1e20};
  std::vector<cdem::BoltNode> nodes(2);
  advance(chain, {0, 3e-3}, nodes.data());
  CHECK(nodes[0].tension == Approx(1e5).epsilon(1e-4));
  advance(chain, {0, 2.5e-3}, nodes.data());
  CHECK(nodes[0].tension == Approx(5e4).epsilon(1e-3));
  CHECK(nodes[0].stretch == Approx(2e-3).epsilon(1e-3));
}

namespace {

// A bar that is drawn out at its top, with a bolt along its axis or without.
cdem::Simulation bolted_bar(int threads, std::shared_ptr<cdem::Observer> observer) {
  cdem::Elastic soft = rock();
  soft.youngs_modulus = 1e9;
  soft.poissons_ratio = 0;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("bar", geom::box_mesh({1, 1, length}, {2, 2, 8}), {}, soft)};
  return cdem::Simulation(spec, threads, std::move(observer));
}

const cdem::Selection foot = cdem::Selection::side("z-"), top = cdem::Selection::side("z+");

} // namespace

TEST_CASE("a bolt stiffens the rock it runs through, and relaxation books its energy", "[bolts]") {
  const auto elongation = [](bool bolted) {
    cdem::Simulation s = bolted_bar(1, nullptr);
    s.fix(fixed(foot, "z"));
    s.fix(fixed(at_place({0, 0, 0}), "xy"));
    s.fix(fixed(at_place({1, 0, 0}), "y"));
    cdem::Bolt bolt = a_bolt(20);
    bolt.grout_stiffness = 1e11; // hardly gives
    if (bolted)
      s.bolt(bolt);
    s.traction(traction(top, {0, 0, 1e6}));
    cdem::RelaxOptions relax;
    relax.residual = 1e-9;
    CHECK(s.relax(relax).converged);
    const cdem::EnergyLedger e = s.energy();
    CHECK(e.balance_error() < 1e-3);
    if (bolted) {
      CHECK(e.bolts > 0);
      double most = 0;
      for (const auto& row : s.bolts())
        most = std::max(most, row.tension);
      // Rock and steel side by side: the steel takes EA / (EA + E_rock) of 1e6 N in the middle.
      CHECK(most ==
            Approx(1e6 * youngs_modulus * bolt_area / (youngs_modulus * bolt_area + 1e9)).epsilon(0.03));
    }
    return s.mean("displacement.z", top);
  };
  CHECK(elongation(true) / elongation(false) ==
        Approx(1 / (1 + youngs_modulus * bolt_area / 1e9)).epsilon(0.02));
}

TEST_CASE("a pretensioned bolt presses the rock between plate and anchor", "[bolts]") {
  cdem::Simulation s = bolted_bar(1, nullptr);
  s.fix(fixed(at_place({0, 0, 0}), "xyz"));
  s.fix(fixed(at_place({1, 0, 0}), "yz"));
  s.fix(fixed(at_place({0, 1, 0}), "z"));
  cdem::Bolt bolt = a_bolt(20);
  bolt.plate = true;
  bolt.free_length = 2;
  bolt.pretension = 1e5;
  s.bolt(bolt);
  CHECK(s.bolts().front().tension == Approx(1e5).epsilon(1e-6));
  cdem::RelaxOptions relax;
  relax.residual = 1e-8;
  CHECK(s.relax(relax).converged);
  // The rock gives way by less than the steel has been stretched: the plate keeps most of it.
  const double plate = s.bolts().front().tension;
  CHECK((plate < 1e5 && plate > 0.8e5));
  CHECK(s.at("stress.zz", {0.5, 0.5, 1}) < 0);
  CHECK(s.energy().balance_error() < 0.01);
}

TEST_CASE("a bolt that swings with the rock goes on to the same bits, its energy counted",
          "[bolts][checkpoint]") {
  const auto solve = [](cdem::Simulation& s, int done) {
    s.fix(fixed(foot));
    cdem::Bolt bolt = a_bolt(10);
    bolt.grout_strength = 2e4;
    bolt.yield_force = 2e4;
    s.set_replaying(done > 0);
    s.bolt(bolt);
    s.set_replaying(false);
    s.traction(traction(top, {0, 0, 2e5}));
    if (done < 1) {
      cdem::RunOptions first;
      first.steps = 100;
      s.run(first);
    }
    cdem::RunOptions run;
    run.steps = 900;
    s.run(run);
    const cdem::EnergyLedger e = s.energy();
    CHECK(e.balance_error() < 0.01);
    CHECK(e.yielding + e.friction > 0);
    return Figures{e.bolts, e.yielding, e.friction, s.bolts().front().slip};
  };
  check_going_on(bolted_bar, solve, {30});
}

TEST_CASE("a bolt outside the rock is refused, and numbers that are none", "[bolts]") {
  cdem::Simulation s = bolted_bar(1, nullptr);
  cdem::Bolt out = a_bolt(10);
  out.to = {0.5, 0.5, length + 1};
  CHECK_THROWS_WITH(s.bolt(out), Catch::Matchers::Contains("to = (0.5, 0.5, 5)") &&
                                     Catch::Matchers::Contains("hangs in the air"));
  cdem::Bolt loose = a_bolt(10);
  loose.pretension = 1e4;
  CHECK_THROWS_WITH(s.bolt(loose), Catch::Matchers::Contains("plate = true"));
  cdem::Bolt none = a_bolt(10);
  none.area = 0;
  CHECK_THROWS_WITH(s.bolt(none), Catch::Matchers::Contains("area"));
}
