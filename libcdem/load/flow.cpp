#include "libcdem/load/flow.hpp"

#include "libcdem/state/places.hpp"

namespace cdem {
namespace {

using Pattern = std::vector<std::pair<int, geom::Vec3>>;

// nodes: counter-clockwise seen from outside.
void add_triangle(const Model& model, const State& state, const geom::Triangle& nodes,
                  const geom::Vec3& direction, Pattern& pattern) {
  const geom::Vec3 x0 = place_of(model, state, nodes[0]);
  const geom::Vec3 outward =
      0.5 * (place_of(model, state, nodes[1]) - x0).cross(place_of(model, state, nodes[2]) - x0);
  const double facing = -outward.dot(direction); // A alpha
  if (facing <= 0)
    return;
  for (const int node : nodes)
    pattern.emplace_back(node, facing / 3 * direction);
}

// Outward, unit, of a face of a convex block where it stands now; a block of small strain hardly turns.
geom::Vec3 present_normal(const Model& model, const State& state, const OuterFace& face) {
  const Block& block = model.blocks[face.block];
  if (!block.meshed)
    return face.normal;
  const std::vector<int>& loop = block.shape.faces[face.face].loop;
  const auto vertex = [&](std::size_t i) { return place_of(model, state, block.node_begin + loop[i]); };
  const geom::Vec3 x0 = vertex(0);
  geom::Vec3 twice_area = geom::Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
    twice_area += (vertex(i) - x0).cross(vertex(i + 1) - x0);
  return twice_area.normalized();
}

// The part of it that no other block covered when the model was made.
void add_block_face(const Model& model, const State& state, const OuterFace& face,
                    const geom::Vec3& direction, Pattern& pattern) {
  const double alpha = -present_normal(model, state, face).dot(direction);
  if (alpha <= 0)
    return;
  for (const auto& [node, area] : face.node_area)
    pattern.emplace_back(node, area * alpha * direction);
}

bool open(const FaceStateBatch& state, int lane) {
  for (const auto& point : state.mode)
    if (point[lane] == static_cast<std::uint8_t>(BondMode::intact))
      return false;
  return true;
}

void add_new_faces(const Model& model, const State& state, const geom::Vec3& direction, Pattern& pattern) {
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!open(state.faces[batch], lane))
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    add_triangle(model, state, nodes.a, direction, pattern);
    add_triangle(model, state, nodes.outward_b(), direction, pattern);
  });
}

} // namespace

Pattern flow_pattern(const Model& model, const State& state, const ResolvedFlow& flow) {
  Pattern pattern;
  for (const int f : flow.faces) {
    const OuterFace& face = model.outer_faces[f];
    if (face.boundary >= 0)
      add_triangle(model, state, model.mesh.boundary[face.boundary].nodes, flow.direction, pattern);
    else
      add_block_face(model, state, face, flow.direction, pattern);
  }
  if (flow.new_faces)
    add_new_faces(model, state, flow.direction, pattern);
  return pattern;
}

} // namespace cdem
