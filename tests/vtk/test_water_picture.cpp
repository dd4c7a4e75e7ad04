// Water in pictures and files: it tints no coloured body, cuts bodies at its level, and is read back as it was written.
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/water_line.hpp"
#include "tests/vtk/image.hpp"
#include "tests/vtk/sample.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

using namespace cdem;

namespace {

// A level sheet over x -1 to 5 and y -1 to 3, in cells of 0.25 m.
WaterSheet level_sheet(double z) {
  WaterSheet s;
  s.origin = {-1, -1};
  s.cell = {0.25, 0.25};
  s.size = {25, 17};
  for (int j = 0; j < s.size[1]; ++j)
    for (int i = 0; i < s.size[0]; ++i) {
      s.points.emplace_back(-1 + 0.25 * i, -1 + 0.25 * j, z);
      s.velocity.emplace_back(1, 0, 0);
      s.height.push_back(z);
    }
  for (int j = 0; j + 1 < s.size[1]; ++j)
    for (int i = 0; i + 1 < s.size[0]; ++i) {
      const int p = i + j * s.size[0];
      s.triangles.push_back({p, p + 1, p + 1 + s.size[0]});
      s.triangles.push_back({p, p + 1 + s.size[0], p + s.size[0]});
    }
  return s;
}

// Two blocks of 1 m x 1 m x 0.2 m with a gap of 1 m between them.
Snapshot two_blocks() {
  const auto all = sample::grid(3, 1, 3, 1);
  return sample::blocks({all[0], all[2]}, 0.2);
}

std::array<int, 3> colour_at(const Image& image, double along) {
  const Image::Bounds b = image.bounds();
  return image.at(static_cast<int>(b.left + along * (b.right - b.left)), (b.bottom + b.top) / 2);
}

Image drawn(const Snapshot& s, const std::string& field) {
  const TemporaryFolder folder;
  PictureOptions o;
  o.field = field;
  o.colour_bar = o.edges = o.axes = o.legend = false;
  o.size = {400, 300};
  render(s, o, folder / "p.png");
  return read_png(folder / "p.png");
}

double length_of(const std::vector<Segment>& lines) {
  double sum = 0;
  for (const Segment& s : lines)
    sum += (s[1] - s[0]).norm();
  return sum;
}

} // namespace

TEST_CASE("water over coloured bodies leaves their colours, and tints what has none") {
  const Snapshot dry = two_blocks();
  Snapshot wet = dry;
  wet.water = {level_sheet(0.5)};
  const Image without = drawn(dry, "block_id"), with = drawn(wet, "block_id");
  for (const double block : {0.15, 0.85})
    CHECK(colour_at(with, block) == colour_at(without, block));
  CHECK(colour_at(without, 0.5) == std::array<int, 3>{255, 255, 255});
  const std::array<int, 3> gap = colour_at(with, 0.5);
  CHECK(gap[2] > gap[0] + 30); // blue over white

  const auto plain = colour_at(drawn(dry, ""), 0.15), under = colour_at(drawn(wet, ""), 0.15);
  CHECK(under[2] - under[0] > plain[2] - plain[0] + 30);
}

TEST_CASE("bodies above the water hide it, and bodies in front of bodies without colour stay in front") {
  Snapshot s = two_blocks();
  s.water = {level_sheet(-0.5)};
  const auto plain = colour_at(drawn(two_blocks(), ""), 0.15);
  CHECK(colour_at(drawn(s, ""), 0.15) == plain);
}

TEST_CASE("frames of a film keep their layout when the water goes") {
  const TemporaryFolder folder;
  PictureOptions o;
  o.size = {400, 300};
  o.fit = geom::Box{{-1, -1, -1}, {4, 2, 1}};
  o.axes = false;
  Snapshot s = two_blocks();
  const auto top_of_bodies = [&](const WaterSheet& sheet) {
    s.water = {sheet};
    render(s, o, folder / "p.png");
    return read_png(folder / "p.png").bounds().top;
  };
  CHECK(top_of_bodies(WaterSheet()) == top_of_bodies(level_sheet(-0.1)));
}

TEST_CASE("arrows of the water are hidden by the bodies over them") {
  Snapshot s = two_blocks();
  s.water = {level_sheet(-0.5)};
  const Image without = drawn(s, "");
  s.water[0].arrows = {{{0.2, 0.5, -0.5}, {1, 0, 0}}}; // below the first block
  CHECK(drawn(s, "").bytes == without.bytes);
  s.water[0].arrows = {{{1.3, 0.5, -0.5}, {1, 0, 0}}}; // in the gap
  CHECK(drawn(s, "").bytes != without.bytes);
}

