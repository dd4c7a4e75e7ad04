// Explicit stepping in real time with the real masses (Han 2010 eqs 1 and 7, central differences).
//
// Stable for dt <= 2 / omega_max; Gershgorin: omega_max^2 <= max_i sum_j |K_ij| / m_i.
#pragma once

#include "libcdem/step/options.hpp"
#include "libcdem/step/stage.hpp"

namespace cdem {

// kind: what progress reports call it.
RunResult run(const StageContext&, const RunOptions&, const std::string& kind = "run");

// s; infinite when all blocks are rigid, whose nodes have no stiffness.
double stable_time_step(const Model&, const std::vector<ResolvedBolt>& = {});

} // namespace cdem
