#include "libcdem/bond/spring_batches.hpp"

#include <algorithm>
#include <limits>

namespace cdem {
namespace {

constexpr double unbreakable = std::numeric_limits<double>::infinity();

InterfaceNumbers numbers_of(const Interface& interface, const SpringStrength& strength) {
  InterfaceNumbers numbers;
  numbers.normal = {interface.normal.x(), interface.normal.y(), interface.normal.z(), strength.tan_friction};
  numbers.stiffness = {interface.kn, interface.ks,
                       interface.may_break ? strength.tensile_strength : unbreakable,
                       interface.may_break ? strength.cohesion : unbreakable};
  return numbers;
}

void set_spring(SpringBatch& batch, int lane, const BondPoint& point) {
  batch.node_a[lane] = point.node_a[0];
  batch.node_b[lane] = point.node_b[0];
  batch.interface[lane] = point.interface;
  batch.area[lane] = point.area;
}

SpringEnds ends_of(const Model& model, Range points) {
  SpringEnds ends = {};
  for (std::int64_t p = points.begin; p < points.end; ++p)
    for (int k = 0; k < 3; ++k) {
      const auto lane = p - points.begin;
      ends.node_a[k][lane] = model.points[p].node_a[k];
      ends.node_b[k][lane] = model.points[p].node_b[k];
      ends.weight_a[k][lane] = model.points[p].weight_a[k];
      ends.weight_b[k][lane] = model.points[p].weight_b[k];
    }
  return ends;
}

bool any_apart(const Model& model, Range points) {
  return !model.point_apart.empty() &&
         std::any_of(model.point_apart.begin() + points.begin, model.point_apart.begin() + points.end,
                     [](const geom::Vec3& apart) { return !apart.isZero(0); });
}

SpringsApart apart_of(const Model& model, Range points) {
  SpringsApart all = {};
  for (std::int64_t p = points.begin; p < points.end; ++p)
    for (int axis = 0; axis < 3; ++axis)
      all.apart[axis][p - points.begin] = model.point_apart[p][axis];
  return all;
}

void set_side(const Model& model, const std::array<int, 3>& nodes, int lane, int (&node)[3][lanes],
              double (&edge)[2][3][lanes]) {
  for (int k = 0; k < 3; ++k)
    node[k][lane] = nodes[k];
  for (int k = 0; k < 2; ++k)
    for (int axis = 0; axis < 3; ++axis)
      edge[k][axis][lane] = model.node_position[nodes[k + 1]][axis] - model.node_position[nodes[0]][axis];
}

// Two faces across z, looked at from both sides: they turn by nothing.
void set_still(FrameBatch& batch, int lane) {
  batch.edge_a[0][0][lane] = batch.edge_a[1][1][lane] = 1;
  batch.edge_b[0][1][lane] = batch.edge_b[1][0][lane] = 1;
  batch.along_a[0][lane] = batch.along_b[1][lane] = 1;
  batch.axes[0][2][lane] = batch.axes[1][0][lane] = batch.axes[2][1][lane] = 1;
}

void set_frame(const Model& model, const Interface& interface, FrameBatch& batch, int lane) {
  const InterfaceFrame& frame = model.frames[interface.frame];
  batch.turns = true;
  set_side(model, frame.nodes_a, lane, batch.node_a, batch.edge_a);
  set_side(model, frame.nodes_b, lane, batch.node_b, batch.edge_b);
  const geom::Vec3 axes[3] = {interface.normal, frame.along, interface.normal.cross(frame.along)};
  for (int k = 0; k < 2; ++k) {
    batch.along_a[k][lane] = frame.along_a[k];
    batch.along_b[k][lane] = frame.along_b[k];
  }
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis)
      batch.axes[k][axis][lane] = axes[k][axis];
}

} // namespace

SpringBatches spring_batches(const Model& model, const std::vector<SpringStrength>& strength,
                             const std::vector<char>& plain) {
  SpringBatches all;
  for (std::size_t i = 0; i < model.interfaces.size(); ++i)
    all.interfaces.push_back(numbers_of(model.interfaces[i], strength[i]));
  for (const Range& chunk : model.point_chunks) {
    const auto later_block = [&](std::int64_t point) -> const Block& {
      return model.blocks[model.interfaces[model.points[point].interface].block_b];
    };
    all.nodes.push_back({later_block(chunk.begin).node_begin, later_block(chunk.end - 1).node_end});
    all.first.push_back(static_cast<std::int64_t>(all.springs.size()));
    for (std::int64_t begin = chunk.begin; begin < chunk.end; begin += lanes) {
      const Range points{begin, std::min<std::int64_t>(begin + lanes, chunk.end)};
      SpringBatch batch = {};
      batch.count = static_cast<int>(points.size());
      bool on_nodes = true;
      for (std::int64_t p = points.begin; p < points.end; ++p) {
        const BondPoint& point = model.points[p];
        const Interface& interface = model.interfaces[point.interface];
        set_spring(batch, static_cast<int>(p - begin), point);
        on_nodes = on_nodes && point.one_to_one;
        batch.turns = batch.turns || interface.frame >= 0;
        batch.plain = batch.plain && plain[point.interface] != 0;
      }
      for (int lane = batch.count; lane < lanes; ++lane)
        batch.interface[lane] = batch.interface[0];
      if (!on_nodes) {
        batch.ends = static_cast<int>(all.ends.size());
        all.ends.push_back(ends_of(model, points));
      }
      if (any_apart(model, points)) {
        batch.apart = static_cast<int>(all.apart.size());
        all.apart.push_back(apart_of(model, points));
      }
      all.springs.push_back(batch);
    }
  }
  all.first.push_back(static_cast<std::int64_t>(all.springs.size()));
  if (model.frames.empty())
    return all;
  all.frames.resize((model.interfaces.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < all.frames.size() * lanes; ++i) {
    FrameBatch& batch = all.frames[i / lanes];
    const int lane = static_cast<int>(i % lanes);
    if (i < model.interfaces.size() && model.interfaces[i].frame >= 0)
      set_frame(model, model.interfaces[i], batch, lane);
    else
      set_still(batch, lane);
  }
  return all;
}

} // namespace cdem
