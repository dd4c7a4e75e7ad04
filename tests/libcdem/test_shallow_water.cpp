// Shallow water along a slope against exact solutions, and the field made of it.
#include "libcdem/water/plain_water.hpp"
#include "libcdem/water/slope_water.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

namespace {

constexpr double earth = 9.81; // m/s2

cdem::ShallowWater channel(double from, double to, int cells, const std::function<double(double)>& bed,
                           const std::function<double(double)>& surface) {
  cdem::ShallowWater w;
  w.cell = (to - from) / cells;
  for (int i = 0; i < cells; ++i) {
    const double x = from + (i + 0.5) * w.cell;
    w.bed.push_back(bed(x));
    w.h.push_back(std::max(0.0, surface(x) - w.bed.back()));
    w.q.push_back(0);
  }
  return w;
}

void advance(cdem::ShallowWater& w, double from, double to) {
  double time = from;
  while (time < to) {
    const double dt = std::min(w.longest_step(), to - time);
    w.step(time, dt);
    time = to - time - dt < 1e-12 * to ? to : time + dt;
  }
}

// Carrier and Greenspan 1958, J. Fluid Mech. 4:97-109: potential A J0(sigma) cos(lambda), in units of the beach: bed z = x,
// gravity 1. At (x, t): surface and velocity, by Newton's method for (sigma, lambda).
struct Beach {
  double a = 0.6;

  struct Water {
    double surface, velocity;
  };
  double j1_over(double s) const { return s < 1e-6 ? 0.5 - s * s / 16 : std::cyl_bessel_j(1, s) / s; }
  double velocity(double s, double l) const { return -a * j1_over(s) * std::cos(l); }
  double place(double s, double l) const {
    const double v = velocity(s, l);
    return -a / 4 * std::cyl_bessel_j(0, s) * std::sin(l) - s * s / 16 - v * v / 2;
  }
  double phase(double t, double s) const { // lambda = 2 (t + v)
    double l = 2 * t;
    for (int i = 0; i < 30; ++i)
      l = 2 * (t + velocity(s, l));
    return l;
  }
  double shore(double t) const { return place(0, phase(t, 0)); }
  Water at(double x, double t) const {
    double low = 0, high = 100; // the place falls as sigma grows
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (place(middle, phase(t, middle)) > x ? low : high) = middle;
    }
    const double l = phase(t, low);
    return {x + low * low / 16, velocity(low, l)};
  }
};

cdem::SlopeGiven slope_of(double cot, double depth) {
  cdem::SlopeGiven given;
  given.bed = {{0, -depth}, {depth * (cot + 0.35 * cot), 0.35 * depth}};
  given.friction = 0;
  return given;
}

} // namespace

TEST_CASE("a lake over an uneven bed with islands stays at rest to rounding", "[water]") {
  cdem::ShallowWater w = channel(
      0, 10, 100, [](double x) { return 0.3 * std::sin(7 * x) + 0.1 * x; }, [](double) { return 0.55; });
  w.entering = [](double) { return 0.0; };
  w.still_depth = w.h[0];
  double volume = 0;
  for (const double h : w.h)
    volume += h;
  for (int i = 0; i < 500; ++i)
    w.step(0, w.longest_step());
  double after = 0;
  for (int i = 0; i < static_cast<int>(w.h.size()); ++i) {
    after += w.h[i];
    CHECK(std::abs(w.q[i]) < 1e-13);
    if (w.h[i] > 0)
      CHECK(std::abs(w.h[i] + w.bed[i] - 0.55) < 1e-13);
  }
  CHECK(std::abs(after - volume) < 1e-12);
}

TEST_CASE("a dam breaks as Ritter found: h = (2 c0 - x / t)^2 / (9 g), depths stay above zero", "[water]") {
  const double t = 1.5, c0 = std::sqrt(earth);
  cdem::ShallowWater w = channel(
      -10, 12, 880, [](double) { return 0.0; }, [](double x) { return x < 0 ? 1.0 : 0.0; });
  w.still_depth = 1;
  advance(w, 0, t);
  double error = 0, volume = 0;
  for (int i = 0; i < static_cast<int>(w.h.size()); ++i) {
    const double x = -10 + (i + 0.5) * w.cell, s = x / t;
    const double exact = s <= -c0 ? 1 : s >= 2 * c0 ? 0 : (2 * c0 - s) * (2 * c0 - s) / (9 * earth);
    CHECK(w.h[i] >= 0);
    error += std::abs(w.h[i] - exact) * w.cell;
    volume += w.h[i] * w.cell;
  }
  CHECK(error < 0.003 * 10);
  CHECK(volume == Approx(10).epsilon(1e-12));
}

