// Charts of a sweep: every figure that is a number over the parameter with the most values.
#pragma once

#include "apps/cdem/commands/commands.hpp"
#include "apps/cdem/results/records.hpp"

#include <functional>

namespace cdem::app {

struct SweptFigures {
  Settings set;
  std::vector<Figure> figures = {};       // none: the run failed
  std::vector<Parameter> parameters = {}; // likewise
};

std::string unit_of_parameter(const std::vector<SweptFigures>&, const std::string& name); // "": not known

// sweep_FIGURE.png in the folder, at most most_sweep_charts. One line for each combination of the other parameters, the
// reference dashed where all runs have the same. Nothing where no parameter has two numbers. will_write is told of each
// file first. Returns the names of the files.
std::vector<std::string> draw_sweep(const std::vector<SweptFigures>&, const std::filesystem::path& folder,
                                    const std::function<void(const std::filesystem::path&)>& will_write);

inline constexpr std::size_t most_sweep_charts = 12, most_sweep_lines = 8;

} // namespace cdem::app
