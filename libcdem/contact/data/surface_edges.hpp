// The semi-edges of the surfaces as they are now (geometry/semi_edges.hpp).
#pragma once

#include "libcdem/model/contact_surface.hpp"

namespace cdem {

// An edge in which the line of another continues over one of its ends.
struct EdgeBeyond {
  int edge = -1;
  double direction = 1; // 1 or -1: the line runs along the edge's own direction or against it
};

// The sides of all triangles of a block that has broken, by the edge of the mesh at which they stand, and the semi-edges found
// there, which stay as long as the same triangles are outside.
struct EdgesOfBroken {
  int block = 0;
  std::vector<int> sides;         // three times the triangle, and the corner from which it runs to the next
  std::vector<int> begin;         // by edge of the mesh, into sides; the last is the end
  std::vector<char> outside;      // per triangle of the block
  std::vector<ContactEdge> found; // by edge of the mesh
  std::vector<int> found_begin;   // likewise, into found
};

// Written by find_semi_edges, when faces have broken.
struct SurfaceEdges {
  std::vector<EdgesOfBroken> of_broken; // by block
  std::vector<ContactEdge> all;         // by id
  std::vector<int> begin;               // (n_triangles + 1) into `all`, by their first triangle
  // Per triangle and side of it, from its corner to the next: the triangle beyond the edge there; -1: no edge.
  std::vector<std::array<int, 3>> triangle_beyond;
  // Per edge: where the edges of its fragment that meet at its two ends begin in at_end.
  std::vector<std::array<int, 2>> ends;
  std::vector<int> at_end; // by end, each list closed by -1
  // Per edge and end: where the edges in which its line continues begin in `beyond`.
  std::vector<std::array<int, 2>> continues;
  std::vector<EdgeBeyond> beyond; // by edge and end, each list closed by -1
};

// Per edge, and per block: it had a contact of edges before the step. Written by mark_touched_edges.
struct EdgesTouched {
  std::vector<char> edges, blocks;
};

} // namespace cdem
