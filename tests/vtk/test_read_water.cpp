// Water in VTK's files: what was written is read back, from images and from meshes, and bad files are refused in one line.
#include "libcdem/vtk/read_water.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetWriter.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

using namespace cdem;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

Vec3 flow_at(const Vec3& x, double time) {
  return {1 + x.x() + 2 * time, 0.5 * x.z(), -x.x()}; // linear, so that linear interpolation is exact
}

struct Image {
  vtkNew<vtkImageData> data;
  vtkNew<vtkDoubleArray> velocity, pressure, fraction;

  explicit Image(double time, const Vec3& origin = {-1, 0, 0}) {
    data->SetOrigin(origin.data());
    data->SetSpacing(0.5, 1, 0.25);
    data->SetDimensions(5, 1, 9);
    velocity->SetName("U");
    velocity->SetNumberOfComponents(3);
    pressure->SetName("p");
    fraction->SetName("alpha.water");
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
      const Vec3 x(data->GetPoint(i));
      velocity->InsertNextTuple(flow_at(x, time).data());
      pressure->InsertNextValue(10 * (1 - x.z()));
      fraction->InsertNextValue(x.z() < 1.1 ? 1 : 0); // the surface half-way from 1 to 1.25
    }
    data->GetPointData()->AddArray(velocity);
    data->GetPointData()->AddArray(pressure);
    data->GetPointData()->AddArray(fraction);
  }
  void write(const std::string& path) const {
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(data);
    REQUIRE(writer->Write() == 1);
  }
};

// Hexahedra of 0.5 m over x 0 to 2, y 0 to 0.1, z 0 to 1, one cell across as OpenFOAM's flumes are, with cell data.
vtkSmartPointer<vtkUnstructuredGrid> flume() {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 5; ++i)
        points->InsertNextPoint(0.5 * i, 0.1 * j, 0.5 * k);
  grid->SetPoints(points);
  vtkNew<vtkDoubleArray> velocity;
  velocity->SetName("U");
  velocity->SetNumberOfComponents(3);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 4; ++i) {
      const auto p = [&](int a, int b, int c) {
        return static_cast<vtkIdType>(i + a + 5 * (b + 2 * (k + c)));
      };
      const vtkIdType corners[8] = {p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0),
                                    p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)};
      grid->InsertNextCell(VTK_HEXAHEDRON, 8, corners);
      velocity->InsertNextTuple3(2, 0, 0.5);
    }
  grid->GetCellData()->AddArray(velocity);
  return grid;
}

// Columns of 0.5 m over a bed that rises by 1:2 from z = 0, between x = 0 and 3, up to z = 2, with four cells in each.
// values(centroid): velocity, pressure, fraction of a cell.
struct CellWater {
  Vec3 velocity;
  double pressure, fraction;
};
template <class Values>
vtkSmartPointer<vtkUnstructuredGrid> over_a_slope(const Values& values) {
  constexpr int columns = 6, layers = 4;
  const auto height = [](int i, int k) { return 0.25 * i + (2 - 0.25 * i) * k / layers; };
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i <= columns; ++i)
        points->InsertNextPoint(0.5 * i, 0.1 * j, height(i, k));
  grid->SetPoints(points);
  vtkNew<vtkDoubleArray> velocity, pressure, fraction;
  velocity->SetName("U");
  velocity->SetNumberOfComponents(3);
  pressure->SetName("p");
  fraction->SetName("alpha.water");
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < columns; ++i) {
      const auto p = [&](int a, int b, int c) {
        return static_cast<vtkIdType>(i + a + (columns + 1) * (b + 2 * (k + c)));
      };
      const vtkIdType corners[8] = {p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0),
                                    p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)};
      grid->InsertNextCell(VTK_HEXAHEDRON, 8, corners);
      // A trapezium of two triangles.
      const double left = height(i, k + 1) - height(i, k), right = height(i + 1, k + 1) - height(i + 1, k);
      const double first = left * (height(i, k) + height(i, k + 1) + height(i + 1, k)) / 3,
                   second = right * (height(i, k + 1) + height(i + 1, k) + height(i + 1, k + 1)) / 3;
      const CellWater water = values(Vec3(0.5 * i + 0.25, 0, (first + second) / (left + right)));
      velocity->InsertNextTuple(water.velocity.data());
      pressure->InsertNextValue(water.pressure);
      fraction->InsertNextValue(water.fraction);
    }
  grid->GetCellData()->AddArray(velocity);
  grid->GetCellData()->AddArray(pressure);
  grid->GetCellData()->AddArray(fraction);
  return grid;
}

