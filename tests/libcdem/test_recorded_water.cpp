// Water of files: it is the recorded wave within the error of interpolation, loads bodies as that wave does, and refuses
// other places and times.
#include "libcdem/load/water_forces.hpp"
#include "libcdem/water/recorded_water.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

cdem::WaveField wave_of() {
  cdem::WaveGiven given;
  given.height = 0.8;
  given.length = 20;
  given.depth = 4;
  return cdem::WaveField(given);
}

struct Wish {
  double cell = 0.25, step = 0.05; // m, s
  bool pressure = true, fraction = true;
};

// The wave on a grid over x -4 to 4 and z -4 to 2, the same along y, at times 0 to 1.
cdem::WaterRecord recorded(const cdem::WaveField& wave, const Wish& wish) {
  cdem::WaterRecord r;
  r.origin = {-4, 0, -4};
  r.spacing = {wish.cell, 1, wish.cell};
  r.size = {static_cast<int>(std::lround(8 / wish.cell)) + 1, 1,
            static_cast<int>(std::lround(6 / wish.cell)) + 1};
  for (int frame = 0; frame * wish.step <= 1 + 1e-9; ++frame) {
    r.times.push_back(frame * wish.step);
    cdem::WaterFrame& f = r.frames.emplace_back();
    for (int k = 0; k < r.size[2]; ++k)
      for (int i = 0; i < r.size[0]; ++i) {
        const Vec3 x = r.origin + Vec3(i * r.spacing.x(), 0, k * r.spacing.z());
        const cdem::WaterPoint water = wave.at(x, r.times.back());
        const double over = x.z() - water.surface;
        f.velocity.push_back(over > 0 ? Vec3(9, 9, -9) : water.velocity); // air blows as it likes
        if (wish.pressure)
          f.pressure.push_back(over > 0 ? 0 : water.pressure);
        if (wish.fraction) // as a mesh of cells has it: linear over one cell
          f.fraction.push_back(std::min(1., std::max(0., 0.5 - over / (2 * wish.cell))));
      }
  }
  return r;
}

struct Error {
  double surface = 0, velocity = 0, pressure = 0, acceleration = 0,
         below = 0; // below: acceleration a cell below the surface
};

Error worst(const cdem::WaveField& wave, const cdem::RecordedWater& water) {
  Error e;
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 10; ++k) {
      const Vec3 x(-3.3 + 0.161 * i, 0.7 * k, -3.9 + 0.49 * k);
      const double t = 0.11 + 0.019 * i;
      const cdem::WaterPoint a = wave.at(x, t), b = water.at(x, t);
      e.surface = std::max(e.surface, std::abs(a.surface - b.surface));
      if (x.z() > std::min(a.surface, b.surface))
        continue;
      e.velocity = std::max(e.velocity, (a.velocity - b.velocity).norm());
      const double acceleration = (a.acceleration - b.acceleration).norm();
      e.acceleration = std::max(e.acceleration, acceleration);
      if (x.z() < a.surface - 0.5)
        e.below = std::max(e.below, acceleration);
      e.pressure = std::max(e.pressure, std::abs(a.pressure - b.pressure));
    }
  return e;
}

Vec3 force_on_cube(std::shared_ptr<const cdem::WaterField> field, double bottom, double time) {
  geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {4, 4, 4});
  for (Vec3& x : mesh.nodes)
    x += Vec3(-0.4, -0.5, bottom);
  System s(build({meshed("unit", mesh)}));
  s.state.time = time;
  cdem::Flow flow;
  flow.water = std::move(field);
  flow.added_mass = 0.67;
  flow.new_faces = true;
  s.conditions.flows = {flow};
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, s.state.time, &s.state.velocity);
  Vec3 sum = Vec3::Zero();
  for (const auto& f : r.external)
    sum += vec(f);
  return sum;
}

} // namespace

TEST_CASE("recorded water is the wave, with an error that falls with the square of the cell", "[water]") {
  const cdem::WaveField wave = wave_of();
  const Error coarse = worst(wave, cdem::RecordedWater(recorded(wave, {0.5, 0.1}))),
              fine = worst(wave, cdem::RecordedWater(recorded(wave, {0.25, 0.05})));
  CHECK(fine.surface < 0.01);  // of a wave of 0.8 m
  CHECK(fine.velocity < 0.01); // of 0.9 m/s
  CHECK(fine.pressure < 60);   // of 40 kPa
  // Of 1.2 m/s2. In the cell of the surface the velocity above it is that at it, so up to k u w is lost.
  CHECK(fine.below < 0.03);
  CHECK(fine.acceleration < 2 * 3.14 / 20 * 0.9 * 0.9);
  CHECK(coarse.surface / fine.surface > 3);
  CHECK(coarse.pressure / fine.pressure > 2.5);
}

