#include "libgeom/assembly/voronoi_cells.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/stop.hpp"

#include <voro++/voro++.hh>

#include <algorithm>
#include <cmath>
#include <string>

namespace geom {

std::vector<VoronoiCell> voronoi_cells(const Vec3& box, const std::vector<Vec3>& seeds,
                                       const std::vector<int>& wanted) {
  // About five seeds to a bin is what voro++ is fastest with.
  const double bin = std::cbrt(5 * box.prod() / static_cast<double>(seeds.size()));
  const auto bins = [&](int axis) {
    return static_cast<int>(std::clamp(std::ceil(box[axis] / bin), 1.0, 1e4));
  };
  voro::container container(0, box.x(), 0, box.y(), 0, box.z(), bins(0), bins(1), bins(2), false, false,
                            false, 8);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    container.put(static_cast<int>(i), seeds[i].x(), seeds[i].y(), seeds[i].z());

  std::vector<std::array<int, 2>> place(seeds.size(), {-1, -1}); // bin, number in it
  voro::c_loop_all loop(container);
  if (loop.start())
    do
      place[loop.pid()] = {loop.ijk, loop.q};
    while (loop.inc());

  std::vector<VoronoiCell> cells;
  cells.reserve(wanted.size());
  voro::voronoicell_neighbor raw;
  std::vector<double> coordinates;
  std::vector<int> loops;
  for (int i : wanted) {
    const Vec3& x = seeds[i];
    if (place[i][0] < 0 || !container.compute_cell(raw, place[i][0], place[i][1]))
      throw InputError("voronoi: seed " + std::to_string(i) +
                       " coincides with another one or lies outside of the box");
    if (cells.size() % 1000 == 0)
      throw_if_stopped();
    VoronoiCell cell;
    raw.vertices(x.x(), x.y(), x.z(), coordinates);
    for (std::size_t k = 0; k + 2 < coordinates.size(); k += 3)
      cell.shape.vertices.emplace_back(coordinates[k], coordinates[k + 1], coordinates[k + 2]);
    raw.face_vertices(loops); // n, v1 ... vn, n, ...
    for (std::size_t k = 0; k < loops.size(); k += static_cast<std::size_t>(loops[k]) + 1) {
      PolyhedronFace face{std::vector<int>(loops.begin() + k + 1, loops.begin() + k + 1 + loops[k])};
      cell.shape.faces.push_back(std::move(face));
      const int last = static_cast<int>(cell.shape.faces.size()) - 1;
      if (face_normal(cell.shape, last).dot(cell.shape.vertices[cell.shape.faces.back().loop[0]] - x) < 0)
        std::reverse(cell.shape.faces.back().loop.begin(), cell.shape.faces.back().loop.end());
    }
    raw.neighbors(cell.neighbours);
    cells.push_back(std::move(cell));
  }
  return cells;
}

} // namespace geom
