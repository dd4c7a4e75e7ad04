#include "libcdem/load/water_forces.hpp"

#include "libcdem/load/flow.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double far_from_surface = 1e9; // m; heights over a surface that is not there

struct NodeWater {
  geom::Vec3 place = geom::Vec3::Zero(); // m
  WaterPoint water;
  double height = 0; // m, over the free surface
  bool wet() const { return height < 0; }
};

// Integrals over the wet part of a triangle: of the shape functions (m2), and of these times the pressure (N).
struct WetTriangle {
  std::array<double, 3> area{}, pressure{};

  WetTriangle(const std::array<const NodeWater*, 3>& corner, double whole) {
    std::array<Point, 4> polygon{};
    int n = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double a = corner[i]->height, b = corner[j]->height;
      std::array<double, 3> weight{};
      if (a < 0) {
        weight[i] = 1;
        polygon[n++] = {weight, corner[i]->water.pressure};
      }
      if ((a < 0) != (b < 0)) {
        weight = {};
        weight[i] = b / (b - a);
        weight[j] = a / (a - b);
        polygon[n++] = {weight, 0};
      }
    }
    for (int i = 1; i + 1 < n; ++i)
      add({&polygon[0], &polygon[i], &polygon[i + 1]}, whole);
  }

private:
  struct Point {
    std::array<double, 3> weight;
    double pressure;
  };
  void add(const std::array<const Point*, 3>& part, double whole) {
    const auto edge = [&](int to, int axis) { return part[to]->weight[axis] - part[0]->weight[axis]; };
    const double share = whole * std::abs(edge(1, 1) * edge(2, 2) - edge(1, 2) * edge(2, 1));
    const double sum = part[0]->pressure + part[1]->pressure + part[2]->pressure;
    for (int i = 0; i < 3; ++i)
      for (const Point* p : part) {
        area[i] += share / 3 * p->weight[i];
        pressure[i] += share / 12 * p->weight[i] * (sum + p->pressure);
      }
  }
};

class ForcesOnBlock {
public:
  ForcesOnBlock(const Model& model, const State& state, const ResolvedFlow& flow, int block,
                WaterForces& forces)
      : model_(model), block_(model.blocks[block]), forces_(forces) {
    for (int node = block_.node_begin; node < block_.node_end; ++node) {
      NodeWater& n = nodes_.emplace_back();
      n.place = place_of(model, state, node);
      n.water = flow.water->at(n.place, state.time);
      n.height = std::clamp(n.place.z() - n.water.surface, -far_from_surface, far_from_surface);
    }
    total_.resize(nodes_.size(), geom::Vec3::Zero());
  }

  void triangle(const geom::Triangle& nodes, const CornerNormals* smooth) {
    const std::array<const NodeWater*, 3> corner{&at(nodes[0]), &at(nodes[1]), &at(nodes[2])};
    if (!corner[0]->wet() && !corner[1]->wet() && !corner[2]->wet())
      return;
    const std::array<geom::Vec3, 3> x{corner[0]->place, corner[1]->place, corner[2]->place};
    const geom::Vec3 outward = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
    const double area = outward.norm();
    if (!(area > 0))
      return;
    const geom::Vec3 n = outward / area;
    const WetTriangle wet(corner, area);
    const CornerNormals normals = smooth ? turned_with(*smooth, x) : CornerNormals{n, n, n};
    for (int i = 0; i < 3; ++i) {
      total_[nodes[i] - block_.node_begin] -= wet.pressure[i] * n;
      forces_.corners.push_back({nodes[i], -wet.area[i] * normals[i], corner[i]->water.velocity});
    }
  }

  void block_face(const OuterFace& face, const geom::Vec3& normal) {
    for (const auto& [node, area] : face.node_area)
      if (at(node).wet()) {
        total_[node - block_.node_begin] -= at(node).water.pressure * area * normal;
        forces_.corners.push_back({node, -area * normal, at(node).water.velocity});
      }
  }

  // On its volume; then all but the drag.
  void finish(const ResolvedFlow& flow, std::vector<double>& water_mass) {
    const double accelerated = flow.added_mass + (flow.water->has_dynamic_pressure() ? 0 : 1);
    if (flow.added_mass > 0)
      water_mass.resize(model_.node_position.size(), 0.0);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int node = block_.node_begin + static_cast<int>(i);
      if (nodes_[i].wet()) {
        const double mass = flow.water_density * node_volume(model_, node);
        total_[i] += accelerated * mass * nodes_[i].water.acceleration;
        if (flow.added_mass > 0)
          water_mass[node] += flow.added_mass * mass;
      }
      if (!total_[i].isZero(0))
        forces_.steady.emplace_back(node, total_[i]);
    }
  }

private:
  const NodeWater& at(int node) const { return nodes_[node - block_.node_begin]; }

  const Model& model_;
  const Block& block_;
  WaterForces& forces_;
  std::vector<NodeWater> nodes_;  // of the block
  std::vector<geom::Vec3> total_; // N, likewise
};

} // namespace

WaterForces water_forces(const Model& model, const State& state, const ResolvedFlow& flow,
                         std::vector<double>& water_mass) {
  WaterForces forces;
  std::vector<ForcesOnBlock> blocks;
  std::vector<int> number(model.blocks.size(), -1);
  blocks.reserve(flow.blocks.size());
  for (const int block : flow.blocks) {
    number[block] = static_cast<int>(blocks.size());
    blocks.emplace_back(model, state, flow, block, forces);
  }
  for (std::size_t i = 0; i < flow.faces.size(); ++i) {
    const OuterFace& face = model.outer_faces[flow.faces[i]];
    ForcesOnBlock& block = blocks[number[face.block]];
    if (face.boundary >= 0)
      block.triangle(model.mesh.boundary[face.boundary].nodes, &flow.normals[i]);
    else
      block.block_face(face, present_normal(model, state, face));
  }
  if (flow.new_faces)
    each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
      if (number[chunk.block] < 0 || chunk.stars || !is_open(state.faces[batch], lane))
        return;
      const FaceNodes pair = face_nodes(model.mesh, chunk, batch, lane);
      blocks[number[chunk.block]].triangle(pair.a, nullptr);
      blocks[number[chunk.block]].triangle(pair.outward_b(), nullptr);
    });
  for (ForcesOnBlock& block : blocks)
    block.finish(flow, water_mass);
  return forces;
}

} // namespace cdem