TEST_CASE("recorded water loads a cube as the wave does, under and through the surface", "[water]") {
  const auto wave = std::make_shared<cdem::WaveField>(wave_of());
  const auto water = std::make_shared<cdem::RecordedWater>(recorded(*wave, {}));
  for (const double bottom : {-2.5, -0.6})
    for (const double time : {0.13, 0.42}) {
      const Vec3 exact = force_on_cube(wave, bottom, time), force = force_on_cube(water, bottom, time);
      CHECK((force - exact).norm() < 0.01 * exact.norm());
    }
}

TEST_CASE("nothing counts twice: water without a pressure has the weight's alone", "[water]") {
  const auto wave = std::make_shared<cdem::WaveField>(wave_of());
  const cdem::RecordedWater water(recorded(*wave, {0.25, 0.05, false, true}));
  const Vec3 x(0.3, 0, -1.2);
  const cdem::WaterPoint here = water.at(x, 0.3);
  CHECK(here.pressure == Approx(1025 * 9.81 * (here.surface + 1.2)));
  CHECK(water.has_pressure());
  const cdem::RecordedWater stream(recorded(*wave, {0.25, 0.05, false, false}));
  CHECK(!stream.has_pressure());
  CHECK(std::isinf(stream.at(x, 0.3).surface));
}

TEST_CASE("recorded water is refused beside its box, outside of its times, and out of order", "[water]") {
  const cdem::WaveField wave = wave_of();
  const cdem::RecordedWater water(recorded(wave, {0.5, 0.5}));
  CHECK_NOTHROW(water.at({4, 1e6, -4}, 1)); // the same all along y
  CHECK(water.at({0, 0, 50}, 0).pressure == 0);
  CHECK_THROWS_WITH(water.at({4.1, 0, -1}, 0), Catch::Matchers::Contains("is known from"));
  CHECK_THROWS_WITH(water.at({0, 0, -4.2}, 0), Catch::Matchers::Contains("is known from"));
  CHECK_THROWS_WITH(water.at({0, 0, -1}, 1.1), Catch::Matchers::Contains("from 0 to 1 s"));
  for (const bool pressure : {true, false}) { // no fraction: water everywhere, but known up to z = 2
    cdem::WaterRecord endless = recorded(wave, {0.5, 0.5, pressure, false}), deep = endless, level = endless;
    deep.level = 2.5;
    level.level = 0.3;
    const cdem::RecordedWater no_end(std::move(endless)), above_box(std::move(deep)),
        in_box(std::move(level));
    CHECK_NOTHROW(no_end.at({0, 0, 2}, 0));
    CHECK_THROWS_WITH(no_end.at({0, 0, 2.1}, 0),
                      Catch::Matchers::Contains("give the level or the water fraction"));
    CHECK_THROWS_WITH(above_box.at({0, 0, 2.4}, 0), Catch::Matchers::Contains("is known from"));
    CHECK_NOTHROW(above_box.at({0, 0, 2.6}, 0)); // air
    CHECK(in_box.at({0, 0, 50}, 0).pressure == 0);
  }
  cdem::WaterRecord twice = recorded(wave, {0.5, 0.5});
  twice.times[1] = twice.times[0];
  CHECK_THROWS_WITH(cdem::RecordedWater(twice), Catch::Matchers::Contains("times[2] = 0: must be later"));
}

TEST_CASE("recorded water tells where it reaches the top of its box", "[water]") {
  CHECK(!cdem::RecordedWater(recorded(wave_of(), {})).reaches_top());
  cdem::WaterRecord r;
  r.size = {3, 1, 3};
  for (const double time : {0, 2}) {
    r.times.push_back(time);
    cdem::WaterFrame& f = r.frames.emplace_back();
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) {
        f.velocity.push_back(Vec3::Zero());
        f.fraction.push_back(k < 2 || (time == 2 && i == 1) ? 1 : 0);
      }
  }
  const auto cut = cdem::RecordedWater(r).reaches_top();
  REQUIRE(cut);
  CHECK(cut->time == 2);
  CHECK(cut->place == Vec3(1, 0, 2));
}

TEST_CASE("a place inside a solid has the water beside it, and a dry column none", "[water]") {
  cdem::WaterRecord r;
  r.size = {6, 1, 4};
  r.times = {0};
  cdem::WaterFrame& f = r.frames.emplace_back();
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 6; ++i) {
      const bool solid = i == 2 && k < 2; // a post in the flow
      f.known.push_back(!solid);
      f.velocity.emplace_back(solid ? 0 : 1, 0, 0);
      f.fraction.push_back(!solid && i < 4 && k < 3 ? 1 : 0);
    }
  const cdem::RecordedWater water(std::move(r));
  CHECK(water.at({2, 0, 0.5}, 7).velocity.x() == Approx(1));
  CHECK(water.at({1.5, 0, 2}, 0).surface == Approx(2.5));
  CHECK(water.is_dry({5, 0, 1}, 0));
  CHECK(water.at({5, 0, 1}, 0).surface == 0); // the lowest point of the column is its bed
  CHECK(water.at({3.4, 0, 1}, 0).surface == Approx(1.5));
}

