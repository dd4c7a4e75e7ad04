// Water of one velocity, and water that functions describe.
#pragma once

#include "libcdem/water/water_field.hpp"

#include <functional>
#include <optional>

namespace cdem {

constexpr double standard_water_gravity = 9.81; // m/s2, of every field that has a weight

// One velocity everywhere below the level; Du/Dt is its derivative in time. With a level the pressure is hydrostatic.
struct UniformWater {
  std::function<geom::Vec3(double time)> velocity; // m/s
  std::optional<double> level;                     // m, z of the free surface; none: water everywhere
  double density = 1025;                           // kg/m3
  double gravity = standard_water_gravity;         // m/s2
};
std::shared_ptr<const WaterField> uniform_water(const UniformWater&);

// Any member but the velocity may be empty. Without a pressure it is hydrostatic under the surface; without a surface either
// there is none. Without an acceleration it is the derivative of the velocity along the path of a particle. All derivatives
// are differences over 1e-4 s and 1e-4 m, so the functions are called as far beyond a place.
struct FunctionWater {
  std::function<geom::Vec3(const geom::Vec3&place, double time)> velocity, acceleration; // m/s, m/s2
  std::function<double(const geom::Vec3& place, double time)> pressure;                  // Pa
  std::function<double(const geom::Vec3& place, double time)> surface;                   // m; of x, y
  double density = 1025;                                                                 // kg/m3
  double gravity = standard_water_gravity;                                               // m/s2
};
std::shared_ptr<const WaterField> function_water(const FunctionWater&);

} // namespace cdem
