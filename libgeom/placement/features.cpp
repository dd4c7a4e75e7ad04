#include "libgeom/placement/features.hpp"

#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace geom {
namespace {

constexpr double flat = 0.02;     // sine of the angle below which an edge does not stand out
constexpr double seam = 1e-9;     // how far beside a face a corner still is on it
constexpr double sideways = 1e-6; // how far a direction may be outside the cone of an edge's normals

Box grown(Box box, double by) {
  box.min.array() -= by;
  box.max.array() += by;
  return box;
}

bool meet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

void fit_boxes(Features& f) {
  f.box = {};
  for (Features::Face& face : f.faces) {
    face.box = {};
    for (const Vec3& x : face.points)
      face.box.extend(x);
    f.box.extend(face.box.min);
    f.box.extend(face.box.max);
  }
  for (Features::Edge& edge : f.edges) {
    edge.box = {};
    edge.box.extend(edge.from);
    edge.box.extend(edge.to);
  }
}

std::vector<int> inside(const std::vector<Vec3>& corners, const Box& box) {
  std::vector<int> found;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (box.contains(corners[i]))
      found.push_back(static_cast<int>(i));
  return found;
}

template <class Boxed>
std::vector<int> inside(const std::vector<Boxed>& parts, const Box& box) {
  std::vector<int> found;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (meet(parts[i].box, box))
      found.push_back(static_cast<int>(i));
  return found;
}

// Distance of a corner over a face; `far` if the corner is beside the face.
constexpr double endless = std::numeric_limits<double>::infinity();
double level(const Vec3& x, const Features::Face& face, double reach) {
  const double gap = face.normal.dot(x - face.points[0]);
  if (std::abs(gap) > reach)
    return endless;
  double least = endless, size = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 side = face.points[(i + 1) % 3] - face.points[i];
    least = std::min(least, face.normal.dot(side.cross(x - face.points[i])));
    size = std::max(size, side.squaredNorm());
  }
  return least >= -seam * size ? gap : endless;
}

// A corner inside came through a face that it points against.
bool may_enter(const Vec3& outward, const Features::Face& face, double gap) {
  return gap >= 0 || outward.dot(face.normal) < 0;
}

// Whether a direction leads away from both faces of an edge.
bool outward(const Features::Edge& edge, const Vec3& direction, double sign) {
  return sign * edge.normals[0].dot(direction) > -sideways &&
         sign * edge.normals[1].dot(direction) > -sideways;
}

// For each corner that is inside, keeps the contact point of least depth.
class Shallowest {
public:
  void add(int corner, const Touch& touch, std::vector<Touch>& outside) {
    if (touch.gap >= 0) {
      outside.push_back(touch);
      return;
    }
    const auto known =
        std::find_if(inside_.begin(), inside_.end(), [&](const auto& one) { return one.first == corner; });
    if (known == inside_.end())
      inside_.emplace_back(corner, touch);
    else if (touch.gap > known->second.gap)
      known->second = touch;
  }
  void give(std::vector<Touch>& found) const {
    for (const auto& [corner, touch] : inside_)
      found.push_back(touch);
  }

private:
  std::vector<std::pair<int, Touch>> inside_;
};

std::uint64_t named(std::uint64_t kind, int first, int second) {
  return kind << 62 | static_cast<std::uint64_t>(first) << 31 | static_cast<std::uint64_t>(second);
}

} // namespace

Features features_of(const Surface& surface) {
  Features f;
  std::map<std::pair<int, int>, std::vector<int>> sides; // faces at each edge
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const TrianglePoints t = surface.corners(i);
    f.faces.push_back({t, (t[1] - t[0]).cross(t[2] - t[0]).normalized(), {}});
    const Triangle& ids = surface.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(ids[k], ids[(k + 1) % 3]);
      sides[{low, high}].push_back(static_cast<int>(i));
    }
  }
  std::vector<char> stands_out(surface.points.size(), 0);
  std::vector<Vec3> outward(surface.points.size(), Vec3::Zero());
  for (const auto& [ends, faces] : sides) {
    const Vec3 &from = surface.points[ends.first], &to = surface.points[ends.second];
    const Features::Face &one = f.faces[faces.front()], &other = f.faces[faces.back()];
    if (faces.size() == 2) {
      // Convex where the far corner of the other face is behind this one.
      double behind = 0;
      for (const Vec3& x : other.points)
        behind = std::min(behind, one.normal.dot(x - from));
      if (one.normal.cross(other.normal).norm() < flat && one.normal.dot(other.normal) > 0)
        continue;
      if (!(behind < -1e-9 * (to - from).norm()))
        continue;
    }
    f.edges.push_back({from, to, {one.normal, other.normal}, {}});
    for (const int end : {ends.first, ends.second}) {
      stands_out[end] = 1;
      outward[end] += one.normal + other.normal;
    }
  }
  for (std::size_t i = 0; i < stands_out.size(); ++i)
    if (stands_out[i] != 0) {
      f.corners.push_back(surface.points[i]);
      f.outward.push_back(outward[i]);
    }
  fit_boxes(f);
  return f;
}

