#include "libgeom/placement/walls.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr double least_slope = 1e-3; // slope below which ground has no foot
constexpr int samples = 8;           // of the ground's height below a cell of a wall, along it
constexpr int most_cells = 400;      // along a wall
constexpr double least_heights = 2;  // of a wall, in units

struct WallSite {
  const Ground& ground;
  double base;      // m, where there is no ground: its lowest place
  double clearance; // m, of the walls above it
  double height;    // m, of the walls
  double cell;      // m
};

double ground_at(const WallSite& site, double x, double y) {
  return site.ground.height(x, y).value_or(site.base);
}

// The highest ground across a wall of this plan, at `along` on the axis.
double highest_across(const WallSite& site, const PlanBox& plan, int axis, double along) {
  double highest = site.base;
  for (const double part : {0., 0.25, 0.5, 0.75, 1.}) {
    Eigen::Vector2d p = plan.min + part * plan.size();
    p[axis] = along;
    highest = std::max(highest, ground_at(site, p.x(), p.y()));
  }
  return highest;
}

// The lower edge of a wall: above the ground at its cells' ends, and raised where the ground is higher between them.
std::vector<double> lower_edge(const WallSite& site, const PlanBox& plan, int axis, int cells) {
  const double step = plan.size()[axis] / cells;
  const auto ground = [&](double cell) {
    return highest_across(site, plan, axis, plan.min[axis] + cell * step);
  };
  std::vector<double> edge;
  for (int i = 0; i <= cells; ++i)
    edge.push_back(ground(i));
  std::vector<double> raised = edge;
  for (int i = 0; i < cells; ++i)
    for (int k = 1; k < samples; ++k) {
      const double part = static_cast<double>(k) / samples, line = (1 - part) * edge[i] + part * edge[i + 1];
      const double excess = std::max(0., ground(i + part) - line);
      for (const int end : {i, i + 1})
        raised[end] = std::max(raised[end], edge[end] + excess);
    }
  for (double& z : raised)
    z += site.clearance;
  return raised;
}

void add_wall(const WallSite& site, const PlanBox& plan, int axis, TetMesh& walls) {
  const Eigen::Vector2d size = plan.size();
  const auto cells_of = [&](double length) {
    return std::clamp(static_cast<int>(std::ceil(length / site.cell)), 1, most_cells);
  };
  const int along = cells_of(size[axis]);
  std::array<int, 3> divisions{1, 1, cells_of(site.height)};
  divisions[axis] = along;
  TetMesh wall = box_mesh({size.x(), size.y(), site.height}, divisions);
  const std::vector<double> edge = lower_edge(site, plan, axis, along);
  const auto first = static_cast<int>(walls.nodes.size());
  for (Vec3& x : wall.nodes) {
    const auto station = static_cast<std::size_t>(std::lround(x[axis] / size[axis] * along));
    walls.nodes.emplace_back(plan.min.x() + x.x(), plan.min.y() + x.y(), edge[station] + x.z());
  }
  for (Tet& tet : wall.tets) {
    for (int& node : tet)
      node += first;
    walls.tets.push_back(tet);
    walls.region.push_back(0);
  }
}

double highest_over_ground(const Pile& pile, const WallSite& site) {
  double highest = 0;
  for (const TetMesh& unit : meshes(pile)) {
    const Box box = bounding_box(unit);
    const Vec3 middle = box.centre();
    highest = std::max(highest, box.max.z() - ground_at(site, middle.x(), middle.y()));
  }
  return highest;
}

} // namespace

TetMesh walls_around(const Pile& pile, const Ground& ground, const WallOptions& options) {
  if (pile.poses.empty())
    throw InputError("pile", "no units", "at least one unit");
  const double thickness = options.thickness.value_or(pile.height), clearance = wall_clearance * pile.height;
  require_positive("thickness", thickness);
  const Box box = bounding_box(pile);
  const PlanBox inside{box.min.head<2>(), box.max.head<2>()};
  double base = box.max.z();
  for (const Vec3& x : ground.surface().points)
    if (const auto z = ground.height(x.x(), x.y()))
      base = std::min(base, *z);
  WallSite site{ground, base, clearance, 0, pile.height};
  site.height =
      options.height.value_or(std::max(least_heights * pile.height, highest_over_ground(pile, site)));
  require_positive("height", site.height);

  const Vec3 normal = ground.normal(inside);
  const int rise = std::abs(normal.x()) >= std::abs(normal.y()) ? 0 : 1, across = 1 - rise;
  const bool sloped = std::abs(normal[rise]) > least_slope;
  // Walls across the rise stand between those along it, which are longer by the thickness at both ends.
  TetMesh walls;
  for (const bool low : {true, false}) {
    PlanBox plan = inside;
    plan.min[rise] -= thickness;
    plan.max[rise] += thickness;
    (low ? plan.max : plan.min)[across] = (low ? inside.min : inside.max)[across];
    (low ? plan.min : plan.max)[across] =
        (low ? inside.min : inside.max)[across] + (low ? -1 : 1) * thickness;
    add_wall(site, plan, rise, walls);
  }
  for (const bool low : {true, false}) {
    if (sloped && low != (normal[rise] < 0)) // the upper end: the ground falls along its normal
      continue;
    PlanBox plan = inside;
    plan.min[across] += clearance;
    plan.max[across] -= clearance;
    (low ? plan.max : plan.min)[rise] = (low ? inside.min : inside.max)[rise];
    (low ? plan.min : plan.max)[rise] = (low ? inside.min : inside.max)[rise] + (low ? -1 : 1) * thickness;
    add_wall(site, plan, across, walls);
  }
  return walls;
}

} // namespace geom
