// Short edges and small faces of a star block would set the time step of the whole model.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// A block whose tets all share the node at its centroid.
struct StarMasses {
  std::vector<geom::Vec3> nodes; // m; the centroid last
  std::vector<geom::Tet> tets;   // over nodes
  std::vector<double> mass;      // kg (nodes.size())
};

// Moves mass of a star block from its centroid's node to nodes whose own stable step is short, so that no node has less
// than the step t, with
//   m_i >= K_i t^2 / 4,   K_i: row sum of |K| of the block's own tetrahedra
// t is half the median step of the block's nodes, or less, where a thousandth of the block's mass does not suffice for it. A
// corner at a short edge is light and stiff: that little mass lengthens the step of Voronoi cells 15 to 30 times. All masses
// are then tilted, m (1 - a . r), so that the centre of mass stays in the centroid. The mass of the block stays, and weights
// stay as they are.
void raise_light_corners(const Elastic&, StarMasses&);

void raise_light_corners(Model&, int block);

// Of joined blocks (join_blocks.hpp): regions whose tets share a node that no other region has, their stars. Each
// gives mass to its own light corners, whatever nodes are freed. mesh: that of the block, which was added last.
void raise_light_corners_of_regions(Model&, const geom::TetMesh& mesh, const Block&);

} // namespace cdem
