#include "libcdem/contact/geometry/edge_touch.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// The fan of an edge's outward normals: those that have both its faces behind.
bool in_fan(const std::array<geom::Vec3, 2>& into, const geom::Vec3& normal, double slack) {
  return !(normal.dot(into[0]) > slack * into[0].norm()) && !(normal.dot(into[1]) > slack * into[1].norm());
}

geom::Vec3 middle_of_fan(const std::array<geom::Vec3, 2>& into) {
  return -(into[0].normalized() + into[1].normalized()).normalized();
}

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

// The line between the two points where the outlines of two wedges cross that overlap.
struct Chord {
  geom::Vec3 across =
      geom::Vec3::Zero(); // m, at right angles to it and as long; on the side of the middle of both fans
  geom::Vec3 middle = geom::Vec3::Zero(); // m, from the tip of e
};

// What a stretch of two nearly parallel edges stores, over its stiffness, and how that changes as f moves past e: as if a load
// stood on the stretch.
struct LineLoad {
  double energy = 0;                      // as the integral of depth^2 over the stretch
  geom::Vec3 force = geom::Vec3::Zero();  // its derivative by the way from e to f
  geom::Vec3 moment = geom::Vec3::Zero(); // of that load, its places along e as arms
  double roll = 0;                        // of the load, about e

  void add(double part, const LineLoad& other) {
    energy += part * other.energy;
    force += part * other.force;
    moment += part * other.moment;
    roll += part * other.roll;
  }
};

// The overlap of two nearly parallel edges, cut at right angles to the first: at each place x along it the overlap of two
// wedges. Its energy there is twice the area.
class Overlap {
public:
  Overlap(const Wedge& e, const Wedge& f, const geom::Vec3& apart, const geom::Vec3& turns,
          const geom::Vec3& along, const geom::Vec3& between)
      : e_(e), f_(f), apart_(apart), turns_(turns), along_(along), between_(between) {
    for (int i = 0; i < 2; ++i)
      for (const auto& [slope, at_0] :
           {std::pair(turns.dot(f.outward[i]), apart.dot(f.outward[i])), // the tip of e passes a face of f
            std::pair(turns.dot(e.outward[i]), apart.dot(e.outward[i]))})
        if (const double x = -at_0 / slope; std::isfinite(x))
          breaks_[n_breaks_++] = x;
    std::sort(breaks_.begin(), breaks_.begin() + n_breaks_);
  }

  LineLoad load_at(double x) const {
    const geom::Vec3 way = apart_ + x * turns_;
    const Chord c = chord(way);
    const geom::Vec3& grows = c.across; // the derivative of the area
    return {way.dot(grows), 2 * grows, 2 * x * grows, 2 * c.middle.cross(grows).dot(along_)};
  }

  // Square of the depth over twice the area where tips meet in the middle of both fans.
  double depth_measure() const { return 1 / chord(between_).across.dot(between_); }

  // Over a stretch. Between two breaks the overlap is quadratic: Simpson's rule is exact.
  LineLoad load(double from, double to) const {
    LineLoad sum;
    each_piece(from, to, [&](double begin, double end) {
      const double sixth = (end - begin) / 6;
      sum.add(sixth, load_at(begin));
      sum.add(4 * sixth, load_at(0.5 * (begin + end)));
      sum.add(sixth, load_at(end));
    });
    return sum;
  }

  // Where the overlap is the largest. None where it goes on without end, further than this away.
  std::optional<double> peak(double near, double within) const {
    const double first = breaks_[0], last = breaks_[std::max(0, n_breaks_ - 1)];
    if (n_breaks_ < 2 || load_at(2 * first - last).energy > 0 || load_at(2 * last - first).energy > 0)
      return std::nullopt;
    double at = near, most = 0;
    each_piece(first, last, [&](double begin, double end) {
      const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin), a = load_at(begin).energy,
                   b = load_at(middle).energy, c = load_at(end).energy, bends = a - 2 * b + c;
      const double top =
          bends < 0 ? std::clamp(middle + 0.5 * half * (a - c) / bends, begin, end) : (a > c ? begin : end);
      if (const double here = load_at(top).energy; here > most) {
        most = here;
        at = top;
      }
    });
    return most > 0 && std::abs(at - near) < within ? std::optional(at) : std::nullopt;
  }

  // Where the stretch of a length begins that holds the most: the overlap is as large at its end. It grows up to its peak and
  // shrinks from there (Brunn and Minkowski).
  double fullest(double length, double peak) const {
    const auto more_behind = [&](double x) { return load_at(x).energy - load_at(x + length).energy; };
    double begin = peak - length, end = peak;
    for (int i = 0; i < n_breaks_; ++i)
      for (const double x : {breaks_[i], breaks_[i] - length})
        if (x > begin && x < end)
          (more_behind(x) < 0 ? begin : end) = x;
    // In between it is quadratic.
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin), a = more_behind(begin),
                 b = more_behind(middle), c = more_behind(end), slope = c - a, bends = 2 * (a - 2 * b + c);
    const double root = std::sqrt(std::max(0.0, slope * slope - 4 * bends * b));
    return std::clamp(slope + root > 0 ? middle - half * 4 * b / (slope + root) : middle, begin, end);
  }

