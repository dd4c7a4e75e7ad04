// Large files in pieces.
#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/pieces.hpp"
#include "libgeom/core/error.hpp"
#include "tests/vtk/same_files.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>

#include <filesystem>

using namespace cdem;
using namespace testing;
using Catch::Matchers::Contains;

namespace {

// Boxes of tetrahedra, each a block, with their bonds.
Snapshot boxes() {
  Snapshot s = sample::blocks(sample::grid(3, 2, 3, 2), 0.5);
  sample::add_wedge_fields(s, 1e-3);
  sample::add_interface(s, {0, 1}, {3, 1}, 0.5, BondMode::broken_tension, 8);
  s.title = "boxes";
  s.time = 0.25;
  s.step = 12;
  return s;
}

} // namespace

TEST_CASE("a large file is written in pieces, which read back to the bit") {
  const Snapshot s = boxes();
  const auto n = s.tets.size();
  for (const std::size_t limit : {n - 1, n / 3, std::size_t{7}, std::size_t{1}}) {
    const TemporaryFolder folder;
    CAPTURE(limit);
    write_vtu(s, folder / "whole.vtu");
    write_bonds(s, folder / "whole_bonds.vtu");
    CHECK(write_vtu(s, folder / "a.vtu", limit) == folder / "a.pvtu");
    write_bonds(s, folder / "a_bonds.vtu", limit);
    const Snapshot whole = read_vtu(folder / "whole.vtu"), joined = read_vtu(folder / "a.pvtu");
    require_same(joined, whole);
    require_same(joined, s);
    CHECK(places(joined, joined.surface) ==
          places(whole, whole.surface)); // pieces have no outside of their own
    CHECK(sorted(joined.block_edges) == sorted(whole.block_edges));
    std::size_t cells = 0, pieces = 0;
    for (; std::ifstream(folder / ("a/a_" + std::to_string(pieces) + ".vtu")); ++pieces)
      cells += read_vtu(folder / ("a/a_" + std::to_string(pieces) + ".vtu")).tets.size();
    CHECK(cells == n);
    CHECK(pieces == (n + limit - 1) / limit);
  }
}

TEST_CASE("a file within the limit is the same as ever") {
  const TemporaryFolder folder;
  const Snapshot s = boxes();
  write_vtu(s, folder / "a.vtu");
  CHECK(write_vtu(s, folder / "b.vtu", s.tets.size()) == folder / "b.vtu");
  CHECK(contents(folder / "a.vtu") == contents(folder / "b.vtu"));
  CHECK(write_vtu(s, folder / "a.vtkhdf", 1) == folder / "a.vtkhdf"); // one file of any number
}

TEST_CASE("VTK reads the pieces of a large file as one") {
  const TemporaryFolder folder;
  const Snapshot s = boxes();
  write_vtu(s, folder / "a.vtu", 5);
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName((folder / "a.pvtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  REQUIRE(grid->GetNumberOfCells() == static_cast<vtkIdType>(s.tets.size()));
  for (const SnapshotField& field : s.cell_fields) {
    INFO(field.name);
    vtkDataArray* array = grid->GetCellData()->GetArray(field.name.c_str());
    REQUIRE(array);
    REQUIRE(array->GetNumberOfComponents() == field.components);
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
      CHECK(array->GetComponent(cell, 0) ==
            field.values[static_cast<std::size_t>(cell) * static_cast<std::size_t>(field.components)]);
  }
  for (const SnapshotField& field : s.point_fields)
    CHECK(grid->GetPointData()->GetArray(field.name.c_str()));
}

TEST_CASE("a file takes the place of pieces of its name, and pieces that of a file") {
  const TemporaryFolder folder;
  const Snapshot s = boxes();
  const auto exists = [&](const std::string& name) { return std::filesystem::exists(folder / name); };
  write_vtu(s, folder / "a.vtu");
  write_vtu(s, folder / "a.vtu", 10);
  CHECK(!exists("a.vtu"));
  CHECK(exists("a/a_3.vtu"));
  write_vtu(s, folder / "a.vtu", s.tets.size() - 1);
  CHECK(exists("a/a_1.vtu"));
  CHECK(!exists("a/a_2.vtu"));
  overwrite(folder / "a/mine.txt", "kept");
  write_vtu(s, folder / "a.vtu");
  CHECK(exists("a.vtu"));
  CHECK(!exists("a.pvtu"));
  CHECK(!exists("a/a_0.vtu"));
  CHECK(exists("a/mine.txt"));
}

TEST_CASE("pieces that do not belong together are refused in one line") {
  const TemporaryFolder folder;
  Snapshot s = boxes();
  write_vtu(s, folder / "a.vtu", 10);
  const auto refused = [&](const std::string& reason) {
    CHECK_THROWS_WITH(read_vtu(folder / "a.pvtu"), Contains("a.pvtu") && Contains(reason));
  };
  const std::string piece = contents(folder / "a/a_1.vtu"), list = contents(folder / "a.pvtu");
  s.step += 1;
  write_vtu(s, folder / "b.vtu", 10);
  overwrite(folder / "a/a_1.vtu", contents(folder / "b/b_1.vtu"));
  refused("its pieces are of different moments");
  write_vtu(sample::plate(), folder / "a/a_1.vtu");
  CHECK_THROWS_AS(read_vtu(folder / "a.pvtu"), geom::InputError);
  overwrite(folder / "a/a_1.vtu", piece.substr(0, piece.size() / 2));
  CHECK_THROWS_WITH(read_vtu(folder / "a.pvtu"), Contains("a_1.vtu") && Contains("incomplete"));
  std::filesystem::remove(folder / "a/a_1.vtu");
  CHECK_THROWS_WITH(read_vtu(folder / "a.pvtu"), Contains("a_1.vtu") && Contains("there is no such file"));
  overwrite(folder / "a/a_1.vtu", piece);
  CHECK(read_vtu(folder / "a.pvtu").tets.size() == s.tets.size());
  std::string outside = list;
  outside.replace(outside.find("a/a_1.vtu"), 9, "../x1.vtu");
  overwrite(folder / "a.pvtu", outside);
  refused("changed or damaged");
  REQUIRE(add_checksum(folder / "a.pvtu"));
  refused("outside its folder");
}
