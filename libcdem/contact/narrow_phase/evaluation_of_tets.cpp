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

using Heights = Eigen::Matrix<double, 4, 4>; // m, of nodes (columns) over planes (rows)

Heights heights_over(const TetShape& shape, const TetPlanes& planes, const TetPlanes& other) {
  Heights h;
  for (int k = 0; k < 4; ++k) {
    const geom::Vec3& foot = planes.x[shape.corners[k][0]];
    for (int i = 0; i < 4; ++i)
      h(k, i) = (other.x[i] - foot).dot(planes.normal[k]);
  }
  return h;
}

double parted(const Heights& h) {
  return h.rowwise().minCoeff().maxCoeff();
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

double Evaluation::springs_of_tet(int source_mover, int mover, const Eigen::Matrix4d& h) {
  const TetPairs& pairs = *work_.tet_pairs;
  const TetShape &from = pairs.shape[source_mover], &to = pairs.shape[mover];
  const bool all = work_.looks_at_all;
  double until = std::numeric_limits<double>::infinity();
  // Semi-springs at a node are about as far outside as the node: of most nodes this is all that is asked.
  std::array<bool, 4> near{};
  for (int i = 0; i < 4; ++i) {
    int plane = 0;
    const double most = h.col(i).maxCoeff(&plane),
                 outside = most - 2 * drawn_in * (most - std::min(most, h.row(plane).minCoeff()));
    near[i] = all || outside < shallow_ratio * to.height;
    if (!near[i])
      until = std::min(until, less_rounding(outside, to.height));
  }
  for (int t = 0; t < 4; ++t) {
    const int source = from.triangles[t];
    if (!keeps_tet_triangle(own_triangles_, source))
      continue;
    // The plane of the triangle that the source's face still holds; -1: none.
    const auto mate = std::find(to.triangles.begin(), to.triangles.end(), from.mates[t]);
    const int held = mate != to.triangles.end() && held_by_face(source, *mate)
                         ? static_cast<int>(mate - to.triangles.begin())
                         : -1;
    for (int corner = 0; corner < 3; ++corner) {
      const int i = from.corners[t][corner];
      if (!near[i])
        continue;
      const int j = from.corners[t][(corner + 1) % 3], l = from.corners[t][(corner + 2) % 3];
      const Eigen::Vector4d here = h.col(i) + drawn_in * ((h.col(j) - h.col(i)) + (h.col(l) - h.col(i)));
      int nearest = 0;
      const double most = here.maxCoeff(&nearest);
      const auto most_without = [&](int plane) {
        Eigen::Vector4d others = here;
        others[plane] = -std::numeric_limits<double>::infinity();
        return others.maxCoeff();
      };
      double waits = less_rounding(most, to.height);
      if (held >= 0) // nearest to the held triangle, on whichever side of it
        waits = std::max(waits, 0.5 * less_rounding(-most_without(held) - std::abs(here[held]), to.height));
      if (!all && waits > 0) {
        until = std::min(until, waits);
        continue;
      }
      const bool known = !all && most < 0 && less_rounding(most - most_without(nearest), to.height) > 0;
      until = std::min(
          until, spring_in_tet(source_mover, mover, source, corner, known ? to.triangles[nearest] : -1));
    }
  }
  return until;
}

// known: the nearest triangle; -1: it is to be found.
double Evaluation::spring_in_tet(int source_mover, int mover, int source, int corner, int known) {
  const ContactTriangle& from = surface_.triangles[source];
  const geom::Vec3 spring = weighted(corners_of(model_, state_, from.nodes), spring_weights(corner));
  Nearest found;
  if (known >= 0)
    found = nearest_on(known, spring, false);
  else
    for (const int target : work_.tet_pairs->shape[mover].triangles) {
      const Facet& y = facet(target);
      take_nearer(found, nearest_of(target, spring, y.x, y.normal), y.x, y.normal,
                  surface_.triangles[target].height, false);
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
  const double begins = shallow + work_.last_displacement[source_mover] + work_.last_displacement[mover];
  const bool may_begin = work_.any_depth_begins || work_.changed[source_mover] || work_.changed[mover] ||
                         found.distance2 <= begins * begins;
  old_ = state_.contacts.begin() + work_.tet_pairs->contact_begin[source];
  return add_contact(source, corner, spring, work_.fragment[found.target], found, may_begin) ? 0 : waits;
}

} // namespace cdem