TEST_CASE("a standing wave on a plane beach moves its shore as Carrier and Greenspan found", "[water]") {
  const Beach beach;
  // From the highest run-up, of no velocity, to the lowest: half a period, pi / 2 in units of the beach.
  const double start = -std::acos(-1.0) / 4, from = -6, to = 0.6;
  cdem::ShallowWater w = channel(
      from, to, 660, [](double x) { return x; },
      [&](double x) { return x < beach.shore(start) ? beach.at(x, start).surface : x; });
  w.gravity = 1;
  w.still_depth = 1e-3; // sets what counts as dry
  REQUIRE(std::abs(beach.at(-1, start).velocity) < 1e-12);
  CHECK(beach.shore(start) == Approx(beach.a / 4).epsilon(1e-9));
  for (int part = 1; part <= 2; ++part) {
    const double now = start + part * std::acos(-1.0) / 4;
    advance(w, now - std::acos(-1.0) / 4, now);
    double shore = from;
    double error = 0, sum = 0;
    for (int i = 0; i < static_cast<int>(w.h.size()); ++i) {
      const double x = from + (i + 0.5) * w.cell;
      if (w.h[i] > 1e-3)
        shore = x + 0.5 * w.cell;
      if (x > -1.5 && x < beach.shore(now) - 0.02) { // no news from the wall has come there
        const Beach::Water exact = beach.at(x, now);
        error += std::abs(w.h[i] + w.bed[i] - exact.surface);
        sum += std::abs(exact.surface);
      }
    }
    CHECK(shore == Approx(beach.shore(now)).margin(0.02 * beach.a));
    CHECK(error < 0.02 * sum);
  }
}

TEST_CASE("a solitary wave runs up a plane beach to 2.831 sqrt(cot b) (H/d)^(5/4) d", "[water]") {
  // Synolakis 1987, J. Fluid Mech. 185:523-545, for waves that do not break.
  const double depth = 1;
  const auto [cot, height] = GENERATE(std::pair(19.85, 0.0185), std::pair(15.0, 0.03), std::pair(30.0, 0.01));
  cdem::SlopeGiven given = slope_of(cot, depth);
  given.cell = 0.05;
  const double c = std::sqrt(earth * depth), k = std::sqrt(0.75 * height), arrives = 4 / (k * c);
  given.entering = [=](double t) {
    const double s = 1 / std::cosh(k * c * (t - arrives));
    return height * s * s;
  };
  given.duration = arrives + 2 * 2 * cot * depth / c;
  const cdem::SlopeWater water(given);
  CHECK(water.run_up() / depth == Approx(2.831 * std::sqrt(cot) * std::pow(height, 1.25)).epsilon(0.03));
}

TEST_CASE("the field on a slope: still water is flat, hydrostatic and at rest", "[water]") {
  cdem::SlopeGiven given = slope_of(1.5, 8);
  given.level = 2;
  for (auto& point : given.bed)
    point[1] += 2;
  given.cell = 0.25;
  given.duration = 1;
  given.entering = [](double) { return 0.0; };
  const cdem::SlopeWater water(given);
  const cdem::WaterPoint point = water.at({5, 3, 0.7}, 0.5);
  CHECK(point.surface == Approx(2).margin(1e-12));
  CHECK(point.pressure == Approx(1025 * earth * 1.3).epsilon(1e-12));
  CHECK(point.velocity.norm() < 1e-12);
  CHECK(point.acceleration.norm() < 1e-11);
  CHECK(water.is_dry({15, 0, 3}, 0.5));
  CHECK(!water.is_dry({11.9, 0, 3}, 0.5)); // the shore is at 12 m
  CHECK(water.at({15, 0, 3}, 0.5).surface == Approx(2).margin(1e-12));
  CHECK_THROWS_WITH(water.at({5, 0, 0}, 1.5), Catch::Contains("known from 0 to 1 s"));
  for (const double beyond : {given.bed.front()[0] - 0.1, given.bed.back()[0] + 0.1})
    CHECK_THROWS_WITH(water.at({beyond, 0, 0}, 0.5), Catch::Contains("along its bed: it is known from"));
}

