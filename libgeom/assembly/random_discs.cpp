#include "libgeom/assembly/random_discs.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>

namespace geom {
namespace {

double power(double x, double exponent) {
  return portable::exp(exponent * portable::log(x));
}

void check(const RandomDiscs& set) {
  const std::string name = "set \"" + set.set + "\": ";
  const RadiusOptions& r = set.radius;
  if (r.law == RadiusLaw::power) {
    require_positive(name + "exponent", r.exponent, "");
    require_positive(name + "smallest", r.smallest);
    if (!(std::isfinite(r.largest) && r.largest > r.smallest))
      throw InputError(name + "largest", text(r.largest), "above smallest = " + text(r.smallest) + " m");
  } else {
    require_positive(name + "radius", r.mean);
    if (r.law == RadiusLaw::lognormal)
      require_positive(name + "deviation", r.deviation);
  }
  if (set.kappa && !(std::isfinite(*set.kappa) && *set.kappa > 0))
    throw InputError(name + "kappa", text(*set.kappa), "a finite number > 0");
  require_positive(name + "density", set.p30, "1/m3");
}

// Unit vector at the angle t and the turn f about the mean pole.
Vec3 about(const Vec3& pole, double cos_t, double turn) {
  const Vec3 e1 = pole.unitOrthogonal(), e2 = pole.cross(e1);
  const double sin_t = std::sqrt(std::max(0.0, 1 - cos_t * cos_t));
  return cos_t * pole + sin_t * (portable::cos(turn) * e1 + portable::sin(turn) * e2);
}

struct DipAngles {
  double dip, direction; // rad
};
DipAngles angles_of(Vec3 pole) {
  if (pole.z() < 0)
    pole = -pole;
  const double direction = portable::atan2(pole.x(), pole.y());
  const double flat = std::hypot(pole.x(), pole.y());
  return {portable::atan2(flat, pole.z()), direction < 0 ? direction + 2 * M_PI : direction};
}

using Point = Eigen::Vector2d;

// Area of a disc of radius r about the origin within the triangle origin, a, b; signed (counter-clockwise positive).
double area_with_origin(const Point& a, const Point& b, double r) {
  const auto cross = [](const Point& p, const Point& q) { return p.x() * q.y() - p.y() * q.x(); };
  const auto sector = [&](const Point& p, const Point& q) {
    return 0.5 * r * r * portable::atan2(cross(p, q), p.dot(q));
  };
  const Point d = b - a;
  const double length2 = d.squaredNorm();
  if (!(length2 > 0))
    return 0;
  // Where the line a + t d meets the circle.
  const double half = -a.dot(d) / length2, inside = half * half - (a.squaredNorm() - r * r) / length2;
  if (!(inside > 0))
    return sector(a, b);
  const double low = half - std::sqrt(inside), high = half + std::sqrt(inside);
  if (high <= 0 || low >= 1)
    return sector(a, b);
  const Point in = a + std::max(low, 0.0) * d, out = a + std::min(high, 1.0) * d;
  return (low > 0 ? sector(a, in) : 0) + 0.5 * cross(in, out) + (high < 1 ? sector(out, b) : 0);
}

struct Flat { // a plane with axes
  Vec3 origin, e1, e2;
  explicit Flat(const Vec3& at, const Vec3& normal)
      : origin(at), e1(normal.unitOrthogonal()), e2(normal.cross(e1)) {}
  Point at(const Vec3& x) const { return {e1.dot(x - origin), e2.dot(x - origin)}; }
  Vec3 in_space(const Point& p) const { return origin + p.x() * e1 + p.y() * e2; }
};

// The part of a box in a plane, counter-clockwise over its axes: a large square cut by the box's sides.
std::vector<Point> section(const Flat& flat, const Box& box) {
  const double reach = box.size().norm() + (flat.origin - box.centre()).norm();
  std::vector<Point> polygon{{-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      std::vector<Point> part;
      const auto level = [&](const Point& p) {
        const double x = flat.in_space(p)[axis];
        return side > 0 ? x - box.max[axis] : box.min[axis] - x;
      };
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double la = level(a), lb = level(b);
        if (la <= 0)
          part.push_back(a);
        if ((la < 0 && lb > 0) || (la > 0 && lb < 0))
          part.emplace_back(a + la / (la - lb) * (b - a));
      }
      polygon.swap(part);
    }
  return polygon;
}

double area_in(const Disc& disc, const Vec3& pole, const Box& box) {
  const std::vector<Point> polygon = section(Flat(disc.centre, pole), box);
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += area_with_origin(polygon[i], polygon[(i + 1) % polygon.size()], disc.radius);
  return std::abs(area);
}

double area_of(const std::vector<Point>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

// Length of the disc's trace in the plane, within the polygon.
double trace_in(const Disc& disc, const Vec3& pole, const Plane& plane, const Flat& flat,
                const std::vector<Point>& polygon) {
  const Vec3 along = pole.cross(plane.normal);
  const double sine = along.norm(), height = plane.level(disc.centre);
  if (!(sine > 1e-12) || !(std::abs(height) < disc.radius * sine))
    return 0;
  const Vec3 direction = along / sine;
  // Towards the plane within the disc.
  const Vec3 middle = disc.centre - height / sine * (direction.cross(pole)).normalized() *
                                        ((direction.cross(pole)).dot(plane.normal) > 0 ? 1 : -1);
  const double half = std::sqrt(std::max(0.0, disc.radius * disc.radius - height * height / (sine * sine)));
  const Point from = flat.at(middle - half * direction), step = flat.at(middle + half * direction) - from;
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point edge = polygon[(i + 1) % polygon.size()] - polygon[i], inward(-edge.y(), edge.x());
    const double start = inward.dot(from - polygon[i]), rate = inward.dot(step);
    if (rate > 0)
      begin = std::max(begin, -start / rate);
    else if (rate < 0)
      end = std::min(end, -start / rate);
    else if (start < 0)
      return 0;
  }
  return std::max(0.0, end - begin) * 2 * half;
}

bool crosses(const Disc& disc, const Vec3& pole, const std::array<Vec3, 2>& line) {
  const double a = pole.dot(line[0] - disc.centre), b = pole.dot(line[1] - disc.centre);
  if ((a < 0) == (b < 0))
    return false;
  const Vec3 x = line[0] + a / (a - b) * (line[1] - line[0]);
  return (x - disc.centre).norm() < disc.radius;
}

} // namespace

double mean_square(const RadiusOptions& r) {
  switch (r.law) {
  case RadiusLaw::constant:
    return r.mean * r.mean;
  case RadiusLaw::exponential:
    return 2 * r.mean * r.mean;
  case RadiusLaw::lognormal:
    return r.mean * r.mean + r.deviation * r.deviation;
  case RadiusLaw::power:
    break;
  }
  const double n = r.exponent, all = power(r.smallest, -n) - power(r.largest, -n);
  if (n == 2)
    return 2 * portable::log(r.largest / r.smallest) / all;
  return n / (n - 2) * (power(r.smallest, 2 - n) - power(r.largest, 2 - n)) / all;
}

double radius_at(const RadiusOptions& r, double u) {
  switch (r.law) {
  case RadiusLaw::constant:
    return r.mean;
  case RadiusLaw::exponential:
    return -r.mean * portable::log(1 - u);
  case RadiusLaw::lognormal: {
    const double variance = portable::log(1 + r.deviation * r.deviation / (r.mean * r.mean));
    return r.mean * portable::exp(std::sqrt(variance) * normal_quantile(u) - 0.5 * variance);
  }
  case RadiusLaw::power:
    break;
  }
  const double low = power(r.smallest, -r.exponent), high = power(r.largest, -r.exponent);
  return power(low - u * (low - high), -1 / r.exponent);
}

std::vector<Disc> random_discs(const std::vector<RandomDiscs>& sets, const Box& box, std::uint64_t seed) {
  if (!((box.max - box.min).array() > 0).all())
    throw InputError("box.max", text(box.max), "above box.min = " + text(box.min) + " in every axis");
  const double volume = box.size().prod();
  double all = 0;
  for (const RandomDiscs& set : sets) {
    check(set);
    all += set.p30 * volume;
  }
  if (!(all <= static_cast<double>(most_discs)))
    throw InputError("sets", std::to_string(static_cast<long long>(std::min(all, 1e15))) + " discs",
                     "such that there are at most 100000 discs",
                     "use a lower density, larger discs or a smaller box");
  std::vector<Disc> discs;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const RandomDiscs& set = sets[s];
    const Vec3 mean = normal_of_dip(set.dip, set.dip_direction);
    const auto count = static_cast<std::uint64_t>(std::llround(set.p30 * volume));
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::uint64_t id = (static_cast<std::uint64_t>(s) << 32) + k;
      const auto draw = [&](std::uint64_t n) { return uniform(seed, id, n); };
      Disc disc;
      disc.id = static_cast<std::int64_t>(discs.size()) + 1;
      disc.set = set.set;
      disc.centre = box.min + box.size().cwiseProduct(Vec3(draw(0), draw(1), draw(2)));
      disc.radius = radius_at(set.radius, std::clamp(draw(3), 0x1p-53, 1 - 0x1p-53));
      disc.dip = set.dip;
      disc.dip_direction = set.dip_direction;
      if (set.kappa) {
        const double k2 = *set.kappa;
        const double cos_t = 1 + portable::log(1 - draw(4) * (1 - portable::exp(-2 * k2))) / k2;
        const DipAngles angles = angles_of(about(mean, std::max(cos_t, -1.0), 2 * M_PI * draw(5)));
        disc.dip = std::min(angles.dip, M_PI / 2);
        disc.dip_direction = angles.direction;
      }
      discs.push_back(std::move(disc));
    }
  }
  return discs;
}

