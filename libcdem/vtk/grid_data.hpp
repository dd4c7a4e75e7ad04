// Between snapshots and VTK's unstructured grids; shared by the writer and the reader of .vtu files.
#pragma once

#include "libcdem/results/snapshot.hpp"

namespace cdem {

// Names of the field data of our files; ParaView reads the time from the first.
inline constexpr const char* time_name = "TimeValue";
inline constexpr const char* step_name = "step";
inline constexpr const char* title_name = "title";

} // namespace cdem
