#include "libgeom/assembly/divided_faces.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/clip_polygon.hpp"
#include "libgeom/query/welder.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace geom {
namespace {

using Ends = std::pair<int, int>; // points, ascending

class FaceDivider {
public:
  FaceDivider(const std::vector<Polyhedron>& blocks, double tolerance)
      : blocks_(blocks), tolerance_(tolerance), welder_(tolerance) {}

  DividedFaces operator()() {
    for (const Polyhedron& block : blocks_) // the points of common parts that are corners are these
      for (const Vec3& x : block.vertices)
        welder_.number(x, made_.points);
    for (const SharedFace& pair : shared_faces(blocks_, tolerance_))
      add_common(pair);
    for (int b = 0; b < static_cast<int>(blocks_.size()); ++b)
      for (int f = 0; f < static_cast<int>(blocks_[b].faces.size()); ++f)
        add_uncovered(b, f);
    add_points_on_edges();
    require_closed();
    return std::move(made_);
  }

private:
  PlaneAxes axes_of(int block, int face) const {
    const Vec3 normal = face_normal(blocks_[block], face), e1 = normal.unitOrthogonal();
    return {face_centroid(blocks_[block], face), e1, normal.cross(e1)};
  }
  Polygon flat(const PlaneAxes& axes, int block, int face) const {
    Polygon polygon;
    for (const int v : blocks_[block].faces[face].loop)
      polygon.push_back(axes.flat(blocks_[block].vertices[v]));
    return polygon;
  }

  bool add(const PlaneAxes& axes, const Polygon& polygon, FacePart part) {
    if (polygon.size() < 3 || !wider_than(tolerance_, polygon))
      return false;
    for (const Point& p : polygon) {
      const int point = welder_.number(axes.origin + p.x() * axes.e1 + p.y() * axes.e2, made_.points);
      if (part.loop.empty() || (part.loop.back() != point))
        part.loop.push_back(point);
    }
    while (part.loop.size() > 1 && part.loop.front() == part.loop.back())
      part.loop.pop_back();
    if (part.loop.size() < 3)
      return false;
    made_.parts.push_back(std::move(part));
    return true;
  }

  void add_common(const SharedFace& pair) {
    const PlaneAxes axes = axes_of(pair.block_a, pair.face_a);
    Polygon common = flat(axes, pair.block_a, pair.face_a), scratch;
    const Polygon other = flat(axes, pair.block_b, pair.face_b); // clockwise
    for (std::size_t i = other.size(); i-- > 0 && common.size() >= 3;)
      clip(common, other[(i + 1) % other.size()], other[i], scratch);
    if (!add(axes, common, {{}, pair.block_a, pair.face_a, pair.block_b, pair.face_b}))
      return;
    const auto place = static_cast<int>(made_.parts.size()) - 1;
    covers_[{pair.block_a, pair.face_a}].push_back(place);
    covers_[{pair.block_b, pair.face_b}].push_back(place);
  }

  // The face less each part that covers it: what lies outside of each of its edges in turn.
  void add_uncovered(int block, int face) {
    const PlaneAxes axes = axes_of(block, face);
    std::vector<Polygon> left{flat(axes, block, face)};
    Polygon scratch;
    if (const auto covers = covers_.find({block, face}); covers != covers_.end())
      for (const int place : covers->second) {
        const FacePart& cover = made_.parts[place];
        Polygon hole;
        for (const int point : cover.loop)
          hole.push_back(axes.flat(made_.points[point]));
        if (cover.block_a != block)
          std::reverse(hole.begin(), hole.end());
        std::vector<Polygon> after;
        for (Polygon rest : left) {
          for (std::size_t i = 0; i < hole.size() && rest.size() >= 3; ++i) {
            const Point &p = hole[i], &q = hole[(i + 1) % hole.size()];
            Polygon outside = rest;
            clip(outside, q, p, scratch);
            if (outside.size() >= 3 && wider_than(tolerance_, outside))
              after.push_back(std::move(outside));
            clip(rest, p, q, scratch);
          }
        }
        left = std::move(after);
      }
    for (const Polygon& polygon : left)
      add(axes, polygon, {{}, block, face});
  }

