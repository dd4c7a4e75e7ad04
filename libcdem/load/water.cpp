#include "libcdem/load/water.hpp"

#include "libcdem/bond/water_work.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/load/water_table.hpp"
#include "libcdem/model/joint_set.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

std::string in_words(const geom::Vec3& x) {
  return geom::shown(x) + " m";
}

void check(const Model& model, const Water& water) {
  geom::require_above("weight", water.weight, 0, "N/m3", "water has 9810");
  for (const std::string& set : water.sets)
    require_joint_set(model, "joints", set);
  if (!water.level)
    return;
  const double top = model.box.max.z(), bottom = model.box.min.z();
  const char* const advice = "water above the ground would press on its surface too; for a confined layer "
                             "give pressure = a table or function";
  if (!std::isfinite(*water.level) || *water.level > top)
    throw geom::InputError("level", fmt::format("{:g}", *water.level),
                           fmt::format("a height z of at most the top of the model, {:g} m", top), advice);
  if (*water.level < bottom)
    throw geom::InputError("level", fmt::format("{:g}", *water.level),
                           fmt::format("a height z of at least the bottom of the model, {:g} m", bottom),
                           "pressure = 0 takes the water away");
}

double pressure_at(const Water& water, const geom::Vec3& place) {
  if (water.level)
    return std::max(0.0, water.weight * (*water.level - place.z()));
  if (water.table)
    return std::max(0.0, water.weight * (required_height(*water.table, place) - place.z()));
  const double pressure = water.pressure(place);
  if (!(std::isfinite(pressure) && pressure >= 0))
    throw geom::InputError("pressure at " + in_words(place), fmt::format("{:g}", pressure),
                           "a finite number >= 0 Pa", "water does not pull joints together");
  return pressure;
}

// f(place, weights of the corners) at the centres of equal parts of a triangle.
template <class F>
void each_part(const std::array<geom::Vec3, 3>& x, const F& f) {
  constexpr int n = 4; // n * n parts
  const auto visit = [&](double a, double b) {
    const std::array<double, 3> w{1 - a - b, a, b};
    f(geom::Vec3(w[0] * x[0] + w[1] * x[1] + w[2] * x[2]), w);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n - i; ++j) {
      visit((i + 1.0 / 3) / n, (j + 1.0 / 3) / n);
      if (j < n - i - 1)
        visit((i + 2.0 / 3) / n, (j + 2.0 / 3) / n);
    }
}

// Adds the integral of shape function times pressure, N, and of the shape function, m2, at the points of an interface.
void integrate(const Model& model, const Interface& interface, const Water& water, std::vector<double>& force,
               std::vector<double>& area) {
  for (int t = interface.triangle_begin; t < interface.triangle_end; ++t) {
    const geom::Triangle& triangle = model.bond_triangles[t];
    std::array<geom::Vec3, 3> x;
    for (int i = 0; i < 3; ++i)
      x[i] = model.point_position[triangle[i]];
    const double whole = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    each_part(x, [&](const geom::Vec3& place, const std::array<double, 3>& weights) {
      const double pressure = pressure_at(water, place);
      for (int i = 0; i < 3; ++i) {
        force[triangle[i]] += weights[i] * pressure * whole / 16;
        area[triangle[i]] += weights[i] * whole / 16;
      }
    });
  }
}

} // namespace

std::function<double(const geom::Vec3&)> pressure_over_height(std::vector<std::array<double, 2>> rows) {
  if (rows.size() < 2)
    throw geom::InputError("pressure", fmt::format("{} rows", rows.size()),
                           "at least two rows {z (m), pressure (Pa)}");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string row = fmt::format("pressure[{}]", i + 1);
    const auto [z, pressure] = rows[i];
    if (!std::isfinite(z) || (i > 0 && !(z > rows[i - 1][0])))
      throw geom::InputError(row, fmt::format("{:g}", z),
                             i > 0 ? fmt::format("above the z of the row before, {:g} m", rows[i - 1][0])
                                   : "a finite height z, m",
                             "rows go upwards");
    if (!(std::isfinite(pressure) && pressure >= 0))
      throw geom::InputError(row, fmt::format("{:g}", pressure), "a finite pressure >= 0 Pa");
  }
  return [rows = std::move(rows)](const geom::Vec3& place) {
    const double z = std::clamp(place.z(), rows.front()[0], rows.back()[0]);
    std::size_t i = 1;
    while (i + 1 < rows.size() && z > rows[i][0])
      ++i;
    const double part = (z - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0]);
    return rows[i - 1][1] + part * (rows[i][1] - rows[i - 1][1]);
  };
}

WaterInJoints set_water(const Model& model, State& state, const Water& water) {
  check(model, water);
  std::vector<double> pressure = state.water_pressure;
  pressure.resize(model.points.size(), 0);
  std::vector<char> holds;
  for (const Interface& interface : model.interfaces) {
    const bool named = water.sets.empty() || std::find(water.sets.begin(), water.sets.end(),
                                                       joint_set_of(model, interface)) != water.sets.end();
    holds.push_back(static_cast<char>(named && !model.joints[interface.joint].glued));
  }
  bool any = false, wet = false;
  std::vector<double> force(pressure.size(), 0), area = force;
  for (std::size_t i = 0; i < model.interfaces.size(); ++i) {
    const Interface& interface = model.interfaces[i];
    std::vector<int> points;
    for (int p = interface.point_begin; p < interface.point_end && holds[i] != 0; ++p)
      if (selects_point(model, water.on, p))
        points.push_back(p);
    if (points.empty())
      continue;
    any = true;
    integrate(model, interface, water, force, area);
    for (const int p : points) {
      pressure[p] = area[p] > 0 ? force[p] / area[p] : 0;
      wet = wet || pressure[p] > 0;
    }
  }
  if (!any)
    throw geom::InputError("on", water.on.text, "a place that holds interfaces between blocks",
                           "nothing of these joints lies there");
  if (water.table && !wet)
    throw geom::InputError("water_table", "below all joints of the place (" + water.on.text + ")",
                           "one that reaches above some of them", "pressure = 0 takes the water away");
  // Where velocities and summed energies stand.
  State moved = moved_back(state, state.velocity_lag);
  const double done = water_work(model, moved);
  state.water_pressure = std::move(pressure);
  if (std::all_of(state.water_pressure.begin(), state.water_pressure.end(), [](double p) { return p == 0; }))
    state.water_pressure.clear();
  // Past work stays, and the new pressure has done none yet.
  moved.water_pressure = state.water_pressure;
  state.spent.external += done - water_work(model, moved);
  WaterInJoints sum;
  for (std::size_t p = 0; p < state.water_pressure.size(); ++p)
    if (const double here = state.water_pressure[p]; here > 0) {
      ++sum.points;
      sum.area += model.points[p].area;
      sum.force += here * model.points[p].area;
      sum.largest = std::max(sum.largest, here);
    }
  return sum;
}

} // namespace cdem
