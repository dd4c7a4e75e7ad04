#include "libcdem/results/overlap.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/polyhedron/common_part.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <map>

namespace cdem {
namespace {

// Depth over the smaller part's size: below it two parts only touch.
constexpr double depth_tolerance = 1e-9;

// A rigid convex block, or a tetrahedron of any other block, as it stands now.
struct ConvexPart {
  int block = 0, tet = -1;
  geom::Polyhedron shape;
  std::vector<geom::Plane> planes;
};

geom::Polyhedron block_now(const Model& model, const State& state, const Block& block) {
  geom::Polyhedron shape = block.shape;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v)
    shape.vertices[v] = place_of(model, state, block.node_begin + static_cast<int>(v));
  return shape;
}

geom::Polyhedron tet_now(const Model& model, const State& state, const geom::Tet& tet) {
  geom::Polyhedron shape;
  for (const int node : tet)
    shape.vertices.push_back(place_of(model, state, node));
  shape.faces = {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}};
  return shape;
}

std::vector<ConvexPart> convex_parts(const Model& model, const State& state) {
  std::vector<ConvexPart> parts;
  const auto add = [&](int block, int tet, geom::Polyhedron&& shape) {
    parts.push_back({block, tet, std::move(shape), {}});
    parts.back().planes = geom::face_planes(parts.back().shape);
  };
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    if (block.convex() && block.rigid >= 0)
      add(b, -1, block_now(model, state, block));
    else
      for (int tet = block.tet_begin; tet < block.tet_end; ++tet)
        add(b, tet, tet_now(model, state, model.tets[tet]));
  }
  return parts;
}

// Whether both are tetrahedra of one mesh that hang together at a node.
bool hang_together(const Model& model, const ConvexPart& a, const ConvexPart& b) {
  if (a.block != b.block)
    return false;
  const geom::Tet &m = model.tets[a.tet], &n = model.tets[b.tet];
  return std::find_first_of(m.begin(), m.end(), n.begin(), n.end()) != m.end();
}

} // namespace

Overlap overlap(const Model& model, const State& state) {
  const std::vector<ConvexPart> parts = convex_parts(model, state);
  std::vector<geom::Box> boxes;
  boxes.reserve(parts.size());
  for (const ConvexPart& part : parts)
    boxes.push_back(geom::bounding_box(part.shape));
  std::map<std::pair<int, int>, geom::CommonPart> common; // of two blocks; centroid: times the volume
  for (const auto& [i, j] : geom::touching_pairs(boxes)) {
    const ConvexPart &a = parts[i], &b = parts[j];
    if (hang_together(model, a, b))
      continue;
    const double depth = depth_tolerance * std::min(model.blocks[a.block].size, model.blocks[b.block].size);
    if (geom::apart(a.planes, b.shape, depth) || geom::apart(b.planes, a.shape, depth))
      continue;
    const geom::CommonPart part = geom::common_part(
        a.planes, b.planes, {boxes[i].min.cwiseMax(boxes[j].min), boxes[i].max.cwiseMin(boxes[j].max)});
    geom::CommonPart& sum = common[std::minmax(a.block, b.block)];
    sum.volume += part.volume;
    sum.centroid += part.volume * part.centroid;
  }
  Overlap result;
  for (const auto& [blocks, sum] : common) {
    if (!(sum.volume > 0))
      continue;
    result.volume += sum.volume;
    ++result.pairs;
    if (sum.volume <= result.largest)
      continue;
    result.largest = sum.volume;
    result.largest_a = block_name(model, blocks.first);
    result.largest_b = block_name(model, blocks.second);
    result.place = sum.centroid / sum.volume;
  }
  return result;
}

FreeOverlap free_overlap(const Model& model, const State& state, double over) {
  FreeOverlap most{over};
  if (model.surface.empty())
    return most;
  std::vector<std::pair<int, int>> held;
  for (const Contact& c : state.contacts)
    if (c.kind != Contact::tets) {
      const auto [source, target] = triangles_of(c);
      const std::vector<ContactTriangle>& triangles = model.surface.triangles;
      held.push_back(std::minmax({triangles[source].block, triangles[target].block}));
    }
  for (const Interface& interface : model.interfaces)
    if (!released(state, interface))
      held.push_back(std::minmax({interface.block_a, interface.block_b}));
  std::sort(held.begin(), held.end());
  std::vector<ConvexPart> parts;
  std::vector<geom::Box> boxes;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
    if (model.blocks[b].convex()) {
      parts.push_back({b, -1, block_now(model, state, model.blocks[b]), {}});
      boxes.push_back(geom::bounding_box(parts.back().shape));
    }
  for (const auto& [i, j] : geom::touching_pairs(boxes)) {
    const int a = parts[i].block, b = parts[j].block;
    const geom::Box both{boxes[i].min.cwiseMax(boxes[j].min), boxes[i].max.cwiseMin(boxes[j].max)};
    const double least = std::min(model.blocks[a].mass.volume, model.blocks[b].mass.volume);
    if ((both.max - both.min).prod() <= most.part * least || !contact_joint(model, a, b) ||
        std::binary_search(held.begin(), held.end(), std::pair<int, int>(std::minmax({a, b}))))
      continue;
    const double volume =
        geom::common_part(geom::face_planes(parts[i].shape), geom::face_planes(parts[j].shape), both).volume;
    if (volume > most.part * least)
      most = {volume / least, a, b};
  }
  return most;
}

} // namespace cdem
