#include "libgeom/core/error.hpp"
#include "libgeom/mesh/read_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace geom {
namespace {

// Names that programs use for the number of a region, the best first; "volumes" always stands there.
constexpr const char* usual_names[] = {"physical",      "sections",      "region",          "regions",
                                       "material",      "materials",     "materialids",     "matid",
                                       "gmsh:physical", "medit:ref",     "cell_tags",       "sets",
                                       "volumes",       "cellentityids", "gmsh:geometrical"};
constexpr std::size_t most_regions = 100000; // more are numbers of cells
constexpr std::size_t most_shown = 8;

std::string lower(std::string text) {
  for (char& c : text)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string listed(const std::vector<const CellLabels*>& all) {
  std::string text;
  for (const CellLabels* labels : all)
    text += (text.empty() ? "\"" : ", \"") + labels->name + "\"";
  return text;
}

} // namespace

void label_regions(MeshFile& file, const std::vector<CellLabels>& all, const std::string& wanted,
                   const std::string& source) {
  file.mesh.region.assign(file.mesh.tets.size(), 0);
  std::vector<const CellLabels*> offered, parting;
  for (const CellLabels& labels : all) {
    offered.push_back(&labels);
    const std::size_t distinct = std::set<std::int64_t>(labels.values.begin(), labels.values.end()).size();
    if (distinct > 1 && distinct <= most_regions)
      parting.push_back(&labels);
  }
  const CellLabels* chosen = nullptr;
  if (!wanted.empty()) {
    for (const CellLabels* labels : offered)
      if (lower(labels->name) == lower(wanted))
        chosen = labels;
    if (chosen == nullptr)
      throw InputError("regions", '"' + wanted + '"',
                       offered.empty() ? "left out" : "one of " + listed(offered),
                       offered.empty() ? source + " has nothing that parts its tetrahedra" : "");
  } else if (parting.size() == 1) {
    chosen = parting.front();
  } else {
    for (const char* name : usual_names)
      for (const CellLabels* labels : parting)
        if (chosen == nullptr && lower(labels->name) == name)
          chosen = labels;
    if (chosen == nullptr && !parting.empty())
      file.doubtful = "its cell data " + listed(parting) +
                      " could each be regions and none was taken; give one as regions = NAME";
  }
  if (chosen == nullptr)
    return;
  std::map<std::int64_t, int> number;
  for (const std::int64_t value : chosen->values)
    number.emplace(value, 0);
  int next = 0;
  std::string values;
  for (auto& [value, region] : number) {
    region = next++;
    if (region < static_cast<int>(most_shown)) {
      const auto name = chosen->names.find(value);
      values += (region > 0 ? ", " : "") +
                (name != chosen->names.end() ? '"' + name->second + '"' : std::to_string(value));
    }
  }
  for (std::size_t t = 0; t < file.mesh.tets.size(); ++t)
    file.mesh.region[t] = number.at(chosen->values[t]);
  if (next < 2)
    return;
  file.told = std::to_string(next) + " regions by \"" + chosen->name + "\": " + values +
              (next > static_cast<int>(most_shown) ? ", ..." : "");
  std::vector<const CellLabels*> others;
  for (const CellLabels* labels : parting)
    if (labels != chosen)
      others.push_back(labels);
  if (!others.empty() && wanted.empty())
    file.told += "; it also has " + listed(others) + ", which regions = NAME takes instead";
}

} // namespace geom
