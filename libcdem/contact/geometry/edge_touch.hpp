// Where two semi-edges are nearest to each other, and whether they touch there.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/query/closest.hpp"

#include <optional>

namespace cdem {

// Two edges whose directions enclose an angle with a smaller sine are nearly parallel. Their common normal would turn with
// every small motion, and they press on each other along a stretch: the middle of the stretch is where they touch, and the
// normal is that along which their two wedges part the most.
inline constexpr double parallel_edges = 0.01;
// Sine of the angle by which both faces of nearly parallel edges must fall away from the normal: where faces lie flat on
// each other, their semi-springs press and not their outlines.
inline constexpr double clear_of_faces = 0.05;
// Sine of the angle by which a normal may be outside a fan: where faces lie flat on each other it is at the border, and
// rounding would put it in and out from step to step.
inline constexpr double fan_slack = 0.01;

struct NearestOfEdges {
  geom::PlacesOnSegments at;
  geom::Vec3 way; // m, from the first edge's place to the second's
  bool nearly_parallel = false;
  std::optional<geom::Vec3>
      normal; // of nearly parallel edges that reach into each other, out of the second one's body
  // Part of each edge that bears: nearly parallel edges bear where they run beside each other.
  std::array<double, 2> parts{1, 1};

  bool within_both() const { return at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1; }
};

// The nearest places of two edges; of nearly parallel ones that reach into each other the middle of where they do.
NearestOfEdges nearest_of_edges(const Model&, const State&, const ContactEdge& e, const ContactEdge& f);

struct EdgeTouch {
  // Unit, out of the second edge's body: at right angles to both edges, but at an end along the line between the two
  // points, and between the wedges of nearly parallel edges.
  geom::Vec3 normal;
  double depth = 0; // m, > 0 where they touch
  double sense = 1; // of (first x second) . normal, 1 or -1
};

// None where no common normal lies in the fans of outward normals of both (the Gauss map).
std::optional<EdgeTouch> touch_of(const Model&, const State&, const ContactEdge& e, const ContactEdge& f,
                                  const NearestOfEdges&);

// The way, m, from the first edge to the second leads into the first one's body, and back into the second one's.
bool leads_into_both(const Model&, const State&, const ContactEdge& e, const ContactEdge& f,
                     const geom::Vec3& way);

// From an edge with its ends at x0 and x1 into its two faces, at right angles to it (m, a third of their height there).
std::array<geom::Vec3, 2> into_faces(const Model&, const State&, const ContactEdge&, const geom::Vec3& x0,
                                     const geom::Vec3& x1);

// Unit, of two nearly parallel edges, out of the second one's body: between the middles of their fans, at right angles to
// `along` (unit). None where a face of one of them does not fall away from it by an angle of a sine above `clear`.
std::optional<geom::Vec3> normal_between(const std::array<geom::Vec3, 2>& into_e,
                                         const std::array<geom::Vec3, 2>& into_f, const geom::Vec3& along,
                                         double clear);

} // namespace cdem
