// Surfaces of cracks as .vtp, read back with VTK.
#include "libcdem/vtk/files.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <catch2/catch.hpp>

using namespace cdem;
using Catch::Matchers::Contains;

namespace {

vtkSmartPointer<vtkPolyData> read(const std::string& path) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

} // namespace

TEST_CASE("a surface written to .vtp has the triangles, fields and time of its snapshot") {
  const TemporaryFolder folder;
  Snapshot s = sample::plate();
  s.time = 0.125;
  write_surface(s, folder / "cracks.vtp");
  const auto surface = read(folder / "cracks.vtp");
  const BondSnapshot& bonds = s.bonds;
  REQUIRE(surface->GetNumberOfPoints() == static_cast<vtkIdType>(bonds.points.size()));
  REQUIRE(surface->GetNumberOfPolys() == static_cast<vtkIdType>(bonds.triangles.size()));
  for (std::size_t i = 0; i < bonds.points.size(); ++i) {
    double x[3];
    surface->GetPoint(static_cast<vtkIdType>(i), x);
    CHECK((geom::Vec3(x[0], x[1], x[2]) - bonds.points[i]).norm() == 0);
  }
  for (const SnapshotField& field : bonds.triangle_fields) {
    vtkDataArray* const array = surface->GetCellData()->GetArray(field.name.c_str());
    REQUIRE(array != nullptr);
    for (std::size_t i = 0; i < field.values.size(); ++i)
      CHECK(array->GetComponent(static_cast<vtkIdType>(i), 0) == field.values[i]);
  }
  for (const SnapshotField& field : bonds.point_fields)
    CHECK(surface->GetPointData()->GetArray(field.name.c_str()) != nullptr);
  CHECK(surface->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0) == 0.125);
}

TEST_CASE("a surface without a triangle is a file all the same, and another ending is refused") {
  const TemporaryFolder folder;
  write_surface({}, folder / "none.vtp");
  CHECK(read(folder / "none.vtp")->GetNumberOfPolys() == 0);
  CHECK_THROWS_WITH(write_surface({}, folder / "cracks.stl"), Contains(".vtp"));
}
