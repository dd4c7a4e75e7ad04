#include "libcdem/fracture/slicing.hpp"

#include "libgeom/core/portable.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <cmath>
#include <limits>

namespace cdem {
namespace {

// All as a part of the block's size.
// A cut plane stays this far away from vertices; it is shifted, never the vertex.
constexpr double vertex_clearance = 0.01;
// A plane through the anchor keeps this away instead: moved aside it would not meet the crack's tip, and a
// small corner that it cuts off does less harm.
constexpr double anchored_clearance = 1e-3;
// A plane through the anchor is turned onto a vertex that it would pass nearer than this, by most_turn at the
// most.
constexpr double snapping = 0.05;
constexpr double most_turn = 0.1; // rad
// A place touches a block when it is nearer than this.
constexpr double touching = 1e-3;
// A vertex nearer than this lies on the plane.
constexpr double on_plane = 1e-9;
// Beside an anchored plane, one nearer to the end of a block than this part of the spacing would make a
// sliver.
constexpr double grazing = 0.25;

geom::Vec3 turned_onto_vertices(const Block& block, const geom::Vec3& normal, const geom::Vec3& anchor) {
  geom::Vec3 turned = normal, first = geom::Vec3::Zero();
  for (const geom::Vec3& x : block.shape.vertices) {
    const geom::Vec3 arm = x - anchor;
    const double level = std::abs(normal.dot(arm));
    if (level >= snapping * block.size || level > most_turn * arm.norm())
      continue;
    if (first.isZero()) {
      first = arm;
      turned = (normal - normal.dot(arm) / arm.squaredNorm() * arm).normalized();
      continue;
    }
    // Two vertices that do not lie in one line with the anchor: the plane is given.
    const geom::Vec3 across = first.cross(arm);
    if (across.norm() > vertex_clearance * block.size * block.size) {
      turned = (across.dot(normal) < 0 ? -1 : 1) * across.normalized();
      break;
    }
  }
  return turned.dot(normal) < geom::portable::cos(most_turn) ? normal : turned;
}

// Middle of the places where a plane meets the edges of a block.
geom::Vec3 section_middle(const Block& block, const geom::Plane& plane) {
  const double tolerance = on_plane * block.size;
  geom::Vec3 sum = geom::Vec3::Zero();
  int count = 0;
  const auto add = [&](const geom::Vec3& x) {
    sum += x;
    ++count;
  };
  for (const geom::Vec3& x : block.shape.vertices)
    if (std::abs(plane.level(x)) <= tolerance)
      add(x);
  for (const auto& [a, b] : geom::edges(block.shape)) {
    const geom::Vec3 &xa = block.shape.vertices[a], &xb = block.shape.vertices[b];
    const double la = plane.level(xa), lb = plane.level(xb);
    if (std::min(la, lb) < -tolerance && std::max(la, lb) > tolerance)
      add(xa + la / (la - lb) * (xb - xa));
  }
  return count > 0 ? geom::Vec3(sum / count) : block.mass.centroid;
}

// The plane, moved only when a vertex lies close to it but not on it: a plane through the anchor stays there.
geom::Plane clear_plane(const Block& block, const geom::Plane& plane, double clearance) {
  for (const geom::Vec3& x : block.shape.vertices) {
    const double level = std::abs(plane.level(x));
    if (level > on_plane * block.size && level < clearance)
      return geom::shifted_clear_of_vertices(block.shape, plane, clearance);
  }
  return plane;
}

} // namespace

bool is_near(const Block& block, const geom::Vec3& place, double radius) {
  double height = -std::numeric_limits<double>::infinity();
  for (int f = 0; f < static_cast<int>(block.shape.faces.size()); ++f) {
    const geom::Vec3& corner = block.shape.vertices[block.shape.faces[f].loop.front()];
    height = std::max(height, geom::face_normal(block.shape, f).dot(place - corner));
  }
  return height <= radius + touching * block.size;
}

Slicing slicing(const Block& block, const geom::Vec3& normal, const RefineOptions& o) {
  const bool anchored = o.anchor && is_near(block, *o.anchor, 0);
  Slicing s;
  s.normal = anchored ? turned_onto_vertices(block, normal, *o.anchor) : normal;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const geom::Vec3& x : block.shape.vertices) {
    const double level = s.normal.dot(x - block.mass.centroid);
    low = std::min(low, level);
    high = std::max(high, level);
  }
  const double spacing = (high - low) / (o.planes + 1);
  const auto add = [&](double level, double clearance = vertex_clearance) {
    const geom::Vec3 place = block.mass.centroid + level * s.normal;
    s.planes.push_back(clear_plane(block, geom::Plane::through(place, s.normal), clearance * block.size));
  };
  if (!anchored) {
    for (int k = 1; k <= o.planes; ++k)
      add(low + k * spacing);
    return s;
  }
  const double through = s.normal.dot(*o.anchor - block.mass.centroid);
  const double clearance = anchored_clearance * block.size;
  if (through < low + clearance || through > high - clearance)
    return s;
  const geom::Vec3 middle = section_middle(block, geom::Plane::through(*o.anchor, s.normal));
  if (o.ahead && o.ahead->dot(middle - *o.anchor) < 0)
    return s;
  const double first = low + grazing * spacing, last = high - grazing * spacing;
  for (int k = -o.planes; k <= o.planes; ++k) {
    const double level = through + k * spacing;
    if (k == 0)
      add(level, anchored_clearance);
    else if (level >= first && level <= last)
      add(level);
  }
  return s;
}

} // namespace cdem
