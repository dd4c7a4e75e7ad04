// Stress of eight tets side by side.
#pragma once

#include "libcdem/parallel/node.hpp"

#include <array>

namespace cdem {

using Stress = std::array<double, 6>; // Pa, tension positive: xx yy zz xy yz xz

struct alignas(64) StressBatch {
  double component[6][lanes]; // Pa, in the order of Stress
};

struct alignas(64) PlasticStrainBatch {
  double strain[lanes];
};

struct alignas(64) TimeBatch {
  double time[lanes]; // s
};

} // namespace cdem
