// Springs of interfaces eight at a time: what a step reads of them, side by side, copied once from Model. Batches stand
// in the order of the springs and none reaches over the end of a chunk; the lanes behind the last spring are empty.
#pragma once

#include "libcdem/joint/mohr_coulomb.hpp"
#include "libcdem/model/model.hpp"

namespace cdem {

// What the springs of an interface share: (normal, tan of the friction angle) and (kn, ks, tensile strength, cohesion), Pa/m and
// Pa; the strengths are infinite where nothing may break. One line of a cache.
struct alignas(64) InterfaceNumbers {
  Node normal, stiffness;
};

struct alignas(64) SpringBatch {
  int node_a[lanes], node_b[lanes]; // where both sides sit on a node
  int interface[lanes];
  int ends = -1;  // into SpringBatches::ends where some spring's do not sit on nodes
  int apart = -1; // into SpringBatches::apart where some spring's sides did not lie on each other undeformed
  int count = 0;  // springs
  bool turns = false; // some interface may turn
  bool plain = true;  // brittle bonds and contacts with friction: nothing softens or has a law of its own
  double area[lanes]; // m2
};

struct SpringEnds {
  int node_a[3][lanes], node_b[3][lanes];
  double weight_a[3][lanes], weight_b[3][lanes];
};

struct SpringsApart {
  double apart[3][lanes]; // m, Model::point_apart
};

// Eight interfaces side by side: edges of the undeformed sides, m, and the rest of InterfaceFrame. Those that do not turn get sides
// that never move.
struct FrameBatch {
  int node_a[3][lanes], node_b[3][lanes];
  double edge_a[2][3][lanes], edge_b[2][3][lanes];
  double along_a[2][lanes], along_b[2][lanes];
  double axes[3][3][lanes]; // normal, along, third
  bool turns = false;
};

struct SpringBatches {
  std::vector<SpringBatch> springs;
  std::vector<InterfaceNumbers> interfaces; // (n_interfaces)
  std::vector<std::int64_t> first;          // batch of each chunk of springs, and the end
  std::vector<SpringEnds> ends;
  std::vector<Range> nodes; // of the blocks that each chunk of springs meets first: those on sides b
  std::vector<SpringsApart> apart;
  std::vector<FrameBatch> frames; // of the interfaces, eight by eight; empty where none turns
};

// strength, plain: of each interface.
SpringBatches spring_batches(const Model&, const std::vector<SpringStrength>& strength,
                             const std::vector<char>& plain);

} // namespace cdem
