// Chains of semi-edges: which pairs of edges act, and which take over the stored energy of another pair.
//
// Two edges that meet at a node continue each other if the angle between them is less than 45 degrees. Where two chains
// cross, their nearest points act, as a spring acts with the nearest point of a surface. These points lie within both
// edges, or at an end where the chain continues. If a chain crosses another twice, in and out again, these are two
// crossings.
#pragma once

#include "libcdem/contact/data/surface_edges.hpp"
#include "libcdem/contact/geometry/edge_touch.hpp"
#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

// Two edges whose directions enclose an angle with a smaller sine lie along each other, as the outlines of blocks in rows.
inline constexpr double edges_in_line = 0.01;

class EdgeLines {
public:
  EdgeLines(const Model&, const State&, const SurfaceEdges&, const EdgesTouched&);

  // Contact of two edges, by their numbers, e < f. None if they do not touch, if one ends at the nearest points and its
  // chain does not continue, or if a pair of the same crossing is nearer: a pair with one of the two edges, touching or
  // not, or a pair of two other edges that touch.
  std::optional<EdgeTouch> active(int e, int f, const NearestOfEdges&, const Contact* old = nullptr) const;

  // The contact that the two edges, or others which continue them, have just left behind, as if it were that of e and f: the one
  // that presses the most of those that these two take over. An edge that only meets an end, as at the corner of a face, is
  // another line: it would press aside.
  std::optional<Contact> left_behind(int e, int f, const geom::Vec3& normal) const;

  const Contact* contact_of(int e, int f) const; // before the step

  // Whether the two edges, or others which continue them, had a contact before the step.
  bool carry_together(int e, int f) const;

  // Whether any edge that meets an end of the one, or that edge itself, had a contact before the step, and of the other.
  bool touched_around(int e, int f) const;

  // Whether the line of an edge goes straight on through this corner of a triangle, into what the normal leads out of, and
  // the edge carried in a contact with the other block before the step, no further from the semi-spring there, m, than twice
  // as deep as the two edges are in each other. The semi-springs of the node are in the other block then because the edge is, and
  // would push along the face that happens to be nearest.
  bool carries_at(int triangle, int corner, const geom::Vec3& spring, const geom::Vec3& normal,
                  int other_block) const;

  // Whether the place, in parts of the edge, is at an end of it where no other edge goes on.
  bool at_last_end(int edge, double place) const;
  // Whether another edge crosses the line of an edge near its end, in the last part of it or within this distance, m, and does
  // not cross what goes on there in the same sense: it cuts off a corner, or nothing goes on.
  bool cuts_off_end(int edge, double place, int by, double within) const;

private:
  int edge_with(int id) const; // -1: there is none
  NearestOfEdges nearest(int e, int f) const;
  // Calls does(next, way) for the edges that continue an edge over one of its ends, until it returns true; way: 1 or
  // -1, with or against their own direction. Returns whether it did.
  template <typename Does>
  bool any_next(int edge, int end, const Does& does) const;
  template <typename Does>
  bool any_of_line(int edge, const Does& does) const; // of the edge itself, too
  bool goes_on(int edge, double place, int other) const;
  bool far_from_ends(int edge, double place, double distance) const;
  bool nearer(int e, int f, const NearestOfEdges&, int than_e, int than_f, const NearestOfEdges& than) const;
  std::vector<int> line_of(int edge) const; // that edge, and those that continue it
  // True if, among all new contacts around that of `from` and `to`, the contact of e and f has the normal most like the
  // old one.
  bool takes_over(int e, int f, const geom::Vec3& normal, int from, int to, const geom::Vec3& before) const;

  const Model& model_;
  const ContactSurface& surface_;
  const State& state_;
  const SurfaceEdges& edges_;
  const EdgesTouched& touched_;
  std::vector<Contact>::const_iterator contacts_; // the first of two edges before the step
};

} // namespace cdem
