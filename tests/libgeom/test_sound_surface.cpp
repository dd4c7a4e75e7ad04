// Surfaces as CAD writes them: needles that close T-junctions, corners on edges of others, surfaces that cross themselves.
#include "libgeom/mesh/sound_surface.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "libgeom/solid/read_surface.hpp"
#include "tests/support/refusal.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace geom;
using Catch::Matchers::Contains;

namespace {

using Corners = std::vector<std::array<Vec3, 3>>;

// A prism of height 1 over a polygon, its upper face as a fan from the point `hub` of its first edge, so that this edge is
// cut in two above and whole on the side.
Corners prism(const std::vector<Vec3>& foot, double hub) {
  const Vec3 up(0, 0, 1);
  Corners all;
  const std::size_t n = foot.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = foot[i], &b = foot[(i + 1) % n];
    all.push_back({a, b, b + up});
    all.push_back({a, b + up, a + up});
    if (i >= 2)
      all.push_back({foot[0], a, foot[i - 1]});
    if (i >= 1)
      all.push_back({foot[0] + hub * (foot[1] - foot[0]) + up, a + up, b + up});
  }
  return all;
}

void write_stl(const std::string& path, const Corners& corners) {
  std::ofstream out(path);
  out.precision(9);
  out << "solid a\n";
  for (const auto& t : corners) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : t)
      out << "vertex " << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid a\n";
}

const std::vector<Vec3> square{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};

double volume_of(const Corners& corners) {
  const TemporaryFolder folder;
  write_stl(folder / "part.stl", corners);
  return mass_properties(make_solid(read_stl(folder / "part.stl"))).volume;
}

} // namespace

TEST_CASE("a solid from STL has the volume within its triangles, with T-junctions open or closed by needles",
          "[stl]") {
  const Corners open = prism(square, 0.3);
  CHECK(volume_of(open) == Approx(4).epsilon(1e-6));
  Corners closed = open; // the needle lies in the edge, as CAD writes it
  closed.push_back({Vec3(0, 0, 1), Vec3(0.6, 0, 1), Vec3(2, 0, 1)});
  CHECK(volume_of(closed) == Approx(4).epsilon(1e-6));
  Corners bent = open; // not quite in it
  bent.push_back({Vec3(0, 0, 1), Vec3(0.6, 1e-7, 1), Vec3(2, 0, 1)});
  CHECK(volume_of(bent) == Approx(4).epsilon(1e-6));
}

TEST_CASE("what was mended is told, and a sound surface is left as it is", "[stl]") {
  const TemporaryFolder folder;
  Corners closed = prism(square, 0.3);
  closed.push_back({Vec3(0, 0, 1), Vec3(0.6, 0, 1), Vec3(2, 0, 1)});
  write_stl(folder / "part.stl", closed);
  CHECK(read_surface(folder / "part.stl", 1, 100).mended ==
        "1 triangle without area, 1 corner on edges of others");
  write_stl(folder / "part.stl", prism(square, 0)); // from a corner
  const FileSurface sound = read_surface(folder / "part.stl", 1, 100);
  CHECK(sound.mended.empty());
  CHECK(open_edges(sound.surface).empty());
}

TEST_CASE("a surface that crosses itself is refused, one that folds or touches itself is not", "[stl]") {
  const TemporaryFolder folder;
  const auto said = [&](const Corners& corners) {
    write_stl(folder / "part.stl", corners);
    return testing::refusal([&] { read_surface(folder / "part.stl", 1, 100); });
  };
  // Two walls that cross in the middle, at the diagonals of both.
  const std::vector<Vec3> bow{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
  CHECK_THAT(said(prism(bow, 0)), Contains("must not cross itself"));
  // A triangle stuck through another.
  CHECK_THAT(
      said({{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)}, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(3, 3, 1)}}),
      Contains("must not cross itself"));
  CHECK(said(prism(square, 0.3)) == "");
  CHECK(said({{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)},
              {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(3, 3, 1)}}) == "");
}
