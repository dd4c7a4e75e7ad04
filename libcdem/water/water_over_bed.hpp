// Water whose bed falls dry. Over dry bed at() gives the surface of the nearest water, no higher than the bed, and its
// velocity: a face that reaches from the water over its edge is cut where the surface meets it.
#pragma once

#include "libcdem/water/water_field.hpp"

namespace cdem {

class WaterOverBed : public WaterField {
public:
  // Whether no water is above the bed there. Throws as at() does.
  virtual bool is_dry(const geom::Vec3& place, double time) const = 0;
};

// The water as it is seen: where no water is above the bed, its surface is minus infinite.
inline WaterPoint seen_at(const WaterField& water, const geom::Vec3& place, double time) {
  WaterPoint point = water.at(place, time);
  const auto* const over_bed = dynamic_cast<const WaterOverBed*>(&water);
  if (over_bed && over_bed->is_dry(place, time))
    point.surface = -std::numeric_limits<double>::infinity();
  return point;
}

} // namespace cdem
