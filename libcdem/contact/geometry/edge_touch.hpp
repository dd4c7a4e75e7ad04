// Where two semi-edges are nearest to each other, and whether they touch there.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/query/closest.hpp"

#include <optional>

namespace cdem {

// Two edges whose directions enclose an angle with a smaller sine are nearly parallel. Their common normal would turn with
// every small motion, and they press on each other along a stretch. From this angle on a stretch is shorter than an edge, as deep
// as edges may get, and the edges bear as those do that cross.
inline constexpr double parallel_edges = 0.05;
// Sine of the angle by which both faces of nearly parallel edges must fall away from the normal: where faces lie flat on
// each other, their semi-springs press and not their outlines.
inline constexpr double clear_of_faces = 0.05;
// Sine of the angle by which a normal may be outside a fan: where faces lie flat on each other it is at the border, and
// rounding would put it in and out from step to step.
inline constexpr double fan_slack = 0.01;
// The same of a contact that goes on: where an edge turns over a face, the contact at one outline opens while that at the other one
// closes. Without this it would end as deep as it is.
inline constexpr double fan_slack_of_old = 0.1;

// How two nearly parallel edges press on each other where they reach into each other. They store an energy U, and the derivative
// of U by their motion is a force F at one place, and a moment beside it.
struct EdgeStretch {
  geom::Vec3 normal; // unit, out of the second one's body: direction of F on the first
  geom::Vec3 place;  // m
  double lever = 0;  // m, of the moment on the first edge about the normal, over F
  double depth = 0;  // m, 2 U / F
  // Part of the stiffness of a crossing: F^2 / 2 U, where the square of the depth is twice the area.
  double share = 0;
  double measure = 0; // that square over twice the area, as the two wedges stand now
};

struct NearestOfEdges {
  geom::PlacesOnSegments at;
  geom::Vec3 way; // m, from the first edge's place to the second's
  bool nearly_parallel = false;
  std::optional<EdgeStretch> stretch; // of nearly parallel edges that reach into each other

  bool within_both() const { return at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1; }
};

// The nearest places of two edges; of nearly parallel ones that reach into each other those where their force acts.
NearestOfEdges nearest_of_edges(const Model&, const State&, const ContactEdge& e, const ContactEdge& f);

struct EdgeTouch {
  // Unit, out of the second edge's body: at right angles to both edges, but at an end along the line between the two
  // points, and of nearly parallel edges that of their stretch.
  geom::Vec3 normal;
  double depth = 0; // m, > 0 where they touch
  double sense = 1; // of (first x second) . normal, 1 or -1
};

// None where no common normal lies in the fans of outward normals of both (the Gauss map). old_normal: of a contact that they had
// before the step.
std::optional<EdgeTouch> touch_of(const Model&, const State&, const ContactEdge& e, const ContactEdge& f,
                                  const NearestOfEdges&, const geom::Vec3* old_normal = nullptr);

// The way, m, from the first edge to the second leads into the first one's body, and back into the second one's.
bool leads_into_both(const Model&, const State&, const ContactEdge& e, const ContactEdge& f,
                     const geom::Vec3& way);

// From an edge with its ends at x0 and x1 into its two faces, at right angles to it (m, a third of their height there).
std::array<geom::Vec3, 2> into_faces(const Model&, const State&, const ContactEdge&, const geom::Vec3& x0,
                                     const geom::Vec3& x1);

// The normal of two nearly parallel edges, out of the second one's body: from the middle of the first fan to that of the second, at right
// angles to `along` (unit).
geom::Vec3 way_between_fans(const std::array<geom::Vec3, 2>& into_e, const std::array<geom::Vec3, 2>& into_f,
                            const geom::Vec3& along);
// By which sine all four faces fall away from this normal at least; below 0: one does not.
double falls_away(const std::array<geom::Vec3, 2>& into_e, const std::array<geom::Vec3, 2>& into_f,
                  const geom::Vec3& normal);
// Unit, of two nearly parallel edges, out of the second one's body: between the middles of their fans, at right angles to
// `along` (unit). None where a face of one of them does not fall away from it by an angle of a sine above `clear`.
std::optional<geom::Vec3> normal_between(const std::array<geom::Vec3, 2>& into_e,
                                         const std::array<geom::Vec3, 2>& into_f, const geom::Vec3& along,
                                         double clear);

} // namespace cdem
