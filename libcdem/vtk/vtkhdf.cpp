#include "libcdem/vtk/vtkhdf.hpp"

#include "libcdem/vtk/quiet.hpp"
#include "libgeom/child/process.hpp"

#include <hdf5.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace cdem {
namespace {

constexpr const char* root_name = "VTKHDF";
constexpr const char* unit_name = "unit";
constexpr unsigned gzip_level = 2; // as in .vtu: a third of the time of 5, and a twentieth more to store
constexpr hsize_t chunk_values = 1 << 16;

struct Failed : std::runtime_error {
  Failed() : std::runtime_error("libhdf5 has failed") {}
};

template <class T>
T good(T result) {
  if (result < 0)
    throw Failed();
  return result;
}

class Handle {
public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(good(id)), close_(close) {}
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; } // as libhdf5 takes it

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// libhdf5 prints what goes wrong itself, over many lines; here one line is said.
class QuietHdf {
public:
  QuietHdf() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietHdf(const QuietHdf&) = delete;
  QuietHdf& operator=(const QuietHdf&) = delete;

private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

Handle space_of(const std::vector<hsize_t>& size) {
  return {H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose};
}

// A string of variable length; not marked as UTF-8, which it is, since VTK 9.1 reads no other strings.
Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  good(H5Tset_size(type, H5T_VARIABLE));
  return {H5Tcopy(type), H5Tclose};
}

void add_text(hid_t to, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  good(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)));
  const Handle attribute(H5Acreate2(to, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  good(H5Awrite(attribute, type, text.c_str()));
}

// Without the time of writing, so that the same values are the same bytes; compressed where there is anything.
void add_data(hid_t group, const std::string& name, hid_t type, const std::vector<hsize_t>& size,
              const void* values, const std::string& unit = "") {
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose), space = space_of(size);
  good(H5Pset_obj_track_times(layout, false));
  if (size[0] > 0 && H5Tis_variable_str(type) <= 0) {
    std::vector<hsize_t> chunk = size;
    const hsize_t row = size.size() > 1 ? std::max<hsize_t>(size[1], 1) : 1;
    chunk[0] = std::min(size[0], std::max<hsize_t>(chunk_values / row, 1));
    good(H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data()));
    good(H5Pset_shuffle(layout));
    good(H5Pset_deflate(layout, gzip_level));
  }
  const Handle data(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose);
  if (size[0] > 0)
    good(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  if (!unit.empty())
    add_text(data, unit_name, unit);
}

hid_t type_of(const vtkDataArray& array) {
  switch (const_cast<vtkDataArray&>(array).GetDataType()) {
  case VTK_DOUBLE:
    return H5T_NATIVE_DOUBLE;
  case VTK_UNSIGNED_CHAR:
    return H5T_NATIVE_UCHAR;
  default:
    return H5T_NATIVE_INT64; // all other arrays of ours
  }
}

void add_texts(hid_t group, vtkDataArray* array) {
  std::vector<const char*> texts;
  for (int i = 0; i < array->GetNumberOfComponents(); ++i)
    texts.push_back(array->GetComponentName(i) ? array->GetComponentName(i) : "");
  const Handle type = text_type();
  add_data(group, array->GetName(), type, {texts.size()}, texts.data());
}

void add_array(hid_t group, const std::string& name, vtkDataArray* array) {
  std::vector<hsize_t> size{static_cast<hsize_t>(array->GetNumberOfTuples())};
  if (array->GetNumberOfComponents() > 1)
    size.push_back(static_cast<hsize_t>(array->GetNumberOfComponents()));
  const bool has_unit = array->HasInformation() && array->GetInformation()->Has(vtkDataArray::UNITS_LABEL());
  add_data(group, name, type_of(*array), size,
           array->GetNumberOfTuples() > 0 ? array->GetVoidPointer(0) : nullptr,
           has_unit ? array->GetInformation()->Get(vtkDataArray::UNITS_LABEL()) : "");
}

