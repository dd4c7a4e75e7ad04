// The springs of an interface where its two faces overlap, and the tables that a model keeps of all springs.
#pragma once

#include "libcdem/model/model.hpp"
#include "libgeom/query/face_overlap.hpp"

namespace cdem {

// Appends the springs and triangles of one overlap, whose nodes are numbered as their blocks' are, and writes the
// interface's ranges. index: of the interface in the model.
void append_springs(Model&, int index, Interface&, const geom::FaceOverlap&);

// Writes point_chunks, bond_begin and bonds_on_nodes anew.
void index_springs(Model&);

} // namespace cdem
