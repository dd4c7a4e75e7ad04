#include "libcdem/vtk/read_water.hpp"

#include "libcdem/vtk/quiet.hpp"
#include "libgeom/child/bytes.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/core/regular_file.hpp"
#include "libgeom/core/text_table.hpp"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellDataToPointData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDataSetReader.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkProbeFilter.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace cdem {
namespace {

using geom::InputError;

constexpr double most_points = 2e7; // of a grid
constexpr double most_values = 2e8; // of all frames: some 2 GB

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError("reading " + path + ": " + why);
}

template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const std::string& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  if constexpr (std::is_same_v<Reader, vtkDataSetReader>) {
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllFieldsOn();
  }
  reader->Update();
  vtkDataSet* data = vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  if (reader->GetErrorCode() != 0 || data == nullptr || data->GetNumberOfPoints() == 0)
    refuse(path, "VTK cannot read it, or it has no points");
  return data;
}

vtkSmartPointer<vtkDataSet> data_of(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".vti")
    return read_with<vtkXMLImageDataReader>(path);
  if (ending == ".vtu")
    return read_with<vtkXMLUnstructuredGridReader>(path);
  if (ending == ".vts")
    return read_with<vtkXMLStructuredGridReader>(path);
  if (ending == ".vtr")
    return read_with<vtkXMLRectilinearGridReader>(path);
  if (ending == ".vtk")
    return read_with<vtkDataSetReader>(path);
  throw InputError("file", '"' + path + '"', "a name that ends in .vti, .vtu, .vts, .vtr or .vtk");
}

std::string names_in(vtkDataSet* data) {
  std::string names;
  const auto add = [&](vtkFieldData* fields) {
    for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
      if (const char* const name = fields->GetArrayName(i);
          name != nullptr && names.find('"' + std::string(name) + '"') == std::string::npos)
        names += (names.empty() ? "\"" : ", \"") + std::string(name) + '"';
  };
  add(data->GetPointData());
  add(data->GetCellData());
  return names.empty() ? "none" : names;
}

// Throws where the array is missing, has another number of components, or a value that is not finite.
bool is_at_points(vtkDataSet* data, const std::string& name, const char* field, int components,
                  const std::string& path) {
  vtkDataArray* const at_points = data->GetPointData()->GetArray(name.c_str());
  vtkDataArray* const array = at_points ? at_points : data->GetCellData()->GetArray(name.c_str());
  if (array == nullptr)
    refuse(path, std::string(field) + " = \"" + name + "\": there is no such array; it has " +
                     names_in(data) +
                     (std::filesystem::path(path).extension() == ".vtk"
                          ? " (VTK reads a .vtk in text up to the first value that is no number, such as nan)"
                          : ""));
  const vtkIdType rows = at_points ? data->GetNumberOfPoints() : data->GetNumberOfCells();
  if (array->GetNumberOfComponents() != components || array->GetNumberOfTuples() != rows)
    refuse(path, "\"" + name + "\" has " + std::to_string(array->GetNumberOfComponents()) +
                     " components and " + std::to_string(array->GetNumberOfTuples()) + " rows: must be " +
                     std::to_string(components) + " and " + std::to_string(rows));
  for (vtkIdType row = 0; row < rows; ++row)
    for (int c = 0; c < components; ++c)
      if (!std::isfinite(array->GetComponent(row, c)))
        refuse(path, "\"" + name + "\" is " + std::to_string(array->GetComponent(row, c)) + " at " +
                         (at_points ? "point " : "cell ") + std::to_string(row) +
                         ": must be a finite number");
  return at_points != nullptr;
}

// The centroid of a cell with flat faces; its corners' mean where it has no volume. OpenFOAM's values of cells stand there.
double centroid_height(vtkCell* cell) {
  const auto mean_of = [](vtkPoints* points) {
    geom::Vec3 sum = geom::Vec3::Zero();
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
      sum += geom::Vec3(points->GetPoint(i));
    return geom::Vec3(sum / static_cast<double>(points->GetNumberOfPoints()));
  };
  const geom::Vec3 middle = mean_of(cell->GetPoints());
  double size = 0, moment = 0; // twice the area or six times the volume of simplices around the middle
  const auto add = [&](double part, double height) {
    size += std::abs(part);
    moment += std::abs(part) * height;
  };
  const auto corner = [](vtkCell* of, vtkIdType i) {
    return geom::Vec3(of->GetPoints()->GetPoint(i % of->GetNumberOfPoints()));
  };
  if (cell->GetCellType() == VTK_VOXEL ||
      cell->GetCellType() == VTK_PIXEL) // their corners are in another order
    return middle.z();
  if (cell->GetCellDimension() == 2)
    for (vtkIdType i = 0; i < cell->GetNumberOfPoints(); ++i) {
      const geom::Vec3 a = corner(cell, i), b = corner(cell, i + 1);
      add((a - middle).cross(b - middle).norm(), (middle + a + b).z() / 3);
    }
  for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
    vtkCell* const face = cell->GetFace(f);
    const geom::Vec3 centre = mean_of(face->GetPoints());
    for (vtkIdType i = 0; i < face->GetNumberOfPoints(); ++i) {
      const geom::Vec3 a = corner(face, i), b = corner(face, i + 1);
      add((centre - middle).dot((a - middle).cross(b - middle)), (middle + centre + a + b).z() / 4);
    }
  }
  return size > 0 ? moment / size : middle.z();
}

