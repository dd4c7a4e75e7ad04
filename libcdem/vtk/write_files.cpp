// Snapshots to .vtu (VTK XML, appended raw data, LZ4) and series to .pvd.
#include "libcdem/vtk/atomic_file.hpp"
#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/header_names.hpp"
#include "libcdem/vtk/quiet.hpp"

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
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cassert>
#include <cmath>
#include <cstdio>
#include <fstream>

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
    const char* const vector_names[] = {"x", "y", "z"};
    const char* const tensor_names[] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"}; // ParaView's symmetric tensor
    const bool principal = field.name.find("principal") != std::string::npos;
    const char* const principal_names[] = {"1", "2", "3"};
    for (int c = 0; c < field.components; ++c)
      if (field.components == 3)
        array->SetComponentName(c, principal ? principal_names[c] : vector_names[c]);
      else if (field.components == 6)
        array->SetComponentName(c, tensor_names[c]);
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
vtkSmartPointer<vtkUnstructuredGrid> to_grid(const std::vector<geom::Vec3>& points,
                                             const std::vector<std::array<int, N>>& cells, int type) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(to_points(points));
  grid->SetCells(type, to_cells(cells));
  return grid;
}

void add_texts(vtkDataSet* grid, const char* name, const std::vector<std::string>& texts) {
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& text : texts)
    array->InsertNextValue(text);
  grid->GetFieldData()->AddArray(array);
}

void add_header(vtkDataSet* grid, const Snapshot& snapshot) {
  vtkNew<vtkDoubleArray> time;
  time->SetName(time_name);
  time->InsertNextValue(snapshot.time);
  vtkNew<vtkTypeInt64Array> step;
  step->SetName(step_name);
  step->InsertNextValue(snapshot.step);
  grid->GetFieldData()->AddArray(time);
  grid->GetFieldData()->AddArray(step);
  add_texts(grid, title_name, {snapshot.title});
  if (!snapshot.body_names.empty())
    add_texts(grid, bodies_name, snapshot.body_names);
}

template <class Writer>
void write_with(vtkDataSet* grid, const std::string& path, const std::string& extension) {
  require_extension(path, extension);
  AtomicFile file(path);
  const Quiet quiet;
  vtkNew<Writer> writer;
  writer->SetFileName(file.temporary().c_str());
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToLZ4();
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 || !add_checksum(file.temporary()))
    file.refuse();
  file.commit();
}

void write_grid(vtkUnstructuredGrid* grid, const std::string& path) {
  write_with<vtkXMLUnstructuredGridWriter>(grid, path, ".vtu");
}

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text)
    switch (c) {
    case '&':
      out += "&amp;";
      break;
    case '<':
      out += "&lt;";
      break;
    case '>':
      out += "&gt;";
      break;
    case '"':
      out += "&quot;";
      break;
    default:
      out += c;
    }
  return out;
}

} // namespace

void write_vtu(const Snapshot& snapshot, const std::string& path) {
  const auto grid = to_grid(snapshot.points, snapshot.tets, VTK_TETRA);
  add_fields(grid->GetPointData(), snapshot.point_fields, snapshot.points.size());
  add_fields(grid->GetCellData(), snapshot.cell_fields, snapshot.tets.size());
  add_header(grid, snapshot);
  write_grid(grid, path);
}

void write_bonds(const Snapshot& snapshot, const std::string& path) {
  const BondSnapshot& bonds = snapshot.bonds;
  const auto grid = to_grid(bonds.points, bonds.triangles, VTK_TRIANGLE);
  add_fields(grid->GetPointData(), bonds.point_fields, bonds.points.size());
  add_fields(grid->GetCellData(), bonds.triangle_fields, bonds.triangles.size());
  add_header(grid, snapshot);
  write_grid(grid, path);
}

void write_surface(const Snapshot& snapshot, const std::string& path) {
  const BondSnapshot& bonds = snapshot.bonds;
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(to_points(bonds.points));
  surface->SetPolys(to_cells(bonds.triangles));
  add_fields(surface->GetPointData(), bonds.point_fields, bonds.points.size());
  add_fields(surface->GetCellData(), bonds.triangle_fields, bonds.triangles.size());
  add_header(surface, snapshot);
  write_with<vtkXMLPolyDataWriter>(surface, path, ".vtp");
}

std::string bonds_path(const std::string& vtu_path) {
  require_extension(vtu_path, ".vtu");
  return vtu_path.substr(0, vtu_path.size() - 4) + "_bonds.vtu";
}

void write_pvd(const std::string& path, const std::vector<SeriesEntry>& series) {
  require_extension(path, ".pvd");
  AtomicFile file(path);
  std::ofstream out(file.temporary());
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         "  <Collection>\n";
  for (const SeriesEntry& entry : series) {
    char time[32];
    std::snprintf(time, sizeof time, "%.17g", entry.time);
    out << "    <DataSet timestep=\"" << time << "\" group=\"\" part=\"0\" file=\"" << xml_text(entry.file)
        << "\"/>\n";
  }
  out << "  </Collection>\n</VTKFile>\n";
  out.close();
  if (!out)
    file.refuse();
  file.commit();
}

} // namespace cdem
