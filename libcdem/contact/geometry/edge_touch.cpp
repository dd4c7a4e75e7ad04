#include "libcdem/contact/geometry/edge_touch.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// Distance over an edge's length: two points nearer to each other than this have no direction between them.
constexpr double same_place_of_ends = 1e-9;

// The fan of an edge's outward normals: those that have both its faces behind.
bool in_fan(const std::array<geom::Vec3, 2>& into, const geom::Vec3& normal) {
  return !(normal.dot(into[0]) > fan_slack * into[0].norm()) &&
         !(normal.dot(into[1]) > fan_slack * into[1].norm());
}

geom::Vec3 middle_of_fan(const std::array<geom::Vec3, 2>& into) {
  return -(into[0].normalized() + into[1].normalized()).normalized();
}

// A linear function on a stretch [x0, x1].
struct Linear {
  double at_0 = 0, slope = 0;
  double operator()(double x) const { return at_0 + slope * x; }
};

// Area and moment of the positive part of functions that are linear between two places.
struct Positive {
  double area = 0, moment = 0;

  void add(std::array<double, 2> at_ends, double from, double to) {
    auto& [a, b] = at_ends;
    if (a <= 0 && b <= 0)
      return;
    if (a < 0) {
      from += (to - from) * a / (a - b);
      a = 0;
    } else if (b < 0) {
      to = from + (to - from) * a / (a - b);
      b = 0;
    }
    const double length = to - from;
    area += 0.5 * length * (a + b);
    moment += length * (0.5 * from * (a + b) + length * (a + 2 * b) / 6);
  }
};

// The wedge behind an edge, seen along the edge: unit vectors along its two faces, and the outward normals of the two.
struct Wedge {
  std::array<geom::Vec3, 2> face, outward;
};

Wedge wedge_of(const std::array<geom::Vec3, 2>& into, const geom::Vec3& along) {
  Wedge w;
  for (int i = 0; i < 2; ++i)
    w.face[i] = (into[i] - into[i].dot(along) * along).normalized();
  for (int i = 0; i < 2; ++i)
    w.outward[i] = (w.face[i].dot(w.face[1 - i]) * w.face[i] - w.face[1 - i]).normalized();
  return w;
}

// m, how deep the tip of each wedge lies under the two faces of the other. way: m, from the tip of e to that of f.
struct TipDepths {
  std::array<Linear, 2> of_e, of_f;

  TipDepths(const Wedge& e, const Wedge& f, const geom::Vec3& way, const geom::Vec3& turns) {
    for (int i = 0; i < 2; ++i) {
      of_e[i] = {way.dot(f.outward[i]), turns.dot(f.outward[i])};
      of_f[i] = {-way.dot(e.outward[i]), -turns.dot(e.outward[i])};
    }
  }
  // The larger depth of the two tips, each under the nearer face of the other wedge.
  double at(double x) const {
    return std::max(std::min(of_e[0](x), of_e[1](x)), std::min(of_f[0](x), of_f[1](x)));
  }
  // Between these places the depth under the nearer face is linear (ascending).
  std::array<double, 8> breaks(double from, double to) const {
    std::array<double, 8> places{from, to};
    const std::array<Linear, 4> all{of_e[0], of_e[1], of_f[0], of_f[1]};
    std::size_t n = 2;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) {
        const double slope = all[i].slope - all[j].slope;
        const double x = slope == 0 ? from : (all[j].at_0 - all[i].at_0) / slope;
        places[n++] = std::clamp(x, from, to);
      }
    std::sort(places.begin(), places.end());
    return places;
  }
};

// The direction along which the overlap of two wedges shrinks the fastest: at right angles to the line between the two
// points where their outlines cross (Feng and Owen 2004, Eng. Comput. 21, 265-277: their potential is the area of the
// overlap). It lies in the fans of both, whatever the angles of the wedges. between: on its side.
geom::Vec3 parting(const Wedge& e, const Wedge& f, const geom::Vec3& way, const geom::Vec3& along,
                   const geom::Vec3& between) {
  std::optional<geom::Vec3> first;
  geom::Vec3 chord = geom::Vec3::Zero();
  for (const geom::Vec3& r : e.face)
    for (const geom::Vec3& g : f.face) {
      const double sine = along.dot(r.cross(g)), s = along.dot(way.cross(g)) / sine,
                   t = along.dot(way.cross(r)) / sine;
      if (!(s >= 0 && t >= 0) || !std::isfinite(s + t))
        continue;
      const geom::Vec3 crossing = s * r;
      if (!first)
        first = crossing;
      else if ((crossing - *first).squaredNorm() > chord.squaredNorm())
        chord = crossing - *first;
    }
  const geom::Vec3 normal = along.cross(chord);
  const double size = normal.norm();
  if (!(size > 0))
    return between;
  return normal / (normal.dot(between) < 0 ? -size : size);
}

