// Water as a field of its own: velocity, acceleration, pressure and free surface as pure functions of place and time.
// Loads take any field (load/water_forces.hpp). A field keeps no state between calls, so a resumed run meets the same bits.
#pragma once

#include "libgeom/core/types.hpp"

#include <limits>
#include <memory>
#include <optional>

namespace cdem {

// Water at a place and time. Above the free surface velocity and acceleration are those of the surface below, and the
// pressure is 0.
struct WaterPoint {
  geom::Vec3 velocity = geom::Vec3::Zero();     // m/s
  geom::Vec3 acceleration = geom::Vec3::Zero(); // m/s2, of the particles of water: Du/Dt
  double pressure = 0;                          // Pa above that of the air
  // m, z of the free surface; infinite: water everywhere; minus infinite: the place is dry
  double surface = std::numeric_limits<double>::infinity();
  // How the pressure of the water and the height of its surface change from here on, so that a body that moves between two
  // looks at the field meets them where it is. Above the free surface the gradient is that at the surface below.
  geom::Vec3 pressure_gradient = geom::Vec3::Zero(); // Pa/m
  geom::Vec3 surface_slope = geom::Vec3::Zero();     // rise of the surface along x and y; z: 0
};

// The bed that waves which keep their shape are made for.
struct FlatBed {
  double z = 0, level = 0; // m; of still water
};

class WaterField {
public:
  virtual ~WaterField() = default;
  // Throws geom::InputError where the field is not known at this time.
  virtual WaterPoint at(const geom::Vec3& place, double time) const = 0;
  virtual double density() const = 0; // kg/m3
  virtual double gravity() const = 0; // m/s2, along -z; the weight of the water
  // Whether the pressure is that of the motion too: its integral over faces then holds the force that accelerated water
  // puts on a body at rest (Froude-Krylov). Otherwise it is hydrostatic below the surface, or 0 without one: loads add
  // density x volume x (acceleration + gravity x slope of the surface), which is what the pressure leaves out.
  virtual bool has_dynamic_pressure() const = 0;
  virtual bool has_pressure() const = 0; // false: no buoyancy comes from it
  virtual std::optional<FlatBed> flat_bed() const { return {}; }
  // s, of the shortest wave; infinite where no period is known.
  virtual double shortest_period() const { return std::numeric_limits<double>::infinity(); }
};

} // namespace cdem
