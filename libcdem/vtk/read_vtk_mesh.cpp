#include "libcdem/vtk/read_vtk_mesh.hpp"

#include "libcdem/vtk/checksum.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/regular_file.hpp"
#include "libgeom/solid/gmsh_session.hpp"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <filesystem>
#include <unordered_map>

namespace cdem {
namespace {

using geom::InputError;

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> grid_in(const std::string& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  if constexpr (std::is_same_v<Reader, vtkUnstructuredGridReader>)
    reader->ReadAllScalarsOn();
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || grid == nullptr || grid->GetPoints() == nullptr)
    throw InputError("reading " + path + ": VTK cannot read it as an unstructured grid");
  return grid;
}

// The cells that are tetrahedra; others may be surfaces, lines and points.
std::vector<vtkIdType> tets_of(vtkUnstructuredGrid* grid, const std::string& path) {
  std::vector<vtkIdType> tets;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    if (grid->GetCellType(cell) == VTK_TETRA)
      tets.push_back(cell);
    else if (grid->GetCell(cell)->GetCellDimension() == 3)
      throw InputError("reading " + path +
                       ": has volume elements that are not tetrahedra with four nodes; mesh it with linear "
                       "tetrahedra");
  return tets;
}

geom::TetMesh mesh_of(vtkUnstructuredGrid* grid, const std::vector<vtkIdType>& tets,
                      const std::string& path) {
  geom::TetMesh mesh;
  std::unordered_map<vtkIdType, int> node_of;
  for (const vtkIdType cell : tets) {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    grid->GetCellPoints(cell, count, corners);
    geom::Tet tet{};
    for (vtkIdType c = 0; c < 4; ++c) {
      if (count != 4 || corners[c] < 0 || corners[c] >= grid->GetNumberOfPoints())
        throw InputError("reading " + path + ": an element names a node that is not there");
      const auto [node, added] = node_of.try_emplace(corners[c], static_cast<int>(mesh.nodes.size()));
      if (added) {
        geom::Vec3 x;
        grid->GetPoint(corners[c], x.data());
        mesh.nodes.push_back(x);
      }
      tet[static_cast<std::size_t>(c)] = node->second;
    }
    mesh.tets.push_back(tet);
  }
  return mesh;
}

// Cell data of one component that holds whole numbers only.
std::vector<geom::CellLabels> labels_of(vtkUnstructuredGrid* grid, const std::vector<vtkIdType>& tets) {
  std::vector<geom::CellLabels> all;
  for (int i = 0; i < grid->GetCellData()->GetNumberOfArrays(); ++i) {
    vtkDataArray* const data = grid->GetCellData()->GetArray(i);
    if (data == nullptr || data->GetNumberOfComponents() != 1 || data->GetName() == nullptr ||
        data->GetNumberOfTuples() < grid->GetNumberOfCells())
      continue;
    geom::CellLabels labels{data->GetName(), {}, {}};
    for (const vtkIdType cell : tets) {
      const double value = data->GetTuple1(cell);
      if (!(std::abs(value) < 1e15 && value == std::floor(value)))
        break;
      labels.values.push_back(static_cast<std::int64_t>(value));
    }
    if (labels.values.size() == tets.size())
      all.push_back(std::move(labels));
  }
  return all;
}

} // namespace

bool is_vtu_of_ours(const std::string& path) {
  return check_checksum(path) != Checksum::none;
}

geom::MeshFile read_vtk_mesh(const std::string& path, const std::string& regions) {
  if (const std::string why = geom::why_not_regular(path); !why.empty())
    throw InputError("file", '"' + path + '"', "an existing mesh file", why);
  const bool xml = std::filesystem::path(path).extension() == ".vtu";
  const std::string bytes = geom::run_in_child("reading " + path, geom::limits_of_file(path), [&] {
    const auto grid =
        xml ? grid_in<vtkXMLUnstructuredGridReader>(path) : grid_in<vtkUnstructuredGridReader>(path);
    const std::vector<vtkIdType> tets = tets_of(grid, path);
    geom::MeshFile read;
    read.mesh = mesh_of(grid, tets, path);
    label_regions(read, labels_of(grid, tets), regions, path);
    std::string out;
    pack(out, read);
    return out;
  });
  geom::MeshFile file;
  geom::Unpacker in(bytes);
  unpack(in, file);
  in.end();
  validate(file.mesh, path);
  return file;
}

} // namespace cdem
