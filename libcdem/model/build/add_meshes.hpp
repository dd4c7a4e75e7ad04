// From tetrahedral meshes to the mesh part of a Model: order, copies of nodes, chunks, bonded faces, boundary.
#pragma once

#include "libcdem/model/model.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

namespace cdem {

// One meshed solid: it becomes one block.
struct MeshSeed {
  std::int64_t id = 0; // of the block; 0: a new one
  int body = 0;
  geom::TetMesh mesh;
};

// After the star blocks are in. Bodies' materials, joints and bonding say what the tets and faces are.
void add_meshes(Model&, std::vector<MeshSeed>&&);

geom::Vec3 face_point(const Model&, const MeshChunk&, const FaceSpringPlace&); // m, undeformed

FaceLaw face_law(const Body&);
TetStiffness tet_stiffness(const Elastic&);

} // namespace cdem
