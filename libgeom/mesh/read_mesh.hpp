// Meshes from other programs.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

#include <cstdint>

namespace geom {

// A number for each tetrahedron of a file that can part the mesh into regions: physical groups, cell data, element sets.
struct CellLabels {
  std::string name;
  std::vector<std::int64_t> values;          // per tet
  std::map<std::int64_t, std::string> names; // of values, where the file has them
};

struct MeshFile {
  TetMesh mesh;
  std::string told;     // what its regions are, one line; empty: there is one
  std::string doubtful; // several labels could be regions and none was taken; empty: no doubt
};

// Regions from the labels named `wanted`, numbered in ascending order of their values. Where `wanted` is empty: from those
// that alone have two values or more, or else from the first with a name that programs use for regions. Throws InputError,
// `source` first, where no labels have the name.
void label_regions(MeshFile&, const std::vector<CellLabels>&, const std::string& wanted,
                   const std::string& source);

// Linear tetrahedra of a gmsh (.msh), Medit (.mesh), Nastran (.bdf), I-deas (.unv) or Abaqus (.inp) file, coordinates in
// metres. Regions: "physical" groups or "volumes" of a .msh, "volumes" of the others, "sets" or "sections" of an .inp.
// Validated. Throws InputError when the file is missing, unreadable, of another format, or holds other volume elements or
// none.
MeshFile read_mesh_file(const std::string& path, const std::string& regions);
inline TetMesh read_mesh(const std::string& path) {
  return read_mesh_file(path, "").mesh;
}

// In the child: the tetrahedra and element sets of an Abaqus file.
TetMesh read_inp(const std::string& text, const std::string& path, std::vector<CellLabels>& labels);

} // namespace geom
