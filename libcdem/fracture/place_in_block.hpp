// Where an undeformed place lies among the tets of a block, and the stress there.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

Eigen::Vector4d weights_in_tet(const Model&, int tet, const geom::Vec3& place); // barycentric

int tet_at(const Model&, const Block&, const geom::Vec3& place); // that holds the place best

// Pa, mean over the tets that hold the place, so that mirror images stay mirror images; of the whole block where none does.
geom::Mat3 stress_at(const Model&, const State&, int block, const geom::Vec3& place);

} // namespace cdem