// Where two nearly parallel edges reach into each other, and along what normal: the middle of the stretch, each place of it
// weighed by how deep the tip of one wedge lies in the other. None where they do not meet.
struct Stretch {
  geom::PlacesOnSegments at;
  geom::Vec3 normal;
  std::array<double, 2> parts; // of the edges, where they run beside each other
};

std::optional<Stretch> stretch_of(const std::array<geom::Vec3, 2>& a, const std::array<geom::Vec3, 2>& b,
                                  const Wedge& e, const Wedge& f, const geom::Vec3& along,
                                  const geom::Vec3& between) {
  const double length = (a[1] - a[0]).norm(), b0 = (b[0] - a[0]).dot(along), b1 = (b[1] - a[0]).dot(along);
  const double from = std::max(0.0, std::min(b0, b1)), to = std::min(length, std::max(b0, b1));
  if (!(from < to))
    return std::nullopt;
  const geom::Vec3 turns = (b[1] - b[0]) / (b1 - b0) - along, apart = b[0] - a[0] - b0 * along - b0 * turns;
  const TipDepths depths(e, f, apart, turns);
  const std::array<double, 8> places = depths.breaks(from, to);
  Positive inside;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    if (places[i] < places[i + 1])
      inside.add({depths.at(places[i]), depths.at(places[i + 1])}, places[i], places[i + 1]);
  if (!(inside.area > 0))
    return std::nullopt;
  const double x = inside.moment / inside.area;
  return Stretch{{x / length, (x - b0) / (b1 - b0)},
                 parting(e, f, apart + x * turns, along, between),
                 {(to - from) / length, (to - from) / std::abs(b1 - b0)}};
}

} // namespace

std::optional<geom::Vec3> normal_between(const std::array<geom::Vec3, 2>& into_e,
                                         const std::array<geom::Vec3, 2>& into_f, const geom::Vec3& along,
                                         double clear) {
  geom::Vec3 normal = middle_of_fan(into_f) - middle_of_fan(into_e);
  normal = (normal - normal.dot(along) * along).normalized();
  for (int i = 0; i < 2; ++i)
    if (!(normal.dot(into_f[i]) < -clear * into_f[i].norm() &&
          normal.dot(into_e[i]) > clear * into_e[i].norm()))
      return std::nullopt;
  return normal;
}

NearestOfEdges nearest_of_edges(const Model& model, const State& state, const ContactEdge& e,
                                const ContactEdge& f) {
  const std::array<geom::Vec3, 2> a{place_of(model, state, e.nodes[0]), place_of(model, state, e.nodes[1])},
      b{place_of(model, state, f.nodes[0]), place_of(model, state, f.nodes[1])};
  const geom::Vec3 of_a = a[1] - a[0], of_b = b[1] - b[0];
  NearestOfEdges nearest;
  nearest.at = geom::nearest_on_segments(a[0], a[1], b[0], b[1]);
  nearest.nearly_parallel = of_a.cross(of_b).norm() < parallel_edges * of_a.norm() * of_b.norm();
  if (nearest.nearly_parallel) {
    const geom::Vec3 along = of_a.normalized();
    const auto into_e = into_faces(model, state, e, a[0], a[1]),
               into_f = into_faces(model, state, f, b[0], b[1]);
    if (const auto between = normal_between(into_e, into_f, along, clear_of_faces))
      if (const auto stretch =
              stretch_of(a, b, wedge_of(into_e, along), wedge_of(into_f, along), along, *between)) {
        nearest.at = stretch->at;
        nearest.normal = stretch->normal;
        nearest.parts = stretch->parts;
      }
  }
  nearest.way = b[0] + nearest.at.t * of_b - a[0] - nearest.at.s * of_a;
  return nearest;
}

bool leads_into_both(const Model& model, const State& state, const ContactEdge& e, const ContactEdge& f,
                     const geom::Vec3& way) {
  const double slack = fan_slack * way.norm();
  const auto leads_into = [&](const ContactEdge& edge, const geom::Vec3& there) {
    const geom::Vec3 x0 = place_of(model, state, edge.nodes[0]), x1 = place_of(model, state, edge.nodes[1]);
    const Wedge wedge = wedge_of(into_faces(model, state, edge, x0, x1), (x1 - x0).normalized());
    return there.dot(wedge.outward[0]) <= slack && there.dot(wedge.outward[1]) <= slack;
  };
  return leads_into(e, way) && leads_into(f, -way);
}

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
  const auto into_e = into_faces(model, state, e, a0, a1), into_f = into_faces(model, state, f, b0, b1);
  if (nearest.nearly_parallel) {
    if (!nearest.normal)
      return std::nullopt;
    return EdgeTouch{*nearest.normal, nearest.way.dot(*nearest.normal),
                     across.dot(*nearest.normal) < 0 ? -1. : 1.};
  }
  EdgeTouch touch{across.normalized()};
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
