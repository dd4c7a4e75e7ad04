#include "libcdem/model/build/interface_springs.hpp"

namespace cdem {
namespace {

constexpr int points_per_chunk = 512;

} // namespace

void append_springs(Model& model, int index, Interface& interface, const geom::FaceOverlap& faces) {
  const Block &a = model.blocks[interface.block_a], &b = model.blocks[interface.block_b];
  interface.point_begin = static_cast<int>(model.points.size());
  interface.triangle_begin = static_cast<int>(model.bond_triangles.size());
  for (const geom::OverlapPoint& p : faces.points) {
    BondPoint point;
    for (int k = 0; k < 3; ++k) {
      point.node_a[k] = a.node_begin + p.nodes_a[k];
      point.node_b[k] = b.node_begin + p.nodes_b[k];
    }
    point.weight_a = p.weights_a;
    point.weight_b = p.weights_b;
    point.normal = interface.normal;
    point.area = p.area;
    point.kn_area = interface.kn * p.area;
    point.ks_area = interface.ks * p.area;
    point.interface = index;
    point.one_to_one = p.weights_a[0] == 1 && p.weights_b[0] == 1;
    model.points.push_back(point);
    model.point_position.push_back(p.position);
  }
  for (geom::Triangle triangle : faces.triangles) {
    for (int& corner : triangle)
      corner += interface.point_begin;
    model.bond_triangles.push_back(triangle);
  }
  interface.point_end = static_cast<int>(model.points.size());
  interface.triangle_end = static_cast<int>(model.bond_triangles.size());
}

void index_springs(Model& model) {
  model.point_chunks = split(static_cast<std::int64_t>(model.points.size()), points_per_chunk);
  if (model.points.size() > std::numeric_limits<std::uint32_t>::max() >> 3U)
    throw geom::InputError("blocks", std::to_string(model.points.size()) + " springs between them",
                           "at most 536 million", "make the model of larger blocks");
  std::vector<std::int64_t> begin(model.node_position.size() + 1, 0);
  const auto each_end = [&](const auto& visit) {
    for (int p = 0; p < static_cast<int>(model.points.size()); ++p)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const BondPoint& point = model.points[p];
        if (point.weight_a[k] != 0)
          visit(point.node_a[k], SpringEnd(p, point.one_to_one ? SpringEnd::only_a : k));
        if (point.weight_b[k] != 0)
          visit(point.node_b[k], SpringEnd(p, point.one_to_one ? SpringEnd::only_b : k + 3));
      }
  };
  each_end([&](int node, SpringEnd) { ++begin[node + 1]; });
  for (std::size_t i = 1; i < begin.size(); ++i)
    begin[i] += begin[i - 1];
  model.spring_ends.resize(begin.back());
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  each_end([&](int node, SpringEnd end) { model.spring_ends[next[node]++] = end; });
  model.bond_begin = std::move(begin);
}

} // namespace cdem
