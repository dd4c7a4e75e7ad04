// Rotation R of the interface of two blocks, from the undeformed interface to its present position.
//
// Each side gives the normal n of three of its nodes and the image t of one direction fixed in the undeformed face. The
// interface turns as the two sides do in the mean:
//   n <- n_a / |n_a| - n_b / |n_b|,   t <- t_a + t_b less its part along n,   R = [n t n x t] [N T N x T]^T
// Springs keep their law in the undeformed directions: with the relative displacement j from a to b they see R^T j and
// pull with R f (joint/spring_law.hpp), so that no rigid motion of the two blocks together strains them.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// The identity for an interface that does not turn.
geom::Mat3 interface_rotation(const Model&, const Node* displacement, const Interface&);

// The angle between the normals of the two sides, rad; 0 for an interface that does not turn.
double interface_opening_angle(const Model&, const Node* displacement, const Interface&);

// From where side a of a spring stands to where side b does, in the interface's undeformed directions, m.
geom::Vec3 local_jump(const Model&, const std::vector<Node>& displacement, int point);

// By how much side b has moved past side a since the two were built, m, likewise: what results show as opening and slip.
geom::Vec3 movement_past(const Model&, const State&, int point);

} // namespace cdem
