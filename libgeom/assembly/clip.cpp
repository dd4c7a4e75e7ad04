#include "libgeom/assembly/clip.hpp"

#include "libgeom/assembly/surface_rays.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/core/stop.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace geom {
namespace {

// Over the block's size: facets nearer than this to a cell's faces lie on them, and vertices nearer than a tenth of it
// to a plane lie on the plane. The rounding of coordinates is smaller, and so is the warp of a face that validate()
// refuses.
constexpr double on_face = 1e-9, on_plane = 1e-10;
constexpr double thin_part = 0.05; // of the block's 6 V / A
constexpr std::size_t most_pieces = 20000;

// A triangle, as far as it lies in a cell.
struct Facet {
  Plane plane;
  std::vector<Vec3> polygon;
  double area = 0; // m2
};

Vec3 twice_area(const std::vector<Vec3>& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return sum;
}

// The part of the polygon where side * level < -depth.
std::vector<Vec3> kept_part(const std::vector<Vec3>& polygon, const Plane& plane, double side, double depth) {
  std::vector<Vec3> part;
  const auto level = [&](const Vec3& x) { return side * plane.level(x) + depth; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double la = level(a), lb = level(b);
    if (la < 0)
      part.push_back(a);
    if ((la < 0) != (lb < 0))
      part.push_back(a + la / (la - lb) * (b - a));
  }
  return part;
}

bool keep_part(Facet& facet, const Plane& plane, double side, double depth) {
  facet.polygon = kept_part(facet.polygon, plane, side, depth);
  if (facet.polygon.size() < 3)
    return false;
  facet.area = 0.5 * twice_area(facet.polygon).norm();
  return facet.area > depth * depth;
}

struct Piece {
  Polyhedron shape;
  bool inside = false;
};

double mean_thickness(const Polyhedron& shape) { // 6 V / A
  double area = 0;
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f)
    area += face_area(shape, f);
  return 6 * mass_properties(shape).volume / area;
}

// One block: its size, and how its cells are cut.
class BlockClip {
public:
  BlockClip(const SurfaceRays& rays, const ClipOptions& options, const Polyhedron& block)
      : rays_(rays), options_(options), size_(bounding_box(block).size().norm()),
        depth_(std::max(on_face * size_, options.tolerance)) {}

  bool inside_whole(const Polyhedron& cell) const { return rays_.inside(mass_properties(cell).centroid); }

  // Facets within `cell`: those of the surface near it, cut by its faces.
  std::vector<Facet> facets_in(const Polyhedron& cell, std::vector<Facet> facets) const {
    for (int f = 0; f < static_cast<int>(cell.faces.size()) && !facets.empty(); ++f) {
      const Plane plane = Plane::through(face_centroid(cell, f), face_normal(cell, f));
      keep_in(facets, plane, 1);
    }
    return facets;
  }

  void pieces(const Polyhedron& cell, std::vector<Facet> facets, std::vector<Piece>& out) {
    if (options_.tolerance > 0 && !facets.empty() && by_one_plane(cell, facets, out))
      return;
    while (!facets.empty()) {
      const auto main = std::max_element(facets.begin(), facets.end(),
                                         [](const Facet& a, const Facet& b) { return a.area < b.area; });
      const Plane plane = main->plane;
      Cut halves = cut(cell, plane, on_plane * size_);
      if (!halves.above || !halves.below) {
        facets.erase(main);
        continue;
      }
      std::vector<Facet> below = facets, above = std::move(facets);
      keep_in(below, plane, 1);
      keep_in(above, plane, -1);
      const std::size_t before = out.size();
      pieces(marked(*halves.below), std::move(below), out);
      const std::size_t middle = out.size();
      pieces(marked(*halves.above), std::move(above), out);
      if (middle == before + 1 && out.size() == middle + 1 && out[before].inside == out[middle].inside) {
        out.pop_back();
        out.back().shape = cell;
      }
      if (out.size() > most_pieces)
        throw InputError("clip: the surface cuts the block at " + place_text(mass_properties(cell).centroid) +
                         " into more than " + std::to_string(most_pieces) +
                         " pieces; give a tolerance (m), cut the rock into smaller blocks first, or make the "
                         "surface coarser");
      return;
    }
    out.push_back({cell, inside_whole(cell)});
  }

private:
  void keep_in(std::vector<Facet>& facets, const Plane& plane, double side) const {
    facets.erase(std::remove_if(facets.begin(), facets.end(),
                                [&](Facet& facet) { return !keep_part(facet, plane, side, depth_); }),
                 facets.end());
  }

