// Semi-springs of two fragments that are single tetrahedra.
//
// Let h_k be the height of a semi-spring over plane k of the other tetrahedron. Then
//
//   it is outside by at least max h_k;
//   inside it is nearest to the triangle with the largest h_k, at the depth -max h_k.
//
// h_k is linear, so the heights of the four nodes give those of all semi-springs.
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/narrow_phase/evaluation.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

using Heights = std::array<std::array<double, 4>, 4>; // m, over each plane, of each node

Heights heights_over(const TetShape& shape, const TetPlanes& planes, const TetPlanes& other) {
  Heights h;
  for (int k = 0; k < 4; ++k) {
    const geom::Vec3 &foot = planes.x[shape.corners[k][0]], &n = planes.normal[k];
    for (int i = 0; i < 4; ++i)
      h[k][i] = (other.x[i].x() - foot.x()) * n.x() + (other.x[i].y() - foot.y()) * n.y() +
                (other.x[i].z() - foot.z()) * n.z();
  }
  return h;
}

double least_of(const std::array<double, 4>& h) {
  return std::min(std::min(h[0], h[1]), std::min(h[2], h[3]));
}
double most_of(const std::array<double, 4>& h) {
  return std::max(std::max(h[0], h[1]), std::max(h[2], h[3]));
}

double parted(const Heights& h) {
  return std::max(std::max(least_of(h[0]), least_of(h[1])), std::max(least_of(h[2]), least_of(h[3])));
}

// m, by which all semi-springs at each node stand outside, at least.
std::array<double, 4> outside_at_nodes(const Heights& h) {
  std::array<double, 4> outside;
  outside.fill(-std::numeric_limits<double>::infinity());
  for (int k = 0; k < 4; ++k) {
    const double others = 2 * drawn_in * least_of(h[k]);
    for (int i = 0; i < 4; ++i)
      outside[i] = std::max(outside[i], (1 - 2 * drawn_in) * h[k][i] + others);
  }
  return outside;
}

// m, of what rounding takes from distances.
double less_rounding(double distance, double height) {
  return distance * (1 - 16 * same_place) - 8 * same_place_at_least * height;
}

} // namespace

double Evaluation::tets(int a, int b) {
  const TetPairs& pairs = *work_.tet_pairs;
  const TetShape &shape_a = pairs.shape[a], &shape_b = pairs.shape[b];
  const TetPlanes &now_a = pairs.now[a], &now_b = pairs.now[b];
  const double height = std::max(shape_a.height, shape_b.height);
  const Heights of_b_over_a = heights_over(shape_a, now_a, now_b),
                of_a_over_b = heights_over(shape_b, now_b, now_a);
  const double apart = std::max(parted(of_b_over_a), parted(of_a_over_b));
  if (!work_.looks_at_all && apart > shallow_ratio * height)
    return less_rounding(apart, height);
  return std::min(springs_of_tet(a, b, of_a_over_b), springs_of_tet(b, a, of_b_over_a));
}

double Evaluation::springs_of_tet(int source_mover, int mover,
                                  const std::array<std::array<double, 4>, 4>& h) {
  const TetPairs& pairs = *work_.tet_pairs;
  const TetShape &from = pairs.shape[source_mover], &to = pairs.shape[mover];
  const bool all = work_.looks_at_all;
  double until = std::numeric_limits<double>::infinity();
  // Semi-springs at a node are about as far outside as the node: of most nodes this is all that is asked.
  const std::array<double, 4> outside = outside_at_nodes(h);
  std::array<bool, 4> near{};
  for (int i = 0; i < 4; ++i) {
    near[i] = all || outside[i] < shallow_ratio * to.height;
    if (!near[i])
      until = std::min(until, less_rounding(outside[i], to.height));
  }
  for (int t = 0; t < 4; ++t) {
    const std::array<std::uint8_t, 3>& corners = from.corners[t];
    const int source = from.triangles[t];
    if (!(near[corners[0]] || near[corners[1]] || near[corners[2]]) ||
        !keeps_tet_triangle(own_triangles_, source))
      continue;
    // The plane of the triangle that the source's face still holds; -1: none.
    int held = -1;
    for (int k = 0; k < 4; ++k)
      if (to.triangles[k] == from.mates[t] && held_by_face(source, to.triangles[k]))
        held = k;
    for (int corner = 0; corner < 3; ++corner) {
      const int i = corners[corner], j = corners[(corner + 1) % 3], l = corners[(corner + 2) % 3];
      if (!near[i])
        continue;
      std::array<double, 4> here;
      for (int k = 0; k < 4; ++k)
        here[k] = (1 - 2 * drawn_in) * h[k][i] + drawn_in * (h[k][j] + h[k][l]);
      const auto most_without = [&](int plane) {
        std::array<double, 4> others = here;
        others[plane] = -std::numeric_limits<double>::infinity();
        return most_of(others);
      };
      const double most = most_of(here);
      double waits = less_rounding(most, to.height);
      if (held >= 0) // nearest to the held triangle, on whichever side of it
        waits = std::max(waits, 0.5 * less_rounding(-most_without(held) - std::abs(here[held]), to.height));
      if (!all && waits > 0) {
        until = std::min(until, waits);
        continue;
      }
      const auto nearest = static_cast<int>(std::find(here.begin(), here.end(), most) - here.begin());
      const bool known = !all && most < 0 && less_rounding(most - most_without(nearest), to.height) > 0;
      until = std::min(until, spring_in_tet(mover, source, corner, known ? to.triangles[nearest] : -1));
    }
  }
  return until;
}

// known: the nearest triangle; -1: it is to be found.
double Evaluation::spring_in_tet(int mover, int source, int corner, int known) {
  const ContactTriangle& from = surface_.triangles[source];
  const geom::Vec3 spring = weighted(corners_of(model_, state_, from.nodes), spring_weights(corner));
  Nearest found;
  if (known >= 0)
    found = nearest_on(known, spring, same_place_at_least);
  else
    for (const int target : work_.tet_pairs->shape[mover].triangles) {
      const Facet& y = facet(target);
      take_nearer(found, nearest_of(target, spring, y.x, y.normal), y.x, y.normal,
                  surface_.triangles[target].height, same_place_at_least);
    }
  if (!found.inside() || held_by_face(source, found.target))
    return 0;
  const ContactTriangle& to = surface_.triangles[found.target];
  const double shallow = std::min(work_.shallow[from.block], work_.shallow[to.block]),
               covered = 2 * depth_limit(work_, from, to);
  // Deeper than a contact may begin: until it has come out so far.
  const double waits = std::max(0.0, 0.5 * (std::sqrt(found.distance2) - shallow));
  if (found.distance2 > covered * covered)
    return waits;
  old_ = state_.contacts.begin() + work_.tet_pairs->contact_begin[source];
  return add_contact(source, corner, spring, work_.fragment[found.target], found,
                     begins_at(source, found.target, shallow))
             ? 0
             : waits;
}

} // namespace cdem
