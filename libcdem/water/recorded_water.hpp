// Water that another program has computed: velocity, pressure and water fraction on a regular grid at some times.
//
// Between grid points all is linear, and so it is in time. A column of the grid is wet where the water fraction is at least
// 1/2, which may be in several layers, such as a pool under a jet. The free surface at a place is the top of the layer that
// holds it, or of the next one below. Where no water lies on the bed, the surface of the nearest column with water there goes
// on, no higher than the bed. Above a layer velocities go on as they are below, and the pressure falls by rho g, so
// that cells that the surface crosses are not mixed with air. The acceleration Du/Dt comes from differences of the velocities
// between grid points and times. Pressures are those of the motion too, or hydrostatic below the surface where none is given.
#pragma once

#include "libcdem/water/plain_water.hpp"
#include "libcdem/water/water_over_bed.hpp"

#include <array>
#include <optional>
#include <vector>

namespace cdem {

struct WaterFrame {
  std::vector<geom::Vec3> velocity;       // m/s, at the grid points
  std::vector<double> pressure, fraction; // Pa above air, 0 (air) to 1 (water); empty: not given
  std::vector<char> known; // 0: the place is outside of the cells, such as inside a solid; empty: all are
};

struct WaterRecord {
  geom::Vec3 origin = geom::Vec3::Zero(), spacing = geom::Vec3::Ones(); // m
  // Points i + size[0] (j + size[1] k). One point along an axis: the same for all coordinates along it.
  std::array<int, 3> size{1, 1, 1};
  std::vector<double> times; // s, ascending; one: the same at all times
  std::vector<WaterFrame> frames;
  std::optional<double> level; // m, z of the surface where no fraction is given; none: water everywhere
  double density = 1025;       // kg/m3
  double gravity = standard_water_gravity;
};

class RecordedWater final : public WaterOverBed {
public:
  explicit RecordedWater(WaterRecord); // throws geom::InputError
  // Throws geom::InputError beside or below the grid, in water above it, and before its first or after its last time. Above the
  // grid there is air where a water fraction or a level below says so.
  WaterPoint at(const geom::Vec3& place, double time) const override;
  bool is_dry(const geom::Vec3& place, double time) const override;
  double density() const override { return record_.density; }
  double gravity() const override { return record_.gravity; }
  bool has_dynamic_pressure() const override { return with_pressure_; }
  bool has_pressure() const override { return with_pressure_ || with_surface_; }

  geom::Box box() const; // m, where it is known; infinite along an axis of one point
  const std::vector<double>& times() const { return record_.times; }
  // The first time and place at which a water fraction says that water reaches the top of the box, where it is cut.
  struct AtTop {
    double time = 0; // s
    geom::Vec3 place = geom::Vec3::Zero();
  };
  std::optional<AtTop> reaches_top() const;

private:
  struct Corner {
    std::size_t point = 0, column = 0;
    double share = 0;
    geom::Vec3 share_gradient = geom::Vec3::Zero(); // 1/m
  };
  struct Layer { // of water in a column, m; below the lowest there is only the bed: minus infinite
    double bottom = 0, top = 0;
    bool dry = false; // no water, but the surface of the water beside that goes on here
    bool meets(const Layer& other) const { return bottom <= other.top && other.bottom <= top; }
  };
  using Layers = std::vector<Layer>; // upwards
  struct Here {
    WaterPoint water;
    Layer layer;
  };
  struct Moment { // between two frames
    std::size_t first = 0, second = 0;
    double part = 0; // of the way
  };
  Moment moment(double time) const;
  std::size_t number(int i, int j, int k) const;
  std::size_t columns() const { return static_cast<std::size_t>(record_.size[0]) * record_.size[1]; }
  void fill_unknown(WaterFrame&) const;
  Layers find_layers(WaterFrame&, const std::vector<char>& known, int i, int j) const;
  void continue_over_dry(WaterFrame&, const std::vector<char>& known, std::vector<Layers>&) const;
  void find_accelerations();
  std::array<Corner, 8> corners(const geom::Vec3& place) const;
  double weight() const { return record_.density * record_.gravity; } // N/m3
  Here in_frame(std::size_t frame, const geom::Vec3& place) const;
  void require_known(const geom::Vec3& place, double time) const;

  WaterRecord record_;
  bool with_pressure_ = false, with_surface_ = false;
  double water_up_to_ =
      0; // m, z: that of the level, infinite without one; minus infinite where fractions tell
  std::vector<std::vector<Layers>> layers_;           // of each column at each time; the lowest is on the bed
  std::vector<std::vector<geom::Vec3>> acceleration_; // m/s2, at the grid points at each time
};

} // namespace cdem
