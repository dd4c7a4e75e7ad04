// Discs of a fracture network from a table.
#include "libgeom/assembly/discs.hpp"

#include "libgeom/core/error.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

namespace geom {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr std::size_t longest_name = 64;
constexpr std::array names{"id", "x", "y", "z", "dip", "dip_direction", "radius", "set"};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  for (std::string& cell : cells) {
    const auto first = cell.find_first_not_of(" \t\r\""), last = cell.find_last_not_of(" \t\r\"");
    cell = first == std::string::npos ? "" : cell.substr(first, last - first + 1);
  }
  return cells;
}

// The column of each name.
std::array<std::size_t, names.size()> columns_of(const std::vector<std::string>& head,
                                                 const std::string& file) {
  std::array<std::size_t, names.size()> column{};
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::size_t found = 0;
    for (std::size_t c = 0; c < head.size(); ++c)
      if (head[c] == names[n]) {
        column[n] = c;
        ++found;
      }
    if (found != 1)
      throw InputError("file \"" + file + "\": " + (found == 0 ? "no" : "more than one") + " column \"" +
                       names[n] +
                       "\"; its first row must name id, x, y, z, dip, dip_direction, radius and set");
  }
  return column;
}

struct Row {
  const std::string& file;
  int number;
  const std::vector<std::string>& cells;
  const std::array<std::size_t, names.size()>& column;

  const std::string& cell(std::size_t name) const { return cells[column[name]]; }
  [[noreturn]] void refuse(std::size_t name, const std::string& allowed) const {
    throw InputError("file \"" + file + "\": row " + std::to_string(number) + ", " + names[name] + " = \"" +
                     cell(name).substr(0, longest_name) + "\": must be " + allowed);
  }
  double value(std::size_t name, double least, double most, const std::string& allowed) const {
    const std::string& text = cell(name);
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
        !(x >= least && x <= most))
      refuse(name, allowed);
    return x;
  }
};

Disc disc_of(const Row& row) {
  constexpr double far = 1e8; // m
  Disc disc;
  disc.id = static_cast<std::int64_t>(row.value(0, 0, 1e15, "a whole number >= 0"));
  if (static_cast<double>(disc.id) != row.value(0, 0, 1e15, ""))
    row.refuse(0, "a whole number >= 0");
  for (int axis = 0; axis < 3; ++axis)
    disc.centre[axis] = row.value(static_cast<std::size_t>(axis) + 1, -far, far, "a number within 1e8 m");
  disc.dip = degree * row.value(4, 0, 90, "a number from 0 to 90 degrees");
  disc.dip_direction = degree * row.value(5, 0, 360, "a number from 0 to 360 degrees");
  disc.radius = row.value(6, 1e-6, far, "a number above 0 m");
  disc.set = row.cell(7);
  if (disc.set.empty() || disc.set.size() > longest_name)
    row.refuse(7, "a name of 1 to 64 letters");
  for (const char c : disc.set)
    if (static_cast<unsigned char>(c) < ' ')
      row.refuse(7, "a name without control characters");
  return disc;
}

} // namespace

std::vector<Disc> read_discs(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  std::string line;
  if (!std::getline(in, line))
    throw InputError("file \"" + file +
                     "\": empty; its first row must name id, x, y, z, dip, dip_direction, radius and set");
  const std::size_t width = cells_of(line).size();
  const auto column = columns_of(cells_of(line), file);
  std::vector<Disc> discs;
  std::set<std::int64_t> ids;
  for (int row = 2; std::getline(in, line); ++row) {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != width)
      throw InputError("file \"" + file + "\": row " + std::to_string(row) + " has " +
                       std::to_string(cells.size()) + " values: must be " + std::to_string(width) +
                       ", as many as there are names");
    const Row here{file, row, cells, column};
    discs.push_back(disc_of(here));
    if (!ids.insert(discs.back().id).second)
      here.refuse(0, "an id that no other disc has");
    if (discs.size() > most_discs)
      throw InputError("file \"" + file + "\": more than " + std::to_string(most_discs) +
                       " discs; leave the small ones out");
  }
  if (discs.empty())
    throw InputError("file \"" + file + "\": no disc; a row for each must follow the names");
  return discs;
}

} // namespace geom
