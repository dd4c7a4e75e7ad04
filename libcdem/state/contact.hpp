// One contact that acts: a semi-spring pressed into a target face, or a semi-edge into a target edge, and what it
// remembers from step to step (Feng 2014 eqs 15-17).
#pragma once

#include "libgeom/core/types.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace cdem {

struct Contact {
  enum Kind : std::uint32_t { spring, edge, tets };
  std::uint32_t kind : 2;
  // 3 triangle + corner; of an edge where it starts on the first of its triangles; of a pair of tetrahedra the first of them.
  std::uint32_t source : 30;
  // For a spring: the target's block, or its fragment once the block has broken; one contact for each. For an edge: its
  // own second triangle. For tetrahedra: the target.
  std::int32_t fragment = 0;
  std::int32_t target = 0;                // triangle; of an edge as source; tetrahedron
  std::int32_t beside = 0;                // of an edge the second triangle of the target
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, out of the target
  geom::Vec3 shear = geom::Vec3::Zero();  // Fs, N, on the source
  geom::Vec3 widening =
      geom::Vec3::Zero(); // m2/m, growth of `area` per slip, as flat faces slide past each other
  // m, depth at which it carries nothing: it was found that deep.
  double reference_penetration = 0;
  double depth = 0;       // m, below the target's surface
  double damping = 0;     // N, what restitution adds to the spring's normal force
  double at_rest = 0;     // m, mean effective penetration over the last one or two oscillations
  double peak = 0;        // m, largest effective penetration; fades as that mean
  double usual_force = 0; // N, mean of its normal force over some ten oscillations
  double felt_force = 0;  // N, the same over two thirds of one
  double stiffness = 0;   // N/m, of its normal spring (as_stiff_as); 0: that of its law
  double from_end = 1;    // x of a crossing near an end of its edges (contact_law.hpp); 1: none is near
  double area = 0;        // m2, for which it stands on a flat face (face_cover.hpp); 0: on another

  explicit Contact(Kind of = spring, int from = 0)
      : kind(of & 3u), source(static_cast<std::uint32_t>(from) & 0x3fffffffu) {}

  double effective_penetration() const { return std::max(0.0, depth - reference_penetration); } // m
};

// The two triangles of a contact of springs or edges, its source's first; of edges the first of each.
inline std::pair<int, int> triangles_of(const Contact& c) {
  return {static_cast<int>(c.source) / 3, c.kind == Contact::spring ? c.target : c.target / 3};
}

// Contacts are sorted by it: of a spring one for each fragment, of an edge one for each other edge, of a tetrahedron one for
// each other.
inline auto key(const Contact& c) {
  return std::tuple(static_cast<int>(c.kind), static_cast<int>(c.source), c.fragment,
                    c.kind == Contact::edge ? c.target : 0);
}

// A contact of a deformable body that has opened a short time ago. If it closes again, it goes on with its means.
struct OpenedContact {
  Contact last{};  // as it was before it opened
  double left = 0; // s, until it is forgotten
};
inline auto key(const OpenedContact& opened) {
  return key(opened.last);
}

// Those of one key, as fragments that are numbered anew may leave, stay in their order.
template <class Kept>
void sort_by_key(std::vector<Kept>& contacts) {
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Kept& a, const Kept& b) { return key(a) < key(b); });
}

} // namespace cdem