  void add_points_on_edges() {
    std::map<Ends, std::vector<std::pair<double, int>>> on; // share of the way, point
    for (const FacePart& part : made_.parts)
      for (std::size_t i = 0; i < part.loop.size(); ++i)
        on[std::minmax(part.loop[i], part.loop[(i + 1) % part.loop.size()])];
    const auto points = static_cast<int>(made_.points.size());
    std::vector<Box> boxes;
    for (const Vec3& x : made_.points)
      boxes.push_back({x, x});
    for (const auto& edge : on) {
      Box box;
      box.extend(made_.points[edge.first.first]);
      box.extend(made_.points[edge.first.second]);
      box.min.array() -= tolerance_;
      box.max.array() += tolerance_;
      boxes.push_back(box);
    }
    std::vector<std::pair<const Ends, std::vector<std::pair<double, int>>>*> edge_of;
    edge_of.reserve(on.size());
    for (auto& edge : on)
      edge_of.push_back(&edge);
    std::vector<char> is_point(boxes.size(), 0);
    std::fill(is_point.begin(), is_point.begin() + points, 1);
    for (const auto& [point, other] : touching_pairs(boxes, is_point)) {
      if (other < points)
        continue;
      auto& [ends, inside] = *edge_of[other - points];
      if (point == ends.first || point == ends.second)
        continue;
      const Vec3 from = made_.points[ends.first], along = made_.points[ends.second] - from,
                 x = made_.points[point] - from;
      const double share = along.dot(x) / along.squaredNorm();
      if (share > 0 && share < 1 && (x - share * along).norm() <= tolerance_)
        inside.emplace_back(share, point);
    }
    for (auto& edge : on)
      std::sort(edge.second.begin(), edge.second.end());
    for (FacePart& part : made_.parts) {
      std::vector<int> loop;
      for (std::size_t i = 0; i < part.loop.size(); ++i) {
        const int a = part.loop[i], b = part.loop[(i + 1) % part.loop.size()];
        loop.push_back(a);
        const auto& inside = on.at(std::minmax(a, b));
        for (std::size_t k = 0; k < inside.size(); ++k)
          loop.push_back(inside[a < b ? k : inside.size() - 1 - k].second);
      }
      part.loop = std::move(loop);
    }
  }

  // Each edge of a block's parts is walked once in each direction.
  void require_closed() const {
    std::vector<std::set<std::pair<int, int>>> open(blocks_.size());
    const auto walk = [&](int block, int from, int to) {
      if (open[block].erase({to, from}) == 0)
        open[block].insert({from, to});
    };
    for (const FacePart& part : made_.parts)
      for (std::size_t i = 0; i < part.loop.size(); ++i) {
        const int from = part.loop[i], to = part.loop[(i + 1) % part.loop.size()];
        walk(part.block_a, from, to);
        if (part.block_b >= 0)
          walk(part.block_b, to, from);
      }
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      if (!open[b].empty())
        throw InputError("shape: the faces of the block at " + text(mass_properties(blocks_[b]).centroid) +
                         " m and of its neighbours do not fit at " +
                         text(made_.points[open[b].begin()->first]) + " m, so that they cannot share a mesh");
  }

  const std::vector<Polyhedron>& blocks_;
  double tolerance_;
  Welder welder_;
  DividedFaces made_;
  std::map<std::pair<int, int>, std::vector<int>> covers_; // of a block and face: parts
};

} // namespace

Vec3 centroid(const DividedFaces& all, const FacePart& part) {
  const Vec3& origin = all.points[part.loop[0]];
  Vec3 normal = Vec3::Zero(), moment = Vec3::Zero();
  const auto corner = [&](std::size_t i) { return Vec3(all.points[part.loop[i]] - origin); };
  for (std::size_t i = 1; i + 1 < part.loop.size(); ++i)
    normal += corner(i).cross(corner(i + 1));
  for (std::size_t i = 1; i + 1 < part.loop.size(); ++i)
    moment += corner(i).cross(corner(i + 1)).dot(normal) / 3 * (corner(i) + corner(i + 1));
  return origin + moment / normal.squaredNorm();
}

DividedFaces divided_faces(const std::vector<Polyhedron>& blocks, double tolerance) {
  return FaceDivider(blocks, tolerance)();
}

} // namespace geom
