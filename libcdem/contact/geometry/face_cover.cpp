#include "libcdem/contact/geometry/face_cover.hpp"

#include "libcdem/contact/geometry/edge_touch.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>

namespace cdem {
namespace {

double cross(const geom::Point& a, const geom::Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// m, from the nearest line along the outline; below 0 outside.
double inside_outline(const geom::Polygon& outline, const geom::Point& x) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const geom::Point &a = outline[i], &b = outline[(i + 1) % outline.size()];
    least = std::min(least, cross(b - a, x - a) / (b - a).norm());
  }
  return least;
}

// A face, laid into the plane of the axes.
geom::Polygon laid_flat(const Model& model, const State& state, const FlatFace& face,
                        const geom::PlaneAxes& axes, bool reverse) {
  geom::Polygon polygon;
  for (const int node : face.outline)
    polygon.push_back(axes.flat(place_of(model, state, node)));
  if (reverse)
    std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

geom::Vec3 normal_of(const Model& model, const State& state, const FlatFace& face) {
  geom::Vec3 twice = geom::Vec3::Zero();
  const geom::Vec3 origin = place_of(model, state, face.outline[0]);
  for (std::size_t i = 2; i < face.outline.size(); ++i)
    twice += (place_of(model, state, face.outline[i - 1]) - origin)
                 .cross(place_of(model, state, face.outline[i]) - origin);
  return twice.normalized();
}

// Sums over places of weight 1, x, y and their products.
struct Sums {
  double one = 0;
  geom::Point first = geom::Point::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  void add(double area, const geom::Point& x) {
    one += area;
    first += area * x;
    second += area * x * x.transpose();
  }
};

// Semi-springs nearer to the outline of the other face than they stand in from that of their own count less, and none leaves with much.
double spring_part(double inside, const FlatFace& own) {
  return std::clamp(1.1 * inside / (drawn_in * own.least_height) - 0.1, 1e-3, 1.0);
}

// Calls each(area, place) for the contacts that two faces have where they lie on each other.
template <class Each>
void each_contact(const Model& model, const State& state, const std::array<const FlatFace*, 2>& faces,
                  const std::array<geom::Polygon, 2>& outlines, const geom::PlaneAxes& axes,
                  const Each& each) {
  for (int side = 0; side < 2; ++side) {
    const FlatFace& other = *faces[1 - side];
    for (const int t : faces[side]->triangles) {
      const ContactTriangle& triangle = model.surface.triangles[t];
      const Corners x = corners_of(model, state, triangle.nodes);
      for (int corner = 0; corner < 3; ++corner) {
        const geom::Point place = axes.flat(weighted(x, spring_weights(corner)));
        if (const double inside = inside_outline(outlines[1 - side], place); inside > 0)
          each(spring_area(triangle.area, other.usual_area) * spring_part(inside, *faces[side]), place);
      }
    }
  }
  const auto flat = [&](int node) { return axes.flat(place_of(model, state, node)); };
  const auto from_end = [](const FlatFace::Edge& edge, double place) {
    return std::min(edge.ends[0] ? place : 1, edge.ends[1] ? 1 - place : 1);
  };
  for (const FlatFace::Edge& e : faces[0]->edges) {
    const geom::Point a = flat(e.nodes[0]), along = flat(e.nodes[1]) - a;
    for (const FlatFace::Edge& f : faces[1]->edges) {
      const geom::Point b = flat(f.nodes[0]), across = flat(f.nodes[1]) - b;
      const double twice = cross(along, across);
      if (std::abs(twice) < parallel_edges * along.norm() * across.norm())
        continue;
      const double s = cross(b - a, across) / twice, t = cross(b - a, along) / twice;
      if (std::min({s, t, 1 - s, 1 - t}) < 0)
        continue;
      if (const double part = part_at_end(std::min(from_end(e, s), from_end(f, t))); part > 0)
        each(edge_area(e.area, f.area) * part, a + s * along);
    }
  }
}

// Largest part of the usual weight by which others differ from it.
constexpr double most_uneven = 0.9;

// Contacts whose second moment, about a line through their mean place, is less than this part of that of the covered area stand
// in that line.
constexpr double least_spread = 0.01;

double area_of(const geom::Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

// Second moment of a polygon over its area, m2, about the origin, which is its centroid.
Eigen::Matrix2d spread_of(const geom::Polygon& polygon, double area) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const geom::Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()], c = a + b;
    sum += cross(a, b) / 24 * (a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  return sum / area;
}

// m, of a place below the face g; less than 0 above it.
double depth_below(const Model& model, const State& state, const geom::Vec3& place, const FlatFace& g,
                   const geom::Vec3& normal) {
  return (place_of(model, state, g.outline[0]) - place).dot(normal);
}

// k: next to nothing far from a corner of P.
double nearness(const geom::Point& way, double reach) {
  const double x = reach * reach / (way.squaredNorm() + reach * reach);
  return x * x;
}

// 0 at the outline of P, 1 well within.
double part_within(const geom::Polygon& covered, double size, const geom::Point& place) {
  return std::clamp(4 * inside_outline(covered, place) / size, 0., 1.);
}

// Corners of a polygon at which its outline turns: edges that are nearly parallel have no contact where they cross.
geom::Polygon turning_corners(const geom::Polygon& polygon, double size) {
  geom::Polygon apart, corners;
  for (const geom::Point& x : polygon)
    if (apart.empty() || ((x - apart.back()).norm() > 1e-6 * size && (x - apart[0]).norm() > 1e-6 * size))
      apart.push_back(x);
  const std::size_t n = apart.size();
  for (std::size_t i = 0; i < n; ++i) {
    const geom::Point in = apart[i] - apart[(i + n - 1) % n], out = apart[(i + 1) % n] - apart[i];
    if (cross(in, out) > parallel_edges * in.norm() * out.norm())
      corners.push_back(apart[i]);
  }
  return corners;
}

double least_height(const Model& model, const FlatFace& face) {
  double least = std::numeric_limits<double>::infinity();
  for (const int t : face.triangles)
    least = std::min(least, model.surface.triangles[t].height);
  return least;
}

} // namespace

double FaceCover::part(const geom::Point& place) const {
  if (share.empty())
    return 1;
  double sum = within * part_within(covered, size, place);
  for (std::size_t v = 0; v < share.size(); ++v)
    sum += share[v] * nearness(place - corners[v], reach);
  return sum;
}

double FaceCover::weight(const geom::Vec3& place) const {
  const geom::Point at = axes.flat(place);
  return part(at) * usual * (1 + std::clamp(slope.dot(at - mean), -most_uneven, most_uneven));
}

double FaceCover::part_of_spring(const geom::Vec3& place, const FlatFace& own) const {
  return spring_part(inside_outline(covered, axes.flat(place)), own);
}

bool FaceCover::covers(const geom::Vec3& place) const {
  return flat && inside_outline(covered, axes.flat(place)) > 0;
}

FlatFaces flat_faces(const Model& model) {
  const ContactSurface& s = model.surface;
  FlatFaces faces;
  faces.of_triangle.assign(s.triangles.size(), -1);
  for (std::size_t b = 0; b + 1 < s.block_begin.size(); ++b) {
    const Block& block = model.blocks[b];
    if (!block.convex())
      continue;
    const int first = static_cast<int>(faces.all.size());
    const auto count = static_cast<int>(block.shape.faces.size());
    std::vector<std::array<geom::Vec3, 2>> planes; // a place and the normal
    for (int f = 0; f < count; ++f) {
      FlatFace& face = faces.all.emplace_back();
      for (const int vertex : block.shape.faces[f].loop)
        face.outline.push_back(block.node_begin + vertex);
      planes.push_back({model.node_position[face.outline[0]], geom::face_normal(block.shape, f)});
    }
    const auto vertices = static_cast<int>(block.shape.vertices.size());
    for (int t = s.block_begin[b]; t < s.block_begin[b + 1]; ++t) {
      const geom::Triangle& n = s.triangles[t].nodes;
      const geom::Vec3 centre =
          (model.node_position[n[0]] + model.node_position[n[1]] + model.node_position[n[2]]) / 3;
      int nearest = 0;
      double least = std::numeric_limits<double>::infinity();
      for (int f = 0; f < count; ++f) // it is in the plane that it is least below
        if (const double below = (planes[f][0] - centre).dot(planes[f][1]); below < least) {
          least = below;
          nearest = f;
        }
      faces.of_triangle[t] = first + nearest;
      faces.all[first + nearest].triangles.push_back(t);
    }
    const auto edges_from =
        std::partition_point(s.edges.begin(), s.edges.end(),
                             [&](const ContactEdge& edge) { return edge.triangles[0] < s.block_begin[b]; });
    for (auto edge = edges_from; edge != s.edges.end() && edge->triangles[0] < s.block_begin[b + 1]; ++edge) {
      FlatFace::Edge own;
      own.nodes = edge->nodes;
      for (int end = 0; end < 2; ++end)
        own.ends[end] = edge->nodes[end] - block.node_begin < vertices;
      own.area = 0.5 * (s.triangles[edge->triangles[0]].area + s.triangles[edge->triangles[1]].area);
      for (int side = 0; side < 2; ++side) {
        FlatFace& face = faces.all[faces.of_triangle[edge->triangles[side]]];
        face.edges.push_back(own);
        face.beside.push_back(faces.of_triangle[edge->triangles[1 - side]]);
      }
    }
    for (int f = first; f < first + count; ++f) {
      FlatFace& face = faces.all[f];
      for (const int t : face.triangles) {
        const geom::Triangle& n = s.triangles[t].nodes;
        for (int i = 0; i < 3; ++i)
          face.least_height =
              std::min(face.least_height,
                       2 * s.triangles[t].area /
                           (model.node_position[n[(i + 1) % 3]] - model.node_position[n[i]]).norm());
      }
      for (const int t : face.triangles)
        face.usual_area += s.triangles[t].area / static_cast<double>(face.triangles.size());
    }
  }
  return faces;
}

bool lie_on_each_other(const geom::Vec3& normal, const geom::Vec3& other) {
  return normal.dot(other) < 0 && normal.cross(other).norm() <= clear_of_faces;
}

FaceCover cover_of(const Model& model, const State& state, const FlatFace& f, const FlatFace& g) {
  FaceCover cover;
  const geom::Vec3 normal = normal_of(model, state, f), other = normal_of(model, state, g);
  if (!lie_on_each_other(normal, other))
    return cover;
  const geom::Vec3 origin = place_of(model, state, f.outline[0]),
                   along = place_of(model, state, f.outline[1]) - origin;
  cover.axes.e1 = (along - along.dot(normal) * normal).normalized();
  cover.axes.e2 = normal.cross(cover.axes.e1);
  cover.axes.origin = origin;
  std::array<geom::Polygon, 2> outlines{laid_flat(model, state, f, cover.axes, false),
                                        laid_flat(model, state, g, cover.axes, true)};
  geom::Polygon covered = outlines[0], scratch;
  for (std::size_t i = 0; i < outlines[1].size() && !covered.empty(); ++i)
    geom::clip(covered, outlines[1][i], outlines[1][(i + 1) % outlines[1].size()], scratch);
  double area = 0;
  geom::Point first = geom::Point::Zero(); // m3
  for (std::size_t i = 2; i < covered.size(); ++i) {
    const double part = 0.5 * cross(covered[i - 1] - covered[0], covered[i] - covered[0]);
    area += part;
    first += part / 3 * (covered[0] + covered[i - 1] + covered[i]);
  }
  if (!(area > 0))
    return cover;
  const geom::Point centroid = first / area;
  cover.axes.origin = origin + centroid.x() * cover.axes.e1 + centroid.y() * cover.axes.e2;
  // Else they are the far sides of the two blocks.
  if (depth_below(model, state, cover.axes.origin, g, other) >
      std::min(least_height(model, f), least_height(model, g)))
    return cover;
  for (geom::Polygon* outline : {&outlines[0], &outlines[1], &covered})
    for (geom::Point& x : *outline)
      x -= centroid;
  cover.covered = std::move(covered);
  each_contact(model, state, {&f, &g}, outlines, cover.axes,
               [&](double of, const geom::Point& x) { cover.contacts.emplace_back(of, x); });
  cover.flat = !cover.contacts.empty();
  return cover;
}

void weigh(FaceCover& cover, const FlatFace& f, const FlatFace& g) {
  cover.weighed = true;
  const double area = area_of(cover.covered);
  const auto has_single_edges = [](const FlatFace& face) { return face.edges.size() == face.outline.size(); };
  if (has_single_edges(f) && has_single_edges(g)) {
    const double size = std::sqrt(area), usual = std::min(f.usual_area, g.usual_area);
    cover.corners = turning_corners(cover.covered, size);
    const std::size_t n = cover.corners.size();
    std::vector<double> near(n, 0.02 * usual);
    double within = 0;
    cover.size = size;
    cover.reach = 4 * drawn_in * std::sqrt(usual);
    for (const auto& [of, x] : cover.contacts) {
      within += of * part_within(cover.covered, size, x);
      for (std::size_t v = 0; v < n; ++v)
        near[v] += of * nearness(x - cover.corners[v], cover.reach);
    }
    cover.within = within > 0 ? std::min(1.0, 2 * area / 3 / within) : 0;
    const double at_corners = 2 - cover.within * within / area;
    cover.share.assign(n, 0);
    for (std::size_t v = 0; v < n; ++v) {
      const double half = 0.25 * cross(cover.corners[v], cover.corners[(v + 1) % n]);
      for (const std::size_t w : {v, (v + 1) % n})
        cover.share[w] += at_corners * half / near[w];
    }
  }
  Sums sums;
  for (const auto& [of, x] : cover.contacts)
    sums.add(of * cover.part(x), x);
  cover.usual = 2 * area / sums.one;
  cover.mean = sums.first / sums.one;
  // Weights that bring the mean place to the centroid.
  const Eigen::Matrix2d spread = sums.second / sums.one - cover.mean * cover.mean.transpose(),
                        over = spread_of(cover.covered, area).inverse() * spread;
  if (!(over.determinant() > least_spread * std::max(1.0, over.trace())))
    return;
  const geom::Point slope = -spread.inverse() * cover.mean;
  double uneven = 0;
  for (const auto& [of, x] : cover.contacts)
    uneven = std::max(uneven, std::abs(slope.dot(x - cover.mean)));
  cover.slope = most_uneven / std::max(uneven, most_uneven) * slope;
}

} // namespace cdem