// What is averaged and interpolated, at the points or in the cells of the mesh: velocity, head and fraction, and the first two
// times a weight, and the weight.
const char *const velocity_name = "u", *const head_name = "q", *const fraction_name = "a",
                  *const weighted_velocity = "w u", *const weighted_head = "w q", *const weight_name = "w";

vtkSmartPointer<vtkDataSet> with_means(vtkDataSet* data) { // of cells, at points
  vtkNew<vtkCellDataToPointData> means;
  means->SetInputData(data);
  means->Update();
  return means->GetOutput();
}

// The head is p + rho g z, Pa.
vtkSmartPointer<vtkDataSet> weighted(vtkDataSet* data, bool at_points, const WaterArrays& wish,
                                     const std::string& path) {
  vtkDataSetAttributes* const given =
      at_points ? static_cast<vtkDataSetAttributes*>(data->GetPointData()) : data->GetCellData();
  const auto array = [&](const std::string& name) {
    return name.empty() ? nullptr : given->GetArray(name.c_str());
  };
  vtkDataArray *const velocity = array(wish.velocity), *const pressure = array(wish.pressure),
                      *const fraction = array(wish.fraction);
  const vtkIdType rows = velocity->GetNumberOfTuples();
  auto result = vtkSmartPointer<vtkDataSet>::Take(data->NewInstance());
  result->CopyStructure(data);
  const auto made = [&](const char* name, int components) {
    vtkNew<vtkDoubleArray> values;
    values->SetName(name);
    values->SetNumberOfComponents(components);
    values->SetNumberOfTuples(rows);
    (at_points ? static_cast<vtkDataSetAttributes*>(result->GetPointData()) : result->GetCellData())
        ->AddArray(values);
    return values.Get();
  };
  vtkDoubleArray *const u = made(velocity_name, 3), *const wu = made(weighted_velocity, 3),
                        *const w = made(weight_name, 1), *const a = made(fraction_name, 1);
  vtkDoubleArray *const q = pressure ? made(head_name, 1) : nullptr, *const wq = pressure
                                                                                     ? made(weighted_head, 1)
                                                                                     : nullptr;
  for (vtkIdType row = 0; row < rows; ++row) {
    const double share = fraction ? fraction->GetComponent(row, 0) : 1,
                 weight = std::clamp(2 * share - 1, 0.0, 1.0);
    a->SetValue(row, share);
    w->SetValue(row, weight);
    for (int c = 0; c < 3; ++c) {
      u->SetComponent(row, c, velocity->GetComponent(row, c));
      wu->SetComponent(row, c, weight * velocity->GetComponent(row, c));
    }
    if (!pressure)
      continue;
    const double z = at_points ? data->GetPoint(row)[2] : centroid_height(data->GetCell(row)),
                 head =
                     wish.pressure_factor * pressure->GetComponent(row, 0) + wish.density * wish.gravity * z;
    if (!std::isfinite(head))
      refuse(path,
             "\"" + wish.pressure + "\" times its factor and the weight of the water are no finite number");
    q->SetValue(row, head);
    wq->SetValue(row, weight * head);
  }
  return result;
}

struct Grid {
  geom::Vec3 origin = geom::Vec3::Zero(), spacing = geom::Vec3::Ones(); // m
  std::array<int, 3> size{1, 1, 1};
};

