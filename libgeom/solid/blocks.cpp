// The blocks of an assembly as the regions of one solid, which share their faces.
#include "libgeom/solid/gmsh_session.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace geom {

namespace occ = gmsh::model::occ;

namespace {

// Points nearer than this part of an assembly's smallest block are one.
constexpr double same_point = 1e-7;

// The faces of all blocks over points that neighbours share.
struct SharedPoints {
  std::vector<Vec3> points;
  std::vector<std::vector<std::vector<int>>>
      loops; // block, face: loop over points; empty when nothing is left of it
};

SharedPoints with_shared_points(const Assembly& assembly, double tolerance) {
  SharedPoints shared;
  std::map<std::array<std::int64_t, 3>, std::vector<int>>
      cells; // points by the cell of side 2 tolerance they lie in
  const auto point_at = [&](const Vec3& x) {
    std::array<std::int64_t, 3> low{};
    for (int axis = 0; axis < 3; ++axis) // of the eight cells that a ball of the tolerance can reach into
      low[axis] = std::llround(std::floor((x[axis] - tolerance) / (2 * tolerance)));
    for (int corner = 0; corner < 8; ++corner) {
      const auto cell =
          cells.find({low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2)});
      if (cell == cells.end())
        continue;
      for (const int point : cell->second)
        if ((shared.points[point] - x).norm() <= tolerance)
          return point;
    }
    std::array<std::int64_t, 3> own{};
    for (int axis = 0; axis < 3; ++axis)
      own[axis] = std::llround(std::floor(x[axis] / (2 * tolerance)));
    cells[own].push_back(static_cast<int>(shared.points.size()));
    shared.points.push_back(x);
    return static_cast<int>(shared.points.size()) - 1;
  };
  for (const Polyhedron& block : assembly.blocks) {
    std::vector<int> number;
    for (const Vec3& x : block.vertices)
      number.push_back(point_at(x));
    shared.loops.emplace_back();
    for (const PolyhedronFace& face : block.faces) {
      std::vector<int> loop;
      for (const int v : face.loop)
        if (loop.empty() || (number[v] != loop.back() && number[v] != loop.front()))
          loop.push_back(number[v]);
      shared.loops.back().push_back(loop.size() < 3 ? std::vector<int>() : loop);
    }
  }
  return shared;
}

std::vector<int> ascending(std::vector<int> loop) {
  std::sort(loop.begin(), loop.end());
  return loop;
}

// Every face that two blocks share is the whole face of both.
bool all_match(const Assembly& assembly, const SharedPoints& shared, double tolerance) {
  for (const SharedFace& pair : shared_faces(assembly.blocks, tolerance))
    if (ascending(shared.loops[pair.block_a][pair.face_a]) !=
        ascending(shared.loops[pair.block_b][pair.face_b]))
      return false;
  return true;
}

// Inside a session: the blocks over shared points, lines and faces.
Pieces add_volumes(const SharedPoints& shared) {
  Pieces volumes;
  std::vector<int> points;
  for (const Vec3& x : shared.points)
    points.push_back(occ::addPoint(x.x(), x.y(), x.z()));
  std::map<std::array<int, 2>, int> lines;  // by ends, ascending
  std::map<std::vector<int>, int> surfaces; // by points, ascending
  for (const auto& block : shared.loops) {
    std::vector<int> faces;
    for (const std::vector<int>& loop : block) {
      if (loop.empty())
        continue;
      const auto [surface, fresh] = surfaces.try_emplace(ascending(loop), 0);
      if (fresh) {
        std::vector<int> curves;
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const auto [low, high] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
          const auto [line, added] = lines.try_emplace({low, high}, 0);
          if (added)
            line->second = occ::addLine(points[low], points[high]);
          curves.push_back(line->second);
        }
        surface->second = occ::addPlaneSurface({occ::addCurveLoop(curves)});
      }
      faces.push_back(surface->second);
    }
    volumes.emplace_back(3, occ::addVolume({occ::addSurfaceLoop(faces)}));
  }
  return volumes;
}

// The same where faces overlap in part: OpenCASCADE cuts them, in a time that grows with the square of the blocks.
void add_fragments(const Assembly& assembly, double tolerance) {
  Pieces first, others;
  for (const Polyhedron& block : assembly.blocks)
    (first.empty() ? first : others).push_back(add_volumes(with_shared_points({{block}}, tolerance)).front());
  Pieces out;
  std::vector<Pieces> map;
  occ::fragment(first, others, out, map); // keeps the numbers of volumes that stay whole
}

} // namespace

Solid make_solid(const Assembly& assembly) {
  if (assembly.blocks.empty())
    throw InputError("blocks", "none", "at least one");
  if (assembly.blocks.size() == 1)
    return make_solid(assembly.blocks.front());
  double smallest = std::numeric_limits<double>::infinity();
  for (const Polyhedron& block : assembly.blocks) {
    smallest = std::min(smallest, std::cbrt(mass_properties(block).volume));
    for (const Vec3& x : block.vertices)
      require_place("vertices", x);
  }
  const double tolerance = same_point * smallest;
  const SharedPoints shared = with_shared_points(assembly, tolerance);
  Solid solid = in_session("solid of blocks", [&] {
    if (all_match(assembly, shared, tolerance))
      add_volumes(shared);
    else
      add_fragments(assembly, tolerance);
    return store("solid of blocks");
  });
  if (solid.regions() != static_cast<int>(assembly.blocks.size()))
    throw InputError("solid of blocks: " + std::to_string(assembly.blocks.size()) + " blocks make " +
                     std::to_string(solid.regions()) + " regions; blocks may touch but not overlap");
  return solid;
}

} // namespace geom
