// Tetrahedra made or read by gmsh.
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/solid/gmsh_session.hpp"

#include "libgeom/core/check.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace geom {
namespace {

struct Collected {
  TetMesh mesh;
  std::vector<CellLabels> labels; // "physical" groups and "volumes"
};

// The first physical group of a volume and its name; 0 without one.
std::pair<int, std::string> group_of(int volume) {
  std::vector<int> groups;
  gmsh::model::getPhysicalGroupsForEntity(3, volume, groups);
  if (groups.empty())
    return {0, "in no group"};
  std::string name;
  gmsh::model::getPhysicalName(3, groups.front(), name);
  return {groups.front(), name.empty() ? std::to_string(groups.front()) : name};
}

// The tets of gmsh's model, each volume a region, and the nodes they use in the order they are met.
Collected collect(const std::string& what) {
  constexpr int linear_tet = 4; // gmsh's number of the element
  MetNodes nodes;
  Collected all;
  TetMesh& mesh = all.mesh;
  CellLabels physical{"physical", {}, {}}, numbers{"volumes", {}, {}};
  Pieces volumes;
  gmsh::model::getEntities(volumes, 3);
  int region = 0;
  for (const auto& [dim, tag] : volumes) {
    const auto [group, name] = group_of(tag);
    physical.names[group] = name;
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, corners;
    gmsh::model::mesh::getElements(types, elements, corners, dim, tag);
    for (std::size_t k = 0; k < types.size(); ++k) {
      if (types[k] != linear_tet)
        throw InputError(what +
                         ": has volume elements that are not tetrahedra with four nodes; mesh it with linear "
                         "tetrahedra");
      for (std::size_t t = 0; t < elements[k].size(); ++t) {
        Tet tet;
        for (std::size_t c = 0; c < 4; ++c)
          tet[c] = nodes.number(corners[k][4 * t + c], what);
        mesh.tets.push_back(tet);
        mesh.region.push_back(region);
        physical.values.push_back(group);
        numbers.values.push_back(tag);
      }
    }
    if (mesh.region.empty() || mesh.region.back() != region)
      throw InputError(what + ": volume " + std::to_string(region + 1) + " has no tetrahedra");
    ++region;
  }
  mesh.nodes = std::move(nodes.points);
  all.labels = {std::move(physical), std::move(numbers)};
  return all;
}

} // namespace

TetMesh tets_of_volumes(const std::string& what) {
  return collect(what).mesh;
}

TetMesh mesh_solid(const Solid& solid, const MeshSize& sizes) {
  validate(sizes);
  const double expected = expected_tets(sizes, bounding_box(solid), mass_properties(solid).volume);
  if (!(expected <= max_tets))
    throw InputError("size", text(sizes.size), "such that there are at most 20 million tetrahedra",
                     "this asks for about " + text(std::round(expected * 1e-6)) + " million");
  ChildLimits limits;
  limits.blame =
      "the solid cannot be meshed with this size; try another, and make sure that no faces nearly touch";
  TetMesh mesh = in_session("mesh", limits, [&] {
    set_mesh_options();
    load(solid);
    gmsh::model::occ::synchronize();
    gmsh::model::mesh::setSizeCallback([&](int, int, double x, double y, double z) {
      return size_at(sizes, {x, y, z});
    });
    // Surfaces are meshed in a parallel region, from which nothing can be thrown: errors are asked for after
    // it.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::logger::start();
    gmsh::model::mesh::generate(3);
    std::vector<std::string> log;
    gmsh::logger::get(log);
    gmsh::logger::stop();
    for (const std::string& line : log)
      if (line.compare(0, 6, "Error:") == 0)
        throw InputError("mesh: the solid cannot be meshed with this size:" + line.substr(6) +
                         "; try another size, and make sure that no faces nearly touch");
    return collect("mesh").mesh;
  });
  validate(mesh, "mesh");
  return mesh;
}

namespace {

// gmsh takes files that it does not know for scripts of its own, which can run commands: only formats it knows
// by their ending may reach it, and .msh, which it knows by its first line.
std::string require_mesh_format(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError("file", '"' + path + '"', "an existing mesh file");
  std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".msh" && ending != ".mesh" && ending != ".bdf" && ending != ".unv" && ending != ".inp")
    throw InputError("file", '"' + path + '"', "a name that ends in .msh, .mesh, .bdf, .unv or .inp");
  return ending;
}

void require_first_line(const std::string& copy, const std::string& path) {
  std::string line;
  std::getline(std::ifstream(copy), line);
  if (line.rfind("$MeshFormat", 0) != 0 && line.rfind("$NOD", 0) != 0)
    throw InputError("file", '"' + path + '"', "a gmsh mesh", "its first line must be $MeshFormat");
}

// In format 2 a volume may stand in several groups, element by element: then the groups are read as volumes.
bool any_in_several_groups() {
  Pieces volumes;
  gmsh::model::getEntities(volumes, 3);
  return std::any_of(volumes.begin(), volumes.end(), [](const std::pair<int, int>& volume) {
    std::vector<int> groups;
    gmsh::model::getPhysicalGroupsForEntity(3, volume.second, groups);
    return groups.size() > 1;
  });
}

Collected read_by_gmsh(const std::string& path, const std::string& ending) {
  return with_copy(path, ending, [&](const std::string& copy) {
    if (ending == ".msh")
      require_first_line(copy, path);
    gmsh::merge(copy);
    if (ending != ".msh" || !any_in_several_groups())
      return collect(path);
    std::map<std::int64_t, std::string> names;
    Pieces groups;
    gmsh::model::getPhysicalGroups(groups, 3);
    for (const auto& [dim, tag] : groups) {
      std::string name;
      gmsh::model::getPhysicalName(dim, tag, name);
      names[tag] = name.empty() ? std::to_string(tag) : name;
    }
    gmsh::clear();
    gmsh::option::setNumber("Mesh.SwitchElementTags", 1);
    gmsh::merge(copy);
    Collected all = collect(path);
    all.labels[0].values = all.labels[1].values; // numbers of volumes are those of groups now
    all.labels[0].names = std::move(names);
    all.labels.pop_back();
    return all;
  });
}

std::string whole_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

} // namespace

void pack(std::string& out, const MeshFile& x) {
  pack(out, x.mesh);
  pack(out, x.told);
  pack(out, x.doubtful);
}
void unpack(Unpacker& in, MeshFile& x) {
  unpack(in, x.mesh);
  unpack(in, x.told);
  unpack(in, x.doubtful);
}

MeshFile read_mesh_file(const std::string& path, const std::string& regions) {
  const std::string ending = require_mesh_format(path);
  MeshFile file = in_session("reading " + path, limits_of_file(path), [&] {
    Collected all;
    if (ending == ".inp")
      all.mesh = read_inp(whole_text(path), path, all.labels);
    else
      all = read_by_gmsh(path, ending);
    MeshFile read;
    read.mesh = std::move(all.mesh);
    label_regions(read, all.labels, regions, path);
    return read;
  });
  validate(file.mesh, path);
  return file;
}

} // namespace geom
