#include "libcdem/vtk/checksum.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libcdem/vtk/files.hpp"
#include "libgeom/core/error.hpp"
#include "tests/vtk/same_files.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace cdem;
using namespace testing;
using Catch::Matchers::Contains;

namespace {

// With a text for every character that a format may trip over, and numbers at the ends of a double.
Snapshot demanding_plate() {
  Snapshot s = sample::plate();
  s.title = "plate <1> & \"2\", \u03c3 = \u221230 MPa";
  s.body_names = {"plate", "<two> words & \"more\"", "", "\u00e9"};
  s.time = 0.1 + 0.2;
  s.step = (std::int64_t{1} << 40) + 1;
  s.point_fields[0].values[0] = 5e-324; // a subnormal, a signed zero and the largest double survive too
  s.point_fields[0].values[1] = -0.0;
  s.point_fields[0].values[2] = 1.7976931348623157e308;
  return s;
}

} // namespace

TEST_CASE("a snapshot written to .vtu or .vtkhdf reads back to the bit") {
  const TemporaryFolder folder;
  const Snapshot s = demanding_plate();
  for (const char* name : {"plate.vtu", "plate.vtkhdf"}) {
    INFO(name);
    write_vtu(s, folder / name);
    write_bonds(s, bonds_path(folder / name));
    require_same(read_vtu(folder / name), s);
  }
  CHECK(bonds_path("out/plate.vtkhdf") == "out/plate_bonds.vtkhdf");
}

TEST_CASE("VTK's readers find the same in a .vtkhdf and in a .vtu") {
  const TemporaryFolder folder;
  const Snapshot s = demanding_plate();
  write_vtu(s, folder / "plate.vtu");
  write_vtu(s, folder / "plate.vtkhdf");
  vtkNew<vtkXMLUnstructuredGridReader> xml;
  xml->SetFileName((folder / "plate.vtu").c_str());
  xml->Update();
  vtkNew<vtkHDFReader> hdf;
  REQUIRE(hdf->CanReadFile((folder / "plate.vtkhdf").c_str()));
  hdf->SetFileName((folder / "plate.vtkhdf").c_str());
  hdf->Update();
  auto* a = xml->GetOutput();
  auto* b = vtkUnstructuredGrid::SafeDownCast(hdf->GetOutputAsDataSet());
  REQUIRE(b != nullptr);
  REQUIRE(a->GetNumberOfPoints() == b->GetNumberOfPoints());
  REQUIRE(a->GetNumberOfCells() == b->GetNumberOfCells());
  const auto same = [](vtkDataArray* x, vtkDataArray* y) {
    REQUIRE(y != nullptr);
    REQUIRE(x->GetNumberOfTuples() == y->GetNumberOfTuples());
    REQUIRE(x->GetNumberOfComponents() == y->GetNumberOfComponents());
    bool all = true;
    for (vtkIdType i = 0; i < x->GetNumberOfTuples(); ++i)
      for (int c = 0; c < x->GetNumberOfComponents(); ++c)
        all = all && x->GetComponent(i, c) == y->GetComponent(i, c);
    CHECK(all);
  };
  same(a->GetPoints()->GetData(), b->GetPoints()->GetData());
  same(a->GetCells()->GetConnectivityArray(), b->GetCells()->GetConnectivityArray());
  same(a->GetCells()->GetOffsetsArray(), b->GetCells()->GetOffsetsArray());
  for (vtkIdType i = 0; i < a->GetNumberOfCells(); ++i)
    REQUIRE(a->GetCellType(i) == b->GetCellType(i));
  CHECK(a->GetPointData()->GetNumberOfArrays() == b->GetPointData()->GetNumberOfArrays());
  CHECK(a->GetCellData()->GetNumberOfArrays() == b->GetCellData()->GetNumberOfArrays());
  for (int i = 0; i < a->GetPointData()->GetNumberOfArrays(); ++i)
    same(a->GetPointData()->GetArray(i), b->GetPointData()->GetArray(a->GetPointData()->GetArrayName(i)));
  for (int i = 0; i < a->GetCellData()->GetNumberOfArrays(); ++i)
    same(a->GetCellData()->GetArray(i), b->GetCellData()->GetArray(a->GetCellData()->GetArrayName(i)));
  same(a->GetFieldData()->GetArray("TimeValue"), b->GetFieldData()->GetArray("TimeValue"));
  same(a->GetFieldData()->GetArray("step"), b->GetFieldData()->GetArray("step"));
}

