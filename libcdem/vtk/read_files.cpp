// .vtu, .pvtu and .vtkhdf files of ours back to snapshots, with every number in them checked before it is used.
#include "libcdem/vtk/cells.hpp"
#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/header_names.hpp"
#include "libcdem/vtk/listed_files.hpp"
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
  throw geom::InputError("file", '"' + path + '"', "a .vtu, .pvtu or .vtkhdf file written by cdem", what);
}

void require_whole(const std::string& path) {
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
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::string& path) {
  require_whole(path);
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
std::vector<std::array<int, N>> corners_of(vtkUnstructuredGrid* grid, int type, const std::string& path) {
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

// Reads the moment that a file tells into the fields of the snapshot that belong to no cell.
void read_header(vtkFieldData* header, Snapshot& snapshot) {
  if (vtkDataArray* time = header->GetArray(time_name); time && time->GetNumberOfTuples() > 0)
    snapshot.time = time->GetComponent(0, 0);
  if (vtkDataArray* step = header->GetArray(step_name); step && step->GetNumberOfTuples() > 0)
    snapshot.step = static_cast<std::int64_t>(step->GetComponent(0, 0));
  if (const auto titles = texts_of(header, title_name); !titles.empty())
    snapshot.title = titles[0];
  snapshot.body_names = texts_of(header, bodies_name);
}

template <std::size_t N>
Cells<N> cells_of(const std::string& path, int type, Snapshot& header) {
  const auto grid = read_grid(path);
  Cells<N> cells;
  cells.points = points_of(grid);
  cells.corners = corners_of<N>(grid, type, path);
  cells.point_fields = fields_of(grid->GetPointData(), cells.points.size(), path);
  cells.cell_fields = fields_of(grid->GetCellData(), cells.corners.size(), path);
  read_header(grid->GetFieldData(), header);
  return cells;
}

bool is_list_of_pieces(const std::filesystem::path& path) {
  return path.extension() == ".pvtu";
}

// A snapshot of one file, or joined from pieces, which must be of one moment.
template <std::size_t N>
Cells<N> read_cells(const std::string& path, int type, Snapshot& header) {
  if (!is_list_of_pieces(path))
    return cells_of<N>(path, type, header);
  require_whole(path);
  std::vector<Cells<N>> pieces;
  for (const std::string& file : listed_files(path, pieces_of_file)) {
    Snapshot of_piece;
    pieces.push_back(
        cells_of<N>((std::filesystem::path(path).parent_path() / file).string(), type, of_piece));
    if (pieces.size() > 1 && (of_piece.time != header.time || of_piece.step != header.step))
      refuse(path, "its pieces are of different moments");
    header = std::move(of_piece);
  }
  Cells<N> all;
  if (const std::string wrong = join(pieces, all); !wrong.empty())
    refuse(path, wrong);
  return all;
}

// "" where there are none. Bonds are fewer or more than tets: they may be in pieces where these are not.
std::string bonds_beside(const std::string& path) {
  std::filesystem::path bonds = bonds_path(path);
  if (std::filesystem::exists(bonds))
    return bonds.string();
  if (bonds.extension() == ".vtkhdf")
    return "";
  bonds.replace_extension(is_list_of_pieces(bonds) ? ".vtu" : ".pvtu");
  return std::filesystem::exists(bonds) ? bonds.string() : "";
}

BondSnapshot read_bonds(const std::string& path) {
  Snapshot header;
  Cells<3> cells = read_cells<3>(path, VTK_TRIANGLE, header);
  BondSnapshot bonds;
  bonds.points = std::move(cells.points);
  bonds.triangles = std::move(cells.corners);
  bonds.point_fields = std::move(cells.point_fields);
  bonds.triangle_fields = std::move(cells.cell_fields);
  return bonds;
}

} // namespace

Snapshot read_vtu(const std::string& path) {
  Snapshot snapshot;
  Cells<4> cells = read_cells<4>(path, VTK_TETRA, snapshot);
  if (cells.corners.empty())
    refuse(path, "it holds no tetrahedra");
  snapshot.points = std::move(cells.points);
  snapshot.tets = std::move(cells.corners);
  snapshot.point_fields = std::move(cells.point_fields);
  snapshot.cell_fields = std::move(cells.cell_fields);
  find_surface(snapshot);
  if (const std::string bonds = bonds_beside(path); !bonds.empty())
    snapshot.bonds = read_bonds(bonds);
  return snapshot;
}

} // namespace cdem