TEST_CASE("the water line runs once round each body, at the level of the water") {
  const Snapshot s = two_blocks();
  const std::vector<Segment> lines = water_lines({level_sheet(0.13)}, s.points, s.surface);
  CHECK(length_of(lines) == Approx(8)); // two squares of 1 m
  for (const Segment& line : lines)
    for (const geom::Vec3& x : line)
      CHECK(x.z() == Approx(0.13));
  CHECK(water_lines({level_sheet(0.3)}, s.points, s.surface).empty());
}

TEST_CASE("water that bodies hide, or that is seen from its edge, is not told as a surface that is drawn") {
  const Snapshot s = two_blocks();
  const View above = View::named("front", "y"), beside = View::named("top", "y");
  const auto seen = [&](const WaterSheet& sheet, const View& view) {
    return is_seen({sheet}, s.points, s.surface, view);
  };
  CHECK(seen(level_sheet(0.1), above)); // in the gap
  CHECK_FALSE(seen(level_sheet(0.1), beside));
  const WaterSheet in_a_block = cropped(level_sheet(0.1), {{0.1, 0.1, 0}, {0.9, 0.9, 1}});
  CHECK_FALSE(seen(in_a_block, above));
  CHECK(seen(cropped(level_sheet(0.3), {{0.1, 0.1, 0}, {0.9, 0.9, 1}}), above));
}

TEST_CASE("a sheet cut to a rectangle covers the rectangle") {
  const WaterSheet part = cropped(level_sheet(0.5), {{0.1, 0.2, 0}, {2.35, 1.3, 1}});
  double area = 0;
  for (const geom::Triangle& t : part.triangles) {
    const geom::Vec3 &a = part.points[t[0]], &b = part.points[t[1]], &c = part.points[t[2]];
    area += 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  }
  CHECK(area == Approx(2.25 * 1.1));
  CHECK(cropped(level_sheet(0.5), {{10, 10, 0}, {11, 11, 1}}).triangles.empty());
}

TEST_CASE("a section shows the line of the water, and its arrows outside of the blocks") {
  Snapshot all = two_blocks();
  WaterSheet sheet = level_sheet(0.1);
  sheet.arrows = {{{0.5, 0.5, 0.1}, {2, 0, 0}}, {{1.5, 0.5, 0.1}, {1, 0, 0}}}; // in a block, in the gap
  const CutPlane plane{{0, 0.5, 0}, {0, 1, 0}};
  const std::vector<Polyline> line = water_in_section({sheet}, plane);
  REQUIRE(!line.empty());
  CHECK(line.front().label == "water line");
  double length = 0;
  for (const Polyline& part : line)
    length += (part.points[1] - part.points[0]).norm();
  CHECK(length == Approx(6));
  const std::vector<Polyline> arrows = water_arrows_in(section_of(all, plane), {sheet});
  REQUIRE(arrows.size() == 2); // shaft and head of one
  CHECK(arrows[0].points[0].x() == Approx(1.5));
  CHECK(arrows[0].label == "longest arrow 1 m/s");
}

TEST_CASE("the free surface is written for ParaView, also where all is dry") {
  const TemporaryFolder folder;
  Snapshot s = two_blocks();
  s.time = 2.5;
  s.water = {level_sheet(0.5), WaterSheet()};
  CHECK(water_path("out/run_3.vtu") == "out/run_3_water.vtu");
  const auto read = [&] {
    write_water(s, folder / "w.vtu");
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((folder / "w.vtu").c_str());
    reader->Update();
    return vtkSmartPointer<vtkUnstructuredGrid>(reader->GetOutput());
  };
  const auto grid = read();
  CHECK(grid->GetNumberOfPoints() == 25 * 17);
  CHECK(grid->GetNumberOfCells() == 2 * 24 * 16);
  CHECK(grid->GetPointData()->GetArray("velocity")->GetComponent(3, 0) == 1);
  CHECK(grid->GetCellData()->GetArray("water")->GetComponent(3, 0) == 0);
  s.water = {WaterSheet()};
  CHECK(read()->GetNumberOfCells() == 0);
}
