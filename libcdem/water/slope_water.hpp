// Waves that run up a slope: shallow water (shallow_water.hpp) along a bed, computed once when the field is made and kept
// over time. So it is a function of place and time, and a resumed run computes the same bits again.
//
// The velocity follows the bed below and the free surface above, linear between them. The pressure is hydrostatic under
// the sloping surface, and thereby that of the motion too: the equations have no other.
#pragma once

#include "libcdem/water/shallow_water.hpp"
#include "libcdem/water/water_over_bed.hpp"

#include <array>

namespace cdem {

struct SlopeGiven {
  std::vector<std::array<double, 2>>
      bed;          // m: distance along the direction, ascending, and z; straight between
  double level = 0; // m, z of still water
  std::function<double(double time)> entering; // m over still water, at the first point of the bed
  double duration = 0;                         // s
  double cell = 0;                             // m
  geom::Vec3 direction{1, 0, 0}, origin = geom::Vec3::Zero(); // horizontal; where the distance is 0
  double friction = 0.01;                                     // f
  double density = 1025, gravity = 9.81;                      // kg/m3, m/s2
};

class SlopeWater final : public WaterOverBed {
public:
  explicit SlopeWater(const SlopeGiven&); // throws geom::InputError
  // Throws geom::InputError beyond both ends of the bed, and after the duration.
  WaterPoint at(const geom::Vec3& place, double time) const override;
  bool is_dry(const geom::Vec3& place, double time) const override;
  double density() const override { return given_.density; }
  double gravity() const override { return given_.gravity; }
  bool has_dynamic_pressure() const override { return true; }
  bool has_pressure() const override { return true; }

  double run_up() const { return run_up_; }     // m, highest z that has been wet
  double run_down() const { return run_down_; } // m, lowest z of the water line
  double duration() const { return given_.duration; }

private:
  struct Column {                       // between two cells
    double surface = 0, bed = 0, u = 0; // m, m, m/s
    bool wet() const { return surface > bed; }
  };
  struct Where {
    double s = 0; // m, along the bed
    std::size_t frame = 0;
    double part = 0; // of the way to the next frame
  };
  Where where(const geom::Vec3& place, double time) const;
  Column column(std::size_t frame, double s) const;
  void compute(ShallowWater&);
  void keep(const ShallowWater&);

  SlopeGiven given_;
  geom::Vec3 along_ = geom::Vec3::UnitX();
  double frame_ = 0;        // s, between frames
  std::vector<double> bed_; // m, of the cells
  // m, m/s, of the cells at each frame; of a dry cell those of the nearest wet one, the surface no higher than the bed
  std::vector<std::vector<double>> surface_, u_;
  double run_up_ = 0, run_down_ = 0;
};

} // namespace cdem
