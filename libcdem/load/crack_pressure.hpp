// Pressure of a gas or a fluid on the faces of cracks of cohesive bodies. A face takes it as it opens: of the area A with
// the normal n from side a to side b the damaged part D is wet,
//
//   force on side a = -p D A n,   on side b = p D A n
//
// with D the mean damage of the face's points (joint/softening.hpp; 1 of a brittle face that has cracked) and A n the mean
// of both sides where they stand. p is given over time. Or a fluid with the bulk modulus K fills a reservoir of the volume
// V_0 and the cracks, into which V(t) has been pumped:
//
//   p = max(0, K (V(t) - V_c) / V_0),   V_c = sum over the wet faces of D A n . (mean opening)
//
// The fluid loses no pressure on its way. V_c is that of the beginning of the step.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

class SharedState; // ranks/shared_state.hpp

struct CrackLoad {
  CrackPressure given;
  std::vector<char> faces; // batch * lanes + lane: 1 takes it
  double pressure = 0;     // Pa, now
  double before = 0;       // Pa, a step earlier
};

// Throws geom::InputError where `on` holds no face of a cohesive body that may crack.
CrackLoad resolve(const Model&, const State&, const CrackPressure&);

// Pressures at `time`. shared: of several ranks each measures its own cracks; null: one measures all.
void update_crack_pressures(const Model&, const State&, const SharedState* shared, double time,
                            std::vector<CrackLoad>&);

// Adds the forces on the nodes of a chunk (N, per place). Returns their work in the last `step` seconds, J.
double add_crack_pressures(const Model&, const State&, const MeshChunk&, const std::vector<CrackLoad>&,
                           const Node* position, const Node* velocity, double step, Node* force);

// m3, of the cracks that take the load.
double crack_volume(const Model&, const State&, const CrackLoad&);

} // namespace cdem
