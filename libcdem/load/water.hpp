// Water in joints: a pressure p at the points of interfaces. It pushes the two faces apart. The springs, with all their
// laws, carry the effective traction (Terzaghi 1936), tension positive,
//
//   t' = t + p n
//
// The pressure is evaluated once, at undeformed positions, and stays until it is set again. A point has the mean over
// the triangles around it, weighted by its shape function. So the force of the water is right where a face reaches
// above the water. An interface of blocks that move far loses its water once it is left to contact and has opened or
// slid by a twentieth of its size (bond/release.hpp). Newly cut faces are dry.
#pragma once

#include "libcdem/model/selection.hpp"
#include "libcdem/state/state.hpp"

#include <memory>
#include <optional>

namespace cdem {

class WaterTable; // load/water_table.hpp

struct Water {
  Selection on;                  // points of interfaces
  std::vector<std::string> sets; // names of joint sets and cuts; empty: all interfaces that are not glued
  std::optional<double> level;   // m, z of a level water table: p = weight (level - z), no less than 0
  double weight = 9810;          // N/m3
  std::function<double(const geom::Vec3&)> pressure; // Pa, >= 0; without level and table
  std::shared_ptr<const WaterTable> table{}; // in place of the level: p = weight times the depth below it
};

struct WaterInJoints {
  std::int64_t points = 0; // under pressure
  double area = 0;         // m2, of these
  double largest = 0;      // Pa
  double force = 0;        // N, sum of pressure times area
};

// The rows of {z, pressure}, straight between them and constant beyond the ends, as a function of the place. Throws
// geom::InputError unless z rises and the pressures are >= 0.
std::function<double(const geom::Vec3&)> pressure_over_height(std::vector<std::array<double, 2>> rows);

// Sets the pressure of the selected points; the others keep theirs. Throws geom::InputError. Returns all the water there is.
WaterInJoints set_water(const Model&, State&, const Water&);

} // namespace cdem