private:
  // The overlap shrinks the fastest at right angles to its chord, and by the length of it (Feng and Owen 2004, Eng.
  // Comput. 21, 265-277: their potential is the area of the overlap). That lies in the fans of both, whatever the angles.
  Chord chord(const geom::Vec3& way) const {
    std::optional<geom::Vec3> first;
    geom::Vec3 longest = geom::Vec3::Zero();
    for (const geom::Vec3& r : e_.face)
      for (const geom::Vec3& g : f_.face) {
        const double sine = along_.dot(r.cross(g)), s = along_.dot(way.cross(g)) / sine,
                     t = along_.dot(way.cross(r)) / sine;
        if (!(s >= 0 && t >= 0) || !std::isfinite(s + t))
          continue;
        const geom::Vec3 crossing = s * r;
        if (!first)
          first = crossing;
        else if ((crossing - *first).squaredNorm() > longest.squaredNorm())
          longest = crossing - *first;
      }
    const geom::Vec3 across = along_.cross(longest);
    return first ? Chord{across.dot(between_) < 0 ? geom::Vec3(-across) : across, *first + 0.5 * longest}
                 : Chord{};
  }

  template <typename Does>
  void each_piece(double from, double to, const Does& does) const {
    double begin = from;
    for (int i = 0; i < n_breaks_; ++i)
      if (breaks_[i] > begin && breaks_[i] < to) {
        does(begin, breaks_[i]);
        begin = breaks_[i];
      }
    if (begin < to)
      does(begin, to);
  }

  Wedge e_, f_;
  geom::Vec3 apart_, turns_, along_, between_;
  std::array<double, 4> breaks_{}; // m along e, ascending
  int n_breaks_ = 0;
};

// What two nearly parallel edges store where they run beside each other, over half of the stiffness of their crossing.
// The square of the depth where it is the largest, times the part of the overlap that is theirs: over that of the stretch of an
// edge's length that holds the most. So parallel edges bear by the length that they have in common; lines that cross bear as much at any
// angle; and the pairs of two straight chains bear together as one crossing does, over the nodes. As both are the largest of their kind,
// neither jumps, and their derivatives are those of a place and a stretch that stay.
constexpr double without_end = 1e4; // times the length: what is deepest so far away does not matter

LineLoad load_of(const Overlap& overlap, double from, double to, double length) {
  const LineLoad own = overlap.load(from, to);
  LineLoad load;
  const auto deepest = own.energy > 0 ? overlap.peak(0.5 * (from + to), without_end * length) : std::nullopt;
  if (!deepest) {
    load.add(1 / length, own);
    return load;
  }
  const double begin = overlap.fullest(length, *deepest);
  const LineLoad there = overlap.load_at(*deepest), around = overlap.load(begin, begin + length);
  const double part = own.energy / around.energy;
  load.add(there.energy / around.energy, own);
  load.add(part, there);
  load.add(-part * there.energy / around.energy, around);
  load.energy = part * there.energy;
  return load;
}

