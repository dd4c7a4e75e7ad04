// The tip of a crack along a path: what hangs together with its start counts, and the speed is that of a front that runs at
// a known one.
#include "libcdem/results/crack_tip.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using cdem::BreakRow;
using geom::Vec3;

namespace {

constexpr double spacing = 0.01, speed = 500; // m, m/s

BreakRow broken(const Vec3& place, double time, std::int64_t step) {
  BreakRow row;
  row.stage = 1;
  row.step = step;
  row.time = time;
  row.mode = cdem::BondMode::broken_tension;
  row.place = place;
  row.area = spacing * spacing / 3;
  return row;
}

// Points every `spacing` along x, each broken when a front of that speed passes.
std::vector<BreakRow> front(int points, double v = speed) {
  std::vector<BreakRow> rows;
  for (int i = 0; i < points; ++i)
    rows.push_back(broken({spacing * i, 0.2 * spacing * (i % 3), 0}, spacing * i / v, i));
  return rows;
}

cdem::CrackLine along_x() {
  return {{Vec3::Zero(), Vec3(2, 0, 0)}, spacing, 1.5 * spacing};
}

} // namespace

TEST_CASE("the tip is where the front has come to, and runs at its speed", "[crack_tip]") {
  std::vector<cdem::CrackTipRow> rows = cdem::crack_tip(front(101), along_x());
  REQUIRE(rows.size() == 101);
  cdem::add_speeds(rows, 20 * spacing / speed);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(rows[i].position == Approx(spacing * static_cast<double>(i)).margin(1e-12));
    // The slope of a staircase of n steps is that of its line to 1 / n^2; cut off windows have half as many.
    CHECK(rows[i].speed == Approx(speed).epsilon(i < 10 || i > 90 ? 0.02 : 0.005));
  }
}

TEST_CASE("a crack that stands still and goes on slower has these speeds", "[crack_tip]") {
  std::vector<BreakRow> breaks = front(51);
  const double pause = 0.2e-3, arrived = breaks.back().time;
  for (int i = 51; i < 101; ++i)
    breaks.push_back(broken({spacing * i, 0, 0}, arrived + pause + spacing * (i - 51) / (0.5 * speed), i));
  std::vector<cdem::CrackTipRow> rows = cdem::crack_tip(breaks, along_x());
  cdem::add_speeds(rows, 0.1e-3);
  REQUIRE(rows.size() == 101);
  CHECK(rows[20].speed == Approx(speed).epsilon(0.05));
  CHECK(rows[80].speed == Approx(0.5 * speed).epsilon(0.1));
}

TEST_CASE("a microcrack ahead counts once the crack has met it, and one beside the path never",
          "[crack_tip]") {
  std::vector<BreakRow> breaks = front(10);
  std::vector<BreakRow> all{broken({0.5, 0, 0}, 0, 0), broken({0.05, 5 * spacing, 0}, 0, 0)};
  all.insert(all.end(), breaks.begin(), breaks.end());
  CHECK(cdem::crack_tip(all, along_x()).back().position == Approx(9 * spacing));
  // The microcrack two spacings on, and what closes the gap.
  all.insert(all.begin(), broken({11 * spacing, 0, 0}, 0, 0));
  CHECK(cdem::crack_tip(all, along_x()).back().position == Approx(9 * spacing));
  all.push_back(broken({10 * spacing, 0, 0}, 1e-3, 11));
  const auto rows = cdem::crack_tip(all, along_x());
  CHECK(rows.back().position == Approx(11 * spacing));
  CHECK(rows.back().time == 1e-3);
}

TEST_CASE("what does not begin at the start of the path has no tip", "[crack_tip]") {
  cdem::CrackLine path = along_x();
  path.corners[0] = Vec3(-5 * spacing, 0, 0);
  CHECK(cdem::crack_tip(front(20), path).empty());
}

TEST_CASE("positions run along the corners of a path", "[crack_tip]") {
  std::vector<BreakRow> breaks = front(11);
  for (int i = 1; i <= 10; ++i)
    breaks.push_back(broken({0.1, spacing * i, 0}, 1e-3 + 1e-5 * i, 20 + i));
  const cdem::CrackLine path{{Vec3::Zero(), Vec3(0.1, 0, 0), Vec3(0.1, 1, 0)}, spacing, 1.5 * spacing};
  CHECK(cdem::crack_tip(breaks, path).back().position == Approx(0.2));
}

TEST_CASE("the usual distance of broken points is that of the triangles they stand for", "[crack_tip]") {
  CHECK(cdem::usual_distance(front(20), along_x().corners, spacing) == Approx(spacing));
  CHECK(cdem::usual_distance({}, along_x().corners, spacing) == 0);
}
