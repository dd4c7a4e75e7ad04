// Snapshots to .vtu and .vtp (VTK XML, appended raw data, zlib, which every reader knows: meshio has no LZ4), and to .vtkhdf.
#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/cells.hpp"
#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/component_names.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/header_names.hpp"
#include "libcdem/vtk/pieces.hpp"
#include "libcdem/vtk/quiet.hpp"
#include "libcdem/vtk/vtkhdf.hpp"
#include "libcdem/vtk/xml_text.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cassert>
#include <cmath>
#include <filesystem>

namespace cdem {
namespace {

template <class Array, class Convert>
vtkSmartPointer<vtkDataArray> to_array(const SnapshotField& field, const Convert& convert) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(field.components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(field.values.size()) / field.components);
  auto* out = array->GetPointer(0);
  for (const double value : field.values)
    *out++ = convert(value);
  return array;
}

void add_fields(vtkFieldData* data, const std::vector<SnapshotField>& fields, std::size_t rows) {
  for (const SnapshotField& field : fields) {
    assert(field.values.size() == rows * static_cast<std::size_t>(field.components));
    static_cast<void>(rows);
    const auto array = field.integer
                           ? to_array<vtkTypeInt64Array>(
                                 field, [](double v) { return static_cast<vtkTypeInt64>(std::llround(v)); })
                           : to_array<vtkDoubleArray>(field, [](double v) { return v; });
    array->SetName(field.name.c_str());
    if (!field.unit.empty()) // written as an information key of the array, and read back
      array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit);
    for (int c = 0; c < field.components; ++c)
      if (const std::string name = component_name(field, c); !name.empty())
        array->SetComponentName(c, name.c_str());
    data->AddArray(array);
  }
}

vtkSmartPointer<vtkPoints> to_points(const std::vector<geom::Vec3>& points) {
  auto out = vtkSmartPointer<vtkPoints>::New();
  out->SetDataTypeToDouble();
  out->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  return out;
}

template <std::size_t N>
vtkSmartPointer<vtkCellArray> to_cells(const std::vector<std::array<int, N>>& cells) {
  vtkNew<vtkIdTypeArray> offsets, corners;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(cells.size()) + 1);
  corners->SetNumberOfValues(static_cast<vtkIdType>(N * cells.size()));
  for (std::size_t i = 0; i <= cells.size(); ++i)
    offsets->SetValue(static_cast<vtkIdType>(i), static_cast<vtkIdType>(N * i));
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t c = 0; c < N; ++c)
      corners->SetValue(static_cast<vtkIdType>(N * i + c), cells[i][c]);
  auto array = vtkSmartPointer<vtkCellArray>::New();
  array->SetData(offsets, corners);
  return array;
}

template <std::size_t N>
vtkSmartPointer<vtkUnstructuredGrid> to_grid(const CellsView<N>& cells, int type) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(to_points(cells.points));
  grid->SetCells(type, to_cells(cells.corners));
  add_fields(grid->GetPointData(), cells.point_fields, cells.points.size());
  add_fields(grid->GetCellData(), cells.cell_fields, cells.corners.size());
  return grid;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string extension_of_grid(const std::string& path) {
  if (ends_with(path, ".vtkhdf"))
    return ".vtkhdf";
  require_extension(path, ".vtu");
  return ".vtu";
}

// Texts as the names of the components of numbers 0, 1, ...: meshio cannot read a file with an array of strings.
void add_texts(vtkDataSet* grid, const char* name, const std::vector<std::string>& texts, bool xml) {
  vtkNew<vtkTypeInt64Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(texts.size()));
  array->SetNumberOfTuples(1);
  for (int i = 0; i < array->GetNumberOfComponents(); ++i) {
    const std::string& text = texts[static_cast<std::size_t>(i)];
    array->SetTypedComponent(0, i, i);
    // VTK's XML writer takes the name as it is.
    array->SetComponentName(i, xml ? xml_text(text).c_str() : text.c_str());
  }
  grid->GetFieldData()->AddArray(array);
}

void add_header(vtkDataSet* grid, const Snapshot& snapshot, bool xml) {
  vtkNew<vtkDoubleArray> time;
  time->SetName(time_name);
  time->InsertNextValue(snapshot.time);
  vtkNew<vtkTypeInt64Array> step;
  step->SetName(step_name);
  step->InsertNextValue(snapshot.step);
  grid->GetFieldData()->AddArray(time);
  grid->GetFieldData()->AddArray(step);
  add_texts(grid, title_name, {snapshot.title}, xml);
  if (!snapshot.body_names.empty())
    add_texts(grid, bodies_name, snapshot.body_names, xml);
}

template <class Writer>
bool write_xml(vtkDataSet* grid, const std::string& path) {
  const Quiet quiet;
  vtkNew<Writer> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(2); // a third of the time of 5, and a twentieth more to store
  return writer->Write() == 1 && writer->GetErrorCode() == 0;
}

template <class Write>
void write_whole(const std::string& path, const Write& write) {
  AtomicFile file(path);
  if (!write(file.temporary()) || !add_checksum(file.temporary()))
    file.refuse();
  file.commit();
}

void write_grid(vtkUnstructuredGrid* grid, const Snapshot& header, const std::string& path) {
  const bool xml = extension_of_grid(path) == ".vtu";
  add_header(grid, header, xml);
  write_whole(path, [&](const std::string& temporary) {
    return xml ? write_xml<vtkXMLUnstructuredGridWriter>(grid, temporary) : write_vtkhdf(grid, temporary);
  });
}

