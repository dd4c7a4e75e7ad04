#include "libcdem/model/build/rigid_bodies.hpp"

#include "libcdem/model/build/second_moments.hpp"

#include <Eigen/Eigenvalues>

namespace cdem {

RigidShape rigid_shape(const Model& model, int block, const Node* displacement) {
  const Block& b = model.blocks[block];
  const auto place = [&](int node) -> geom::Vec3 {
    if (!displacement)
      return model.node_position[node];
    const Node& u = displacement[node];
    return model.node_position[node] + geom::Vec3(u.x, u.y, u.z);
  };
  RigidShape shape;
  shape.body.block = block;
  const geom::Vec3 origin = place(b.node_begin); // near the body, so that what is summed has its size
  for (int node = b.node_begin; node < b.node_end; ++node) {
    shape.body.mass += model.node_mass[node];
    shape.centroid += model.node_mass[node] * (place(node) - origin);
  }
  shape.centroid = origin + shape.centroid / shape.body.mass;
  geom::Mat3 nodal = geom::Mat3::Zero(); // sum of m r r^T
  for (int node = b.node_begin; node < b.node_end; ++node) {
    const geom::Vec3 r = place(node) - shape.centroid;
    nodal += model.node_mass[node] * r * r.transpose();
  }
  const geom::Mat3 solid =
      second_moments(model, block, [&](int node) -> geom::Vec3 { return place(node) - shape.centroid; });
  const auto about_centroid = [](const geom::Mat3& moments) {
    return geom::Mat3(moments.trace() * geom::Mat3::Identity() - moments);
  };
  shape.nodal_inertia = about_centroid(nodal);
  const geom::Mat3 inertia = about_centroid(solid);
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(inertia);
  shape.body.inertia = inertia;
  shape.body.principal = solver.eigenvalues();
  shape.body.axes = solver.eigenvectors();
  shape.body.inverse_inertia = inertia.inverse();
  return shape;
}

void add_rigid_bodies(Model& model) {
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    Block& block = model.blocks[b];
    if (!block.meshed || model.bodies[block.body].element != Element::rigid)
      continue;
    block.rigid = static_cast<int>(model.rigid.size());
    model.rigid.push_back(rigid_shape(model, b).body);
  }
}

double rigid_inverse_mass(const RigidBody& body, double arm) {
  return 1 / body.mass + arm * arm / body.principal[0];
}

} // namespace cdem
