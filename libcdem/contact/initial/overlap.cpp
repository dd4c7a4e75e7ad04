#include "libcdem/contact/initial/overlap.hpp"

#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/model/names.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace cdem {
namespace {

// Over the smaller block's size: the depth by which meshes may overlap, as in a pile at rest, and the distance below
// which they touch.
constexpr double overlap_ratio = 0.01, touching_ratio = 1e-3;

Corners corners(const Model& model, int triangle) {
  const geom::Triangle& n = model.surface.triangles[triangle].nodes;
  return {model.node_position[n[0]], model.node_position[n[1]], model.node_position[n[2]]};
}

// The shortest displacement that separates two triangles, m; 0 when they do not meet. Over the axes that can separate
// them: their normals and the common normals of their edges.
double depth_of(const Corners& x, const Corners& y) {
  double least = std::numeric_limits<double>::infinity();
  const auto along = [&](const geom::Vec3& axis) {
    const double length = axis.norm();
    if (length < 1e-12 * (x[1] - x[0]).norm() * (y[1] - y[0]).norm())
      return;
    double x_min = x[0].dot(axis), x_max = x_min, y_min = y[0].dot(axis), y_max = y_min;
    for (int i = 1; i < 3; ++i) {
      x_min = std::min(x_min, x[i].dot(axis));
      x_max = std::max(x_max, x[i].dot(axis));
      y_min = std::min(y_min, y[i].dot(axis));
      y_max = std::max(y_max, y[i].dot(axis));
    }
    least = std::min(least, std::max(0.0, std::min(x_max - y_min, y_max - x_min)) / length);
  };
  along((x[1] - x[0]).cross(x[2] - x[0]));
  along((y[1] - y[0]).cross(y[2] - y[0]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      along((x[(i + 1) % 3] - x[i]).cross(y[(j + 1) % 3] - y[j]));
  return least;
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

double distance_to_surface(const Model& model, int block, const geom::Vec3& place) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = model.surface.block_begin[block]; t < model.surface.block_begin[block + 1]; ++t)
    if (model.surface.triangles[t].face < 0) {
      const Corners x = corners(model, t);
      const geom::Vec3 w = geom::nearest_on_triangle(place, x[0], x[1], x[2]).weights;
      nearest = std::min(nearest, (place - w[0] * x[0] - w[1] * x[1] - w[2] * x[2]).norm());
    }
  return nearest;
}

// Where one block reaches into another by more than the depth, by some places that far below its outer triangles; none
// that is found says nothing. Sees what crossing triangles do not: faces that lie in one plane, and two copies of a body.
std::optional<geom::Vec3> place_inside(const Model& model, int inner, int around, const geom::Box& region,
                                       double depth) {
  constexpr int most = 24;
  std::vector<geom::Vec3> places;
  for (int t = model.surface.block_begin[inner]; t < model.surface.block_begin[inner + 1]; ++t) {
    if (model.surface.triangles[t].face >= 0)
      continue;
    const Corners x = corners(model, t);
    const geom::Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized(),
                     place = (x[0] + x[1] + x[2]) / 3 - depth * normal;
    if ((place.array() > region.min.array()).all() && (place.array() < region.max.array()).all())
      places.push_back(place);
  }
  const std::size_t step = std::max<std::size_t>(1, places.size() / most);
  for (std::size_t i = 0; i < places.size(); i += step)
    if (holds(model, around, places[i]) && distance_to_surface(model, around, places[i]) > 0.25 * depth &&
        holds(model, inner, places[i]))
      return places[i];
  return std::nullopt;
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
        box_of(corners(model, static_cast<int>(boxes.size())), touching_ratio * model.blocks[t.block].size));
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
    if (!meshed[a] || !meshed[b] || (model.blocks[a].convex() && model.blocks[b].convex()))
      continue; // two convex blocks: require_separate
    const double smaller = std::min(model.blocks[a].size, model.blocks[b].size);
    const double depth = overlap_ratio * smaller;
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
      if (depth_of(x, y) > depth)
        refuse_overlap(model, a, b, (x[0] + x[1] + x[2] + y[0] + y[1] + y[2]) / 6);
      if (lawless && distance(x, y) < touching_ratio * smaller)
        refuse_touching(model, a, b);
    }
    const bool deep = ((region.max - region.min).array() > depth).all();
    for (const auto& [inner, around] : {std::pair(a, b), std::pair(b, a)}) {
      if (const auto inside = deep ? place_inside(model, inner, around, region, depth) : std::nullopt)
        refuse_overlap(model, a, b, *inside);
      const geom::Vec3& x = model.node_position[s.triangles[s.block_begin[inner]].nodes[0]];
      const geom::Box& box = block_boxes[around];
      const bool deep_in =
          (x.array() > box.min.array() + 3 * depth).all() && (x.array() < box.max.array() - 3 * depth).all();
      if (deep_in && block_boxes[inner].size().maxCoeff() < box.size().maxCoeff() &&
          holds(model, around, x) && distance_to_surface(model, around, x) > depth)
        refuse_overlap(model, a, b, x);
    }
  }
}

} // namespace cdem
