// The part of a Model that bodies meshed with tetrahedra make: finite-volume tets that share nodes, and bonds between
// the two sides of inner faces where a joint was asked for (Feng 2014 section 2).
//
// A copy of a node is a connected component of the tets around it through faces without bonds: where every face is
// bonded each tet has its own four nodes, where none is the nodes are those of the mesh. In a cohesive body a face is
// bonded in this sense once one of its nodes has been freed (fracture/split_nodes.hpp), and only freed nodes have copies.
//
// Tets are stored in the order of a Hilbert curve, nodes in the order of their first use. A chunk is a run of tets. It
// owns the nodes that it is the first to use; nodes that no other chunk uses (inner) come first. It lists the other
// nodes that it needs. It sums the forces of its tets and faces, moves its inner nodes, and writes the other forces to
// its own slice of an array of partial forces. The owner of a node adds these in a fixed order. Nothing is written
// twice.
#pragma once

#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"
#include "libgeom/core/types.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

// Eight tets of one chunk. Lanes past the chunk's last tet repeat its first one and are given no stiffness.
struct alignas(64) MeshBatch {
  std::uint16_t place[4][lanes]; // of the nodes among those of the chunk
};

// Eight bonded faces of one chunk: corner i of side a against corner i of side b, counter-clockwise seen from b.
// Lanes past the last face repeat the first one with kn = 0.
struct alignas(32) FaceBatch {
  double kn[lanes];                                   // N/m, of one of the face's three springs
  double area[lanes];                                 // m2, of one of them: a third of the face
  std::uint16_t place_a[3][lanes], place_b[3][lanes]; // of the nodes among those of the chunk
};

// Strengths of eight bonded faces that have strengths of their own (model/build/face_strength.hpp).
struct alignas(64) FaceStrengthBatch {
  double tensile_strength[lanes], cohesion[lanes]; // Pa
  double tan_friction[lanes];
  std::int32_t joint[lanes]; // into the body's region_laws; -1: the body's joint
};

// Eight freed faces of cohesive bodies, seen from a tet of the chunk: corner i of its own against corner i beyond the face,
// counter-clockwise seen from outside. A face between two tets of one chunk stands there once, one between two chunks in each
// of them. Lanes past the last face repeat the first one with face = -1.
struct alignas(64) FaceSideBatch {
  std::int32_t tet[lanes];                         // batch * lanes + lane, from the chunk's first batch on
  std::int32_t beyond_tet[lanes];                  // the same of the tet beyond; -1: it is in another chunk
  std::int32_t face[lanes];                        // batch * lanes + lane in MeshData::faces
  std::uint16_t place[3][lanes], beyond[3][lanes]; // of the nodes among those of the chunk
};

struct MeshChunk {
  int block = 0; // the first of `blocks`; all are of one body
  Range blocks;  // whole convex blocks, or the one block that this is a part of
  bool stars =
      false;   // whole convex blocks: no node is touched by another chunk, and bonds may act on all of them
  Range nodes; // its own, the inner ones first
  std::int64_t inner_end = 0; // of those: nodes that no other chunk touches
  Range others;               // into MeshData::others: further nodes it touches
  Range tets;                 // of the model
  Range batches;              // into MeshData::batches
  Range face_batches;         // into MeshData::faces
  int faces = 0;              // in them
  Range side_batches;         // into MeshData::sides
  Range partial; // its slice of the partial forces: its own nodes but the inner ones, then the others
  std::int64_t share_begin = 0; // into MeshData::share_begin: its own nodes but the inner ones

  std::int64_t places() const { return nodes.size() + others.size(); } // own nodes, then others
};

struct BoundaryTriangle {
  geom::Triangle nodes{}; // of the model, counter-clockwise seen from outside
  int tet = 0;
  int block = 0;
  int face = -1; // of a convex block: the one it is a part of
};

// The two tets at a bonded face, in the place batch * lanes + lane.
struct FaceTets {
  int tet_a = -1, tet_b = -1; // -1: an empty lane
};

