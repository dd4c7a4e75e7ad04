#include "libcdem/bond/interface_frame.hpp"

#include "libcdem/bond/interface_turn.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/portable.hpp"

namespace cdem {
namespace {

TurnedSide<double> side_of(const Model& model, const Node* u, const std::array<int, 3>& nodes,
                           const std::array<double, 2>& along) {
  const auto& x = model.node_position;
  const auto edge = [&](int corner) {
    const geom::Vec3 undeformed = x[nodes[corner]] - x[nodes[0]];
    return triple(undeformed) + (triple(vec(u[nodes[corner]])) - triple(vec(u[nodes[0]])));
  };
  return {edge(1), edge(2), along[0], along[1]};
}

geom::Vec3 normal_of(const TurnedSide<double>& side) {
  return vec(unit(cross(side.e1, side.e2)));
}

} // namespace

geom::Mat3 interface_rotation(const Model& model, const Node* u, const Interface& interface) {
  if (interface.frame < 0)
    return geom::Mat3::Identity();
  const InterfaceFrame& frame = model.frames[interface.frame];
  const geom::Vec3 third = interface.normal.cross(frame.along);
  const Rotation<double> r = rotation_of(
      side_of(model, u, frame.nodes_a, frame.along_a), side_of(model, u, frame.nodes_b, frame.along_b),
      Axes<double>{triple(interface.normal), triple(frame.along), triple(third)});
  geom::Mat3 m;
  m << vec(r.x), vec(r.y), vec(r.z);
  return m;
}

double interface_opening_angle(const Model& model, const Node* u, const Interface& interface) {
  if (interface.frame < 0)
    return 0;
  const InterfaceFrame& frame = model.frames[interface.frame];
  const geom::Vec3 a = normal_of(side_of(model, u, frame.nodes_a, frame.along_a)),
                   b = normal_of(side_of(model, u, frame.nodes_b, frame.along_b));
  return geom::portable::atan2(a.cross(b).norm(), -a.dot(b));
}

geom::Vec3 local_jump(const Model& model, const std::vector<Node>& displacement, int point) {
  const Interface& interface = model.interfaces[model.points[point].interface];
  return interface_rotation(model, displacement.data(), interface).transpose() *
         jump(model, displacement, point);
}

geom::Vec3 movement_past(const Model& model, const State& state, int point) {
  const geom::Vec3 j = local_jump(model, state.displacement, point);
  return state.slid_before.empty() ? j : geom::Vec3(j + state.slid_before[point]);
}

} // namespace cdem
