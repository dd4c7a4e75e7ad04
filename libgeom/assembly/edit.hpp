// What can be done to an assembly once it is built: cutting it by a plane, moving it, joining several.
#pragma once

#include "libgeom/assembly/assembly.hpp"

#include <functional>
#include <optional>

namespace geom {

struct PlaneCutOptions {
  std::optional<Box> inside; // only blocks whose centroid lies in this box are cut
  double clearance =
      0; // m; where a vertex of a block is nearer than this, the plane is shifted for that block
  // Only blocks that reach into this box, by more than 1e-6 of their size, are cut: a notch or a load line that
  // no block boundary meets.
  std::optional<Box> crossing{};
  std::string
      name{}; // of the faces that the cut makes; a plane along a face that is there leaves that one as it is
  bool glued = false; // the faces are no joint
  // Whether the faces that are cut into a block have the name, by the number of the block; all have it when empty.
  std::function<bool(std::size_t)> named{};
};

// Splits every block that the plane crosses; the two parts take its place, the lower one first. The normal
// need not be a unit vector. Throws InputError on a zero or non-finite normal, a non-finite offset or a
// negative clearance.
Assembly cut_by_plane(Assembly, const Plane&, const PlaneCutOptions& = {});

Assembly kept(Assembly, const Box& inside);       // the blocks whose centroid lies in the box
Assembly translated(Assembly, const Vec3& shift); // m
// Right-handed about the axis through `centre`; angle in rad.
Assembly rotated(Assembly, const Vec3& axis, double angle, const Vec3& centre = Vec3::Zero());
Assembly merged(const std::vector<Assembly>&); // the blocks of each in turn

} // namespace geom