template <class Data>
std::string written(const TemporaryFolder& folder, const std::string& name, const Data& data) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName((folder / name).c_str());
  writer->SetInputData(data);
  REQUIRE(writer->Write() == 1);
  return folder / name;
}

WaterArrays all_arrays() {
  WaterArrays wish;
  wish.velocity = "U";
  wish.pressure = "p";
  wish.fraction = "alpha.water";
  return wish;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

} // namespace

TEST_CASE("a series of images is read back, and linear in between") {
  const TemporaryFolder folder;
  Image(0).write(folder / "a_0.vti");
  Image(2).write(folder / "a_1.vti");
  write_text(folder / "a.pvd",
             "<VTKFile type=\"Collection\"><Collection>"
             "<DataSet timestep=\"3\" part=\"0\" file=\"a_0.vti\"/>"
             "<DataSet timestep=\"5\" part=\"0\" file=\"a_1.vti\"/></Collection></VTKFile>");
  const WaterFiles files = water_files_of(folder / "a.pvd");
  CHECK(files.times == std::vector<double>{3, 5});
  WaterArrays wish = all_arrays();
  wish.pressure_factor = 1000;
  const RecordedWater water(read_water(files, wish));
  for (const Vec3& x : {Vec3(-1, 0, 0), Vec3(0.3, 7, 0.61), Vec3(1, -2, 0.9)})
    for (const double time : {3., 3.7, 5.}) {
      const WaterPoint point = water.at(x, time);
      CHECK((point.velocity - flow_at(x, time - 3)).norm() < 1e-12);
      CHECK(point.surface == Approx(1.125));
      CHECK(point.pressure == Approx(1e4 * (1 - x.z())));
    }
  CHECK(water.at({0, 0, 1.5}, 4).pressure == 0);
  CHECK((water.at({0, 0, 1.5}, 4).velocity - flow_at({0, 0, 1}, 1)).norm() < 1e-12); // of the water below
  wish.shift = {100, 0, 20};
  CHECK(RecordedWater(read_water(files, wish)).at({100, 0, 20.5}, 3).surface == Approx(21.125));
}

TEST_CASE("cells of a mesh one cell across are the same all along it") {
  const TemporaryFolder folder;
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName((folder / "f.vtu").c_str());
  writer->SetInputData(flume());
  REQUIRE(writer->Write() == 1);
  vtkNew<vtkDataSetWriter> legacy;
  legacy->SetFileName((folder / "f.vtk").c_str());
  legacy->SetInputData(flume());
  REQUIRE(legacy->Write() == 1);
  WaterArrays wish;
  wish.velocity = "U";
  wish.same_along = 1;
  for (const char* const name : {"f.vtu", "f.vtk"}) {
    const RecordedWater water(read_water({{folder / name}, {0}}, wish));
    CHECK((water.at({1.3, -40, 0.7}, 12).velocity - Vec3(2, 0, 0.5)).norm() < 1e-12);
    CHECK(water.box().max.x() == Approx(2));
    CHECK(std::isinf(water.box().max.y()));
  }
}

TEST_CASE("still water over a slope is exact beside the bed, whatever the cells", "[water]") {
  const TemporaryFolder folder;
  const double weight = 1000 * 9.81, level = 1.87;
  WaterArrays wish = all_arrays();
  wish.same_along = 1;
  wish.cell = 0.2; // the grid goes through cells and bed
  wish.density = 1000;
  wish.pressure_factor = 1000; // kPa
  const bool with_air = GENERATE(false, true);
  if (!with_air)
    wish.fraction.clear();
  const auto grid = over_a_slope([&](const Vec3& x) {
    const double deep = with_air ? std::max(0.0, level - x.z()) : level - x.z();
    return CellWater{Vec3::Zero(), 1e-3 * weight * deep, level > x.z() ? 1.0 : 0.0};
  });
  const RecordedWater water(read_water({{written(folder, "still.vtu", grid)}, {0}}, wish));
  for (const Vec3& x :
       {Vec3(0.01, 0, 0.02), Vec3(0.77, 0, 0.4), Vec3(1.5, 0, 0.76), Vec3(2.2, 0, 1.11), Vec3(2.3, 0, 1.5)})
    CHECK(water.at(x, 0).pressure == Approx(weight * (level - x.z())).epsilon(1e-9));
  wish.shift = {10, 0, -7};
  const RecordedWater shifted(read_water({{folder / "still.vtu"}, {0}}, wish));
  CHECK(shifted.at({11.5, 0, -6.2}, 0).pressure == Approx(weight * (level - 0.8)).epsilon(1e-9));
}

