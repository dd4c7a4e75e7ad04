// A field of water as a script holds it.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libcdem/water/slope_water.hpp"

namespace cdem::script {

struct WaterObject final : Object {
  std::shared_ptr<const WaterField> field;
  std::shared_ptr<const SlopeWater> slope; // the same, where it is one
  std::string words;                       // "waves of 2 m and 8 s"
  const char* class_name() const override { return "Water"; }
};

} // namespace cdem::script