TEST_CASE("a .vtkhdf with the same values has the same bytes, and is smaller than without compression") {
  const TemporaryFolder folder;
  const Snapshot s = sample::plate();
  write_vtu(s, folder / "a.vtkhdf");
  write_vtu(s, folder / "b.vtkhdf");
  CHECK(contents(folder / "a.vtkhdf") == contents(folder / "b.vtkhdf"));
  std::size_t raw = 0; // bytes
  for (const auto* fields : {&s.point_fields, &s.cell_fields})
    for (const SnapshotField& field : *fields)
      raw += sizeof(double) * field.values.size();
  CHECK(contents(folder / "a.vtkhdf").size() < raw);
}

TEST_CASE("a bond file without triangles goes into .vtkhdf too") {
  const TemporaryFolder folder;
  Snapshot s = sample::plate();
  s.bonds = {};
  write_vtu(s, folder / "plate.vtkhdf");
  write_bonds(s, bonds_path(folder / "plate.vtkhdf"));
  CHECK(read_vtu(folder / "plate.vtkhdf").bonds.triangles.empty());
}

TEST_CASE("a .vtkhdf that was changed, cut short or forged is refused in one line") {
  const TemporaryFolder folder;
  const std::string path = folder / "plate.vtkhdf";
  write_vtu(sample::plate(), path);
  const std::string good = contents(path);
  std::string changed = good;
  changed[good.size() / 2] = static_cast<char>(changed[good.size() / 2] ^ 1);
  overwrite(path, changed);
  CHECK_THROWS_WITH(read_vtu(path), Contains("changed or damaged"));
  overwrite(path, good.substr(0, good.size() / 2));
  CHECK_THROWS_WITH(read_vtu(path), Contains("incomplete"));
  // With a checksum that is right the bytes reach libhdf5, which may crash: in a child.
  constexpr std::size_t line = 40; // of the checksum
  for (std::size_t at = 0; at + line < good.size(); at += good.size() / 60 + 1) {
    std::string forged = good.substr(0, good.size() - line);
    for (std::size_t i = at; i < std::min(at + 8, forged.size()); ++i)
      forged[i] = static_cast<char>(~forged[i]);
    overwrite(path, forged);
    REQUIRE(add_checksum(path));
    try {
      static_cast<void>(read_vtu(path)); // numbers alone may have changed
    } catch (const geom::InputError& error) {
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("surface and block edges are found again from tets and block ids") {
  const TemporaryFolder folder;
  const Snapshot s = sample::plate();
  write_vtu(s, folder / "plate.vtu");
  const Snapshot r = read_vtu(folder / "plate.vtu");
  CHECK(places(r, r.surface) == places(s, s.surface));
  CHECK(sorted(r.block_edges) == sorted(s.block_edges));
  REQUIRE(r.surface_tet.size() == r.surface.size());
  // Each triangle's three nodes belong to the tet it names, and its normal points away from the fourth.
  bool belongs = true, outward = true;
  for (std::size_t i = 0; i < r.surface.size(); ++i) {
    const geom::Tet& tet = r.tets[static_cast<std::size_t>(r.surface_tet[i])];
    const geom::Triangle& t = r.surface[i];
    for (const int v : t)
      belongs = belongs && std::count(tet.begin(), tet.end(), v) == 1;
    const auto at = [&](int v) { return r.points[static_cast<std::size_t>(v)]; };
    const geom::Vec3 normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    for (const int v : tet)
      outward = outward && normal.dot(at(v) - at(t[0])) <= 1e-15;
  }
  CHECK(belongs);
  CHECK(outward);
}

TEST_CASE("tets of a block with nodes of their own share one surface") {
  // Two tets of one block that meet in a face but repeat its three nodes: six outer faces, not eight.
  Snapshot s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  s.tets = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  SnapshotField id{"block_id", "", 1, {7, 7}, true};
  const TemporaryFolder folder;
  s.cell_fields = {id};
  write_vtu(s, folder / "one.vtu");
  CHECK(read_vtu(folder / "one.vtu").surface.size() == 6);
  s.cell_fields[0].values = {7, 8};
  write_vtu(s, folder / "two.vtu");
  CHECK(read_vtu(folder / "two.vtu").surface.size() == 8);
}

TEST_CASE("the files say what ParaView looks for") {
  const TemporaryFolder folder;
  write_vtu(sample::plate(), folder / "plate.vtu");
  const std::string text = contents(folder / "plate.vtu");
  CHECK_THAT(text, Contains("type=\"UnstructuredGrid\""));
  CHECK_THAT(text, Contains("header_type=\"UInt64\""));
  CHECK_THAT(text, Contains("compressor=\"vtkZLibDataCompressor\""));
  CHECK_THAT(text, Contains("<AppendedData encoding=\"raw\">"));
  CHECK_THAT(text, Contains("Name=\"TimeValue\""));
}

TEST_CASE("a .pvd lists its files along one axis, time, steps or their order") {
  const TemporaryFolder folder;
  const auto places = [&](const std::vector<SeriesEntry>& series) {
    write_pvd(folder / "run.pvd", series);
    return contents(folder / "run.pvd");
  };
  CHECK(places({{0, 0, "a_0.vtu"}, {0.1, 50, "a & b.vtu"}}) ==
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
        "  <!-- timestep: time, s -->\n"
        "  <Collection>\n"
        "    <DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"a_0.vtu\"/>\n"
        "    <DataSet timestep=\"0.10000000000000001\" group=\"\" part=\"0\" file=\"a &amp; b.vtu\"/>\n"
        "  </Collection>\n"
        "</VTKFile>\n");
  // Two relaxations, which take no time, then a run.
  const std::string relaxed = places({{0, 200, "a.vtu"}, {0, 500, "b.vtu"}, {0.1, 900, "c.vtu"}});
  CHECK_THAT(relaxed, Contains("steps so far") && Contains("timestep=\"200\"") &&
                          Contains("timestep=\"900\"") && !Contains("0.1"));
  // Twice the same moment, as before and after an excavation.
  CHECK_THAT(places({{0, 200, "a.vtu"}, {0, 200, "b.vtu"}}),
             Contains("number of the file") && Contains("timestep=\"1\"") && Contains("timestep=\"2\""));
}

TEST_CASE("contacts are points with their forces") {
  const TemporaryFolder folder;
  ContactPoint contact;
  contact.place = {1, 2, 3};
  contact.normal = {0, 0, 400};
  contact.shear = {300, 0, 0};
  contact.depth = 1e-5;
  write_contacts({contact, contact}, sample::plate(), contacts_path(folder / "a.vtu"));
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder / "a_contacts.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  REQUIRE(grid->GetNumberOfPoints() == 2);
  CHECK(grid->GetCellType(1) == VTK_VERTEX);
  CHECK(grid->GetPoint(1)[2] == 3);
  CHECK(grid->GetPointData()->GetArray("force")->GetComponent(1, 0) == 300);
  CHECK(grid->GetPointData()->GetArray("normal_force")->GetComponent(0, 0) == 400);
  CHECK(grid->GetPointData()->GetArray("shear_force")->GetComponent(0, 0) == 300);
}

TEST_CASE(
    "meshio reads every kind of file") { // that holds anything: it fails at files without cells, whoever wrote them
  if (std::system("/usr/bin/python3 -c 'import meshio' 2>/dev/null") != 0) {
    WARN("no python3-meshio here: it is not tried");
    return;
  }
  const TemporaryFolder folder;
  Snapshot s = sample::plate();
  s.body_names = {"plate", "<two> words"};
  write_vtu(s, folder / "a.vtu");
  write_bonds(s, bonds_path(folder / "a.vtu"));
  write_surface(s, folder / "cracks.vtu");
  write_contacts({ContactPoint()}, s, folder / "contacts.vtu");
  write_vtu(s, folder / "p.vtu", s.tets.size() - 1);
  overwrite(folder / "read.py", "import meshio, sys\n"
                                "for name in ['a', 'a_bonds', 'cracks', 'contacts', 'p/p_0']:\n"
                                "    mesh = meshio.read(sys.argv[1] + '/' + name + '.vtu')\n"
                                "    print(name, len(mesh.points), sum(len(c.data) for c in mesh.cells))\n");
  const std::string run = "/usr/bin/python3 '" + (folder / "read.py") + "' '" + (folder / "") + "' >'" +
                          (folder / "said") + "' 2>&1";
  const int code = std::system(run.c_str());
  const std::string said = contents(folder / "said");
  INFO(said);
  CHECK(code == 0);
  CHECK_THAT(said,
             Contains("a " + std::to_string(s.points.size()) + " " + std::to_string(s.tets.size()) + "\n") &&
                 Contains("contacts 1 1\n"));
}

TEST_CASE("no temporary file stays behind") {
  const TemporaryFolder folder;
  const Snapshot s = sample::plate();
  write_vtu(s, folder / "a.vtu");
  write_bonds(s, folder / "a_bonds.vtu");
  write_pvd(folder / "a.pvd", {});
  CHECK(folder.names() == std::vector<std::string>{"a.pvd", "a.vtu", "a_bonds.vtu"});
}

TEST_CASE("a file that cannot be written is refused in one line") {
  const TemporaryFolder folder;
  const Snapshot s = sample::plate();
  CHECK_THROWS_WITH(write_vtu(s, folder / "none/a.vtu"),
                    Contains("none/a.vtu cannot be written: there is no folder"));
  CHECK_THROWS_AS(write_vtu(s, folder / "none/a.vtu"), FileError);
  CHECK_THROWS_WITH(write_vtu(s, folder / "a.txt"), Contains("ending in .vtu"));
  CHECK_THROWS_WITH(write_pvd(folder / "a.vtu", {}), Contains("ending in .pvd"));
  CHECK(folder.names().empty());
}

TEST_CASE("a file that cannot be read is refused in one line") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& path, const std::string& reason) {
    INFO(path);
    CHECK_THROWS_AS(read_vtu(path), geom::InputError);
    CHECK_THROWS_WITH(read_vtu(path), Contains(reason) && !Contains("\n"));
  };
  CHECK_THROWS_AS(read_vtu(folder / "missing.vtu"), FileError);
  CHECK_THROWS_WITH(read_vtu(folder / "missing.vtu"), Contains("no such file"));
  CHECK_THROWS_WITH(read_vtu(""), Contains("no such file"));
  overwrite(folder / "text.vtu", "not xml at all");
  refused(folder / "text.vtu", "it is not, or it is incomplete");
  overwrite(folder / "empty.vtu", "");
  refused(folder / "empty.vtu", "it is not, or it is incomplete");
  overwrite(folder / "other.vtu",
            "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\">" + std::string(99, ' '));
  refused(folder / "other.vtu", "it is not, or it is incomplete");

  const Snapshot s = sample::plate();
  write_bonds(s, folder / "bonds.vtu");
  refused(folder / "bonds.vtu", "not tetrahedra");

  write_vtu(s, folder / "whole.vtu");
  const std::string whole = contents(folder / "whole.vtu");
  for (const double part : {0.05, 0.3, 0.6, 0.9}) { // cut short, in the header and in the data
    overwrite(folder / "short.vtu",
              whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    refused(folder / "short.vtu", "incomplete");
  }
}

TEST_CASE("a file with any one byte changed is refused") {
  const TemporaryFolder folder;
  write_vtu(sample::blocks(sample::grid(1, 1, 2, 1), 0.5), folder / "whole.vtu");
  const std::string whole = contents(folder / "whole.vtu");
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 0x55);
    overwrite(folder / "changed.vtu", changed);
    INFO("byte " << i << " of " << whole.size());
    REQUIRE_THROWS_AS(read_vtu(folder / "changed.vtu"), geom::InputError);
  }
}
