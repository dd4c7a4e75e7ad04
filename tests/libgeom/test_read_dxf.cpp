// Surfaces from DXF files: each kind of face, and files that are cut off or lie.
#include "libgeom/core/error.hpp"
#include "libgeom/solid/read_surface.hpp"
#include "tests/libgeom/dxf_files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace geom;
using Catch::Matchers::Contains;
using testing::refusal;

namespace {

struct Dxf {
  TemporaryFolder folder;
  FileSurface operator()(const std::string& text, double scale = 1) const {
    std::ofstream(folder / "ground.dxf", std::ios::binary) << text;
    return read_surface(folder / "ground.dxf", scale, max_surface_triangles);
  }
};

double area(const Surface& surface) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto x = surface.corners(t);
    sum += 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  }
  return sum;
}

} // namespace

TEST_CASE("3DFACE, polyface and polygon meshes of the same roof are the same surface", "[dxf]") {
  const Dxf read;
  for (const std::string& text : {dxf_faces(), dxf_polyface(), dxf_mesh()}) {
    const Surface roof = read(text, 0.5).surface;
    CHECK(roof.triangles.size() == 4);
    CHECK(roof.points.size() == 6);
    CHECK(area(roof) == Approx(2 * std::sqrt(2.0) / 4));
    CHECK(open_edges(roof).size() == 6);
  }
}

TEST_CASE("line ends of both kinds, three corners, and what is no face", "[dxf]") {
  const Dxf read;
  std::string text =
      dxf("0\n3DFACE\n10\n0\n20\n0\n30\n0\n11\n1\n21\n0\n31\n0\n12\n0\n22\n1\n32\n0\n13\n0\n23\n1\n33\n0\n"
          "0\nLINE\n10\n0\n20\n0\n30\n0\n",
          "9\n$INSUNITS\n70\n4\n");
  std::string other;
  for (const char c : text)
    other += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& file : {text, other}) {
    const FileSurface one = read(file);
    CHECK(one.surface.triangles.size() == 1);
    CHECK_THAT(one.note, Contains("1 LINE") && Contains("millimetres; scale = 0.001"));
  }
}

TEST_CASE("a DXF that lies or is cut off is refused with its line", "[dxf]") {
  const Dxf read;
  const auto why = [&](const std::string& text) { return refusal([&] { read(text); }); };
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  CHECK_THAT(why("AutoCAD Binary DXF\r\n"), Contains("save it as ASCII"));
  CHECK_THAT(why("hello\n"), Contains("a group code must stand here"));
  CHECK_THAT(why(dxf_faces().substr(0, 200)), Contains("cut off"));
  CHECK_THAT(why(changed(dxf_faces(), "\n10\n0\n", "\n10\nnan\n")), Contains("must have a finite number"));
  CHECK_THAT(why(changed(dxf_polyface(), "\n71\n1\n", "\n71\n99\n")), Contains("names point 99 of 6"));
  CHECK_THAT(why(changed(dxf_mesh(), "\n72\n2\n", "\n72\n1000000000\n")),
             Contains("must be those of codes 71 x 72"));
  CHECK_THAT(why(dxf("0\n3DFACE\n10\n0\n")), Contains("lacks a corner"));
  CHECK_THAT(why(dxf("0\nCIRCLE\n10\n0\n")), Contains("it has none") && Contains("1 CIRCLE"));
  CHECK_THAT(why(dxf_faces() + dxf_faces()), !Contains("overlap")); // EOF ends it
}
