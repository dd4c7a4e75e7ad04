// A Model and State as plain arrays for files and pictures.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

Snapshot make_snapshot(const Model&, const State&, const std::string& title);

} // namespace cdem
