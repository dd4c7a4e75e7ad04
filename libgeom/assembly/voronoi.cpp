// Voronoi blocks of a box. The seeds are relaxed by Lloyd's steps, then the few that make edges much shorter
// than a block are moved a little until none is left: collapsing such edges instead would warp the faces
// around them. At last the cells' corners, which voro++ computes cell by cell, are made one where they agree
// to rounding.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/voronoi_cells.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace geom {
namespace {

// Below, lengths are in units of a cell's size: voro++ has absolute tolerances.
constexpr double merge_distance = 1e-8; // corners this near are one; rounding leaves them within 1e-11
constexpr double shortest_edge = 1e-3;  // of a cell's size, or of the box's smallest side
constexpr double shortest_extruded_edge = 1e-2; // 2-D diagrams have fewer edges, so more can be asked
constexpr double nudge = 0.1;                   // largest move of a seed along an axis to lengthen an edge
constexpr int most_rounds = 100;

class Diagram {
public:
  Diagram(const VoronoiOptions& o, double unit)
      : options_(o), box_(o.size / unit), all_(static_cast<std::size_t>(o.count)) {
    std::iota(all_.begin(), all_.end(), 0);
    for (int i = 0; i < o.count; ++i) {
      Vec3 x;
      for (int axis = 0; axis < 3; ++axis)
        x[axis] = box_[axis] * uniform(o.seed, i, axis);
      seeds_.push_back(on_mid_plane(x));
    }
    cells_ = voronoi_cells(box_, seeds_, all_);
  }

  void relax() {
    for (int step = 0; step < options_.relaxations; ++step) {
      for (std::size_t i = 0; i < seeds_.size(); ++i)
        seeds_[i] = on_mid_plane(mass_properties(cells_[i].shape).centroid);
      cells_ = voronoi_cells(box_, seeds_, all_);
    }
  }

  void lengthen_edges() {
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<char> moved(seeds_.size(), 0), stale(seeds_.size(), 0);
      std::vector<int> movers;
      for (int i : all_) {
        const std::vector<int>& around = cells_[i].neighbours;
        const bool neighbour_moved =
            std::any_of(around.begin(), around.end(), [&](int j) { return j >= 0 && moved[j]; });
        if (neighbour_moved || !has_short_edge(cells_[i].shape))
          continue;
        moved[i] = 1;
        movers.push_back(i);
        mark(i, stale);
        for (int axis = 0; axis < 3; ++axis) {
          const double step = nudge * (2 * uniform(options_.seed, i, 3 + 3 * round + axis) - 1);
          const double x = seeds_[i][axis] + step * std::min(1.0, box_[axis]);
          seeds_[i][axis] = x > 0 && x < box_[axis] ? x : 2 * seeds_[i][axis] - x;
        }
        seeds_[i] = on_mid_plane(seeds_[i]);
      }
      if (movers.empty())
        return;
      // Only the moved cells and their neighbours of before and after have changed.
      recompute(movers);
      for (int i : movers)
        mark(i, stale);
      std::vector<int> rest;
      for (int i : all_)
        if (stale[i] && !moved[i])
          rest.push_back(i);
      recompute(rest);
    }
  }

  // Every corner of every cell: its number in `corners`, one for all cells that meet there.
  std::vector<std::vector<int>> merged_corners(std::vector<Vec3>& corners) const {
    struct Entry {
      double key;
      int cell, vertex;
    };
    const Vec3 skew(0.8365163037, 0.5257311121,
                    options_.extruded ? 0 : 0.1545084972); // no two box sides have one key
    std::vector<Entry> entries;
    std::vector<std::vector<int>> number(cells_.size());
    for (int i : all_) {
      number[i].resize(cells_[i].shape.vertices.size());
      for (std::size_t v = 0; v < number[i].size(); ++v)
        entries.push_back({skew.dot(cells_[i].shape.vertices[v]), i, static_cast<int>(v)});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.key != b.key ? a.key < b.key : a.cell != b.cell ? a.cell < b.cell : a.vertex < b.vertex;
    });
    std::vector<std::pair<double, int>> recent; // key and number of the corners so far
    std::size_t oldest = 0;
    for (const Entry& e : entries) {
      const Vec3 x = on_sides(cells_[e.cell].shape.vertices[e.vertex]);
      while (oldest < recent.size() && recent[oldest].first < e.key - 2 * merge_distance)
        ++oldest;
      int found = -1;
      Vec3 place = x;
      for (std::size_t k = oldest; k < recent.size() && found < 0; ++k) {
        const Vec3& y = corners[recent[k].second];
        if ((y - x).head<2>().norm() > merge_distance)
          continue;
        if (std::abs(y.z() - x.z()) <= merge_distance)
          found = recent[k].second;
        else if (options_.extruded)
          place.head<2>() = y.head<2>(); // straight above or below: the same line
      }
      if (found < 0) {
        found = static_cast<int>(corners.size());
        corners.push_back(place);
        recent.emplace_back(e.key, found);
      }
      number[e.cell][e.vertex] = found;
    }
    return number;
  }

  const std::vector<VoronoiCell>& cells() const { return cells_; }
  const Vec3& box() const { return box_; }