TEST_CASE("a box across the shore is cut where still water meets it, whatever the cell and the mesh",
          "[water]") {
  cdem::SlopeGiven given = slope_of(2, 2); // 1:2, and the shore at x = 4
  given.duration = 0.1;
  given.cell =
      GENERATE(0.3, 0.02, 0.003); // with the last one films, too thin to count as wet, end at the shore
  given.entering = [](double) { return 0.0; };
  const int divisions = GENERATE(1, 3);
  geom::TetMesh mesh = geom::box_mesh({2, 1, 1}, {2 * divisions, divisions, divisions});
  const geom::Mat3 up_slope = Eigen::AngleAxisd(-std::atan(0.5), geom::Vec3::UnitY()).toRotationMatrix();
  for (geom::Vec3& x : mesh.nodes)
    x = geom::Vec3(4, 0, 0) + up_slope * (x + geom::Vec3(-1, -0.5, 0.02));
  testing::System s(testing::build({testing::meshed("box", mesh)}));
  s.state.time = 0.05;
  // Its force (N), of this water.
  const auto force = [&](std::shared_ptr<const cdem::WaterField> water) {
    cdem::Flow flow;
    flow.water = std::move(water);
    flow.added_mass = 1;
    s.conditions.flows = {flow};
    cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
    cdem::update_external(r, s.state.time, &s.state.velocity);
    geom::Vec3 sum = geom::Vec3::Zero();
    for (const auto& f : r.external)
      sum += testing::vec(f);
    return sum;
  };
  cdem::UniformWater level;
  level.velocity = [](double) { return geom::Vec3(geom::Vec3::Zero()); };
  level.level = 0;
  const geom::Vec3 exact = force(cdem::uniform_water(level));
  CHECK(exact.z() > 1025 * earth * 0.2);
  CHECK((force(std::make_shared<cdem::SlopeWater>(given)) - exact).norm() < 1e-9 * exact.norm());
}

TEST_CASE("the surface on a slope has no jumps where a wave runs up and down", "[water]") {
  cdem::SlopeGiven given = slope_of(3, 4);
  given.cell = 0.1;
  given.entering = [](double t) { return 0.6 * std::sin(1.6 * t); };
  given.duration = 9;
  const cdem::SlopeWater water(given);
  CHECK(water.run_up() > 0.5);
  for (double t = 0; t < 9; t += 0.37)
    for (double x = given.bed[0][0] + 0.1; x < given.bed[1][0]; x += 0.013) {
      const cdem::WaterPoint a = water.at({x - 1e-7, 0, 0}, t), b = water.at({x + 1e-7, 0, 0}, t);
      const double bed = (x - 12) / 3;
      REQUIRE(std::abs(a.surface - b.surface) < 1e-5);
      REQUIRE(std::abs(a.velocity.x() - b.velocity.x()) < 1e-3);
      REQUIRE((!water.is_dry({x, 0, 0}, t) || a.surface < bed + 1e-6));
    }
}

TEST_CASE("the water on a slope obeys Froude's law to the bit: lengths by 4 or 1/16, times by 2 or 1/4",
          "[water]") {
  const auto [length, time] = GENERATE(std::pair(4., 2.), std::pair(1. / 16, 1. / 4));
  const auto scaled = [](double l, double s) {
    cdem::SlopeGiven given = slope_of(2, 2);
    for (auto& point : given.bed)
      point = {l * point[0], l * point[1]};
    given.cell = 0.1 * l;
    given.duration = 5 * s;
    given.entering = [=](double t) { return 0.3 * l * std::sin(2 * t / s); };
    return cdem::SlopeWater(given);
  };
  const cdem::SlopeWater model = scaled(1, 1), other = scaled(length, time);
  CHECK(model.run_up() > 0.3);
  CHECK(other.run_up() == length * model.run_up());
  CHECK(other.run_down() == length * model.run_down());
  for (double t = 0; t < 5; t += 0.37)
    for (double x = 0.2; x < 5; x += 0.43) {
      const cdem::WaterPoint a = model.at({x, 0, -0.4}, t),
                             b = other.at(length * geom::Vec3(x, 0, -0.4), time * t);
      REQUIRE(b.surface == length * a.surface);
      REQUIRE(b.pressure == length * a.pressure);
      REQUIRE(b.velocity == length / time * a.velocity);
      REQUIRE(b.acceleration == a.acceleration);
    }
}

TEST_CASE("a solution that would take more than 2 GB is refused, and the message names the cell", "[water]") {
  cdem::SlopeGiven given = slope_of(2, 2); // 5.4 m of bed
  given.cell = 1e-3;
  given.duration = 10; // 5400 cells, 4.43 m/s over 1 mm: 44300 frames
  CHECK_THROWS_WITH(cdem::SlopeWater(given), Catch::Contains("at most 5.02 s with this cell") &&
                                                 Catch::Contains("a cell twice as large takes a quarter"));
}

TEST_CASE("the water on a slope does not depend on how long it is asked for", "[water]") {
  cdem::SlopeGiven given = slope_of(2, 10);
  given.cell = 0.2;
  double asked = 0; // s, the latest time
  given.entering = [&](double t) {
    asked = std::max(asked, t);
    return 0.05 * std::sin(t);
  };
  given.duration = 3.011;
  const cdem::SlopeWater longer(given);
  CHECK(asked == given.duration); // the waves may be known no longer
  given.duration = 2;
  const cdem::SlopeWater shorter(given);
  const cdem::WaterPoint a = longer.at({3, 0, -0.2}, 1.77), b = shorter.at({3, 0, -0.2}, 1.77);
  CHECK(a.surface == b.surface);
  CHECK(a.velocity == b.velocity);
}
