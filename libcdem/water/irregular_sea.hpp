// An irregular sea of long crests: Airy waves of random phase whose energy follows the spectrum JONSWAP (Hasselmann and
// others 1973), scaled to the significant height H = 4 sqrt(m0):
//
//   S(f) ~ f^-5 exp(-5/4 (f_p / f)^4) gamma^exp(-(f / f_p - 1)^2 / (2 s^2)),   s = 0.07 up to the peak f_p, 0.09 beyond
//
// Each component has a frequency anywhere in its own bin and a phase, both drawn from (seed, component): a sea depends on
// its seed alone, and does not repeat itself. Above still water the velocities are those of the depth z' that Wheeler (1970)
// stretches to the surface, z' = d (z - eta) / (d + eta).
#pragma once

#include "libcdem/water/water_field.hpp"

#include <cstdint>
#include <vector>

namespace cdem {

struct SeaGiven {
  double significant_height = 0;          // m
  double peak_period = 0;                 // s
  double depth = 0;                       // m, of still water
  double level = 0;                       // m, z of still water
  double peak_enhancement = 3.3;          // gamma
  geom::Vec3 direction{1, 0, 0};          // of travel; its horizontal part counts
  geom::Vec3 origin = geom::Vec3::Zero(); // where the phases are counted from
  int components = 100;                   // over 0.5 to 3 peak frequencies
  std::uint64_t seed = 1;
  double density = 1025; // kg/m3
  double gravity = 9.81; // m/s2
};

class IrregularSea final : public WaterField {
public:
  explicit IrregularSea(const SeaGiven&); // throws geom::InputError
  WaterPoint at(const geom::Vec3& place, double time) const override;
  double density() const override { return given_.density; }
  double gravity() const override { return given_.gravity; }
  bool has_dynamic_pressure() const override { return true; }
  bool has_pressure() const override { return true; }
  std::optional<FlatBed> flat_bed() const override {
    return FlatBed{given_.level - given_.depth, given_.level};
  }

  double shortest_period() const override { return given_.peak_period / 3; }

  struct Component {
    double amplitude = 0, omega = 0, wave_number = 0, phase = 0; // m, rad/s, 1/m, rad
  };
  const std::vector<Component>& components() const { return components_; }

private:
  SeaGiven given_;
  geom::Vec3 along_ = geom::Vec3::UnitX();
  std::vector<Component> components_;
};

} // namespace cdem