std::optional<EdgeStretch> stretch_of(const std::array<geom::Vec3, 2>& a, const std::array<geom::Vec3, 2>& b,
                                      const Wedge& e, const Wedge& f, const geom::Vec3& along,
                                      const geom::Vec3& between, double length) {
  const double b0 = (b[0] - a[0]).dot(along), b1 = (b[1] - a[0]).dot(along);
  const double from = std::max(0.0, std::min(b0, b1)), to = std::min((a[1] - a[0]).norm(), std::max(b0, b1));
  if (!(from < to))
    return std::nullopt;
  const geom::Vec3 turns = (b[1] - b[0]) / (b1 - b0) - along, apart = b[0] - a[0] - b0 * along - b0 * turns;
  const Overlap overlap(e, f, apart, turns, along, between);
  const LineLoad load = load_of(overlap, from, to, length);
  const double force2 = load.force.squaredNorm();
  if (!(load.energy > 0 && force2 > 0))
    return std::nullopt;
  // One force through the place where it turns about the edges as the load does, and what is left of the moment.
  const double force = std::sqrt(force2), x = load.moment.dot(load.force) / force2;
  EdgeStretch stretch;
  stretch.normal = load.force / force;
  stretch.depth = 2 * load.energy / force;
  stretch.share = 0.25 * force2 / load.energy;
  stretch.measure = overlap.depth_measure();
  stretch.place = a[0] + x * along + load.roll / force2 * load.force.cross(along);
  stretch.lever = along.cross(load.moment - x * load.force).dot(stretch.normal) / force;
  return stretch;
}

} // namespace

geom::Vec3 way_between_fans(const std::array<geom::Vec3, 2>& into_e, const std::array<geom::Vec3, 2>& into_f,
                            const geom::Vec3& along) {
  const geom::Vec3 way = middle_of_fan(into_f) - middle_of_fan(into_e);
  return way - way.dot(along) * along;
}

double falls_away(const std::array<geom::Vec3, 2>& into_e, const std::array<geom::Vec3, 2>& into_f,
                  const geom::Vec3& normal) {
  const auto least = [&](const std::array<geom::Vec3, 2>& into) {
    return std::min(normal.dot(into[0].normalized()), normal.dot(into[1].normalized()));
  };
  return std::min(least(into_e), least({-into_f[0], -into_f[1]}));
}

std::optional<geom::Vec3> normal_between(const std::array<geom::Vec3, 2>& into_e,
                                         const std::array<geom::Vec3, 2>& into_f, const geom::Vec3& along,
                                         double clear) {
  const geom::Vec3 normal = way_between_fans(into_e, into_f, along).normalized();
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
      nearest.stretch = stretch_of(a, b, wedge_of(into_e, along), wedge_of(into_f, along), along, *between,
                                   0.5 * (of_a.norm() + of_b.norm()));
    if (nearest.stretch)
      nearest.at = {std::clamp((nearest.stretch->place - a[0]).dot(of_a) / of_a.squaredNorm(), 0., 1.),
                    std::clamp((nearest.stretch->place - b[0]).dot(of_b) / of_b.squaredNorm(), 0., 1.)};
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
                                  const ContactEdge& f, const NearestOfEdges& nearest,
                                  const geom::Vec3* old_normal) {
  const double slack = old_normal ? fan_slack_of_old : fan_slack;
  const geom::Vec3 a0 = place_of(model, state, e.nodes[0]), a1 = place_of(model, state, e.nodes[1]),
                   b0 = place_of(model, state, f.nodes[0]), b1 = place_of(model, state, f.nodes[1]);
  const geom::Vec3 across = (a1 - a0).cross(b1 - b0);
  const auto into_e = into_faces(model, state, e, a0, a1), into_f = into_faces(model, state, f, b0, b1);
  if (nearest.nearly_parallel) {
    if (!nearest.stretch)
      return std::nullopt;
    const geom::Vec3& normal = nearest.stretch->normal;
    return EdgeTouch{normal, nearest.stretch->depth, across.dot(normal) < 0 ? -1. : 1.};
  }
  EdgeTouch touch{across.normalized()};
  if (old_normal ? touch.normal.dot(*old_normal) < 0 : !in_fan(into_f, touch.normal, slack)) {
    touch.normal = -touch.normal;
    touch.sense = -1;
  }
  if (!in_fan(into_f, touch.normal, slack) || !in_fan(into_e, -touch.normal, slack))
    return std::nullopt;
  touch.depth = nearest.way.dot(touch.normal);
  if (touch.depth > 0 && !nearest.within_both()) {
    const double distance = nearest.way.norm();
    touch.normal = nearest.way / distance;
    touch.depth =
        in_fan(into_f, touch.normal, slack) && in_fan(into_e, -touch.normal, slack) ? distance : -distance;
  }
  return touch;
}

} // namespace cdem
