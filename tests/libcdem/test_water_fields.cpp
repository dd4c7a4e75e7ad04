// Waves as fields: printed values of an independent program, order of Stokes's theory, Euler's equation, spectrum.
#include "libcdem/water/irregular_sea.hpp"
#include "libcdem/water/plain_water.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using geom::Vec3;
using testing::pi;

namespace {

cdem::WaveGiven wave_of(cdem::WaveTheory theory, double height) {
  cdem::WaveGiven given;
  given.theory = theory;
  given.height = height;
  given.depth = 0.5;
  given.length = 2;
  return given;
}

// The equation of motion of a fluid without friction: Du/Dt = -grad p / rho - g. And Du/Dt from the velocities themselves.
void check_motion(const cdem::WaterField& water, const Vec3& x, double t) {
  const double d = 1e-4;
  const auto at = [&](const Vec3& place, double time) { return water.at(place, time); };
  const cdem::WaterPoint here = at(x, t);
  Vec3 by_pressure(0, 0, -9.81), by_velocity = (at(x, t + d).velocity - at(x, t - d).velocity) / (2 * d);
  double divergence = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 aside = d * Vec3::Unit(axis);
    const cdem::WaterPoint a = at(x - aside, t), b = at(x + aside, t);
    by_pressure[axis] -= (b.pressure - a.pressure) / (2 * d * water.density());
    by_velocity += here.velocity[axis] * (b.velocity - a.velocity) / (2 * d);
    divergence += (b.velocity[axis] - a.velocity[axis]) / (2 * d);
  }
  CHECK((here.acceleration - by_pressure).norm() < 1e-5 * 9.81);
  CHECK((here.acceleration - by_velocity).norm() < 1e-5 * 9.81);
  CHECK(std::abs(divergence) < 1e-6);
}

// The gradients of the pressure and the surface, by differences.
void check_gradients(const cdem::WaterField& water, const Vec3& x, double t, double tolerance) {
  const double d = 1e-4;
  const cdem::WaterPoint here = water.at(x, t);
  Vec3 gradient = Vec3::Zero(), slope = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 aside = d * Vec3::Unit(axis);
    const cdem::WaterPoint a = water.at(x - aside, t), b = water.at(x + aside, t);
    gradient[axis] = (b.pressure - a.pressure) / (2 * d);
    slope[axis] = (b.surface - a.surface) / (2 * d);
  }
  CHECK((here.pressure_gradient - gradient).norm() < tolerance * water.density() * 9.81);
  CHECK((here.surface_slope - slope).norm() < tolerance);
}

} // namespace

TEST_CASE("pressure and surface change by their gradients", "[water]") {
  cdem::WaveGiven given = wave_of(cdem::WaveTheory::stream_function, 0.1);
  given.direction = {1, -2, 0};
  check_gradients(cdem::WaveField(given), {0.3, 0.1, -0.2}, 0.4, 1e-6);
  cdem::SeaGiven small;
  small.significant_height = 0.02;
  small.peak_period = 6;
  small.depth = 10;
  check_gradients(cdem::IrregularSea(small), {2, 1, -3}, 5, 1e-5);
  cdem::FunctionWater functions;
  functions.velocity = [](const Vec3&, double) { return Vec3(Vec3::Zero()); };
  functions.surface = [](const Vec3& x, double t) { return 2 + 0.1 * x.x() - 0.2 * x.y() * t; };
  check_gradients(*cdem::function_water(functions), {1, 2, 0.4}, 0.5, 1e-6);
  functions.pressure = [](const Vec3& x, double) { return 8e3 * (2 - x.z()) + 300 * x.x() * x.y(); };
  const auto with_pressure = cdem::function_water(functions);
  check_gradients(*with_pressure, {1, 2, 0.4}, 0.5, 1e-6);
  // Above the surface the gradient is that at the surface.
  CHECK((with_pressure->at({1, 2, 3}, 0.5).pressure_gradient - Vec3(600, 300, -8e3)).norm() < 0.1);
  CHECK(with_pressure->at({1, 2, 3}, 0.5).pressure == 0);
}

TEST_CASE("a stream function wave has the printed surface and velocity", "[water]") {
  cdem::WaveGiven given = wave_of(cdem::WaveTheory::stream_function, 0.25);
  given.level = 0.5; // z from the bed
  const cdem::WaveField wave(given);
  const double printed[][2] = {{0, 0.67352456}, {0.1, 0.61795882}, {0.2, 0.57230232}, {0.3, 0.53352878}};
  for (const auto& [x, surface] : printed)
    CHECK(wave.at({x, 0, 0.2}, 0).surface == Approx(surface).margin(1e-6));
  CHECK(wave.at({0, 0, 0.2}, 0).velocity.x() == Approx(0.27263788).margin(1e-6));
}

