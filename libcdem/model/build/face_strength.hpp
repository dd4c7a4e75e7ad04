// Which law a face of a mesh has, and how strong it is: that of its regions, and its draw of a strength that scatters.
// The draw depends on the seed and on where the face lies in the undeformed mesh, so that neither the numbering of
// nodes and tetrahedra nor the freeing of nodes changes it.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Some face of a mesh has another strength than its body's joint.
bool has_own_strengths(const Body&);
bool has_own_strengths(const Model&);

struct FaceStrength {
  int joint = -1;                            // into the body's region_laws; -1: the body's joint
  double tensile_strength = 0, cohesion = 0; // Pa
  double tan_friction = 0;
};

// corners: undeformed, m; volumes: of the tets on both sides, m3. A quarter of each belongs to the face.
FaceStrength face_strength(const Body&, int region_a, int region_b, const std::array<geom::Vec3, 3>& corners,
                           double volumes);

// Strength of an interface between blocks with these centroids. Its volume is that of the pyramids from it to both, m3.
double interface_strength(const Joint&, const geom::Vec3& centroid_a, const geom::Vec3& centroid_b,
                          double volume);

} // namespace cdem
