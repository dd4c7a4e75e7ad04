#include "libcdem/water/plain_water.hpp"

#include "libgeom/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double small_time = 1e-4, small_length = 1e-4; // s, m

class Uniform final : public WaterField {
public:
  explicit Uniform(UniformWater given) : given_(std::move(given)) {}

  WaterPoint at(const geom::Vec3& place, double time) const override {
    WaterPoint point;
    point.velocity = given_.velocity(time);
    point.acceleration =
        (given_.velocity(time + small_time) - given_.velocity(std::max(0.0, time - small_time))) /
        (small_time + std::min(small_time, time));
    if (given_.level) {
      point.surface = *given_.level;
      point.pressure = std::max(0.0, given_.density * given_.gravity * (*given_.level - place.z()));
      point.pressure_gradient.z() = -given_.density * given_.gravity;
    }
    return point;
  }
  double density() const override { return given_.density; }
  double gravity() const override { return given_.gravity; }
  bool has_dynamic_pressure() const override { return false; }
  bool has_pressure() const override { return given_.level.has_value(); }

private:
  UniformWater given_;
};

class OfFunctions final : public WaterField {
public:
  explicit OfFunctions(FunctionWater given) : given_(std::move(given)) {}

  WaterPoint at(const geom::Vec3& given_place, double time) const override {
    WaterPoint point;
    geom::Vec3 place = given_place;
    if (given_.surface) {
      point.surface = given_.surface(place, time);
      for (int axis = 0; axis < 2; ++axis) {
        const geom::Vec3 aside = small_length * geom::Vec3::Unit(axis);
        point.surface_slope[axis] =
            (given_.surface(place + aside, time) - given_.surface(place - aside, time)) / (2 * small_length);
      }
      place.z() = std::min(place.z(), point.surface);
    }
    point.velocity = given_.velocity(place, time);
    point.acceleration =
        given_.acceleration ? given_.acceleration(place, time) : along_path(place, time, point.velocity);
    if (given_.pressure) {
      const double pressure = given_.pressure(place, time);
      point.pressure = given_place.z() <= point.surface ? pressure : 0;
      point.pressure_gradient = gradient_below(place, time, pressure);
    } else if (given_.surface) {
      const double weight = given_.density * given_.gravity;
      point.pressure = std::max(0.0, weight * (point.surface - given_place.z()));
      point.pressure_gradient = weight * (point.surface_slope - geom::Vec3::UnitZ());
    }
    return point;
  }
  double density() const override { return given_.density; }
  double gravity() const override { return given_.gravity; }
  bool has_dynamic_pressure() const override { return static_cast<bool>(given_.pressure); }
  bool has_pressure() const override { return given_.pressure || given_.surface; }

private:
  // By places a little below, which are in the water where the place is at its surface.
  geom::Vec3 gradient_below(const geom::Vec3& place, double time, double pressure) const {
    const geom::Vec3 below = place - small_length * geom::Vec3::UnitZ();
    const double there = given_.pressure(below, time);
    return geom::Vec3(given_.pressure(below + small_length * geom::Vec3::UnitX(), time) - there,
                      given_.pressure(below + small_length * geom::Vec3::UnitY(), time) - there,
                      pressure - there) /
           small_length;
  }

  geom::Vec3 along_path(const geom::Vec3& place, double time, const geom::Vec3& velocity) const {
    const double before = std::min(small_time, std::max(0.0, time));
    geom::Vec3 rate = (given_.velocity(place, time + small_time) - given_.velocity(place, time - before)) /
                      (small_time + before);
    for (int axis = 0; axis < 3; ++axis) {
      const geom::Vec3 aside = small_length * geom::Vec3::Unit(axis);
      rate += velocity[axis] / (2 * small_length) *
              (given_.velocity(place + aside, time) - given_.velocity(place - aside, time));
    }
    return rate;
  }

  FunctionWater given_;
};

void check_liquid(double density, double gravity) {
  geom::require_positive("density", density, "kg/m3");
  geom::require_positive("gravity", gravity, "m/s2");
}

} // namespace

std::shared_ptr<const WaterField> uniform_water(const UniformWater& given) {
  check_liquid(given.density, given.gravity);
  return std::make_shared<Uniform>(given);
}

std::shared_ptr<const WaterField> function_water(const FunctionWater& given) {
  check_liquid(given.density, given.gravity);
  return std::make_shared<OfFunctions>(given);
}

} // namespace cdem