std::vector<DiscStatistics> disc_statistics(const std::vector<Disc>& discs, const DiscWindow& window) {
  if (!((window.box.max - window.box.min).array() > 0).all())
    throw InputError("box.max", text(window.box.max),
                     "above box.min = " + text(window.box.min) + " in every axis");
  const double volume = window.box.size().prod();
  std::optional<Flat> flat;
  std::vector<Point> polygon;
  if (window.plane) {
    flat.emplace(window.plane->offset * window.plane->normal, window.plane->normal);
    polygon = section(*flat, window.box);
    if (polygon.size() < 3 || !(area_of(polygon) > 0))
      throw InputError("plane: it does not meet the box");
  }
  const double length = window.line ? ((*window.line)[1] - (*window.line)[0]).norm() : 0;
  if (window.line && !(length > 0))
    throw InputError("line: its two ends must be apart");
  struct Sums {
    DiscStatistics out;
    Mat3 tensor = Mat3::Zero();
    std::vector<Vec3> poles;
    double traces = 0;
    std::int64_t centres = 0, crossings = 0;
  };
  std::map<std::string, Sums> sets;
  for (const Disc& disc : discs) {
    Sums& s = sets[disc.set];
    const Vec3 pole = normal_of_dip(disc.dip, disc.dip_direction);
    ++s.out.count;
    s.out.mean_radius += disc.radius;
    s.tensor += pole * pole.transpose();
    s.poles.push_back(pole);
    s.centres += window.box.contains(disc.centre) ? 1 : 0;
    s.out.p32 += area_in(disc, pole, window.box) / volume;
    if (window.plane)
      s.traces += trace_in(disc, pole, *window.plane, *flat, polygon);
    if (window.line)
      s.crossings += crosses(disc, pole, *window.line) ? 1 : 0;
  }
  std::vector<DiscStatistics> result;
  for (auto& [name, s] : sets) {
    const auto n = static_cast<double>(s.out.count);
    s.out.set = name;
    s.out.mean_radius /= n;
    s.out.p30 = static_cast<double>(s.centres) / volume;
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(s.tensor);
    const Vec3 main = axes.eigenvectors().col(2);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& pole : s.poles)
      sum += pole.dot(main) < 0 ? Vec3(-pole) : pole;
    const DipAngles angles = angles_of(sum.normalized());
    s.out.dip = std::min(angles.dip, M_PI / 2);
    s.out.dip_direction = angles.direction;
    if (s.out.count >= 3 && n - sum.norm() > 1e-12 * n)
      s.out.kappa = (n - 1) / (n - sum.norm());
    if (window.plane)
      s.out.p21 = s.traces / area_of(polygon);
    if (window.line)
      s.out.p10 = static_cast<double>(s.crossings) / length;
    result.push_back(std::move(s.out));
  }
  return result;
}

} // namespace geom
