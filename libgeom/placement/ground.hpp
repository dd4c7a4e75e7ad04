// What units are laid on: the upper side of a solid, z up.
#pragma once

#include "libgeom/mesh/surface.hpp"

#include <optional>

namespace geom {

struct PlanBox { // x and y, m
  Eigen::Vector2d min, max;

  Eigen::Vector2d size() const { return max - min; }
  Eigen::Vector2d centre() const { return 0.5 * (min + max); }
};

class Ground {
public:
  // Throws InputError when no face of it looks up.
  explicit Ground(Surface surface);

  const Surface& surface() const { return surface_; }
  PlanBox plan() const; // of the faces that look up

  // z of the highest point of it over (x, y); none beside it.
  std::optional<double> height(double x, double y) const;
  // Mean outward normal of its upper side over a part of its plan, a unit vector.
  Vec3 normal(const PlanBox&) const;

private:
  Surface surface_;
  std::vector<std::array<Vec3, 3>> upper_; // faces that look up
};

// Checks a part of a ground's plan that a user gave; without one, all of it. Throws InputError naming
// "region".
PlanBox region_of(const Ground&, const std::optional<PlanBox>& given);

} // namespace geom