private:
  Vec3 on_mid_plane(Vec3 x) const {
    if (options_.extruded)
      x.z() = 0.5 * box_.z();
    return x;
  }

  Vec3 on_sides(Vec3 x) const {
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(x[axis]) <= merge_distance)
        x[axis] = 0;
      else if (std::abs(x[axis] - box_[axis]) <= merge_distance)
        x[axis] = box_[axis];
    if (options_.extruded)
      x.z() = x.z() < 0.5 * box_.z() ? 0 : box_.z();
    return x;
  }

  bool has_short_edge(const Polyhedron& p) const {
    const double limit = options_.extruded ? shortest_extruded_edge * std::min(1.0, box_.head<2>().minCoeff())
                                           : shortest_edge * std::min(1.0, box_.minCoeff());
    for (const PolyhedronFace& face : p.faces)
      for (std::size_t k = 0; k < face.loop.size(); ++k) {
        const Vec3 d = p.vertices[face.loop[(k + 1) % face.loop.size()]] - p.vertices[face.loop[k]];
        const bool through_thickness = options_.extruded && std::abs(d.z()) > 0.5 * box_.z();
        if (!through_thickness && d.norm() < limit)
          return true;
      }
    return false;
  }

  void mark(int cell, std::vector<char>& stale) const {
    for (int j : cells_[cell].neighbours)
      if (j >= 0)
        stale[j] = 1;
  }

  void recompute(const std::vector<int>& wanted) {
    std::vector<VoronoiCell> fresh = voronoi_cells(box_, seeds_, wanted);
    for (std::size_t k = 0; k < wanted.size(); ++k)
      cells_[wanted[k]] = std::move(fresh[k]);
  }

  VoronoiOptions options_;
  Vec3 box_;
  std::vector<int> all_;
  std::vector<Vec3> seeds_;
  std::vector<VoronoiCell> cells_;
};

void check(const VoronoiOptions& o) {
  require_positive("size", o.size);
  require_finite("origin", o.origin);
  constexpr double most = 1e4; // beyond it cells are slivers whose corners cannot be told apart
  const double shortest = o.extruded ? o.size.head<2>().minCoeff() : o.size.minCoeff(),
               longest = o.extruded ? o.size.head<2>().maxCoeff() : o.size.maxCoeff();
  if (!(longest <= most * shortest))
    throw InputError("size", text(o.size), "such that no side is more than 10000 times as long as another",
                     o.extruded ? "" : "a thin plate can be extruded = true");
  if (o.count < 1)
    throw InputError("count", std::to_string(o.count), "a whole number >= 1");
  require_block_count("count", std::to_string(o.count), o.count, "use fewer blocks");
  if (o.relaxations < 0 || o.relaxations > 1000)
    throw InputError("relaxations", std::to_string(o.relaxations), "a whole number from 0 to 1000");
}

// The cell's shape over the merged corners, in metres; `corners` are in cell units.
Polyhedron block_of(const Polyhedron& cell, const std::vector<int>& number,
                    const std::vector<Vec3>& corners) {
  Polyhedron block;
  std::vector<int> used; // merged corners in the order they are met
  for (const PolyhedronFace& face : cell.faces) {
    PolyhedronFace mine;
    for (int v : face.loop) {
      const auto found = std::find(used.begin(), used.end(), number[v]);
      const int place = static_cast<int>(found - used.begin());
      if (found == used.end()) {
        used.push_back(number[v]);
        block.vertices.push_back(corners[number[v]]);
      }
      if (mine.loop.empty() || (mine.loop.back() != place && mine.loop.front() != place))
        mine.loop.push_back(place);
    }
    if (mine.loop.size() >= 3)
      block.faces.push_back(std::move(mine));
  }
  return block;
}

} // namespace

Assembly voronoi(const VoronoiOptions& o) {
  check(o);
  const double unit = o.extruded ? std::sqrt(o.size.x() / o.count * o.size.y())
                                 : std::cbrt(o.size.x() / o.count * o.size.y() * o.size.z());
  Diagram diagram(o, unit);
  diagram.relax();
  diagram.lengthen_edges();

  std::vector<Vec3> corners;
  const auto number = diagram.merged_corners(corners);
  for (Vec3& x : corners)
    for (int axis = 0; axis < 3; ++axis)
      x[axis] = o.origin[axis] + (x[axis] == diagram.box()[axis] ? o.size[axis] : unit * x[axis]);
  Assembly assembly;
  for (std::size_t i = 0; i < number.size(); ++i)
    assembly.blocks.push_back(block_of(diagram.cells()[i].shape, number[i], corners));
  return assembly;
}

} // namespace geom
