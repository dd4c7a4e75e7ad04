#include "libcdem/contact/separate.hpp"

#include "libcdem/contact/overlap.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <fmt/format.h>

namespace cdem {
namespace {

// Of a meshed block's size: bodies nearer than this touch.
constexpr double touching_tolerance = 1e-3;

// Blocks may reach this part of their size into each other, and share this part of their volume: rounding of
// builders and of coordinates read from files.
constexpr double depth_tolerance = 1e-6, volume_tolerance = 1e-6;

std::vector<geom::Plane> face_planes(const geom::Polyhedron& shape) {
  std::vector<geom::Plane> planes;
  planes.reserve(shape.faces.size());
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f)
    planes.push_back(
        geom::Plane::through(shape.vertices[shape.faces[f].loop.front()], geom::face_normal(shape, f)));
  return planes;
}

// Does a face of one block have all of the other outside? Settles all but a few pairs.
bool apart(const std::vector<geom::Plane>& planes, const geom::Polyhedron& other, double depth) {
  for (const geom::Plane& plane : planes) {
    bool outside = true;
    for (const geom::Vec3& x : other.vertices)
      outside = outside && plane.level(x) >= -depth;
    if (outside)
      return true;
  }
  return false;
}

// What two convex blocks share: one cut by all the faces of the other.
std::optional<geom::Polyhedron> common_part(const geom::Polyhedron& a,
                                            const std::vector<geom::Plane>& planes_of_b, double tolerance) {
  geom::Polyhedron rest = a;
  for (const geom::Plane& plane : planes_of_b) {
    geom::Cut parts = geom::cut(rest, plane, tolerance);
    if (!parts.below)
      return {};
    rest = std::move(parts.below->shape);
  }
  return rest;
}

geom::Box box_of_nodes(const Model& model, const Block& block) {
  geom::Box box;
  for (int node = block.node_begin; node < block.node_end; ++node)
    box.extend(model.node_position[node]);
  return box;
}

[[noreturn]] void refuse_contact(const Model& model, const Block& one, const Block& other) {
  throw geom::InputError(
      "bodies: \"" + model.bodies[one.body].name + "\" and \"" + model.bodies[other.body].name +
      "\" may touch, and blocks of small strain meet nothing new; move them apart, or leave "
      "element = \"small_strain\" out");
}

} // namespace

void require_separate(const Model& model) {
  require_separate_meshes(model);
  std::vector<geom::Box> boxes;
  std::vector<std::vector<geom::Plane>> planes;
  for (const Block& block : model.blocks) {
    boxes.push_back(block.convex() ? geom::bounding_box(block.shape) : box_of_nodes(model, block));
    planes.push_back(block.convex() ? face_planes(block.shape) : std::vector<geom::Plane>());
  }
  // Meshes next to each other differ by rounding, however they were put there.
  for (std::size_t b = 0; b < boxes.size(); ++b)
    if (!model.blocks[b].convex()) {
      const geom::Vec3 margin = geom::Vec3::Constant(touching_tolerance * model.blocks[b].size);
      boxes[b].min -= margin;
      boxes[b].max += margin;
    }
  for (const auto& [a, b] : geom::touching_pairs(boxes)) {
    const Block &one = model.blocks[a], &other = model.blocks[b];
    if (one.meshed && other.meshed && !(one.convex() && other.convex()))
      continue; // judged by their surfaces
    if (!one.convex() || !other.convex())
      refuse_contact(model, one, other);
    const double depth = depth_tolerance * std::min(one.size, other.size);
    if (apart(planes[a], other.shape, depth) || apart(planes[b], one.shape, depth))
      continue;
    const auto common = common_part(one.shape, planes[b], depth);
    if (!common)
      continue;
    const geom::MassProperties shared = geom::mass_properties(*common);
    if (shared.volume <= volume_tolerance * std::min(one.mass.volume, other.mass.volume))
      continue;
    const std::string &name = model.bodies[one.body].name, &other_name = model.bodies[other.body].name;
    const geom::Vec3& x = shared.centroid;
    throw geom::InputError((name == other_name
                                ? "shape: two blocks of body \"" + name + "\""
                                : "bodies: blocks of \"" + name + "\" and \"" + other_name + "\"") +
                           fmt::format(" occupy the same place near ({:g}, {:g}, {:g}) m; blocks may touch "
                                       "but not overlap: move or cut one "
                                       "of them",
                                       x.x(), x.y(), x.z()));
  }
}

} // namespace cdem
