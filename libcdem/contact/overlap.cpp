#include "libcdem/contact/overlap.hpp"

#include "libcdem/contact/build_surface.hpp"
#include "libcdem/model/names.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/closest.hpp"

#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace cdem {
namespace {

// Of the smaller block's size: how far meshes may stand in each other (rounding of builders and files), and how near
// they must be to touch.
constexpr double tolerance_ratio = 1e-3;

using Corners = std::array<geom::Vec3, 3>;

Corners corners(const Model& model, int triangle) {
  const geom::Triangle& n = model.surface.triangles[triangle].nodes;
  return {model.node_position[n[0]], model.node_position[n[1]], model.node_position[n[2]]};
}

geom::Box box_of(const Corners& x, double around) {
  geom::Box box;
  for (const geom::Vec3& corner : x)
    box.extend(corner);
  box.min.array() -= around;
  box.max.array() += around;
  return box;
}

// Where a segment goes through a triangle, with both ends further than `depth` from its plane and its sides.
std::optional<geom::Vec3> pierced(const geom::Vec3& a, const geom::Vec3& b, const Corners& x, double depth) {
  const geom::Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const double length = normal.norm(), ha = (a - x[0]).dot(normal) / length,
               hb = (b - x[0]).dot(normal) / length;
  if (ha * hb >= 0 || std::min(std::abs(ha), std::abs(hb)) <= depth)
    return {};
  const geom::Vec3 at = a + ha / (ha - hb) * (b - a);
  for (int i = 0; i < 3; ++i) {
    const geom::Vec3 side = x[(i + 1) % 3] - x[i];
    if (side.cross(at - x[i]).dot(normal) <= depth * side.norm() * length)
      return {};
  }
  return at;
}

std::optional<geom::Vec3> pierced(const Corners& x, const Corners& y, double depth) {
  for (int i = 0; i < 3; ++i) {
    if (auto at = pierced(x[i], x[(i + 1) % 3], y, depth))
      return at;
    if (auto at = pierced(y[i], y[(i + 1) % 3], x, depth))
      return at;
  }
  return {};
}

double distance(const Corners& x, const Corners& y) {
  double nearest2 = std::numeric_limits<double>::infinity();
  const auto take = [&](const geom::Vec3& a, const geom::Vec3& b) {
    nearest2 = std::min(nearest2, (a - b).squaredNorm());
  };
  const auto on = [](const Corners& t, const geom::Vec3& p) {
    const geom::Vec3 w = geom::nearest_on_triangle(p, t[0], t[1], t[2]).weights;
    return geom::Vec3(w[0] * t[0] + w[1] * t[1] + w[2] * t[2]);
  };
  for (int i = 0; i < 3; ++i) {
    take(x[i], on(y, x[i]));
    take(y[i], on(x, y[i]));
    for (int j = 0; j < 3; ++j) {
      const geom::Vec3 &a0 = x[i], &a1 = x[(i + 1) % 3], &b0 = y[j], &b1 = y[(j + 1) % 3];
      const auto at = geom::nearest_on_segments(a0, a1, b0, b1);
      take(a0 + at.s * (a1 - a0), b0 + at.t * (b1 - b0));
    }
  }
  return std::sqrt(nearest2);
}

// Does the surface of a block go round the place? By the solid angle it is seen under (Van Oosterom and Strackee 1983).
bool holds(const Model& model, int block, const geom::Vec3& place) {
  double angle = 0;
  for (int t = model.surface.block_begin[block]; t < model.surface.block_begin[block + 1]; ++t) {
    if (model.surface.triangles[t].face >= 0)
      continue;
    const Corners x = corners(model, t);
    const geom::Vec3 a = x[0] - place, b = x[1] - place, c = x[2] - place;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle > 6; // 4 pi inside, 0 outside
}

std::string both(const Model& model, int a, int b) {
  return block_name(model, a) + " and " + block_name(model, b);
}

[[noreturn]] void refuse_overlap(const Model& model, int a, int b, const geom::Vec3& x) {
  throw geom::InputError(
      fmt::format("bodies: {} stand in each other near ({:.6g}, {:.6g}, {:.6g}) m; leave a gap between them",
                  both(model, a, b), x.x(), x.y(), x.z()));
}

[[noreturn]] void refuse_touching(const Model& model, int a, int b) {
  const std::string &one = model.bodies[model.blocks[a].body].name,
                    &other = model.bodies[model.blocks[b].body].name;
  throw geom::InputError(fmt::format("contacts: {} touch and no contact between them is given; add {{\"{}\", "
                                     "\"{}\", cdem.coulomb{{ friction_angle = ... }}}}, move them apart, or "
                                     "unite them to one solid before meshing",
                                     both(model, a, b), one, other));
}

} // namespace

void require_separate_meshes(const Model& model) {
  const ContactSurface& s = model.surface;
  if (s.empty())
    return;
  std::vector<geom::Box> boxes, block_boxes;
  std::vector<char> outer, meshed;
  for (const ContactTriangle& t : s.triangles) {
    boxes.push_back(
        box_of(corners(model, static_cast<int>(boxes.size())), tolerance_ratio * model.blocks[t.block].size));
    outer.push_back(static_cast<char>(t.face < 0));
  }
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    geom::Box box;
    for (int t = s.block_begin[b]; t < s.block_begin[b + 1]; ++t) {
      box.extend(boxes[t].min);
      box.extend(boxes[t].max);
    }
    block_boxes.push_back(box);
    meshed.push_back(static_cast<char>(model.blocks[b].meshed));
  }
  for (const auto& [a, b] : geom::touching_pairs(block_boxes, meshed)) {
    if (!meshed[a] || !meshed[b])
      continue;
    const double depth = tolerance_ratio * std::min(model.blocks[a].size, model.blocks[b].size);
    std::vector<geom::Box> near;
    std::vector<int> triangles;
    int first_of_b = 0;
    const geom::Box region{block_boxes[a].min.cwiseMax(block_boxes[b].min),
                           block_boxes[a].max.cwiseMin(block_boxes[b].max)};
    for (const int block : {a, b}) {
      first_of_b = static_cast<int>(triangles.size());
      for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
        if (outer[t] && (boxes[t].min.array() <= region.max.array()).all() &&
            (region.min.array() <= boxes[t].max.array()).all()) {
          triangles.push_back(t);
          near.push_back(boxes[t]);
        }
    }
    const bool lawless = !contact_joint(model, a, b);
    for (const auto& [i, j] : geom::touching_pairs(near)) {
      if (i >= first_of_b || j < first_of_b)
        continue;
      const Corners x = corners(model, triangles[i]), y = corners(model, triangles[j]);
      if (const auto at = pierced(x, y, depth))
        refuse_overlap(model, a, b, *at);
      if (lawless && distance(x, y) < depth)
        refuse_touching(model, a, b);
    }
    for (const auto& [inner, around] : {std::pair(a, b), std::pair(b, a)}) {
      const geom::Vec3& x = model.node_position[s.triangles[s.block_begin[inner]].nodes[0]];
      const geom::Box& box = block_boxes[around];
      const bool deep_in =
          (x.array() > box.min.array() + 3 * depth).all() && (x.array() < box.max.array() - 3 * depth).all();
      if (deep_in && block_boxes[inner].size().maxCoeff() < box.size().maxCoeff() && holds(model, around, x))
        refuse_overlap(model, a, b, x);
    }
  }
}

} // namespace cdem
