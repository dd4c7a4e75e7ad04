// Checks whether a mesh resolves the process zone of its softening faces.
//
//   l_ch = E' G_I / T^2,   E' = E / (1 - nu^2)          (Hillerborg, Modeer and Petersson 1976)
//   cohesive zone of a full-grown crack: 0.88 l_ch      (Rice 1979: 9 pi / 32)
//   at least three faces in it                          (Turon, Davila, Camanho and Costa 2007, Eng. Fract. Mech. 74)
//
// A face is as long as the edge of an equilateral triangle of its area; between blocks, of a square.
#pragma once

#include "libcdem/model/model.hpp"

#include <string>
#include <vector>

namespace cdem {

inline constexpr double cohesive_zone = 0.88, least_faces_in_zone = 3;

struct ProcessZone {
  std::string of;               // "bar", or "bar" regions 1 and 2, or "a" and "b", as messages call them
  double length = 0;            // l_ch, m; medians over the faces
  double face_size = 0;         // m
  double largest_face_size = 0; // that serves, m: 0.88 l_ch / 3
  double faces_in_zone() const { return cohesive_zone * length / face_size; }
  bool resolved() const { return face_size <= largest_face_size; }
};

// m; modulus: E', Pa.
double process_zone_length(double modulus, double fracture_energy, double tensile_strength);

// Process zones of each body and pair of bodies with a law that softens, by body; one for each law if a body has
// several.
std::vector<ProcessZone> process_zones(const Model&);

} // namespace cdem
