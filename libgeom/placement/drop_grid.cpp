#include "libgeom/placement/drop_grid.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/placement/lowering.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

// Columns of units over a region, along x and y.
struct Grid {
  std::array<int, 2> columns{};
  int layers = 0;
};

Grid choose_grid(int count, const Eigen::Vector2d& room, double radius, double pitch, int layers) {
  std::array<int, 2> most{};
  for (int k = 0; k < 2; ++k)
    most[k] = static_cast<int>(std::clamp(std::floor((room[k] - 2 * radius) / pitch + 1e-9) + 1, 0., 1e6));
  if (most[0] == 0 || most[1] == 0)
    throw InputError("region", text(room.x()) + " m by " + text(room.y()) + " m",
                     "at least " + text(2 * radius) + " m wide and long, the size of a unit turned any way");
  const double a_layer = static_cast<double>(most[0]) * most[1];
  const int allowed = layers > 0 ? layers : max_drop_layers;
  if (count > a_layer * allowed)
    throw InputError("count", std::to_string(count),
                     "at most " + text(a_layer * allowed) + ": " + std::to_string(most[0]) + " by " +
                         counted(most[1], "unit") + " in " + counted(allowed, "layer"),
                     "a wider region, smaller units or more layers take more");
  Grid grid;
  grid.layers = layers > 0 ? layers : static_cast<int>(std::ceil(count / a_layer));
  const int needed = (count + grid.layers - 1) / grid.layers;
  grid.columns[1] =
      std::clamp(static_cast<int>(std::ceil(std::sqrt(needed * room.y() / room.x()))), 1, most[1]);
  grid.columns[0] = (needed + grid.columns[1] - 1) / grid.columns[1];
  if (grid.columns[0] > most[0]) {
    grid.columns[0] = most[0];
    grid.columns[1] = (needed + most[0] - 1) / most[0];
  }
  return grid;
}

// Centres of the columns, rows across the rise one after the other, the lowest row first.
std::vector<Eigen::Vector2d> column_places(const Grid& grid, const Eigen::Vector2d& centre, double pitch,
                                           const Vec3& normal) {
  const int along = std::abs(normal.x()) >= std::abs(normal.y()) ? 0 : 1, across = 1 - along;
  const bool falls = normal[along] > 0; // along the axis
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < grid.columns[along]; ++i)
    for (int j = 0; j < grid.columns[across]; ++j) {
      Eigen::Vector2d place = centre;
      place[along] += (falls ? -1 : 1) * (i - 0.5 * (grid.columns[along] - 1)) * pitch;
      place[across] += (j - 0.5 * (grid.columns[across] - 1)) * pitch;
      places.push_back(place);
    }
  return places;
}

} // namespace

Pile drop_grid(const TetMesh& unit, int count, const Ground& ground, const DropOptions& options) {
  if (count < 1)
    throw InputError("count", std::to_string(count), "at least 1");
  require_block_count("count", std::to_string(count), count, "drop fewer units");
  if (options.layers < 0 || options.layers > max_drop_layers)
    throw InputError("layers", std::to_string(options.layers),
                     "from 1 to " + std::to_string(max_drop_layers));
  Pile pile = pile_of(unit);
  const double gap = options.gap.value_or(0.1 * pile.height);
  require_positive("gap", gap);
  const double radius = bounding_radius(pile.unit), pitch = 2 * radius + gap;
  const PlanBox region = region_of(ground, options.region);
  const Grid grid = choose_grid(count, region.size(), radius, pitch, options.layers);
  const auto places = column_places(grid, region.centre(), pitch, ground.normal(region));

  const Mat3 upright = frame_along(Vec3::UnitZ());
  const Profile below(ground.surface(), upright);
  const Surface shape = surface_of(pile.unit);
  std::vector<double> height(places.size()); // of the lowest unit of each column
  for (int i = 0; i < count; ++i) {
    const std::size_t column = i % places.size();
    const int layer = static_cast<int>(i / places.size());
    Pose pose;
    pose.rotation = random_rotation(options.seed, static_cast<std::uint64_t>(i));
    pose.translation = {places[column].x(), places[column].y(), 0};
    if (layer == 0) {
      if (!ground.height(places[column].x(), places[column].y())) {
        const PlanBox plan = ground.plan();
        throw InputError("region: unit " + std::to_string(i + 1) + " would be dropped at " +
                         text(pose.translation.x()) + ", " + text(pose.translation.y()) +
                         ", beside the ground, whose plan is from {" + text(plan.min.x()) + ", " +
                         text(plan.min.y()) + "} to {" + text(plan.max.x()) + ", " + text(plan.max.y()) +
                         "}; move or narrow the region");
      }
      Surface turned = shape;
      for (Vec3& x : turned.points)
        x = pose(x);
      constexpr double far = 1e30;
      height[column] = gap - clearance(Profile(turned, upright), Vec3::Zero(), below, far);
    }
    pose.translation.z() = height[column] + layer * pitch;
    pile.poses.push_back(pose);
  }
  return pile;
}

} // namespace geom
