// Size and motion of every fragment: the pieces that unbroken bonds hold together (bond/fragments.hpp).
//
// With the masses m of the nodes (a quarter of each tetrahedron around them), or mass and inertia of rigid bodies,
//   M = sum m,  c = sum m x / M,  P = sum m v,  L = sum m (x - c) x v
//   translation = P.P / 2M,  rotation = L . I^-1 L / 2,  rest = kinetic - translation - rotation
// I: inertia about c. The rest is vibration. Sums over fragments of M, P and the kinetic energy are those of the model.
#pragma once

#include "libcdem/results/fragment.hpp"

#include <vector>

namespace cdem {

struct Model;
struct State;
struct ResolvedConditions;

struct FragmentMotion : Fragment {
  int body = -1;                                     // its number; -1: parts of several bodies hang together
  double diameter = 0;                               // m, of the sphere with its volume
  double mass = 0;                                   // kg
  geom::Vec3 centre = geom::Vec3::Zero();            // m, c, now
  geom::Vec3 momentum = geom::Vec3::Zero();          // N s
  geom::Vec3 angular_momentum = geom::Vec3::Zero();  // N m s, about c
  double kinetic = 0, translation = 0, rotation = 0; // J
  double rest() const { return kinetic - translation - rotation; }
};

// As fragments(): largest first; equal ones in the order of their first node.
std::vector<FragmentMotion> fragment_motions(const Model&, const State&, const ResolvedConditions&);

// Cumulative distribution: a row for each fragment, smallest first, with the part of the mass in fragments up to its
// diameter.
struct PassingRow {
  double diameter = 0; // m
  double passing = 0;  // 0 .. 1 of the mass
};
std::vector<PassingRow> mass_passing(const std::vector<FragmentMotion>&);

} // namespace cdem
