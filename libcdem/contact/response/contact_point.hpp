// A contact that acts: its law, its two blocks, and the nodes on which its forces act.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/geometry/edge_touch.hpp"
#include "libcdem/contact/response/contact_law.hpp"
#include "libcdem/state/state.hpp"
#include "libgeom/query/closest.hpp"

namespace cdem {

ContactLaw law_of(const Model&, const Contact&);
double normal_stiffness_of(const Model&, const Contact&); // N/m, of a spring or an edge

// Law of a spring, from its triangle and the triangle it is pressed into; law of two edges that cross, each with the means of
// its two triangles. The joint is that between their bodies. A rigid body has no compliance beside one that deforms.
ContactLaw spring_law(const Model&, const Joint&, double tan_friction, const ContactTriangle& from,
                      const ContactTriangle& to);
ContactLaw edge_law(const Model&, const Joint&, double tan_friction, const std::array<int, 2>& from,
                    const std::array<int, 2>& to);

// Means of a tetrahedron's faces and heights, undeformed. Two faces that lie on each other as they did in the mesh, pressed by their
// middles alone, are 4 times as stiff as the tetrahedra behind them, a corner in a face a quarter, as with semi-springs; in shear
// a pair is a third as stiff.
struct TetSize {
  double area = 0, height = 0; // m2, m
};
TetSize tet_size(const Model&, int tet);
struct TetPairLaw {
  double corner = 0; // N/m, of the potential (tet_potential.hpp)
  ContactLaw law;    // kn follows from force and energy of the moment
};
TetPairLaw tet_pair_law(const Model&, const Joint&, double tan_friction, int block, const TetSize& a,
                        const TetSize& b);

// Weights of a tetrahedron's corners that make up a place (m) within it; of one outside, those that are above 0 alone.
std::array<double, 4> within_tet(const Model&, const State&, const geom::Tet&, const geom::Vec3& place);

// The two blocks of a contact, its source's first.
std::pair<int, int> blocks_of(const Model&, const Contact&);

// Weights of a triangle's corners at the position of the semi-spring of one of them.
geom::Vec3 spring_weights(int corner);

// nearest: weights of the target's corners.
ContactArms spring_arms(const Model&, const State&, const ContactTriangle& from, int corner,
                        const ContactTriangle& to, const geom::Vec3& nearest);
ContactArms edge_arms(const Model&, const State&, const ContactEdge& source, const ContactEdge& target,
                      const NearestOfEdges&);
// Forces on the corners of a tetrahedron that turn it as a moment (N m) does, and together move it nowhere, N.
std::array<geom::Vec3, 4> forces_of_moment(const Model&, const State&, const geom::Tet&,
                                           const geom::Vec3& moment);
ContactArms arms_of(const Model&, const State&, const Contact&); // as the two stand now

geom::Vec3 velocity_past(const State&, const ContactArms&); // m/s, of the source past the target

} // namespace cdem
