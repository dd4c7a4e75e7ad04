#include "apps/cdem/commands/sweep_charts.hpp"

#include "libcdem/vtk/chart.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>

namespace cdem::app {
namespace {

std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    return std::nullopt;
  return value;
}

// The parameter whose values are numbers, with the most of them; empty: none has two.
std::string parameter_of_axis(const std::vector<SweptFigures>& runs) {
  std::string chosen;
  std::size_t most = 1;
  for (const auto& entry : runs.front().set) {
    const std::string& name = entry.first;
    std::set<double> values;
    bool numbers = true;
    for (const SweptFigures& run : runs) {
      const auto value = number_in(run.set.at(name));
      numbers = numbers && value;
      if (value)
        values.insert(*value);
    }
    if (numbers && values.size() > most) {
      most = values.size();
      chosen = name;
    }
  }
  return chosen;
}

std::string others(const Settings& set, const std::string& axis) {
  std::string text;
  for (const auto& [name, value] : set)
    if (name != axis)
      text += (text.empty() ? "" : ", ") + name + " = " + value;
  return text;
}

std::string file_name(const std::string& figure) {
  std::string name = "sweep_";
  for (const char c : figure)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
  return name + ".png";
}

struct Point {
  double x = 0, y = 0;
  std::optional<double> reference;
};

void add_series(const std::string& name, std::vector<Point> points, std::vector<Series>& all) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
  Series series;
  series.name = name;
  series.style = "both";
  for (const Point& point : points) {
    series.x.push_back(point.x);
    series.y.push_back(point.y);
  }
  all.push_back(std::move(series));
}

} // namespace

std::string unit_of_parameter(const std::vector<SweptFigures>& runs, const std::string& name) {
  for (const SweptFigures& run : runs)
    for (const Parameter& parameter : run.parameters)
      if (parameter.name == name)
        return parameter.unit;
  return "";
}

std::vector<std::string> draw_sweep(const std::vector<SweptFigures>& runs,
                                    const std::filesystem::path& folder,
                                    const std::function<void(const std::filesystem::path&)>& will_write) {
  std::vector<std::string> files;
  const std::string axis = parameter_of_axis(runs);
  if (axis.empty())
    return files;
  std::vector<std::string> names, units; // of figures, in the order they come
  for (const SweptFigures& run : runs)
    for (const Figure& figure : run.figures)
      if (number_in(figure.value) && std::find(names.begin(), names.end(), figure.name) == names.end()) {
        names.push_back(figure.name);
        units.push_back(figure.unit);
      }
  for (std::size_t i = 0; i < names.size() && files.size() < most_sweep_charts; ++i) {
    std::map<std::string, std::vector<Point>> lines; // by the other parameters
    std::vector<Point> references;
    for (const SweptFigures& run : runs)
      for (const Figure& figure : run.figures) {
        const auto value = number_in(figure.value);
        if (figure.name != names[i] || !value)
          continue;
        const Point point{*number_in(run.set.at(axis)), *value, number_in(figure.reference)};
        lines[others(run.set, axis)].push_back(point);
        if (point.reference)
          references.push_back(point);
      }
    const bool one_line = lines.size() == 1;
    if (lines.size() > most_sweep_lines || lines.begin()->second.size() < 2)
      continue;
    std::vector<Series> all;
    for (const auto& [name, points] : lines)
      add_series(one_line && !references.empty() ? "cdem" : name, points, all);
    if (one_line && references.size() == lines.begin()->second.size()) {
      for (Point& point : references)
        point.y = *point.reference;
      add_series("reference", references, all);
      all.back().style = "dashed";
    }
    ChartOptions options;
    options.x_label = name_with_unit(axis, unit_of_parameter(runs, axis));
    options.y_label = name_with_unit(names[i], units[i]);
    const std::filesystem::path file = folder / file_name(names[i]);
    will_write(file);
    chart(all, options, file.string());
    files.push_back(file.filename().string());
  }
  return files;
}

} // namespace cdem::app
