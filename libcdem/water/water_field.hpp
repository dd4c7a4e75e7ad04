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
  // Whether the pressure is that of the motion too: its integral over faces then holds the force that accelerated water
  // puts on a body at rest (Froude-Krylov). Otherwise it is hydrostatic or 0, and density x volume x acceleration is added.
  virtual bool has_dynamic_pressure() const = 0;
  virtual bool has_pressure() const = 0; // false: no buoyancy comes from it
  virtual std::optional<FlatBed> flat_bed() const { return {}; }
};

} // namespace cdem