TEST_CASE("the wind over the water adds nothing to its velocity", "[water]") {
  const TemporaryFolder folder;
  WaterArrays wish = all_arrays();
  wish.same_along = 1;
  wish.cell = 0.1;
  const auto grid = over_a_slope([](const Vec3& x) {
    const bool wet = x.z() < 1.4;
    return CellWater{wet ? Vec3(2, 0, -1) : Vec3(-30, 5, 40), 0, wet ? 1.0 : x.z() < 1.6 ? 0.3 : 0.0};
  });
  const RecordedWater water(read_water({{written(folder, "wind.vtu", grid)}, {0}}, wish));
  for (const double x : {0.1, 0.6, 1.3}) {
    const double surface = water.at({x, 0, 0.7}, 0).surface;
    REQUIRE(surface > 1);
    REQUIRE(surface < 1.8);
    for (const double deep : {0.7, 0.2, 0.01})
      CHECK((water.at({x, 0, surface - deep}, 0).velocity - Vec3(2, 0, -1)).norm() < 1e-9);
  }
}

TEST_CASE("bad files of water are refused in one line that names the file") {
  const TemporaryFolder folder;
  const auto refused = [&](const WaterFiles& files, const WaterArrays& wish, const std::string& why) {
    try {
      read_water(files, wish);
      FAIL("read");
    } catch (const std::exception& error) {
      const std::string line = error.what();
      CHECK_THAT(line, Contains(why));
      CHECK(line.find('\n') == std::string::npos);
    }
  };
  const std::string good = folder / "good.vti";
  Image(0).write(good);
  WaterArrays wish = all_arrays();
  wish.pressure = "p_rgh";
  refused({{good}, {0}}, wish,
          "pressure = \"p_rgh\": there is no such array; it has \"U\", \"p\", \"alpha.water\"");
  wish = all_arrays();
  wish.velocity = "p";
  refused({{good}, {0}}, wish, "\"p\" has 1 components");
  Image(0, {40, 0, 0}).write(folder / "far.vti");
  refused({{good, folder / "far.vti"}, {0, 1}}, all_arrays(),
          "far.vti: its box begins at (40, 0, 0) m with 45 points, that of the first file at (-1, 0, 0) m "
          "with 45 points");
  Image hole(0);
  hole.velocity->SetComponent(7, 1, std::nan(""));
  hole.write(folder / "nan.vti");
  refused({{folder / "nan.vti"}, {0}}, all_arrays(), "nan.vti: \"U\" is nan at point 7");
  write_text(folder / "nan.vtk",
             "# vtk DataFile Version 2.0\nf\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 2\n"
             "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 4\nFIELD f 2\np 1 4 double\n1 nan 1 1\n"
             "U 3 4 double\n0 0 0 0 0 0 0 0 0 0 0 0\n");
  wish = all_arrays();
  wish.fraction.clear();
  refused({{folder / "nan.vtk"}, {0}}, wish, "nan");
  wish.same_along = 2;
  refused({{good}, {0}}, wish, "same_along = \"z\": must be x or y beside a pressure or a fraction");
  write_text(folder / "torn.vti", "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 99999 0 9999");
  refused({{folder / "torn.vti"}, {0}}, all_arrays(), "torn.vti");
  write_text(folder / "x.txt", "x");
  refused({{folder / "x.txt"}, {0}}, all_arrays(), "must be a name that ends in .vti");
  refused({{folder / "none.vti"}, {0}}, all_arrays(), "none.vti");
  wish = all_arrays();
  wish.cell = 1e-5;
  refused({{good}, {0}}, wish, "more than 2e7 points");
  const auto list = [&](const std::string& entry) {
    write_text(folder / "l.pvd", "<VTKFile><Collection>" + entry + "</Collection></VTKFile>");
    return folder / "l.pvd";
  };
  CHECK_THROWS_WITH(water_files_of(list("<DataSet timestep=\"0\" file=\"../a.vti\"/>")),
                    Contains("outside its folder"));
  CHECK_THROWS_WITH(water_files_of(list("<DataSet timestep=\"soon\" file=\"a.vti\"/>")),
                    Contains("no timestep"));
  CHECK_THROWS_WITH(water_files_of(list("")), Contains("lists no file"));
  CHECK_THROWS_WITH(water_files_of(folder / "x.txt"), Contains("no .pvd file"));
}
