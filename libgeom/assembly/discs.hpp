// Joints of finite size: discs of a discrete fracture network cut the blocks they reach.
//
// A block that a disc reaches is cut by the disc's whole plane. A cut face with its centroid in the disc belongs to the
// disc's set. A face beyond the disc has no name: it is a rock bridge with the body's own joint. For finer bridges cut
// the rock into smaller blocks first.
#pragma once

#include "libgeom/assembly/assembly.hpp"

#include <cstdint>
#include <optional>

namespace geom {

inline constexpr std::size_t most_discs = 100000; // of a model

struct Disc {
  std::int64_t id = 0;
  Vec3 centre = Vec3::Zero(); // m
  double dip = 0;             // rad, 0..pi/2
  double dip_direction = 0;   // rad, 0..2 pi, clockwise from +y (north) seen from above
  double radius = 0;          // m, > 0
  std::string set = {};       // name of the faces
};

// Upward normal of a plane that dips towards dip_direction: x east, y north, z up.
Vec3 normal_of_dip(double dip, double dip_direction);

// Cuts that were moved, so that no corner of the block lay nearer to the plane than the clearance without lying on it.
struct MovedCuts {
  std::size_t count = 0;
  double farthest = 0; // m
};

// The discs in the order of their ids. `clearance` in m; 0 cuts exactly where the discs are; 1e-3 of each block's diagonal
// when left out: blocks thinner than that fail before the rock does and shorten the time step. Throws InputError naming the
// disc.
Assembly cut_by_discs(const Assembly&, std::vector<Disc>, std::optional<double> clearance = {},
                      MovedCuts* moved = nullptr);

// From a table with a first row of names, id, x, y, z, dip, dip_direction, radius, set in any order, commas between, angles
// in degrees. Throws InputError naming `file`, row and column.
std::vector<Disc> read_discs(const std::string& text, const std::string& file);

} // namespace geom