  Polyhedron marked(const Part& part) const {
    Polyhedron shape = part.shape;
    for (std::size_t f = 0; f < shape.faces.size(); ++f)
      if (part.parent_face[f] == cut_face) {
        shape.faces[f].cut = options_.name;
        shape.faces[f].glued = options_.glued;
      }
    return shape;
  }

  // True when all facets lie within the tolerance of one plane and the cell is done.
  bool by_one_plane(const Polyhedron& cell, const std::vector<Facet>& facets, std::vector<Piece>& out) const {
    const auto main = std::max_element(facets.begin(), facets.end(),
                                       [](const Facet& a, const Facet& b) { return a.area < b.area; });
    Vec3 normal = Vec3::Zero(), centre = Vec3::Zero();
    double area = 0;
    for (const Facet& facet : facets) {
      normal +=
          (facet.plane.normal.dot(main->plane.normal) < 0 ? -facet.area : facet.area) * facet.plane.normal;
      Vec3 mean = Vec3::Zero();
      for (const Vec3& x : facet.polygon)
        mean += x / static_cast<double>(facet.polygon.size());
      centre += facet.area * mean;
      area += facet.area;
    }
    if (!(normal.norm() > 0.1 * area))
      return false;
    const Plane plane = Plane::through(centre / area, normal);
    for (const Facet& facet : facets)
      for (const Vec3& x : facet.polygon)
        if (!(std::abs(plane.level(x)) <= options_.tolerance))
          return false;
    // The vertices furthest from the plane on both sides lie beyond all facets.
    const auto deepest = [&](double side) {
      return *std::max_element(cell.vertices.begin(), cell.vertices.end(), [&](const Vec3& a, const Vec3& b) {
        return side * plane.level(a) < side * plane.level(b);
      });
    };
    const Vec3 centroid = mass_properties(cell).centroid;
    const auto side_at = [&](const Vec3& x) { return rays_.inside(x + 1e-6 * (centroid - x)); };
    const Vec3 up = deepest(1), down = deepest(-1);
    const bool has_up = plane.level(up) > options_.tolerance,
               has_down = plane.level(down) < -options_.tolerance;
    if (!has_up || !has_down || side_at(up) == side_at(down)) {
      out.push_back({cell, has_up ? side_at(up) : has_down ? side_at(down) : inside_whole(cell)});
      return true;
    }
    Cut halves = cut(cell, plane, on_plane * size_);
    if (!halves.above || !halves.below)
      return false;
    out.push_back({marked(*halves.below), side_at(down)});
    out.push_back({marked(*halves.above), side_at(up)});
    return true;
  }

  const SurfaceRays& rays_;
  const ClipOptions& options_;
  double size_, depth_; // m
};

// The convex outline of points in plan, counter-clockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> outline(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= base + 2) {
        const Eigen::Vector2d a = hull[hull.size() - 2], b = hull.back();
        if ((b - a).x() * (p - b).y() - (b - a).y() * (p - b).x() > 0)
          break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Whether a segment in plan runs through the inside of a convex outline, deeper than `depth`.
bool runs_through(const std::vector<Eigen::Vector2d>& hull, const Vec3& from, const Vec3& to, double depth) {
  double begin = 0, end = 1;
  const Eigen::Vector2d a(from.x(), from.y()), along = Eigen::Vector2d(to.x(), to.y()) - a;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const Eigen::Vector2d inward = Eigen::Vector2d(-edge.y(), edge.x()).normalized();
    const double start = inward.dot(a - hull[i]) - depth, rate = inward.dot(along);
    if (rate > 0)
      begin = std::max(begin, -start / rate);
    else if (rate < 0)
      end = std::min(end, -start / rate);
    else if (start <= 0)
      return false;
  }
  return begin < end;
}

