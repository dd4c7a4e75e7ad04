// In what direction each pair of tetrahedra pushes its first. Where a corner or an edge comes near an inner plane of the body that it
// stands in, that plane is the nearest and pushes it aside, and the tetrahedron beyond pushes it back; and an edge is that of
// several tetrahedra, each with one plane of the surface. So friction goes by the direction of all that presses from about the same
// side on one of the two.
#pragma once

#include "libcdem/contact/data/tet_contacts.hpp"
#include "libcdem/contact/narrow_phase/tet_question.hpp"

namespace cdem {

class PushDirections {
public:
  // force: N, on the first tetrahedron of each pair that is asked; 0: it does not press.
  PushDirections(const TetContacts&, const TetQuestion&, const std::vector<geom::Vec3>& force);

  geom::Vec3 of(std::size_t asked) const; // unit; 0: it does not press, or what presses cancels

private:
  geom::Vec3 by_tet(int tet, const geom::Vec3& force, double length) const;
  const TetContacts& contacts_;
  const TetQuestion& question_;
  const std::vector<geom::Vec3>& force_;
  std::vector<int> begin_;   // by tetrahedron, into on_tet_
  std::vector<Node> on_tet_; // N, forces on each tetrahedron; w: their lengths
};

} // namespace cdem