TEST_CASE("a jet over air over a pool is two layers of water, with air between them", "[water]") {
  cdem::WaterRecord r;
  r.size = {9, 1, 13};
  r.spacing = {0.5, 1, 0.25};
  r.times = {0};
  cdem::WaterFrame& f = r.frames.emplace_back();
  for (int k = 0; k < 13; ++k)
    for (int i = 0; i < 9; ++i) {
      const bool pool = k <= 4, jet = k >= 8 && k <= 9; // 0 to 1 m; 2 to 2.25 m
      f.velocity.emplace_back(pool ? 1 : jet ? 3 : 20, 0, 0);
      f.pressure.push_back(pool ? 1025 * 9.81 * (1.125 - 0.25 * k) : 0);
      f.fraction.push_back(pool || jet ? 1 : 0);
    }
  const auto water = std::make_shared<cdem::RecordedWater>(std::move(r));
  CHECK(water->at({2, 0, 0.5}, 0).surface == Approx(1.125));
  CHECK(water->at({2, 0, 0.5}, 0).pressure == Approx(1025 * 9.81 * 0.625));
  const cdem::WaterPoint air = water->at({2, 0, 1.6}, 0), jet = water->at({2, 0, 2.1}, 0);
  CHECK(air.surface == Approx(1.125)); // 0.475 m under the air
  CHECK(air.pressure == 0);
  CHECK(jet.surface == Approx(2.375));
  CHECK(jet.velocity.x() == Approx(3));
  CHECK(water->at({2, 0, 1.9}, 0).velocity.x() == Approx(3)); // just inside, below its lowest point
  CHECK(std::abs(jet.pressure) < 1025 * 9.81 * 0.25);
  geom::TetMesh mesh = geom::box_mesh({0.3, 0.3, 0.3}, {2, 2, 2});
  for (Vec3& x : mesh.nodes)
    x += Vec3(1.8, 0, 1.3);
  System s(build({meshed("unit", mesh)})); // in the air between them
  cdem::Flow flow;
  flow.water = water;
  s.conditions.flows = {flow};
  cdem::ResolvedConditions conditions = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(conditions, 0, &s.state.velocity);
  for (const auto& force : conditions.external)
    CHECK(vec(force).norm() == 0);
}

TEST_CASE("a cube across the shore of recorded still water floats as in water of that level", "[water]") {
  const bool pressure = GENERATE(true, false);
  cdem::WaterRecord r;
  r.origin = {-2, 0, -1};
  r.spacing = {0.2, 1, 0.2};
  r.size = {21, 1, 16};
  r.times = {0};
  cdem::WaterFrame& f = r.frames.emplace_back();
  for (int k = 0; k < r.size[2]; ++k)
    for (int i = 0; i < r.size[0]; ++i) {
      const double x = -2 + 0.2 * i, z = -1 + 0.2 * k, level = 0.1;
      const bool ground = z < x / 2 - 0.05; // 1:2, and the shore at x = 0.3
      f.known.push_back(!ground);
      f.velocity.emplace_back(0, 0, ground || z < level ? 0 : 20); // wind
      if (pressure)
        f.pressure.push_back(ground ? 0 : 1025 * 9.81 * std::max(0.0, level - z));
      f.fraction.push_back(ground ? 0 : std::min(1., std::max(0., 0.5 + (level - z) / 0.2)));
    }
  cdem::UniformWater level;
  level.velocity = [](double) { return Vec3(Vec3::Zero()); };
  level.level = 0.1;
  const Vec3 exact = force_on_cube(cdem::uniform_water(level), -0.3, 0),
             force = force_on_cube(std::make_shared<cdem::RecordedWater>(std::move(r)), -0.3, 0);
  CHECK(exact.z() == Approx(1025 * 9.81 * 0.4));
  CHECK((force - exact).norm() < 1e-9 * exact.norm());
}

TEST_CASE("still water goes on hydrostatic into points that the cells leave out", "[water]") {
  cdem::WaterRecord r;
  r.size = {5, 1, 6};
  r.times = {0};
  cdem::WaterFrame& f = r.frames.emplace_back();
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < 5; ++i) {
      const bool bed = k < i / 2 + 1;
      f.known.push_back(!bed);
      f.velocity.emplace_back(Vec3::Zero());
      f.pressure.push_back(bed ? 0 : 1025 * 9.81 * std::max(0.0, 4.5 - k));
      f.fraction.push_back(!bed && k < 4.5 ? 1 : 0);
    }
  const cdem::RecordedWater water(std::move(r));
  for (const Vec3& x : {Vec3(0, 0, 0.3), Vec3(1.7, 0, 1.2), Vec3(3.6, 0, 2.4)})
    CHECK(water.at(x, 0).pressure == Approx(1025 * 9.81 * (4.5 - x.z())));
}
