// A field of water, and a water table, as a script holds them.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libcdem/load/water_table.hpp"
#include "libcdem/water/slope_water.hpp"

#include <optional>

namespace cdem::script {

// Waves that keep their shape over a flat bed.
struct TravellingWaves {
  geom::Vec3 direction = geom::Vec3::UnitX(); // horizontal, of length 1
  double wave_number = 0;                     // 1/m, at the peak of a sea
  double current = 0;                         // m/s, along the direction
};

struct WaterObject final : Object {
  std::shared_ptr<const WaterField> field;
  std::shared_ptr<const SlopeWater> slope; // the same, where it is one
  std::optional<TravellingWaves> travelling;
  std::string words; // "waves of 2 m and 8 s"
  const char* class_name() const override { return "Water"; }
};

struct WaterTableObject final : Object {
  std::shared_ptr<const WaterTable> table;
  std::string words; // "a plane that dips by 10 degrees towards 90"
  const char* class_name() const override { return "WaterTable"; }
};

} // namespace cdem::script
