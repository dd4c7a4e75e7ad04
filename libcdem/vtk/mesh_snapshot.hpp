// A bare mesh of tetrahedra as a snapshot, to be drawn and written for ParaView before there is a model of
// it.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libgeom/mesh/boundary.hpp"

namespace cdem {

using geom::NamedFaces;

// Cell fields: "region", "radius_ratio" (1 regular, 0 flat), "min_dihedral" degrees, "volume" m3; point
// fields: "on_<name>", 1 on the nodes of the named faces. Edges of the surface are outlined where it has a
// corner of more than `crease` (radians; below 0: every edge of the surface mesh).
Snapshot mesh_snapshot(const geom::TetMesh&, const NamedFaces&, double crease);

// For pictures: gives the named faces of the surface points of their own, so that "on_<name>" ends at their
// edges instead of fading over the faces around them. `faces` are those that `named` refers to.
void set_apart(Snapshot&, const std::vector<geom::OuterFace>& faces, const NamedFaces& named);

// The mesh in a file written by write_vtu. Throws geom::InputError as read_vtu does, and when the mesh is not
// valid.
geom::TetMesh read_vtu_mesh(const std::string& path);

} // namespace cdem
