// Where two semi-edges are nearest to each other, and whether they touch there.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/query/closest.hpp"

#include <optional>

namespace cdem {

// Two edges whose directions enclose an angle with a smaller sine are parallel: between their crossing and the next node
// one goes into the other by half a hundredth of an edge at most before the semi-springs there do.
inline constexpr double parallel_edges = 0.01;
// Sine of the angle by which a normal may be outside a fan: where faces lie flat on each other it is at the border, and
// rounding would put it in and out from step to step.
inline constexpr double fan_slack = 0.01;

struct NearestOfEdges {
  geom::PlacesOnSegments at;
  geom::Vec3 way; // m, from the first edge's place to the second's

  bool within_both() const { return at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1; }
};

inline NearestOfEdges nearest_of_edges(const Model& model, const State& state, const ContactEdge& e,
                                       const ContactEdge& f) {
  const geom::Vec3 a0 = place_of(model, state, e.nodes[0]), a1 = place_of(model, state, e.nodes[1]),
                   b0 = place_of(model, state, f.nodes[0]), b1 = place_of(model, state, f.nodes[1]);
  const auto at = geom::nearest_on_segments(a0, a1, b0, b1);
  return {at, b0 + at.t * (b1 - b0) - a0 - at.s * (a1 - a0)};
}

struct EdgeTouch {
  // Unit, out of the second edge's body: at right angles to both edges, but at an end along the line between the two
  // points.
  geom::Vec3 normal;
  double depth = 0; // m, > 0 where they touch
  double sense = 1; // of (first x second) . normal, 1 or -1
};

// None for parallel edges and where no common normal lies in the fans of outward normals of both (the Gauss map).
std::optional<EdgeTouch> touch_of(const Model&, const State&, const ContactEdge& e, const ContactEdge& f,
                                  const NearestOfEdges&);

// From an edge with its ends at x0 and x1 into its two faces, at right angles to it (m, a third of their height there).
std::array<geom::Vec3, 2> into_faces(const Model&, const State&, const ContactEdge&, const geom::Vec3& x0,
                                     const geom::Vec3& x1);

} // namespace cdem
