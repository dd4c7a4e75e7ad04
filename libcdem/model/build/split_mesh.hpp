// A mesh before it becomes part of the model, with its own numbers. Its nodes are split where faces may separate, and
// numbered by the first chunk that uses them.
#pragma once

#include "libcdem/model/build/face_strength.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

namespace cdem {

// A mesh whose nodes are split along its bonded faces, in its own numbers.
struct SplitMesh {
  std::vector<geom::Tet> tets; // over copies of nodes
  std::vector<int> original;   // per copy: node of the mesh
};

// Which nodes of a mesh stay one whatever their faces, and which faces part the others.
struct Splitting {
  const geom::TetMesh& mesh;
  const Bonding& bonding;
  const std::vector<char>& freed;

  bool whole(int node) const {
    return bonding.none() || (bonding.is_cohesive() && (freed.empty() || freed[node] == 0));
  }
  bool parts(const geom::InnerFace& face) const {
    return bonding.bonds(mesh.region[face.tets[0]], mesh.region[face.tets[1]]) &&
           !(whole(face.nodes[0]) && whole(face.nodes[1]) && whole(face.nodes[2]));
  }
};

SplitMesh split_mesh(const geom::TetMesh&, const std::vector<geom::InnerFace>&, const Splitting&);

struct BondedFace {
  geom::InnerFace face;
  double kn = 0, area = 0; // of one spring
  FaceStrength strength;   // where some have their own
};

std::vector<BondedFace> bonded_faces(const geom::TetMesh&, const std::vector<geom::InnerFace>&, const Body&,
                                     const Splitting&, bool with_strength);

// Throws geom::InputError where a face that may crack would store more at its strength than its fracture energy.
void require_fracture_energy(const geom::TetMesh&, const std::vector<geom::InnerFace>&, const Body&);

// Numbers the copies that tets have again, chunk by chunk: first those that no other chunk uses. Returns their number for each
// chunk.
// both_sides: the tets of side b ask for the nodes of side a too.
std::vector<std::int64_t> inner_first(SplitMesh&, const std::vector<BondedFace>&, int chunk_tets,
                                      bool both_sides);

double tet_volume(const geom::TetMesh&, int tet); // m3

} // namespace cdem
