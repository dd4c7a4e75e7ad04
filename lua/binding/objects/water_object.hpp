// A field of water, and a water table, as a script holds them.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libcdem/load/water_table.hpp"
#include "libcdem/water/slope_water.hpp"

namespace cdem::script {

struct WaterObject final : Object {
  std::shared_ptr<const WaterField> field;
  std::shared_ptr<const SlopeWater> slope; // the same, where it is one
  std::string words;                       // "waves of 2 m and 8 s"
  const char* class_name() const override { return "Water"; }
};

struct WaterTableObject final : Object {
  std::shared_ptr<const WaterTable> table;
  std::string words; // "a plane that dips by 10 degrees towards 90"
  const char* class_name() const override { return "WaterTable"; }
};

} // namespace cdem::script
