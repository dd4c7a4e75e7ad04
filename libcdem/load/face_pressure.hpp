// A pressure on outer faces that may vary from place to place, such as that of a reservoir:
//
//   force on node i = -n * integral of p N_i over the uncovered part of the face
//
// N_i is the shape function of the node in its triangle. What another block covers is subtracted as the integral over the
// triangles of the interface, as for a uniform traction (model/build/build_model.cpp). Below a level p = weight (level - z) is
// linear: a triangle is cut at the level, and the midpoints of edges integrate p N_i exactly; under a table that is a plane
// too. Under any other table each of sixteen parts of a triangle is cut so, and any other p is taken at their midpoints. Undeformed places; the pressure does not follow the faces.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/model/model.hpp"

namespace cdem {

// Node, N. faces: into Model::outer_faces.
std::vector<std::pair<int, geom::Vec3>> pressure_pattern(const Model&, const std::vector<int>& faces,
                                                         const FacePressure&);

} // namespace cdem
