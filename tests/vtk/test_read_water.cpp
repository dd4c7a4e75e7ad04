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
  refused({{good, folder / "far.vti"}, {0, 1}}, all_arrays(), "far.vti: its box begins at");
  Image hole(0);
  hole.velocity->SetComponent(7, 1, std::nan(""));
  hole.write(folder / "nan.vti");
  refused({{folder / "nan.vti"}, {0}}, all_arrays(), "nan.vti: \"U\" is nan at point 7");
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