// One file, or pieces of so many cells at most. Returns the file to open.
template <std::size_t N>
std::string write_cells(const CellsView<N>& all, int type, const Snapshot& header, const std::string& path,
                        std::size_t limit) {
  const std::size_t cells = all.corners.size(),
                    pieces = extension_of_grid(path) == ".vtu" ? number_of_pieces(cells, limit) : 1;
  if (pieces == 1) {
    write_grid(to_grid(all, type), header, path);
    remove_superseded(path, 0);
    return path;
  }
  std::error_code told_by_the_file;
  std::filesystem::create_directory(std::filesystem::path(piece_path(path, 0)).parent_path(),
                                    told_by_the_file);
  std::vector<SnapshotField> point_fields, cell_fields;
  for (std::size_t i = 0; i < pieces; ++i) {
    Cells<N> piece = piece_of(all, i * cells / pieces, (i + 1) * cells / pieces);
    const CellsView<N> view{piece.points, piece.corners, piece.point_fields, piece.cell_fields};
    write_grid(to_grid(view, type), header, piece_path(path, i));
    point_fields = std::move(piece.point_fields);
    cell_fields = std::move(piece.cell_fields);
  }
  remove_superseded(path, pieces);
  write_list_of_pieces(path, pieces, point_fields, cell_fields);
  return list_of_pieces(path);
}

std::string beside(const std::string& path, const std::string& what) {
  const std::string extension = ends_with(path, ".pvtu") ? ".pvtu" : extension_of_grid(path);
  return path.substr(0, path.size() - extension.size()) + what + extension;
}

} // namespace

std::string write_vtu(const Snapshot& s, const std::string& path, std::size_t cells_per_file) {
  return write_cells<4>({s.points, s.tets, s.point_fields, s.cell_fields}, VTK_TETRA, s, path,
                        cells_per_file);
}

std::string write_bonds(const Snapshot& snapshot, const std::string& path, std::size_t cells_per_file) {
  const BondSnapshot& bonds = snapshot.bonds;
  return write_cells<3>({bonds.points, bonds.triangles, bonds.point_fields, bonds.triangle_fields},
                        VTK_TRIANGLE, snapshot, path, cells_per_file);
}

void write_surface(const Snapshot& snapshot, const std::string& path) {
  const BondSnapshot& bonds = snapshot.bonds;
  if (ends_with(path, ".vtu") || ends_with(path, ".vtkhdf")) {
    write_bonds(snapshot, path);
    return;
  }
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(to_points(bonds.points));
  surface->SetPolys(to_cells(bonds.triangles));
  add_fields(surface->GetPointData(), bonds.point_fields, bonds.points.size());
  add_fields(surface->GetCellData(), bonds.triangle_fields, bonds.triangles.size());
  add_header(surface, snapshot, true);
  require_extension(path, ".vtp");
  write_whole(path, [&](const std::string& temporary) {
    return write_xml<vtkXMLPolyDataWriter>(surface, temporary);
  });
}

std::string write_contacts(const std::vector<ContactPoint>& contacts, const Snapshot& header,
                           const std::string& path, std::size_t cells_per_file) {
  std::vector<geom::Vec3> places;
  std::vector<std::array<int, 1>> cells;
  SnapshotField force{"force", "N", 3, {}}, normal{"normal_force", "N", 1, {}},
      shear{"shear_force", "N", 1, {}}, depth{"depth", "m", 1, {}}, edge{"edge", "", 1, {}, true},
      source_body{"source_body", "", 1, {}, true}, target_body{"target_body", "", 1, {}, true},
      source_block{"source_block", "", 1, {}, true}, target_block{"target_block", "", 1, {}, true};
  for (const ContactPoint& contact : contacts) {
    cells.push_back({static_cast<int>(places.size())});
    places.push_back(contact.place);
    const geom::Vec3 sum = contact.normal + contact.shear;
    force.values.insert(force.values.end(), sum.data(), sum.data() + 3);
    normal.values.push_back(contact.normal.norm());
    shear.values.push_back(contact.shear.norm());
    depth.values.push_back(contact.depth);
    edge.values.push_back(contact.edge);
    source_body.values.push_back(contact.source_body);
    target_body.values.push_back(contact.target_body);
    source_block.values.push_back(static_cast<double>(contact.source_block));
    target_block.values.push_back(static_cast<double>(contact.target_block));
  }
  return write_cells<1>(
      {places,
       cells,
       {force, normal, shear, depth, edge, source_body, target_body, source_block, target_block},
       {}},
      VTK_VERTEX, header, path, cells_per_file);
}

void write_water(const Snapshot& snapshot, const std::string& path) {
  std::vector<geom::Vec3> points;
  std::vector<geom::Triangle> triangles;
  SnapshotField velocity{"velocity", "m/s", 3, {}}, number{"water", "", 1, {}, true};
  for (std::size_t i = 0; i < snapshot.water.size(); ++i) {
    const WaterSheet& sheet = snapshot.water[i];
    const int before = static_cast<int>(points.size());
    points.insert(points.end(), sheet.points.begin(), sheet.points.end());
    for (const geom::Vec3& v : sheet.velocity)
      velocity.values.insert(velocity.values.end(), v.data(), v.data() + 3);
    for (const geom::Triangle& t : sheet.triangles) {
      triangles.push_back({before + t[0], before + t[1], before + t[2]});
      number.values.push_back(static_cast<double>(i));
    }
  }
  write_cells<3>({points, triangles, {velocity}, {number}}, VTK_TRIANGLE, snapshot, path, 0);
}

std::string water_path(const std::string& vtu_path) {
  return beside(vtu_path, "_water");
}

std::string bonds_path(const std::string& vtu_path) {
  return beside(vtu_path, "_bonds");
}

std::string contacts_path(const std::string& vtu_path) {
  return beside(vtu_path, "_contacts");
}

} // namespace cdem
