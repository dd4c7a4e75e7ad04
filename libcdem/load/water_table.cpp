#include "libcdem/load/water_table.hpp"

#include "libgeom/assembly/discs.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace cdem {
namespace {

constexpr double upright = 1e-6;   // z of the normal of a triangle that has no height over the plan
constexpr double on_border = 1e-6; // of a triangle's weights: it holds what lies beside it by rounding
constexpr int most_cells = 1000;   // along an axis

class WaterPlane final : public WaterTable {
public:
  explicit WaterPlane(const geom::Plane& plane) : plane_(plane) {}
  std::optional<double> height(const geom::Vec3& x) const override {
    return x.z() - plane_.level(x) / plane_.normal.z();
  }
  bool is_plane() const override { return true; }

private:
  geom::Plane plane_;
};

class WaterProfile final : public WaterTable {
public:
  WaterProfile(std::vector<std::array<double, 2>> rows, const geom::Vec3& origin, const geom::Vec3& along)
      : rows_(std::move(rows)), origin_(origin), along_(along) {}

  std::optional<double> height(const geom::Vec3& x) const override {
    const double s = std::clamp((x - origin_).dot(along_), rows_.front()[0], rows_.back()[0]);
    const auto next =
        std::upper_bound(rows_.begin() + 1, rows_.end() - 1, s,
                         [](double at, const std::array<double, 2>& row) { return at < row[0]; });
    const auto& [s0, z0] = *(next - 1);
    const auto& [s1, z1] = *next;
    return z0 + (s - s0) / (s1 - s0) * (z1 - z0);
  }

  std::string apart_from(const geom::Box& box) const override {
    double low = std::numeric_limits<double>::infinity(), high = -low; // m, distances of the box
    for (const double x : {box.min.x(), box.max.x()})
      for (const double y : {box.min.y(), box.max.y()}) {
        const double s = (geom::Vec3(x, y, 0) - origin_).dot(along_);
        low = std::min(low, s);
        high = std::max(high, s);
      }
    if (low < rows_.back()[0] && high > rows_.front()[0])
      return "";
    return fmt::format("its profile has distances from {:g} to {:g} m, and the model lies at {:g} to {:g} m "
                       "along it, so that "
                       "the table is level there, at z = {:g} m; look at origin and direction",
                       rows_.front()[0], rows_.back()[0], low, high,
                       low < rows_.back()[0] ? rows_.front()[1] : rows_.back()[1]);
  }

private:
  std::vector<std::array<double, 2>> rows_; // m: distance, z
  geom::Vec3 origin_, along_;               // along_: horizontal unit vector
};

class WaterSurface final : public WaterTable {
public:
  explicit WaterSurface(geom::Surface surface)
      : surface_(std::move(surface)), box_(geom::bounding_box(surface_)) {
    const auto side = static_cast<int>(std::sqrt(static_cast<double>(surface_.triangles.size())));
    cells_ = std::clamp(side, 1, most_cells);
    holds_.resize(static_cast<std::size_t>(cells_) * cells_);
    for (int t = 0; t < static_cast<int>(surface_.triangles.size()); ++t) {
      const auto x = surface_.corners(t);
      const geom::Vec3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2]), high = x[0].cwiseMax(x[1]).cwiseMax(x[2]);
      for (int i = cell(low, 0); i <= cell(high, 0); ++i)
        for (int j = cell(low, 1); j <= cell(high, 1); ++j)
          holds_[static_cast<std::size_t>(i) * cells_ + j].push_back(t);
    }
  }

  std::optional<double> height(const geom::Vec3& place) const override {
    double inside = -on_border, z = 0;
    bool found = false;
    for (const int t : holds_[static_cast<std::size_t>(cell(place, 0)) * cells_ + cell(place, 1)]) {
      const auto x = surface_.corners(t);
      const geom::Vec3 a = x[1] - x[0], b = x[2] - x[0], p = place - x[0];
      const double area = a.x() * b.y() - a.y() * b.x(), v = (p.x() * b.y() - p.y() * b.x()) / area,
                   w = (a.x() * p.y() - a.y() * p.x()) / area, least = std::min({1 - v - w, v, w});
      const double here = x[0].z() + v * a.z() + w * b.z();
      if (found && least > on_border && inside > on_border && here != z)
        throw geom::InputError(
            fmt::format("water_table: its surface lies twice over ({:g}, {:g}) m, at z = {:g} "
                        "and {:g} m; it must lie over each place once",
                        place.x(), place.y(), z, here));
      if (least >= inside) {
        inside = least;
        z = here;
        found = true;
      }
    }
    return found ? std::optional(z) : std::nullopt;
  }

