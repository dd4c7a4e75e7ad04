// A relaxation ends where it has settled, and what has settled stays: masses that follow the contacts, the mean residual.
#include "tests/libcdem/system.hpp"

#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/procedure/fictitious_masses.hpp"
#include "libcdem/procedure/settled.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace testing;
using cdem::Verdict;
using geom::Vec3;

namespace {

constexpr double goal = 1e-4;

// The step at which a residual r(n) has settled, -1: not in 100,000.
template <class Residual>
int settles(double frequency, const Residual& residual) {
  cdem::Settled settled(goal);
  for (int n = 0; n < 100000; ++n) {
    settled.add(residual(n));
    if (settled.reached(frequency))
      return n;
  }
  return -1;
}

} // namespace

TEST_CASE("a swing through the balance has not settled, one four times the goal at most has",
          "[relaxation]") {
  for (const double w : {0.3, 0.05, 0.01}) {
    CAPTURE(w);
    const auto swing = [&](double peak) { return [=](int n) { return peak * std::abs(std::cos(w * n)); }; };
    CHECK(settles(w, swing(6 * goal)) == -1);
    CHECK(settles(w, swing(0.9 * goal)) <= 100);
    CHECK(settles(w, swing(100 * goal)) == -1);
  }
}

TEST_CASE("what falls evenly settles soon after its goal", "[relaxation]") {
  const double w = 0.02; // critically damped: exp(-w n)
  const int n = settles(w, [&](int i) { return std::exp(-w * i); });
  const int reached = static_cast<int>(std::log(1 / goal) / w);
  CHECK(n >= reached);
  CHECK(n <= reached + static_cast<int>(1 / w));
}

TEST_CASE("single steps above the goal do not matter where the mean is below it", "[relaxation]") {
  CHECK(settles(1, [](int n) { return n % 8 == 0 ? 1.4 * goal : 0.8 * goal; }) > 0);
  CHECK(settles(1, [](int n) { return n % 8 == 0 ? 1.4 * goal : 0.99 * goal; }) == -1);
}

TEST_CASE("a relaxation that goes on from a checkpoint settles in the same step", "[relaxation]") {
  const auto residual = [](int n) { return 3 * goal * std::exp(-0.004 * n); };
  const int alone = settles(0.004, residual);
  for (const int left_at : {100, 250, 350}) {
    cdem::Settled before(goal);
    for (int n = 0; n < left_at; ++n)
      before.add(residual(n));
    std::vector<double> kept{7};
    before.add_to(kept);
    kept.push_back(7);
    cdem::Settled after(goal);
    CHECK(after.take(kept, 1) == kept.size() - 1);
    int n = left_at;
    for (; n < alone + 1000; ++n) {
      after.add(residual(n));
      if (after.reached(0.004))
        break;
    }
    CHECK(n == alone);
  }
}

TEST_CASE("a contact stiffer than its node raises the mass for good, others change nothing", "[relaxation]") {
  const cdem::Model model = build({body("block", geom::grid({1, 1, 1}, {1, 1, 1}))});
  cdem::FictitiousMasses masses(model, {});
  const std::vector<double> first = masses.of_nodes(), rows = cdem::all_row_sums(model);
  cdem::ContactLoads contact;
  contact.stiffness.assign(rows.size(), 0.0);
  contact.touched = {{2, 0}, {5, 0}};
  contact.stiffness[2] = 0;
  contact.stiffness[5] = 20 * rows[5];
  masses.follow(model, contact);
  CHECK(masses.of_nodes()[2] == first[2]);
  // Stable for unit steps: row sum over mass below 4.
  CHECK((rows[5] + contact.stiffness[5]) / masses.of_nodes()[5] == Approx(4 * 0.95 * 0.95));
  const double raised = masses.of_nodes()[5];
  contact.stiffness[5] = 0;
  masses.follow(model, contact);
  CHECK(masses.of_nodes()[5] == raised);

  std::vector<double> kept;
  masses.add_to(kept);
  cdem::FictitiousMasses again(model, {});
  CHECK(again.take(kept, 0) == kept.size());
  CHECK(again.of_nodes() == masses.of_nodes());
}

TEST_CASE("what has settled stays when the relaxation goes on", "[relaxation]") {
  cdem::Joint joint = rock_joint();
  joint.bonded = false;
  joint.friction_angle = 38 * degree;
  cdem::ModelSpec spec;
  spec.bodies = {body("wall", geom::grid({2, 0.5, 2}, {4, 1, 4}), rock(), joint)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  s.gravity(gravity(Vec3(1.5, 0, -9.81)));
  cdem::RelaxOptions options;
  options.stop_on_failure = true;
  options.residual = goal;
  const cdem::RelaxResult first = s.relax(options);
  REQUIRE(first.verdict == Verdict::stable);
  const double moved = s.max("displacement.magnitude").value;
  options.residual = 1e-7;
  CHECK(s.relax(options).verdict == Verdict::stable);
  CHECK(s.max("displacement.magnitude").value == Approx(moved).epsilon(1e-2));
}