void add_arrays(hid_t root, const char* name, vtkFieldData* data, bool texts) {
  const Handle group(H5Gcreate2(root, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (vtkDataArray* array = data->GetArray(i)) {
      if (texts && array->HasAComponentName())
        add_texts(group, array);
      else
        add_array(group, array->GetName(), array);
    }
}

void add_count(hid_t root, const char* name, vtkIdType count) {
  const auto value = static_cast<std::int64_t>(count);
  add_data(root, name, H5T_NATIVE_INT64, {1}, &value);
}

void write(vtkUnstructuredGrid* grid, const std::string& path) {
  const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const Handle root(H5Gcreate2(file, root_name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  {
    const std::int64_t version[2] = {1, 0};
    const Handle space = space_of({2});
    const Handle attribute(H5Acreate2(root, "Version", H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    good(H5Awrite(attribute, H5T_NATIVE_INT64, version));
  }
  add_text(root, "Type", "UnstructuredGrid");
  vtkCellArray* cells = grid->GetCells();
  add_count(root, "NumberOfPoints", grid->GetNumberOfPoints());
  add_count(root, "NumberOfCells", grid->GetNumberOfCells());
  add_count(root, "NumberOfConnectivityIds", cells->GetConnectivityArray()->GetNumberOfTuples());
  add_array(root, "Points", grid->GetPoints()->GetData());
  add_array(root, "Connectivity", cells->GetConnectivityArray());
  add_array(root, "Offsets", cells->GetOffsetsArray());
  std::vector<unsigned char> types(static_cast<std::size_t>(grid->GetNumberOfCells()));
  for (std::size_t i = 0; i < types.size(); ++i)
    types[i] = static_cast<unsigned char>(grid->GetCellType(static_cast<vtkIdType>(i)));
  add_data(root, "Types", H5T_NATIVE_UCHAR, {types.size()}, types.data());
  add_arrays(root, "PointData", grid->GetPointData(), false);
  add_arrays(root, "CellData", grid->GetCellData(), false);
  add_arrays(root, "FieldData", grid->GetFieldData(), true);
  good(H5Fflush(file, H5F_SCOPE_GLOBAL)); // what closing could not say
}

// VTK's reader leaves attributes of arrays out.
void read_units(hid_t root, const char* name, vtkFieldData* data) {
  const Handle group(H5Gopen2(root, name, H5P_DEFAULT), H5Gclose);
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (!array->GetName() || H5Aexists_by_name(group, array->GetName(), unit_name, H5P_DEFAULT) <= 0)
      continue;
    const Handle attribute(H5Aopen_by_name(group, array->GetName(), unit_name, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0)
      continue;
    std::string unit(H5Tget_size(type), '\0');
    good(H5Aread(attribute, type, unit.data()));
    array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), unit.c_str());
  }
}

std::string as_vtu(const std::string& path) {
  const Quiet quiet;
  const QuietHdf quiet_hdf;
  vtkNew<vtkHDFReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkSmartPointer<vtkUnstructuredGrid> grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutputAsDataSet());
  if (reader->GetErrorCode() != 0 || !grid)
    throw Failed();
  if (grid->GetNumberOfPoints() ==
      0) { // as of a single block's bonds: VTK's reader leaves it without its parts
    grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->SetPoints(vtkNew<vtkPoints>());
    grid->SetCells(VTK_TRIANGLE, vtkNew<vtkCellArray>());
  } else {
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Handle root(H5Gopen2(file, root_name, H5P_DEFAULT), H5Gclose);
    read_units(root, "PointData", grid->GetPointData());
    read_units(root, "CellData", grid->GetCellData());
  }
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->WriteToOutputStringOn();
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  if (writer->Write() != 1 || writer->GetErrorCode() != 0)
    throw Failed();
  return writer->GetOutputString();
}

} // namespace

bool write_vtkhdf(vtkUnstructuredGrid* grid, const std::string& path) {
  const QuietHdf quiet;
  try {
    write(grid, path);
    return true;
  } catch (const Failed&) {
    return false;
  }
}

std::string vtkhdf_as_vtu(const std::string& path) {
  geom::ChildLimits limits = geom::limits_of_file(path);
  limits.worker = "libhdf5";
  return geom::run_in_child('"' + path + '"', limits, [&]() -> std::string {
    try {
      return as_vtu(path);
    } catch (const Failed&) {
      return "";
    }
  });
}

} // namespace cdem