// An open surface must reach over every block.
void require_covered(const Assembly& assembly, const Surface& surface, const SurfaceRays& rays,
                     const std::vector<std::array<int, 2>>& open) {
  std::vector<Box> boxes;
  const auto flat_box = [](Box box) {
    box.min.z() = box.max.z() = 0;
    return box;
  };
  for (const Polyhedron& block : assembly.blocks)
    boxes.push_back(flat_box(bounding_box(block)));
  std::vector<char> wanted(boxes.size(), 1);
  for (const auto& edge : open) {
    Box box;
    box.extend(surface.points[edge[0]]);
    box.extend(surface.points[edge[1]]);
    boxes.push_back(flat_box(box));
    wanted.push_back(0);
  }
  const auto refuse = [&](const Vec3& x) {
    char place[64];
    std::snprintf(place, sizeof place, "x = %.4g, y = %.4g m", x.x(), x.y());
    throw InputError("surface: it is open and ends, or has a gap, over the blocks at " + std::string(place) +
                     "; it must reach over all of them in plan: extend it, mend it, or cut the rock smaller");
  };
  const int blocks = static_cast<int>(assembly.blocks.size());
  for (const Polyhedron& block : assembly.blocks) {
    const Vec3 centroid = mass_properties(block).centroid;
    for (const Vec3& x : block.vertices) {
      const SurfaceRays::Crossings met = rays.at(x + 1e-6 * (centroid - x));
      if (met.above + met.below == 0)
        refuse(x);
    }
  }
  std::vector<std::vector<Eigen::Vector2d>> outlines(assembly.blocks.size());
  for (const auto& [b, e] : touching_pairs(boxes, wanted)) {
    if (b >= blocks || e < blocks)
      continue;
    if (outlines[b].empty()) {
      std::vector<Eigen::Vector2d> plan;
      for (const Vec3& x : assembly.blocks[b].vertices)
        plan.emplace_back(x.x(), x.y());
      outlines[b] = outline(plan);
    }
    const auto& edge = open[e - blocks];
    const Vec3 &from = surface.points[edge[0]], &to = surface.points[edge[1]];
    if (runs_through(outlines[b], from, to, 1e-6 * boxes[b].size().norm()))
      refuse(0.5 * (from + to));
  }
}

std::vector<Facet> facets_of(const Surface& surface) {
  std::vector<Facet> facets;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto corners = surface.corners(t);
    Facet facet;
    facet.polygon = {corners.begin(), corners.end()};
    const Vec3 normal = twice_area(facet.polygon);
    facet.area = 0.5 * normal.norm();
    if (facet.area > 0)
      facet.plane = Plane::through((corners[0] + corners[1] + corners[2]) / 3, normal);
    facets.push_back(std::move(facet));
  }
  return facets;
}

// For each block the facets whose boxes touch its own.
std::vector<std::vector<int>> near_facets(const Assembly& assembly, const std::vector<Facet>& facets) {
  std::vector<Box> boxes;
  for (const Polyhedron& block : assembly.blocks)
    boxes.push_back(bounding_box(block));
  std::vector<char> wanted(boxes.size(), 1);
  for (const Facet& facet : facets) {
    Box box;
    for (const Vec3& x : facet.polygon)
      box.extend(x);
    boxes.push_back(box);
    wanted.push_back(0);
  }
  const int blocks = static_cast<int>(assembly.blocks.size());
  std::vector<std::vector<int>> near(assembly.blocks.size());
  for (const auto& [b, f] : touching_pairs(boxes, wanted))
    if (b < blocks && f >= blocks && facets[f - blocks].area > 0)
      near[b].push_back(f - blocks);
  return near;
}

} // namespace

Clipped clip(const Assembly& assembly, const Surface& surface, const ClipOptions& options) {
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)))
    throw InputError("tolerance", text(options.tolerance), "finite and >= 0 m");
  const std::vector<std::array<int, 2>> open = open_edges(surface);
  const SurfaceRays rays(surface, open.empty());
  if (!open.empty())
    require_covered(assembly, surface, rays, open);
  const std::vector<Facet> facets = facets_of(surface);
  const std::vector<std::vector<int>> near = near_facets(assembly, facets);
  Clipped result;
  result.thinnest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < assembly.blocks.size(); ++b) {
    throw_if_stopped();
    const Polyhedron& block = assembly.blocks[b];
    BlockClip cutting(rays, options, block);
    std::vector<Facet> own;
    for (const int f : near[b])
      own.push_back(facets[f]);
    std::vector<Piece> pieces;
    cutting.pieces(block, cutting.facets_in(block, std::move(own)), pieces);
    result.cut_blocks += pieces.size() > 1 ? 1 : 0;
    const double whole = pieces.size() > 1 ? mean_thickness(block) : 0;
    for (Piece& piece : pieces) {
      if (options.keep != ClipSide::both && piece.inside != (options.keep == ClipSide::inside))
        continue;
      if (pieces.size() > 1)
        if (const double own_thickness = mean_thickness(piece.shape); own_thickness < thin_part * whole) {
          ++result.thin;
          if (own_thickness < result.thinnest) {
            result.thinnest = own_thickness;
            result.thinnest_place = mass_properties(piece.shape).centroid;
          }
        }
      result.assembly.blocks.push_back(std::move(piece.shape));
    }
    require_block_count("surface", std::to_string(facets.size()) + " triangles",
                        static_cast<double>(result.assembly.blocks.size()), "give a larger tolerance");
  }
  if (result.assembly.blocks.empty())
    throw InputError("clip: nothing is left: the surface leaves no block on the side that is kept");
  return result;
}

} // namespace geom
