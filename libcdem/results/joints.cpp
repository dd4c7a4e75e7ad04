#include "libcdem/results/joints.hpp"

#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/model/joint_set.hpp"
#include "libcdem/results/bond_surface.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <map>

namespace cdem {
namespace {

double part_of(double load, double strength) {
  if (load <= 0)
    return 0;
  return strength > 0 ? load / strength : 1;
}

double utilisation_of(const Model& model, const State& state, int p, double normal, double shear) {
  const Interface& interface = model.interfaces[model.points[p].interface];
  const Joint& joint = model.joints[interface.joint];
  const double tan_friction = geom::portable::tan(joint.friction_angle);
  if (is_intact(state.bond_mode[p])) {
    if (!interface.may_break)
      return 0;
    return std::max(
        part_of(normal, interface.strength * joint.tensile_strength),
        part_of(shear, shear_strength(interface.strength * joint.cohesion, tan_friction, normal)));
  }
  if (!has_law(joint.law))
    return part_of(shear, friction_limit(std::max(0.0, -normal), tan_friction));
  return part_of(shear, joint_strength(joint.law, {interface.kn, interface.ks, tan_friction}, -normal,
                                       state.joint_history[p].path));
}

// visit(name, interface) for the interfaces chosen. Glued faces are no joints.
template <class Visit>
void each_chosen(const Model& model, const JointChoice& choice, const Visit& visit) {
  for (const std::string& set : choice.sets)
    require_joint_set(model, "set", set);
  for (const Interface& interface : model.interfaces) {
    const std::string name = joint_set_of(model, interface);
    if (model.joints[interface.joint].glued)
      continue;
    if (choice.sets.empty() || std::find(choice.sets.begin(), choice.sets.end(), name) != choice.sets.end())
      visit(name, interface);
  }
}

void add_point(JointSum& sum, const JointPoint& point) {
  sum.area += point.area;
  sum.open_area += point.apart ? point.area : 0;
  if (point.mode == BondMode::broken_tension || point.mode == BondMode::broken_shear)
    sum.broken_area += point.area;
  sum.normal += point.area * point.normal;
  sum.shear += point.area * point.shear;
  sum.water += point.area * point.water;
  sum.mean_utilisation += point.area * point.utilisation;
  sum.largest_utilisation = std::max(sum.largest_utilisation, point.utilisation);
  sum.mean_slip += point.area * point.slip;
  sum.largest_slip = std::max(sum.largest_slip, point.slip);
  sum.mean_opening += point.area * point.opening;
  sum.largest_opening = std::max(sum.largest_opening, point.opening);
}

[[noreturn]] void nothing_there(const Selection& on) {
  throw geom::InputError("on", on.text, "a place that holds interfaces between blocks",
                         "nothing of these joints lies there; glued faces are none");
}

} // namespace

JointPoint joint_point(const Model& model, const State& state, int p) {
  const BondPoint& point = model.points[p];
  const geom::Vec3 t = traction(model, state, p), gap = movement_past(model, state, p);
  JointPoint r;
  r.place = model.point_position[p];
  r.area = point.area;
  r.mode = static_cast<BondMode>(state.bond_mode[p]);
  r.normal = t.dot(point.normal);
  r.shear = (t - r.normal * point.normal).norm();
  r.water = state.water_pressure.empty() ? 0 : state.water_pressure[p];
  r.opening = gap.dot(point.normal);
  r.slip = (gap - r.opening * point.normal).norm();
  r.apart = r.mode != BondMode::intact && t.isZero(0);
  r.utilisation = utilisation_of(model, state, p, r.normal, r.shear);
  return r;
}

std::vector<JointSum> joint_sums(const Model& model, const State& state, const JointChoice& choice) {
  std::map<std::string, JointSum> sums;
  each_chosen(model, choice, [&](const std::string& name, const Interface& interface) {
    std::int64_t counted = 0;
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      if (selects_point(model, choice.on, p)) {
        JointSum& sum = sums[name];
        if (!released(state, interface))
          add_point(sum, joint_point(model, state, p));
        ++counted;
      }
    if (counted > 0)
      ++(released(state, interface) ? sums[name].parted : sums[name].interfaces);
  });
  if (sums.empty())
    nothing_there(choice.on);
  std::vector<JointSum> rows;
  for (auto& [name, sum] : sums) {
    sum.set = name;
    for (double* mean : {&sum.normal, &sum.shear, &sum.water, &sum.mean_slip, &sum.mean_opening})
      *mean = sum.area > 0 ? *mean / sum.area : 0;
    const double touching = sum.area - sum.open_area;
    sum.mean_utilisation = touching > 0 ? sum.mean_utilisation / touching : 0;
    rows.push_back(sum);
  }
  if (rows.front().set.empty()) // those of no set stand last
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
  return rows;
}

std::vector<std::pair<std::string, JointPoint>> joint_points(const Model& model, const State& state,
                                                             const JointChoice& choice) {
  std::vector<std::pair<std::string, JointPoint>> points;
  each_chosen(model, choice, [&](const std::string& name, const Interface& interface) {
    if (!released(state, interface))
      for (int p = interface.point_begin; p < interface.point_end; ++p)
        if (selects_point(model, choice.on, p))
          points.emplace_back(name, joint_point(model, state, p));
  });
  return points;
}

Snapshot joint_surface(const Model& model, const State& state, const JointChoice& choice,
                       const std::string& title) {
  const std::vector<std::string> sets = joint_sets(model);
  BondSurface surface({{"set", "", true},
                       {"mode", "", true},
                       {"normal_traction", "Pa"},
                       {"shear_traction", "Pa"},
                       {"water_pressure", "Pa"},
                       {"utilisation", "1"},
                       {"opening", "m"},
                       {"slip", "m"},
                       {"parted", "", true}});
  each_chosen(model, choice, [&](const std::string& name, const Interface& interface) {
    const auto found = std::find(sets.begin(), sets.end(), name);
    const double number = found == sets.end() ? 0 : static_cast<double>(found - sets.begin()) + 1;
    const double parted = released(state, interface) ? 1 : 0;
    for (int t = interface.triangle_begin; t < interface.triangle_end; ++t) {
      const geom::Triangle& triangle = model.bond_triangles[t];
      if (!std::all_of(triangle.begin(), triangle.end(),
                       [&](int p) { return selects_point(model, choice.on, p); }))
        continue;
      double mode = 0, sums[6]{};
      for (const int p : triangle) {
        const JointPoint point = joint_point(model, state, p);
        mode = std::max(mode, static_cast<double>(point.mode));
        const double values[] = {point.normal,      point.shear,   point.water,
                                 point.utilisation, point.opening, point.slip};
        for (int i = 0; i < 6; ++i)
          sums[i] += values[i] / 3;
      }
      surface.add(spring_corners(model, state, triangle),
                  {number, mode, sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], parted});
    }
  });
  if (surface.faces.triangles.empty())
    nothing_there(choice.on);
  Snapshot snapshot = snapshot_of(model, state, title);
  snapshot.bonds = std::move(surface.faces);
  for (SnapshotField& field : snapshot.bonds.triangle_fields) {
    if (field.name == "set") {
      field.names = {"no set"};
      field.names.insert(field.names.end(), sets.begin(), sets.end());
    } else if (field.name == "mode") {
      field.names = {"bonded", "broken in tension", "broken in shear", "contact"};
    }
  }
  return snapshot;
}

} // namespace cdem
