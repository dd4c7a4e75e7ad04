#include "libcdem/model/face_fan.hpp"

#include "libgeom/mesh/star_mesh.hpp"

namespace cdem {

std::vector<geom::Triangle> fan_of(const Model& model, int block, int face) {
  const Block& b = model.blocks[block];
  if (!b.meshed)
    return geom::star_mesh(b.shape).fans[face];
  std::vector<geom::Triangle> fan;
  each_boundary_triangle(model, block, [&](int, const BoundaryTriangle& triangle) {
    if (triangle.face != face)
      return;
    geom::Triangle nodes = triangle.nodes;
    for (int& node : nodes)
      node -= b.node_begin;
    fan.push_back(nodes);
  });
  return fan;
}

std::vector<std::vector<geom::Triangle>> fans_of(const Model& model, int block) {
  const Block& b = model.blocks[block];
  if (!b.meshed)
    return geom::star_mesh(b.shape).fans;
  std::vector<std::vector<geom::Triangle>> fans;
  for (std::size_t face = 0; face < b.shape.faces.size(); ++face)
    fans.push_back(fan_of(model, block, static_cast<int>(face)));
  return fans;
}

} // namespace cdem
