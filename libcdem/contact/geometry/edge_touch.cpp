#include "libcdem/contact/geometry/edge_touch.hpp"

namespace cdem {
namespace {

// Distance over an edge's length: two points nearer to each other than this have no direction between them.
constexpr double same_place_of_ends = 1e-9;

// The fan of an edge's outward normals: those that have both its faces behind.
bool in_fan(const std::array<geom::Vec3, 2>& into, const geom::Vec3& normal) {
  return !(normal.dot(into[0]) > fan_slack * into[0].norm()) &&
         !(normal.dot(into[1]) > fan_slack * into[1].norm());
}

} // namespace

std::array<geom::Vec3, 2> into_faces(const Model& model, const State& state, const ContactEdge& e,
                                     const geom::Vec3& x0, const geom::Vec3& x1) {
  const geom::Vec3 along = (x1 - x0).normalized();
  std::array<geom::Vec3, 2> into;
  for (int i = 0; i < 2; ++i) {
    const Corners x = corners_of(model, state, model.surface.triangles[e.triangles[i]].nodes);
    into[i] = (x[0] + x[1] + x[2]) / 3 - x0;
    into[i] -= into[i].dot(along) * along;
  }
  return into;
}

std::optional<EdgeTouch> touch_of(const Model& model, const State& state, const ContactEdge& e,
                                  const ContactEdge& f, const NearestOfEdges& nearest) {
  const geom::Vec3 a0 = place_of(model, state, e.nodes[0]), a1 = place_of(model, state, e.nodes[1]),
                   b0 = place_of(model, state, f.nodes[0]), b1 = place_of(model, state, f.nodes[1]);
  const geom::Vec3 across = (a1 - a0).cross(b1 - b0);
  if (across.norm() < parallel_edges * (a1 - a0).norm() * (b1 - b0).norm())
    return std::nullopt;
  EdgeTouch touch{across.normalized()};
  const auto into_e = into_faces(model, state, e, a0, a1), into_f = into_faces(model, state, f, b0, b1);
  if (!in_fan(into_f, touch.normal)) {
    touch.normal = -touch.normal;
    touch.sense = -1;
  }
  if (!in_fan(into_f, touch.normal) || !in_fan(into_e, -touch.normal))
    return std::nullopt;
  touch.depth = nearest.way.dot(touch.normal);
  const double distance = nearest.way.norm();
  if (touch.depth > 0 && !nearest.within_both() && distance > same_place_of_ends * (a1 - a0).norm()) {
    touch.normal = nearest.way / distance;
    touch.depth = in_fan(into_f, touch.normal) && in_fan(into_e, -touch.normal) ? distance : -distance;
  }
  return touch;
}

} // namespace cdem
