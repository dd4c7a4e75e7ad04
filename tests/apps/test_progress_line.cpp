#include "apps/cdem/process/terminal.hpp"
#include "apps/cdem/progress/line.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace cdem::app;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using cdem::Progress;

namespace {

Progress half_way() {
  Progress p;
  p.stage = 3;
  p.kind = "relax";
  p.step = 12345;
  p.max_steps = 500000;
  p.residual = 1e-3;
  p.residual_goal = 1e-6;
  p.broken_tension = 4;
  p.broken_shear = 1200;
  p.steps_per_second = 12345 / 75.;
  return p;
}

// From a residual of 1 it has fallen evenly.
TimeLeft seen(const Progress& p) {
  TimeLeft left;
  for (int i = 0; i <= 10; ++i) {
    Progress then = p;
    then.step = p.step * i / 10;
    then.residual = std::pow(p.residual, 0.1 * i);
    left.add(then, 0.1 * i);
  }
  return left;
}

} // namespace

TEST_CASE("a wide line says everything") {
  const Progress p = half_way();
  CHECK(live_line(p, seen(p), 200) ==
        "stage 3 relax  [========>       ]  50 %  step 12,345  residual 0.001 -> 1e-06  "
        "1,204 broken  165 steps/s  1 min 15 s left");
}

TEST_CASE("a line is never wider than the terminal, and says first what matters most") {
  const Progress p = half_way();
  const TimeLeft left = seen(p);
  for (int columns = 1; columns <= 140; ++columns)
    CHECK(live_line(p, left, columns).size() <= static_cast<std::size_t>(columns));
  const std::string narrow = live_line(p, left, 64);
  CHECK_THAT(narrow,
             StartsWith("stage 3 relax  50 %") && Contains("residual 0.001 -> 1e-06") && Contains("left"));
}

TEST_CASE("the bar follows the decades of the residual, not its value") {
  Progress p = half_way();
  p.residual = std::pow(10, -1.5); // a quarter of the way from 1 to 1e-6
  CHECK_THAT(live_line(p, seen(p), 200), Contains(" 25 %"));
}

TEST_CASE("a stage that goes on is never done, and names no time that is none", "[progress]") {
  Progress p = half_way();
  p.residual = 0.9e-6; // below its goal, which has to last
  CHECK_THAT(live_line(p, seen(p), 200), Contains(" 99 %") && !Contains("100 %") && !Contains("left"));
  CHECK_THAT(plain_line(p, seen(p)), Contains(" 99 %") && !Contains("left"));
  p.last = true;
  CHECK_THAT(plain_line(p, seen(p)), Contains("100 %"));
}

TEST_CASE("a plain line names both kinds of breaking") {
  const Progress p = half_way();
  CHECK(plain_line(p, seen(p)) == "stage 3 relax: step 12,345, residual 0.001 -> 1e-06, 50 %, 1,204 broken "
                                  "(4 tension, 1,200 shear), 165 steps/s, 1 min 15 s left");
}

TEST_CASE("a line of units that settle says how calm they are") {
  Progress p;
  p.stage = 1;
  p.kind = "settle: rigid fall";
  p.step = 100;
  p.time = 0.5;
  p.time_goal = 60;
  p.kinetic_ratio = 1e-3;
  p.kinetic_ratio_goal = 1e-6;
  CHECK_THAT(live_line(p, TimeLeft(), 200),
             Contains("time 0.5 of 60 s, kinetic energy 0.001 -> 1e-06 of its peak") && !Contains("left"));
}

TEST_CASE("a line of what is not solved counts what it counts") {
  Progress p;
  p.kind = "place";
  p.counts = "unit";
  p.note = "laid, spacing 2 of at most 6";
  p.step = 12;
  p.max_steps = 50;
  TimeLeft left;
  left.add(p, 1);
  CHECK(plain_line(p, left) == "place: unit 12 of 50, laid, spacing 2 of at most 6, 24 %");
  p.note = "come to rest together, spacing 2 of at most 6";
  p.step = 50;
  p.max_steps = 0;
  left.add(p, 5);
  CHECK(plain_line(p, left) == "place: 50 units, come to rest together, spacing 2 of at most 6");
}

TEST_CASE("the last line of a stage says what it came to") {
  Progress p = half_way();
  p.last = true;
  p.wall_time = 2.5;
  CHECK(stage_line(p) == "stage 3 relax: 12,345 steps in 2.5 s, residual 0.001 (goal 1e-06), 1,204 broken "
                         "(4 tension, 1,200 shear)");
}

TEST_CASE("one step is no steps") {
  Progress p;
  p.stage = 1;
  p.kind = "run";
  p.step = 1;
  CHECK_THAT(stage_line(p), StartsWith("stage 1 run: 1 step in "));
}

TEST_CASE("a bar is empty at 0, full at 1 and as wide as asked at every fraction") {
  CHECK(bar_text(0, 4) == "[    ]");
  CHECK(bar_text(1, 4) == "[====]");
  for (int i = 0; i <= 100; ++i)
    CHECK(bar_text(0.01 * i, 17).size() == 19);
}