Features moved(const Features& features, const Pose& pose) {
  Features f = features;
  for (Vec3& x : f.corners)
    x = pose(x);
  for (Vec3& direction : f.outward)
    direction = pose.rotation * direction;
  for (Features::Edge& edge : f.edges) {
    edge.from = pose(edge.from);
    edge.to = pose(edge.to);
    for (Vec3& n : edge.normals)
      n = pose.rotation * n;
  }
  for (Features::Face& face : f.faces) {
    for (Vec3& x : face.points)
      x = pose(x);
    face.normal = pose.rotation * face.normal;
  }
  fit_boxes(f);
  return f;
}

NearFeatures::NearFeatures(const Features& first, const Features& second, double reach) {
  const Box near_first = grown(first.box, reach), near_second = grown(second.box, reach);
  if (!meet(near_first, second.box))
    return;
  const std::vector<int> corners = inside(first.corners, near_second),
                         faces = inside(first.faces, near_second), edges = inside(first.edges, near_second),
                         other_corners = inside(second.corners, near_first),
                         other_faces = inside(second.faces, near_first),
                         other_edges = inside(second.edges, near_first);
  for (const int j : other_faces) {
    const Box box = grown(second.faces[j].box, reach);
    for (const int i : corners)
      if (box.contains(first.corners[i]))
        corner_face_.emplace_back(i, j);
  }
  for (const int i : faces) {
    const Box box = grown(first.faces[i].box, reach);
    for (const int j : other_corners)
      if (box.contains(second.corners[j]))
        face_corner_.emplace_back(i, j);
  }
  for (const int i : edges) {
    const Box box = grown(first.edges[i].box, reach);
    for (const int j : other_edges)
      if (meet(box, second.edges[j].box))
        edge_edge_.emplace_back(i, j);
  }
}

void NearFeatures::touches(const Features& first, const Features& second, double reach,
                           std::vector<Touch>& found) const {
  // A corner inside may be behind many faces: it came through the nearest of them.
  Shallowest entered, entering;
  for (const auto& [i, j] : corner_face_) {
    const double gap = level(first.corners[i], second.faces[j], reach);
    if (gap < reach && may_enter(first.outward[i], second.faces[j], gap))
      entered.add(i, {first.corners[i], second.faces[j].normal, gap, named(0, i, j)}, found);
  }
  for (const auto& [i, j] : face_corner_) {
    const double gap = level(second.corners[j], first.faces[i], reach);
    if (gap < reach && may_enter(second.outward[j], first.faces[i], gap))
      entering.add(
          j, {second.corners[j] - gap * first.faces[i].normal, -first.faces[i].normal, gap, named(1, i, j)},
          found);
  }
  entered.give(found);
  entering.give(found);
  for (const auto& [i, j] : edge_edge_) {
    const Features::Edge &one = first.edges[i], &other = second.edges[j];
    const PlacesOnSegments at = nearest_on_segments(one.from, one.to, other.from, other.to);
    const Vec3 here = one.from + at.s * (one.to - one.from),
               apart = here - other.from - at.t * (other.to - other.from);
    const double gap = apart.norm();
    if (!(gap < reach && gap > 0))
      continue;
    const Vec3 normal = apart / gap;
    if (outward(other, normal, 1) && outward(one, normal, -1))
      found.push_back({here, normal, gap, named(2, i, j)});
    else if (at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1 && outward(other, normal, -1) &&
             outward(one, normal, 1))
      found.push_back({here, -normal, -gap, named(2, i, j)});
  }
}

} // namespace geom
