// Names of what a .vtu of ours says about the whole snapshot; shared by its writer and its reader.
#pragma once

namespace cdem {

inline constexpr const char* time_name = "TimeValue"; // where ParaView looks for the time
inline constexpr const char* step_name = "step";
inline constexpr const char* title_name = "title";
inline constexpr const char* bodies_name = "body_names"; // by their numbers in cell field "body"

} // namespace cdem
