// The pressure field of bodies that touch: the tetrahedra near the surface of each block with a potential phi, m, linear in
// each: 0 on the surface, the distance to it (undeformed) at inner nodes.
//
// Where all nodes of an inner edge, face or tetrahedron lie on the surface, phi would be 0 in the midst of the body. Such
// dead places are split at a further node, the mean of their 2, 3 or 4 nodes, which moves with them.
#pragma once

#include <array>
#include <vector>

namespace cdem {

// Nodes of cells: those of the model, then the means, from n_nodes on.
struct MeanNode {
  std::array<int, 4> of{}; // nodes of the model, all on the surface; the first `count`
  int count = 0;
};

struct FieldCell {
  std::array<int, 4> nodes{};  // positive volume
  std::array<double, 4> phi{}; // m
  double volume6 = 0;          // m3, six times the volume, undeformed
  double slope = 1;            // |grad phi|, undeformed: a depth is phi / slope
  double compliance = 0;       // h / E, m/Pa, of the tetrahedron it is part of
};

struct ContactField {
  std::vector<MeanNode> means;
  std::vector<FieldCell> cells;    // by block
  std::vector<int> mean_begin;     // (n_blocks + 1) into means
  std::vector<int> cell_begin;     // (n_blocks + 1) into cells
  std::vector<double> compliance;  // m/Pa, per block, of its outer triangles the median
  std::vector<double> edge_length; // m2, per edge of ContactSurface: w L0 (contact/field/edge_in_tet.hpp)

  bool empty() const { return cell_begin.empty(); }
};

} // namespace cdem
