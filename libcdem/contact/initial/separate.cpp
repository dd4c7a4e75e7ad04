#include "libcdem/contact/initial/separate.hpp"

#include "libcdem/contact/initial/overlap.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/polyhedron/common_part.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <fmt/format.h>

namespace cdem {
namespace {

// Distance over a meshed block's size: bodies nearer than this touch.
constexpr double touching_tolerance = 1e-3;

// Blocks may reach this part of their size into each other, and share this part of their volume: rounding of
// builders and of coordinates read from files.
constexpr double depth_tolerance = 1e-6, volume_tolerance = 1e-6;

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
    planes.push_back(block.convex() ? geom::face_planes(block.shape) : std::vector<geom::Plane>());
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
    if (geom::apart(planes[a], other.shape, depth) || geom::apart(planes[b], one.shape, depth))
      continue;
    const geom::CommonPart shared = geom::common_part(
        planes[a], planes[b], {boxes[a].min.cwiseMax(boxes[b].min), boxes[a].max.cwiseMin(boxes[b].max)});
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
