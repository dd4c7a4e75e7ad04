#include "libgeom/placement/pile_measures.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/placement/ground.hpp"
#include "libgeom/placement/lowering.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

using Point = Eigen::Vector2d;

constexpr double columns_per_height = 40;
constexpr std::int64_t least_columns = 400; // a square of H/2
constexpr double none = -std::numeric_limits<double>::infinity();

double cross_in_plan(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Vec3 centroid(const Surface& surface) {
  const Vec3 origin = surface.points.front();
  double volume = 0;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto [a, b, c] = surface.corners(i);
    const double v = (a - origin).dot((b - origin).cross(c - origin)) / 6;
    volume += v;
    moment += v / 4 * ((a - origin) + (b - origin) + (c - origin));
  }
  return origin + moment / volume;
}

// Corners of the convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Point> hull_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= begin + 2 &&
             cross_in_plan(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

bool inside(const std::vector<Point>& hull, const Point& p, double margin) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point along = hull[(i + 1) % hull.size()] - hull[i];
    if (cross_in_plan(along.normalized(), p - hull[i]) < margin)
      return false;
  }
  return true;
}

// Columns on a grid, with what they cross.
struct Columns {
  Point first = Point::Zero(); // m
  double spacing = 0;          // m
  int nx = 0, ny = 0;
  std::vector<char> wanted;
  std::vector<double> ground; // m, along the normal
  std::vector<std::vector<std::pair<double, int>>>
      faces; // height of each face crossed, +1 into a solid from below

  Point place(int i, int j) const { return first + spacing * Point(i, j); }
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(j) * nx + i; }
};

// Twice the area of a, b, p, and whether p is left of the line from a to b; a point on the line counts as one
// moved by (-e^2, e). Both change sign with the order of a and b, so that a column between two faces meets
// exactly one of them.
std::pair<double, bool> side_of(Point a, Point b, const Point& p) {
  const bool swapped = a.x() != b.x() ? a.x() > b.x() : a.y() > b.y();
  if (swapped)
    std::swap(a, b);
  const double area = cross_in_plan(b - a, p - a);
  return {swapped ? -area : area, swapped != (area >= 0)};
}

// visit(column, height, turn) for every column that a triangle crosses; turn: 1 when it is counter-clockwise
// seen along the normal, its outside up.
template <class Visit>
void cross_columns(const Columns& columns, const TrianglePoints& t, const Visit& visit) {
  const Point a = t[0].head<2>(), b = t[1].head<2>(), c = t[2].head<2>();
  const double twice_area = cross_in_plan(b - a, c - a);
  if (twice_area == 0)
    return;
  const int turn = twice_area > 0 ? 1 : -1;
  const Point low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const auto range = [&](int k, int n) {
    const double first = std::ceil((low[k] - columns.first[k]) / columns.spacing);
    const double last = std::floor((high[k] - columns.first[k]) / columns.spacing);
    return std::pair<int, int>(static_cast<int>(std::clamp(first, 0., static_cast<double>(n))),
                               static_cast<int>(std::clamp(last, -1., n - 1.)));
  };
  const auto [i0, i1] = range(0, columns.nx);
  const auto [j0, j1] = range(1, columns.ny);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const std::size_t column = columns.at(i, j);
      if (!columns.wanted[column])
        continue;
      const Point p = columns.place(i, j);
      const auto [wa, left_a] = side_of(b, c, p);
      const auto [wb, left_b] = side_of(c, a, p);
      const auto [wc, left_c] = side_of(a, b, p);
      if (left_a == left_b && left_b == left_c && left_a == (turn > 0))
        visit(column, (wa * t[0].z() + wb * t[1].z() + wc * t[2].z()) / (wa + wb + wc), turn);
    }
}

template <class Visit>
void cross_columns(const Columns& columns, const Surface& surface, const Mat3& frame, const Visit& visit) {
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    TrianglePoints t = surface.corners(i);
    for (Vec3& x : t)
      x = frame * x;
    cross_columns(columns, t, visit);
  }
}

