// The free field at a vertical side of a model: what the rock would do there if the model were not there, for waves that
// rise vertically. It depends on z and time only, so it is a column of layers in one dimension,
//
//   rho d2u/dt2 = d/dz (G du_x/dz, G du_y/dz, M du_z/dz)
//
// of lumped masses at its levels, with the foot of the model: its quiet boundary and the wave that enters there, or its
// support. The side is tied to it by dashpots and takes the column's stress,
//
//   t = Z (v_ff - v) + sigma_ff n,   sigma_ff: zz = M e_z, xx = yy = lambda e_z, xz = G g_x, yz = G g_y
//
// so that a plane wave that rises in both passes along the side as if there was none, and what the model sends towards
// the side leaves (Cundall and others' free field of UDEC and FLAC; here without its second, static part).
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/parallel/node.hpp"

#include <array>
#include <utility>
#include <vector>

namespace cdem {

struct ColumnLayer {
  double height = 0;                              // m
  double lambda = 0, shear = 0, p_modulus = 0;    // Pa
  double mass_damping = 0, stiffness_damping = 0; // 1/s, s; Rayleigh's alpha and beta
  double density = 0;                             // kg/m3
};

// A part of a face of the side.
struct ColumnShare {
  int node = 0;
  double area = 0; // m2
  int layer = 0;   // whose stress it takes
  int level = 0;   // the node moves with this level and the next, by `above`
  double above = 0;
  geom::Mat3 impedance = geom::Mat3::Zero(); // Z, Pa s/m
};

struct Column {
  int axis = 0; // of the side: 0 x, 1 y
  bool upper = false;
  std::vector<double> z; // m, of the levels, from the foot
  std::vector<ColumnLayer> layers;
  std::vector<double> mass; // kg/m2, of the levels
  std::vector<ColumnShare> shares;
  std::size_t first = 0; // level 0 in State::column_displacement
  std::size_t load = 0;  // the forces on the side in ResolvedConditions::varying

  // The foot: a dashpot with tractions that enter, Pa; components that are held move with their supports.
  geom::Vec3 foot_impedance = geom::Vec3::Zero(); // Pa s/m
  std::vector<std::pair<geom::Vec3, Amplitude>> entering;
  std::array<bool, 3> held{};
  std::array<std::pair<double, Amplitude>, 3> support{}; // m/s at amplitude 1
};

} // namespace cdem