TEST_CASE("Stokes's theory of fifth order is wrong by the sixth power of the height", "[water]") {
  double before = 0;
  for (const double height : {0.04, 0.08}) {
    const cdem::WaveField exact(wave_of(cdem::WaveTheory::stream_function, height)),
        stokes(wave_of(cdem::WaveTheory::stokes, height));
    double error = 0;
    for (int i = 0; i < 20; ++i) {
      const Vec3 x(0.05 * i, 0, -0.1);
      const cdem::WaterPoint a = exact.at(x, 0), b = stokes.at(x, 0);
      error = std::max({error, std::abs(a.surface - b.surface), (a.velocity - b.velocity).norm(),
                        std::abs(a.pressure - b.pressure) / 1e4});
    }
    if (before > 0)
      CHECK(error / before == Approx(64).epsilon(0.5));
    before = error;
  }
  CHECK(before < 2e-5);
}

TEST_CASE("waves meet the equation of motion, keep the volume, and travel by their period", "[water]") {
  const auto theory = GENERATE(cdem::WaveTheory::stokes, cdem::WaveTheory::stream_function);
  cdem::WaveGiven given = wave_of(theory, 0.06);
  given.length.reset();
  given.period = 1.1;
  given.direction = {3, 4, 0};
  given.current = 0.2;
  const cdem::WaveField wave(given);
  CHECK(wave.period() == Approx(1.1).epsilon(1e-10));
  for (const Vec3& x : {Vec3(0.2, -0.3, -0.2), Vec3(-0.6, 0.1, -0.05), Vec3(4, 2, -0.45)}) {
    check_motion(wave, x, 0.37);
    CHECK((wave.at(x, 0.37).velocity - wave.at(x, 0.37 + 1.1).velocity).norm() < 1e-9);
  }
}

TEST_CASE("small waves have tanh's speed, and the pressure vanishes at the surface", "[water]") {
  const cdem::WaveField wave(wave_of(cdem::WaveTheory::airy, 1e-4));
  CHECK(wave.wave.mean == Approx(std::sqrt(9.81 / pi * std::tanh(0.5 * pi))).epsilon(1e-12));
  const cdem::WaveField high(wave_of(cdem::WaveTheory::stream_function, 0.2));
  for (const double x : {0.0, 0.3, 0.77, 1.0}) {
    const double surface = high.at({x, 0, 0}, 0).surface;
    CHECK(high.at({x, 0, surface - 1e-9}, 0).pressure < 0.05); // Pa; between the points that meet it, of 1e4
    CHECK(high.at({x, 0, surface + 0.01}, 0).pressure == 0);
  }
}

TEST_CASE("a sea has its significant height, and the same waves from the same seed", "[water]") {
  cdem::SeaGiven given;
  given.significant_height = 2;
  given.peak_period = 8;
  given.depth = 20;
  given.seed = 7;
  const cdem::IrregularSea sea(given), again(given);
  double sum2 = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i)
    sum2 += std::pow(sea.at({0, 0, 0}, 0.7 * i).surface, 2);
  CHECK(4 * std::sqrt(sum2 / n) == Approx(2).epsilon(0.03));
  CHECK(sea.at({3, 0, -1}, 50).velocity == again.at({3, 0, -1}, 50).velocity);
  given.seed = 8;
  CHECK(sea.at({3, 0, -1}, 50).surface != cdem::IrregularSea(given).at({3, 0, -1}, 50).surface);
  check_motion(cdem::IrregularSea([&] {
                 given.significant_height = 1e-3; // linear
                 return given;
               }()),
               {5, 0, -4}, 11);
}

TEST_CASE("water of functions finds the acceleration along the path of a particle", "[water]") {
  cdem::FunctionWater given;
  given.velocity = [](const Vec3& x, double t) { return Vec3(x.x() * x.x() + t, 0, x.x() * x.z()); };
  given.surface = [](const Vec3& x, double) { return 1 + 0.1 * x.x(); };
  const auto water = cdem::function_water(given);
  const cdem::WaterPoint point = water->at({2, 0, 0.5}, 1);
  CHECK((point.acceleration - Vec3(1 + 5 * 4, 0, 5 * 0.5 + 1 * 2)).norm() < 1e-6);
  CHECK(point.pressure == Approx(1025 * 9.81 * 0.7));
}

TEST_CASE("waves that cannot be are refused in one line", "[water]") {
  CHECK_THROWS_WITH(cdem::WaveField(wave_of(cdem::WaveTheory::stokes, 0.3)),
                    Catch::Contains("height = 0.3: must be at most") && Catch::Contains("breaks"));
  cdem::WaveGiven given = wave_of(cdem::WaveTheory::airy, 0.1);
  given.depth = -1;
  CHECK_THROWS_WITH(cdem::WaveField(given), Catch::Contains("depth"));
  given = wave_of(cdem::WaveTheory::stokes, 0.1);
  given.length = 20;
  CHECK_THROWS_WITH(cdem::WaveField(given), Catch::Contains("stream_function"));
  given = wave_of(cdem::WaveTheory::stream_function, 0.01);
  given.length.reset();
  given.period = 1;
  given.current = -0.6; // waves of 1 s and 1.6 m/s travel against 0.39 m/s at most
  CHECK_THROWS_WITH(cdem::WaveField(given),
                    Catch::Contains("current = -0.6: must be weaker against waves of 1 s"));
  given.current = -0.3;
  CHECK_NOTHROW(cdem::WaveField(given));
}
