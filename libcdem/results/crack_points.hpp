// Every bond of a model that can crack, seen alike: springs of interfaces between blocks, springs on the faces of meshes,
// points of freed faces of cohesive bodies.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

struct CrackPoint {
  int body = 0;                     // its number; n_bodies where the bond joins two bodies
  BondMode mode = BondMode::intact; // never contact
  double area = 0;                  // m2
  double damage = 0;                // D, 1 where it is broken
  double projection = 1;            // m.n: its area on the plane its law works on is projection * area
};

inline bool is_broken(BondMode mode) {
  return mode == BondMode::broken_tension || mode == BondMode::broken_shear;
}

inline CrackPoint crack_point(const Model& model, const State& state, int point) {
  const BondPoint& bond = model.points[point];
  const Interface& interface = model.interfaces[bond.interface];
  const int a = model.blocks[interface.block_a].body, b = model.blocks[interface.block_b].body;
  CrackPoint p;
  p.body = a == b ? a : static_cast<int>(model.bodies.size());
  p.mode = static_cast<BondMode>(state.bond_mode[point]);
  p.area = bond.area;
  if (interface.frame >= 0) { // what has broken, however much of it the faces still cover
    const InterfaceFrame& frame = model.frames[interface.frame];
    if (frame.renewed)
      p.area *= frame.size * frame.size / frame.area;
  }
  if (is_broken(p.mode))
    p.damage = 1;
  else if (!state.bond_damage.empty() && p.mode == BondMode::intact)
    p.damage = state.bond_damage[point];
  return p;
}

inline CrackPoint crack_point(const Model& model, const State& state, const MeshChunk& chunk,
                              const FaceSpringPlace& at) {
  CrackPoint p;
  p.body = model.blocks[chunk.block].body;
  p.mode = static_cast<BondMode>(state.faces[at.batch].mode[at.point][at.lane]);
  p.area = model.mesh.faces[at.batch].area[at.lane];
  if (is_broken(p.mode))
    p.damage = 1;
  if (model.bodies[p.body].bonding.is_cohesive()) {
    const CohesiveFace& face = state.cohesive[at.batch * lanes + at.lane];
    if (!holds(state.faces[at.batch].stage[at.lane]))
      p.projection = face.plane[2];
    if (p.mode == BondMode::intact)
      p.damage = face.damage[at.point];
  }
  return p;
}

// visit(CrackPoint) for every bond that is or was whole, in order.
template <class Visit>
void each_crack_point(const Model& model, const State& state, const Visit& visit) {
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p)
    if (state.bond_mode[p] != static_cast<std::uint8_t>(BondMode::contact))
      visit(crack_point(model, state, p));
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    if (state.faces[at.batch].mode[at.point][at.lane] != static_cast<std::uint8_t>(BondMode::contact))
      visit(crack_point(model, state, chunk, at));
  });
}

} // namespace cdem
