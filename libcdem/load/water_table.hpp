// A water table that is not level: its height z_w over the plan, as a plane, a profile along a direction, or a surface of
// triangles. Joints and faces below it have the pressure
//
//   p = weight (z_w(x, y) - z)
//
// of still water that stands as high above them. Under a table that slopes by beta, with flow parallel to it, the pressure
// is cos^2(beta) times that (Bear 1972, section 7.1): this one is too large, by 3 % at 10 degrees and a third at 30.
#pragma once

#include "libgeom/core/types.hpp"
#include "libgeom/mesh/surface.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cdem {

class WaterTable {
public:
  virtual ~WaterTable() = default;
  // z_w above or below a place, m; nothing where the table ends before.
  virtual std::optional<double> height(const geom::Vec3& place) const = 0;
  virtual bool is_plane() const { return false; }
  // Where it is known lies beside this box in plan, so that the table is level over it: one line; else "".
  virtual std::string apart_from(const geom::Box&) const { return ""; }
};

// The same; throws geom::InputError where the table ends before.
double required_height(const WaterTable&, const geom::Vec3& place);

// All of them throw geom::InputError. Angles in rad; dip in [0, pi/2), dip_direction clockwise from +y (north).
std::shared_ptr<const WaterTable> water_plane(const geom::Vec3& point, double dip, double dip_direction);
// Rows of distance along a horizontal direction from the origin, rising, and z: straight between them, level beyond.
std::shared_ptr<const WaterTable> water_profile(std::vector<std::array<double, 2>> rows,
                                                const geom::Vec3& origin, const geom::Vec3& direction);
// An open surface that lies over each place once.
std::shared_ptr<const WaterTable> water_surface(geom::Surface);

} // namespace cdem