struct MeshData {
  int first_node = 0,
      first_tet = 0; // of the model; those before belong to blocks with star meshes, all without meshes
  std::vector<MeshBatch> batches;
  std::vector<FaceBatch> faces;
  std::vector<FaceTets> face_tets;         // (faces.size() * lanes)
  std::vector<FaceStrengthBatch> strength; // (faces.size()); empty: all faces are as their body's joint says
  std::vector<FaceSideBatch> sides;        // of cohesive bodies
  std::vector<MeshChunk> chunks;
  std::vector<int> tet_slot; // (n mesh tets) batch * lanes + lane
  std::vector<int> others;   // nodes of the model
  std::vector<int> original; // (n mesh nodes) one number for all copies of a node
  std::vector<int> region;   // (n mesh tets) of the mesh they come from
  std::vector<char> freed; // (n mesh nodes) 1: faces around it may have parted; empty without cohesive bodies
  // Into the body's PlasticLaws, batch * lanes + lane; -1: elastic. Empty without plastic bodies.
  std::vector<std::int8_t> plastic_law;
  // The partial forces that add up to the force of a node that several chunks use, in order: into `shares`.
  std::vector<int> share_begin, shares;
  std::vector<BoundaryTriangle> boundary;
  // Those that were given a name, by body and name: into `boundary`, ascending. They say where conditions are, not what
  // the model is: neither hashed nor saved.
  std::map<std::pair<int, std::string>, std::vector<int>> named;

  bool empty() const { return batches.empty(); }
  int node_at(const MeshChunk& chunk, int place) const { // of the model
    return static_cast<int>(place < chunk.nodes.size()
                                ? chunk.nodes.begin + place
                                : others[chunk.others.begin + place - chunk.nodes.size()]);
  }
};

// The nodes of the model at the corners of a bonded face, those of a and b against each other: counter-clockwise seen
// from b.
struct FaceNodes {
  geom::Triangle a{}, b{};
  geom::Triangle outward_b() const { return {b[0], b[2], b[1]}; } // counter-clockwise seen from a
};

inline FaceNodes face_nodes(const MeshData& mesh, const MeshChunk& chunk, std::int64_t batch, int lane) {
  FaceNodes nodes;
  for (int i = 0; i < 3; ++i) {
    nodes.a[i] = mesh.node_at(chunk, mesh.faces[batch].place_a[i][lane]);
    nodes.b[i] = mesh.node_at(chunk, mesh.faces[batch].place_b[i][lane]);
  }
  return nodes;
}

// visit(tet of the model, place of the face in MeshData::faces, its nodes, those beyond) for each side of each freed
// face; the nodes counter-clockwise seen from outside the tet.
template <class Visit>
void each_side(const MeshData& mesh, const Visit& visit) {
  for (const MeshChunk& chunk : mesh.chunks)
    for (std::int64_t b = chunk.side_batches.begin; b < chunk.side_batches.end; ++b)
      for (int lane = 0; lane < lanes && mesh.sides[b].face[lane] >= 0; ++lane) {
        geom::Triangle own{}, beyond{};
        for (int i = 0; i < 3; ++i) {
          own[i] = mesh.node_at(chunk, mesh.sides[b].place[i][lane]);
          beyond[i] = mesh.node_at(chunk, mesh.sides[b].beyond[i][lane]);
        }
        const auto first = static_cast<int>(chunk.tets.begin), face = mesh.sides[b].face[lane];
        visit(first + mesh.sides[b].tet[lane], face, own, beyond);
        if (const int other = mesh.sides[b].beyond_tet[lane]; other >= 0)
          visit(first + other, face, geom::Triangle{beyond[0], beyond[2], beyond[1]},
                geom::Triangle{own[0], own[2], own[1]});
      }
}

// One spring of a bonded face.
struct FaceSpringPlace {
  std::int64_t batch = 0;
  int point = 0, lane = 0;
};

// visit(chunk, batch, lane) for every bonded face, in order.
template <class Visit>
void each_face(const MeshData& mesh, const Visit& visit) {
  for (const MeshChunk& chunk : mesh.chunks)
    for (int face = 0; face < chunk.faces; ++face)
      visit(chunk, chunk.face_batches.begin + face / lanes, face % lanes);
}

// visit(chunk, place) for every spring, in order.
template <class Visit>
void each_face_spring(const MeshData& mesh, const Visit& visit) {
  each_face(mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    for (int point = 0; point < 3; ++point)
      visit(chunk, FaceSpringPlace{batch, point, lane});
  });
}

} // namespace cdem
