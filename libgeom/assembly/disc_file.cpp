// Discs of a fracture network from a table.
#include "libgeom/assembly/discs.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/text_table.hpp"

#include <array>
#include <cmath>
#include <set>

namespace geom {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr std::size_t longest_name = 64;
constexpr const char* all_names = "id, x, y, z, dip, dip_direction, radius and set";

// Other names of a column that surveys use; a unit in brackets may follow the name.
struct DiscColumn {
  const char* name;
  std::vector<std::string> other_names, units;
};

const std::array<DiscColumn, 8>& disc_columns() {
  static const std::vector<std::string> length{"(m)", "[m]"},
      angle{"(deg)", "[deg]", "(\xc2\xb0)", "[\xc2\xb0]"};
  static const std::array<DiscColumn, 8> all{{{"id", {}, {}},
                                              {"x", {}, length},
                                              {"y", {}, length},
                                              {"z", {}, length},
                                              {"dip", {}, angle},
                                              {"dip_direction", {"dipdir"}, angle},
                                              {"radius", {}, length},
                                              {"set", {}, {}}}};
  return all;
}

std::size_t find_column(const TextTable& table, const DiscColumn& wanted) {
  std::vector<std::string> spellings{wanted.name};
  spellings.insert(spellings.end(), wanted.other_names.begin(), wanted.other_names.end());
  const std::size_t bare = spellings.size();
  for (std::size_t i = 0; i < bare; ++i)
    for (const std::string& unit : wanted.units)
      spellings.push_back(spellings[i] + unit);
  std::optional<std::size_t> found;
  for (const std::string& spelling : spellings)
    if (const auto column = table.find(spelling)) {
      if (found)
        table.refuse("more than one column \"" + std::string(wanted.name) + "\"");
      found = column;
    }
  if (!found)
    table.refuse("no column \"" + std::string(wanted.name) + "\"; its first row must name " + all_names);
  return *found;
}

struct DiscRow {
  const TextTable& table;
  std::size_t row;
  const std::array<std::size_t, 8>& column;

  [[noreturn]] void refuse(std::size_t name, const std::string& allowed) const {
    table.refuse(row, column[name], allowed);
  }
  const std::string& cell(std::size_t name) const { return table.cell(row, column[name]); }
  double value(std::size_t name, double least, double most, const std::string& allowed) const {
    const double x = table.number(row, column[name]);
    if (!(x >= least && x <= most))
      refuse(name, allowed);
    return x;
  }
};

Disc disc_of(const DiscRow& row) {
  constexpr double far = 1e8; // m
  Disc disc;
  const double id = row.value(0, 0, 1e15, "a whole number >= 0");
  disc.id = static_cast<std::int64_t>(id);
  if (static_cast<double>(disc.id) != id)
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
  const TextTable table(text, file);
  if (table.names().empty())
    table.refuse(std::string("has no names of columns; its first row must name ") + all_names);
  std::array<std::size_t, 8> column{};
  for (std::size_t n = 0; n < column.size(); ++n)
    column[n] = find_column(table, disc_columns()[n]);
  if (table.rows() == 0)
    table.refuse("no disc; a row for each must follow the names");
  if (table.rows() > most_discs)
    table.refuse("more than " + std::to_string(most_discs) + " discs; leave the small ones out");
  std::vector<Disc> discs;
  std::set<std::int64_t> ids;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const DiscRow here{table, row, column};
    discs.push_back(disc_of(here));
    if (!ids.insert(discs.back().id).second)
      here.refuse(0, "an id that no other disc has");
  }
  return discs;
}

} // namespace geom
