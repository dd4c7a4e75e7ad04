// Which tetrahedra of a broken body hang together, and so cannot touch.
//
// Around a node of the undeformed mesh its tetrahedra hang together over nodes that they share and over faces that are
// not loose. Each such set is a *joint* of the node. Two tetrahedra may touch unless they have a joint in common, or a face
// that its own springs still hold. Two that hang together over loose faces too, which their own springs hold, are still
// *in place*. Only the nodes of faces that have come loose or were handed over are looked at anew.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

class TetJoints {
public:
  TetJoints() = default;
  // paired: per block, those whose tetrahedra are asked about.
  TetJoints(const Model&, const State&, const std::vector<char>& paired);

  // Looks at faces that have come loose or were handed over since. Returns the tetrahedra around their nodes, ascending.
  std::vector<int> update(const Model&, const State&);

  bool may_touch(int tet_a, int tet_b) const;
  bool in_place(int tet_a, int tet_b) const;
  // The undeformed node at a corner, and whether it lies on the outside or has several joints.
  int node(int tet, int corner) const { return node_[4 * (tet - first_) + corner]; }
  bool is_outside(int node) const { return outside_[node] != 0; }
  // Planes of a tetrahedron at the outside or at a loose face, a bit each, by the corner opposite.
  std::uint8_t open_planes(int tet) const;
  bool is_split(int node) const { return split_[node] != 0; }
  int nodes() const { return static_cast<int>(split_.size()); }

private:
  void join_around(const Model&, int node);

  int first_ = 0;                            // tet of the mesh
  std::vector<int> node_, joint_, place_of_; // four per tet; place_of_: joints over loose faces too
  std::vector<std::uint8_t> outer_;   // per tet: planes at the outside, a bit each
  std::vector<std::int64_t> face_;    // four per tet, by the corner opposite: batch * lanes + lane; -1: none
  std::vector<int> fan_begin_, fan_;  // per node: 4 * (tet - first) + corner
  std::vector<char> outside_, split_; // per node
  std::vector<std::uint8_t> seen_;    // per face: HandOver when it was last looked at
  std::vector<FaceTets> tets_;        // per face
  std::vector<int> place_;            // per tet, in the fan that is looked at
};

// The same of all tetrahedra of the mesh, as State has it now.
std::vector<std::uint8_t> open_planes(const Model&, const State&);

} // namespace cdem
