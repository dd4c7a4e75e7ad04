// From tetrahedral meshes to the mesh part of a Model: order, copies of nodes, chunks, bonded faces, boundary.
#pragma once

#include "libcdem/model/build/split_mesh.hpp"
#include "libcdem/model/model.hpp"
#include "libgeom/mesh/block_mesh.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

namespace cdem {

// One connected part of a mesh: it becomes one block.
struct MeshSeed {
  std::int64_t id = 0; // of the block; 0: a new one
  int body = 0;
  int unit = 0; // 0: a new one
  geom::TetMesh mesh;
  bool ordered = false;         // its tets and nodes stand in their order already
  std::vector<char> freed = {}; // per node, of a cohesive body; empty: none
};

// A seed in its order, split along its bonded faces.
struct MeshPart {
  MeshSeed seed;
  geom::MassProperties mass;
  std::vector<BondedFace> bonded; // by first tet, then its face
  SplitMesh split;
  std::vector<geom::OuterFace> outer; // by tet, then face; their nodes are not needed
};

// Nodes and tets that are added from now on belong to MeshData.
void start_meshes(Model&);

// The convex blocks that move far, whose tets stand in the model already: chunks of whole blocks of one body, and their
// faces as boundary. meshes: of all convex blocks; tets and nodes numbered from those of the block.
void add_convex_blocks(Model&, const std::vector<geom::BlockMesh>& meshes);

// After the convex blocks are in. Bodies' materials, joints and bonding say what the tets and faces are.
void add_meshes(Model&, std::vector<MeshSeed>&&);

// The same part by part, where faces and copies of nodes are known; after the last one, what goes over all of them.
void add_part(Model&, MeshPart&&);
void end_parts(Model&);

geom::Vec3 face_point(const Model&, const MeshChunk&, const FaceSpringPlace&); // m, undeformed

} // namespace cdem
