// Which tets of cohesive bodies may have a stress beyond a bound on the utilisation of their faces, eight side by side.
#pragma once

#include "libcdem/fracture/critical_plane.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/state.hpp"

#include <cstdint>
#include <vector>

namespace cdem {

// Pa2, s : s below which no stress is beyond any of the bounds: its mean is at most |s| / sqrt(3), its q at most |s| / sqrt(2).
double harmless_norm2(const std::vector<UtilisationBound>&);

// Writes the bits of NearStrength, per batch. steps_ahead: how many steps to go on at the rate of the last one. before: the stress
// of a step ago, or null.
void find_near(const StressBatch* stress, const StressBatch* before, std::int64_t count,
               const std::vector<UtilisationBound>&, double steps_ahead, std::uint8_t* bits);

// Per batch of tets of a chunk, 0: no stress is beyond the bounds, now or at its rate in the time `ahead`, s.
std::vector<char> loaded_batches(const Model&, const State&, const MeshChunk&,
                                 const std::vector<UtilisationBound>&, double ahead);

// Whether a stress, Pa, is beyond one of the bounds.
bool may_use(const std::vector<UtilisationBound>&, const geom::Mat3& stress);

} // namespace cdem
