// State of the springs of an interface, as fields over one of its faces. New springs, which stand where the faces
// overlap now, take their state from these fields. The fields are linear over the triangles of the interface. Outside
// the triangles they have the value of the nearest point.
//
//   preload and dilation    o.n, the normal part of the offset: the pressure follows from it and from where the faces stand
//   elastic shear           (j - o)_s, so that the shear traction goes on
//   slip, path, dilation, damage, water, usual pressure and rest    as they are
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

struct SpringMemory {
  double preload = 0;                    // m, normal part of the offset
  geom::Vec3 shear = geom::Vec3::Zero(); // m, elastic, in undeformed directions
  geom::Vec3 slid = geom::Vec3::Zero();  // m, of side b past side a since both were built, likewise
  JointHistory history;
  geom::Vec3 bond_slip = geom::Vec3::Zero(); // m
  double damage = 0;
  double water = 0; // Pa
  double usual = 0; // Pa, usual_force over the area
  double rested = 0;
  std::uint8_t mode = 0;
};

class InterfaceMemory {
public:
  InterfaceMemory(const Model&, const State&, const Interface&);

  const geom::Mat3& rotation() const { return rotation_; }
  double mean_pressure() const { return mean_pressure_; } // Pa, over all of its area
  // The preload is the same everywhere, to a hundredth of the mean closure: where the faces stand says all about the
  // pressure.
  bool evenly_preloaded() const { return evenly_preloaded_; }
  // The fields at a spring of a model with the same blocks or parts of them. Its place on the face that the interface
  // covered more of counts.
  SpringMemory at(const Model&, int point) const;

private:
  geom::Mat3 rotation_; // of the interface
  double mean_pressure_ = 0;
  bool evenly_preloaded_ = true, on_b_ = false;
  std::vector<geom::Vec3> places_; // undeformed, m
  std::vector<geom::Triangle> triangles_;
  std::vector<SpringMemory> springs_;
};

// Undeformed place of a spring on one of its sides, m.
geom::Vec3 place_on_side(const Model&, int point, bool side_b);

} // namespace cdem