Grid grid_over(vtkDataSet* data, const WaterArrays& wish, const std::string& path) {
  Grid grid;
  std::array<double, 6> bounds{};
  data->GetBounds(bounds.data());
  const auto low = [&](int axis) { return bounds[2 * static_cast<std::size_t>(axis)]; };
  const auto extent = [&](int axis) { return bounds[2 * static_cast<std::size_t>(axis) + 1] - low(axis); };
  for (const double bound : bounds)
    if (!(std::abs(bound) < 1e9))
      refuse(path, "its points lie beyond 1e9 m");
  vtkImageData* const image = vtkImageData::SafeDownCast(data);
  double cell = wish.cell;
  if (cell == 0) {
    double measure = 1;
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (extent(axis) > 0 && axis != wish.same_along) {
        measure *= extent(axis);
        ++axes;
      }
    cell = axes == 0
               ? 1
               : std::pow(measure / static_cast<double>(std::max<vtkIdType>(1, data->GetNumberOfCells())),
                          1.0 / axes);
  }
  double points = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = image && wish.cell == 0 ? image->GetSpacing()[axis] : cell;
    const bool one = axis == wish.same_along || !(extent(axis) > 0);
    const double cells = one ? 0 : std::max(1.0, std::round(extent(axis) / step));
    points *= cells + 1;
    if (!(points <= most_points))
      throw InputError("cell", geom::text(cell), "larger: the grid would have more than 2e7 points");
    const auto n = static_cast<int>(cells);
    grid.size[static_cast<std::size_t>(axis)] = n + 1;
    grid.origin[axis] = one ? low(axis) + 0.5 * extent(axis) : low(axis);
    grid.spacing[axis] = one ? 1 : extent(axis) / n;
  }
  return grid;
}

std::vector<double> values_of(vtkDataSet* at_grid, const char* name) {
  vtkDataArray* const array = at_grid->GetPointData()->GetArray(name);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(array->GetNumberOfTuples() * array->GetNumberOfComponents()));
  for (vtkIdType row = 0; row < array->GetNumberOfTuples(); ++row)
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      values.push_back(array->GetComponent(row, c));
  return values;
}

// Values whose weighted means and weights are known at the points of the grid; the plain means where the weight is 0.
std::vector<double> ratios_of(vtkDataSet* at_grid, const char* products, const char* plain) {
  constexpr double no_weight = 1e-9;
  std::vector<double> values = values_of(at_grid, plain);
  const std::vector<double> product = values_of(at_grid, products), weight = values_of(at_grid, weight_name);
  const std::size_t components = weight.empty() ? 1 : values.size() / weight.size();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const double by = weight[i / components]; by > no_weight)
      values[i] = product[i] / by;
  return values;
}

// In the child: grid, known, and velocity, head and fraction at the points of the grid.
std::string sampled(const std::string& path, const WaterArrays& wish) {
  const Quiet quiet;
  vtkSmartPointer<vtkDataSet> data = data_of(path);
  const bool velocity_at_points = is_at_points(data, wish.velocity, "velocity", 3, path);
  bool alike = true; // all at points, or all in cells
  for (const auto& [name, field] :
       {std::pair{&wish.pressure, "pressure"}, std::pair{&wish.fraction, "fraction"}})
    if (!name->empty())
      alike = is_at_points(data, *name, field, 1, path) == velocity_at_points && alike;
  const Grid grid = grid_over(data, wish, path);
  if (!alike)
    data = with_means(data);
  const bool at_points = velocity_at_points || !alike;
  data = weighted(data, at_points, wish, path);
  if (!at_points)
    data = with_means(data);
  vtkNew<vtkImageData> points;
  points->SetOrigin(grid.origin.data());
  points->SetSpacing(grid.spacing.data());
  points->SetDimensions(grid.size.data());
  vtkNew<vtkProbeFilter> probe;
  probe->SetInputData(points);
  probe->SetSourceData(data);
  probe->Update();
  vtkDataSet* const found = probe->GetOutput();
  std::string out;
  geom::pack(out, grid.origin);
  geom::pack(out, grid.spacing);
  geom::pack(out, grid.size);
  std::vector<int> known;
  for (const double value : values_of(found, probe->GetValidPointMaskArrayName()))
    known.push_back(value > 0 ? 1 : 0);
  geom::pack(out, known);
  geom::pack(out, ratios_of(found, weighted_velocity, velocity_name));
  geom::pack(out, wish.pressure.empty() ? std::vector<double>() : ratios_of(found, weighted_head, head_name));
  geom::pack(out, wish.fraction.empty() ? std::vector<double>() : values_of(found, fraction_name));
  return out;
}

} // namespace

