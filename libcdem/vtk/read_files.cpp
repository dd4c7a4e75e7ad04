// .vtu and .vtkhdf files of ours back to snapshots, with every number in them checked before it is used.
#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/header_names.hpp"
#include "libcdem/vtk/outline.hpp"
#include "libcdem/vtk/vtkhdf.hpp"
#include "libgeom/core/error.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>

namespace cdem {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw geom::InputError("file", '"' + path + '"', "a .vtu or .vtkhdf file written by cdem", what);
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw FileError('"' + path + "\" cannot be read: there is no such file");
  switch (check_checksum(path)) {
  case Checksum::none: // another program's file, or one of ours cut short
    refuse(path, "it is not, or it is incomplete");
  case Checksum::wrong:
    refuse(path, "it was changed or damaged after it was written");
  case Checksum::right:
    break;
  }
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  const std::string hdf = ".vtkhdf";
  if (path.size() > hdf.size() && path.compare(path.size() - hdf.size(), hdf.size(), hdf) == 0) {
    const std::string vtu = vtkhdf_as_vtu(path);
    if (vtu.empty())
      refuse(path, "VTK cannot read it");
    reader->ReadFromInputStringOn();
    reader->SetInputString(vtu);
  } else {
    reader->SetFileName(path.c_str());
  }
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !grid || !grid->GetPoints())
    refuse(path, "VTK cannot read it");
  return grid;
}

std::vector<geom::Vec3> points_of(vtkUnstructuredGrid* grid) {
  std::vector<geom::Vec3> points(static_cast<std::size_t>(grid->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i)
    grid->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  return points;
}

template <std::size_t N>
std::vector<std::array<int, N>> cells_of(vtkUnstructuredGrid* grid, int type, const std::string& path) {
  std::vector<std::array<int, N>> cells(static_cast<std::size_t>(grid->GetNumberOfCells()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto id = static_cast<vtkIdType>(i);
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    grid->GetCells()->GetCellAtId(id, count, corners);
    // The checksum vouches for the bytes; what they mean is checked here, since anybody can write such a
    // line.
    if (grid->GetCellType(id) != type || count != static_cast<vtkIdType>(N))
      refuse(path, N == 4 ? "it has cells that are not tetrahedra" : "it has cells that are not triangles");
    for (std::size_t c = 0; c < N; ++c) {
      if (corners[c] < 0 || corners[c] >= grid->GetNumberOfPoints())
        refuse(path, "it is damaged: a cell names a point that is not there");
      cells[i][c] = static_cast<int>(corners[c]);
    }
  }
  return cells;
}

std::vector<SnapshotField> fields_of(vtkFieldData* data, std::size_t rows, const std::string& path) {
  std::vector<SnapshotField> fields;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data->GetArray(i);
    if (!array || !array->GetName())
      continue;
    SnapshotField field;
    field.name = array->GetName();
    field.components = array->GetNumberOfComponents();
    field.integer = array->GetDataType() != VTK_DOUBLE && array->GetDataType() != VTK_FLOAT;
    if (array->HasInformation() && array->GetInformation()->Has(vtkDataArray::UNITS_LABEL()))
      field.unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL());
    if (static_cast<std::size_t>(array->GetNumberOfTuples()) != rows)
      refuse(path, "it is damaged: " + field.name + " has the wrong length");
    field.values.reserve(rows * static_cast<std::size_t>(field.components));
    for (vtkIdType row = 0; row < array->GetNumberOfTuples(); ++row)
      for (int c = 0; c < field.components; ++c)
        field.values.push_back(array->GetComponent(row, c));
    fields.push_back(std::move(field));
  }
  return fields;
}

BondSnapshot read_bonds(const std::string& path) {
  const auto grid = read_grid(path);
  BondSnapshot bonds;
  bonds.points = points_of(grid);
  bonds.triangles = cells_of<3>(grid, VTK_TRIANGLE, path);
  bonds.point_fields = fields_of(grid->GetPointData(), bonds.points.size(), path);
  bonds.triangle_fields = fields_of(grid->GetCellData(), bonds.triangles.size(), path);
  return bonds;
}

// Empty when there are none of the name. Files of version 0.1.0 have them as strings.
std::vector<std::string> texts_of(vtkFieldData* header, const char* name) {
  std::vector<std::string> texts;
  if (vtkDataArray* array = header->GetArray(name))
    for (int i = 0; i < array->GetNumberOfComponents(); ++i) {
      const char* const text = array->GetComponentName(i);
      texts.emplace_back(text ? text : "");
    }
  if (auto* array = vtkStringArray::SafeDownCast(header->GetAbstractArray(name)))
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
      texts.push_back(array->GetValue(i));
  return texts;
}

} // namespace

Snapshot read_vtu(const std::string& path) {
  const auto grid = read_grid(path);
  Snapshot snapshot;
  snapshot.points = points_of(grid);
  snapshot.tets = cells_of<4>(grid, VTK_TETRA, path);
  if (snapshot.tets.empty())
    refuse(path, "it holds no tetrahedra");
  snapshot.point_fields = fields_of(grid->GetPointData(), snapshot.points.size(), path);
  snapshot.cell_fields = fields_of(grid->GetCellData(), snapshot.tets.size(), path);
  vtkFieldData* header = grid->GetFieldData();
  if (vtkDataArray* time = header->GetArray(time_name); time && time->GetNumberOfTuples() > 0)
    snapshot.time = time->GetComponent(0, 0);
  if (vtkDataArray* step = header->GetArray(step_name); step && step->GetNumberOfTuples() > 0)
    snapshot.step = static_cast<std::int64_t>(step->GetComponent(0, 0));
  if (const auto titles = texts_of(header, title_name); !titles.empty())
    snapshot.title = titles[0];
  snapshot.body_names = texts_of(header, bodies_name);
  find_surface(snapshot);
  if (std::filesystem::exists(bonds_path(path)))
    snapshot.bonds = read_bonds(bonds_path(path));
  return snapshot;
}

} // namespace cdem