Columns middle_of(const std::vector<Point>& centroids, double height) {
  const std::vector<Point> hull = hull_of(centroids);
  Columns columns;
  if (hull.size() >= 3) {
    Point low = hull[0], high = hull[0];
    for (const Point& p : hull) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    columns.spacing = height / columns_per_height;
    // Half a step in, so that the columns are the middles of squares.
    columns.first = low + Point::Constant(0.5 * columns.spacing);
    columns.nx = static_cast<int>((high - low).x() / columns.spacing);
    columns.ny = static_cast<int>((high - low).y() / columns.spacing);
    columns.wanted.assign(static_cast<std::size_t>(columns.nx) * columns.ny, 0);
    for (int j = 0; j < columns.ny; ++j)
      for (int i = 0; i < columns.nx; ++i)
        columns.wanted[columns.at(i, j)] = inside(hull, columns.place(i, j), 0.5 * height);
  }
  if (std::count(columns.wanted.begin(), columns.wanted.end(), 1) < least_columns)
    throw InputError("the pile has no middle: porosity is measured a unit's height away from its edge, and "
                     "its " +
                     counted(centroids.size(), "unit reaches", "units reach") +
                     " no further; take at least three rows of three, or more where they lie close");
  columns.ground.assign(columns.wanted.size(), none);
  columns.faces.resize(columns.wanted.size());
  return columns;
}

// Length of a column inside any unit, up to a height.
double filled(const std::vector<std::pair<double, int>>& faces, double up_to) {
  double length = 0;
  int depth = 0;
  for (std::size_t f = 0; f + 1 < faces.size(); ++f) {
    depth += faces[f].second;
    if (depth > 0)
      length += std::max(0., std::min(up_to, faces[f + 1].first) - std::min(up_to, faces[f].first));
  }
  return length;
}

struct Sums {
  double solid = 0, layer_solid = 0, thickness = 0;
  std::int64_t columns = 0;
  double porosity() const { return 1 - layer_solid / (static_cast<double>(columns) * thickness); }
};

Sums sum(const Columns& columns, int every) {
  Sums sums;
  double top = 0;
  std::int64_t met = 0;
  const auto each = [&](const auto& visit) {
    for (int j = 0; j < columns.ny; j += every)
      for (int i = 0; i < columns.nx; i += every)
        if (columns.wanted[columns.at(i, j)])
          visit(columns.at(i, j));
  };
  each([&](std::size_t c) {
    ++sums.columns;
    sums.solid += filled(columns.faces[c], std::numeric_limits<double>::infinity());
    if (columns.faces[c].empty())
      return;
    ++met;
    top += columns.faces[c].back().first - columns.ground[c];
  });
  if (met == 0)
    throw InputError("no unit lies over the middle of the pile: porosity cannot be measured");
  sums.thickness = top / static_cast<double>(met);
  each([&](std::size_t c) {
    sums.layer_solid += filled(columns.faces[c], columns.ground[c] + sums.thickness);
  });
  return sums;
}

} // namespace

PileMeasures measure_pile(const std::vector<Surface>& units, const Surface& ground, double height,
                          double unit_volume) {
  if (units.empty())
    throw InputError("the pile has no units");
  PlanBox plan{units.front().points.front().head<2>(), units.front().points.front().head<2>()};
  for (const Surface& unit : units) {
    const Box box = bounding_box(unit);
    plan.min = plan.min.cwiseMin(box.min.head<2>());
    plan.max = plan.max.cwiseMax(box.max.head<2>());
  }
  const Mat3 frame = frame_along(Ground(ground).normal(plan));
  std::vector<Point> centroids;
  centroids.reserve(units.size());
  for (const Surface& unit : units)
    centroids.emplace_back((frame * centroid(unit)).head<2>());
  Columns columns = middle_of(centroids, height);

  cross_columns(columns, ground, frame, [&](std::size_t column, double at, int turn) {
    if (turn > 0)
      columns.ground[column] = std::max(columns.ground[column], at);
  });
  for (std::size_t c = 0; c < columns.wanted.size(); ++c)
    if (columns.wanted[c] && columns.ground[c] == none)
      throw InputError(
          "the pile reaches beside its ground, where it has no thickness; choose a wider ground");
  for (const Surface& unit : units)
    cross_columns(columns, unit, frame, [&](std::size_t column, double at, int turn) {
      columns.faces[column].emplace_back(at, -turn);
    });
  for (auto& faces : columns.faces) // into a solid first where two touch
    std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    });

  const Sums all = sum(columns, 1), half = sum(columns, 2);
  PileMeasures m;
  m.columns = all.columns;
  m.area = static_cast<double>(all.columns) * columns.spacing * columns.spacing;
  m.porosity = all.porosity();
  m.porosity_error = std::abs(all.porosity() - half.porosity());
  m.units_per_area = all.solid / (static_cast<double>(all.columns) * unit_volume);
  m.packing_density = m.units_per_area * std::pow(unit_volume, 2. / 3);
  m.thickness = all.thickness;
  return m;
}

} // namespace geom