WaterFiles water_files_of(const std::string& pvd) {
  if (const std::string why = geom::why_not_regular(pvd); !why.empty())
    throw InputError("series", '"' + pvd + '"', "an existing .pvd file", why);
  const std::string bytes = geom::run_in_child("reading " + pvd, geom::limits_of_file(pvd), [&] {
    const Quiet quiet;
    const auto root =
        vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(pvd.c_str()));
    vtkXMLDataElement* const group = root ? root->FindNestedElementWithName("Collection") : nullptr;
    if (group == nullptr)
      refuse(pvd, "it is no .pvd file, or it is damaged");
    WaterFiles files;
    for (int i = 0; i < group->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* const entry = group->GetNestedElement(i);
      const char *const file = entry->GetAttribute("file"), *const time = entry->GetAttribute("timestep");
      if (file == nullptr || std::string(entry->GetName()) != "DataSet")
        continue;
      const std::filesystem::path name(file);
      if (name.empty() || name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
        refuse(pvd, "it names \"" + std::string(file) + "\", outside its folder");
      const auto number = time ? geom::plain_number(time) : std::nullopt;
      if (!number || !std::isfinite(*number))
        refuse(pvd, "\"" + std::string(file) + "\" has no timestep that is a finite number");
      files.paths.push_back((std::filesystem::path(pvd).parent_path() / name).string());
      files.times.push_back(*number);
    }
    if (files.paths.empty())
      refuse(pvd, "it lists no file");
    std::string out;
    geom::pack(out, files.paths);
    geom::pack(out, files.times);
    return out;
  });
  WaterFiles files;
  geom::Unpacker in(bytes);
  geom::unpack(in, files.paths);
  geom::unpack(in, files.times);
  in.end();
  return files;
}

WaterRecord read_water(const WaterFiles& files, const WaterArrays& wish) {
  WaterRecord record;
  record.times = files.times;
  record.density = wish.density;
  record.gravity = wish.gravity;
  if (wish.same_along == 2 && !(wish.pressure.empty() && wish.fraction.empty()))
    throw InputError("same_along", "\"z\"", "x or y beside a pressure or a fraction",
                     "along z both change from water to air");
  double values = 0;
  for (const std::string& path : files.paths) {
    if (const std::string why = geom::why_not_regular(path); !why.empty())
      throw InputError("file", '"' + path + '"', "an existing file", why);
    geom::ChildLimits limits = geom::limits_of_file(path);
    limits.memory += std::uint64_t{4} << 30; // for the grid
    const std::string bytes =
        geom::run_in_child("reading " + path, limits, [&] { return sampled(path, wish); });
    Grid grid;
    std::vector<int> known;
    std::vector<double> velocity;
    WaterFrame frame;
    geom::Unpacker in(bytes);
    geom::unpack(in, grid.origin);
    geom::unpack(in, grid.spacing);
    geom::unpack(in, grid.size);
    geom::unpack(in, known);
    geom::unpack(in, velocity);
    geom::unpack(in, frame.pressure);
    geom::unpack(in, frame.fraction);
    in.end();
    const auto points = static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]) *
                        static_cast<std::size_t>(grid.size[2]);
    if (known.size() != points || velocity.size() != 3 * points ||
        frame.pressure.size() != (wish.pressure.empty() ? 0 : points) ||
        frame.fraction.size() != (wish.fraction.empty() ? 0 : points))
      geom::Unpacker::refuse();
    grid.origin += wish.shift;
    if (record.frames.empty()) {
      record.origin = grid.origin;
      record.spacing = grid.spacing;
      record.size = grid.size;
    } else if (grid.size != record.size ||
               (grid.origin - record.origin).norm() > 1e-6 * record.spacing.norm() ||
               (grid.spacing - record.spacing).norm() > 1e-6 * record.spacing.norm()) {
      refuse(path, "its box begins at " + geom::place_text(grid.origin) + " with " + std::to_string(points) +
                       " points, that of the first file at " + geom::place_text(record.origin) + " with " +
                       std::to_string(record.frames[0].velocity.size()) +
                       " points: files of one series have one place");
    }
    if (values += 8 * static_cast<double>(points); values > most_values)
      throw InputError("files", std::to_string(files.paths.size()),
                       "fewer, or a larger cell: their grids would take more than 2 GB");
    frame.known.assign(known.begin(), known.end());
    for (std::size_t i = 0; i < points; ++i)
      frame.velocity.emplace_back(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]);
    for (std::size_t i = 0; i < frame.pressure.size(); ++i) { // from the head, at heights of the file
      const std::size_t k =
          i / (static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]));
      const double z = grid.origin.z() - wish.shift.z() + static_cast<double>(k) * grid.spacing.z();
      frame.pressure[i] = known[i] > 0 ? frame.pressure[i] - wish.density * wish.gravity * z : 0;
    }
    record.frames.push_back(std::move(frame));
  }
  return record;
}

} // namespace cdem
