// Surface of meshed bodies for contact: their outer triangles, the faces along which bonds may open, and the edges
// where the surface turns outwards (Feng 2014 section 2.2).
//
// Every triangle carries three semi-springs, its corners drawn in a little, each with a third of its area; every such
// edge is a semi-edge. Inner faces of the mesh take no part unless their bonds have broken.
#pragma once

#include "libcdem/joint/joint.hpp"
#include "libgeom/core/types.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace cdem {

struct ContactTriangle {
  geom::Triangle nodes{}; // of the model, counter-clockwise seen from outside
  int block = 0;
  int tet = 0;           // that it bounds
  int face = -1;         // of a bonded inner face: batch * lanes + lane in MeshData::faces; -1: an outer one
  int mate = -1;         // the triangle on that face's other side
  int left = -1;         // law that a joint of its own leaves here (into Model::joints); -1: none
  double area = 0;       // m2, undeformed
  double height = 0;     // h, m, of its tet above it, undeformed
  double compliance = 0; // h / E, m/Pa: what a pressure on it presses the tet together by
};

// A convex edge between two triangles; it belongs to the first.
struct ContactEdge {
  std::array<int, 2> nodes{};     // along the first triangle's boundary
  std::array<int, 2> triangles{}; // ascending
  int corner = 0;                 // of the first triangle, where it starts

  int id() const { return 3 * triangles[0] + corner; }
};

// Two blocks that an interface with a law of its own holds: what they have once they have parted.
struct BlockPairLaw {
  std::array<int, 2> blocks{}; // the smaller first
  int joint = 0;               // index into Model::joints
};

struct ContactSurface {
  std::vector<ContactTriangle> triangles; // by block, outer ones first
  std::vector<ContactEdge> edges;         // between outer ones, by id
  std::vector<int> block_begin;           // (n_blocks + 1) into triangles
  std::vector<double> usual_height;       // m, per block, of the tets at its outside the median; 0: none
  std::vector<int> original;              // (n_nodes) one number for all copies of a node
  // Bodies (smaller first) -> index into Model::joints, the law of their contact.
  std::map<std::pair<int, int>, int> joint;
  // Body -> the law of what one of its meshes breaks into, where that is not the one of its parts (index into Model::joints).
  std::map<int, int> within;
  // Law of an interface -> the law of the contact that it leaves, where that is not the one of its bodies (indices into
  // Model::joints).
  std::map<int, int> left_by;
  std::vector<BlockPairLaw> pairs; // by blocks

  bool empty() const { return triangles.empty(); }
};

} // namespace cdem
