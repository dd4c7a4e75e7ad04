#include "libcdem/bond/interface_frame.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>

namespace cdem {
namespace {

struct Side {
  geom::Vec3 normal; // unit, outward
  geom::Vec3 along;
};

Side side_of(const Model& model, const Node* u, const std::array<int, 3>& nodes,
             const std::array<double, 2>& along) {
  const auto& x = model.node_position;
  const geom::Vec3 x0 = x[nodes[0]] + vec(u[nodes[0]]);
  const geom::Vec3 e1 = x[nodes[1]] + vec(u[nodes[1]]) - x0, e2 = x[nodes[2]] + vec(u[nodes[2]]) - x0;
  return {e1.cross(e2).normalized(), along[0] * e1 + along[1] * e2};
}

geom::Mat3 triad(const geom::Vec3& normal, const geom::Vec3& along) {
  geom::Mat3 m;
  m << normal, along, normal.cross(along);
  return m;
}

} // namespace

geom::Mat3 interface_rotation(const Model& model, const Node* u, const Interface& interface) {
  if (interface.frame < 0)
    return geom::Mat3::Identity();
  const InterfaceFrame& frame = model.frames[interface.frame];
  const Side a = side_of(model, u, frame.nodes_a, frame.along_a),
             b = side_of(model, u, frame.nodes_b, frame.along_b);
  const geom::Vec3 normal = (a.normal - b.normal).normalized();
  geom::Vec3 along = a.along + b.along;
  along = (along - along.dot(normal) * normal).normalized();
  return triad(normal, along) * triad(interface.normal, frame.along).transpose();
}

double interface_opening_angle(const Model& model, const Node* u, const Interface& interface) {
  if (interface.frame < 0)
    return 0;
  const InterfaceFrame& frame = model.frames[interface.frame];
  const geom::Vec3 a = side_of(model, u, frame.nodes_a, frame.along_a).normal,
                   b = side_of(model, u, frame.nodes_b, frame.along_b).normal;
  return geom::portable::atan2(a.cross(b).norm(), -a.dot(b));
}

geom::Vec3 local_jump(const Model& model, const std::vector<Node>& displacement, int point) {
  const BondPoint& p = model.points[point];
  return interface_rotation(model, displacement.data(), model.interfaces[p.interface]).transpose() *
         jump(p, displacement);
}

} // namespace cdem