private:
  int cell(const geom::Vec3& x, int axis) const {
    const double size = box_.max[axis] - box_.min[axis];
    return static_cast<int>(std::clamp((x[axis] - box_.min[axis]) / size * cells_, 0.0, cells_ - 1.0));
  }

  geom::Surface surface_;
  geom::Box box_;
  int cells_ = 1;                       // along each axis
  std::vector<std::vector<int>> holds_; // triangles that reach into a cell
};

} // namespace

double required_height(const WaterTable& table, const geom::Vec3& place) {
  if (const std::optional<double> z = table.height(place))
    return *z;
  throw geom::InputError(
      fmt::format("water_table: its surface ends before ({:g}, {:g}) m, where there is rock to be "
                  "wetted; make it larger than the model in plan, or give a smaller place (on)",
                  place.x(), place.y()));
}

std::shared_ptr<const WaterTable> water_plane(const geom::Vec3& point, double dip, double dip_direction) {
  if (!point.allFinite())
    throw geom::InputError("point", geom::shown(point), "three finite numbers (m)");
  const geom::Vec3 normal = geom::normal_of_dip(dip, dip_direction);
  if (!(normal.z() > upright))
    throw geom::InputError("dip", fmt::format("{:g} rad", dip), "from 0 to less than 90 degrees");
  return std::make_shared<WaterPlane>(geom::Plane::through(point, normal));
}

std::shared_ptr<const WaterTable> water_profile(std::vector<std::array<double, 2>> rows,
                                                const geom::Vec3& origin, const geom::Vec3& direction) {
  if (rows.size() < 2)
    throw geom::InputError("profile", fmt::format("{} rows", rows.size()),
                           "at least two rows {distance (m), z (m)}", "a level table is level = z");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string row = fmt::format("profile[{}]", i + 1);
    if (!std::isfinite(rows[i][0]) || (i > 0 && !(rows[i][0] > rows[i - 1][0])))
      throw geom::InputError(
          row, fmt::format("{:g}", rows[i][0]),
          i > 0 ? fmt::format("beyond the distance of the row before, {:g} m", rows[i - 1][0])
                : "a finite distance, m",
          "distances rise");
    if (!std::isfinite(rows[i][1]))
      throw geom::InputError(row, fmt::format("{:g}", rows[i][1]), "a finite height z, m");
  }
  if (!origin.allFinite())
    throw geom::InputError("origin", geom::shown(origin), "three finite numbers (m)");
  const double length = std::hypot(direction.x(), direction.y());
  if (!(length > 0 && std::isfinite(length)) || direction.z() != 0)
    throw geom::InputError("direction", geom::shown(direction), "a horizontal direction, such as {1, 0, 0}");
  return std::make_shared<WaterProfile>(std::move(rows), origin, direction / length);
}

std::shared_ptr<const WaterTable> water_surface(geom::Surface surface) {
  if (surface.triangles.empty())
    throw geom::InputError("surface: it has no triangles");
  if (geom::open_edges(surface).empty())
    throw geom::InputError("surface", "a closed surface", "an open one that lies over each place once");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto x = surface.corners(t);
    const geom::Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
    if (!(std::abs(normal.z()) > upright * normal.norm()))
      throw geom::InputError(
          fmt::format("surface: triangle {} at ({:g}, {:g}, {:g}) m", t + 1, x[0].x(), x[0].y(), x[0].z()),
          "upright", "one that lies over the plan", "a water table has one height at each place");
  }
  return std::make_shared<WaterSurface>(std::move(surface));
}

} // namespace cdem
