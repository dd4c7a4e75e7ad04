#include "libcdem/fracture/crack_faces.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libgeom/core/portable.hpp"

#include <limits>

namespace cdem {
namespace {

SpringStrength strength_of(const Model& model, const Interface& interface) {
  const Joint joint = joint_of(model, interface);
  return {joint.cohesion, geom::portable::tan(joint.friction_angle), joint.tensile_strength};
}

double over(double load, double strength) {
  if (load <= 0)
    return 0;
  return strength > 0 ? load / strength : std::numeric_limits<double>::infinity();
}

} // namespace

LoadRatio load_ratio(const SpringStrength& s, double normal_traction, double shear_traction) {
  const double tension = over(normal_traction, s.tensile_strength);
  const double shear = over(cohesive_load(shear_traction, s.tan_friction, normal_traction), s.cohesion);
  return shear > tension ? LoadRatio{shear, BondMode::broken_shear}
                         : LoadRatio{tension, BondMode::broken_tension};
}

std::vector<FaceLoad> face_loads(const Model& model, const State& state) {
  std::vector<FaceLoad> loads;
  for (int i = 0; i < static_cast<int>(model.interfaces.size()); ++i) {
    const Interface& interface = model.interfaces[i];
    if (!interface.may_break)
      continue;
    double area = 0;
    geom::Vec3 force = geom::Vec3::Zero();
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      if (is_intact(state.bond_mode[p])) {
        area += model.points[p].area;
        force += model.points[p].area * traction(model, state, p);
      }
    if (area <= 0)
      continue;
    FaceLoad load;
    load.interface = i;
    load.normal_traction = force.dot(interface.normal) / area;
    load.shear_traction = (force / area - load.normal_traction * interface.normal).norm();
    load.ratio = load_ratio(strength_of(model, interface), load.normal_traction, load.shear_traction);
    loads.push_back(load);
  }
  return loads;
}

std::vector<FaceLoad> worst_faces(const std::vector<FaceLoad>& loads, double break_ratio) {
  double worst = 0;
  for (const FaceLoad& load : loads)
    worst = std::max(worst, load.ratio.value);
  std::vector<FaceLoad> found;
  for (const FaceLoad& load : loads)
    if (load.ratio.value >= 1 && load.ratio.value >= break_ratio * worst)
      found.push_back(load);
  return found;
}

CrackFace break_face(const Model& model, State& state, RunLog& log, int stage, const FaceLoad& load) {
  const Interface& interface = model.interfaces[load.interface];
  const double before = spring_energy(model, state);
  CrackFace face;
  face.interface = interface.id;
  face.mode = load.ratio.mode;
  face.normal = interface.normal;
  face.ratio = load.ratio.value;
  for (int p = interface.point_begin; p < interface.point_end; ++p) {
    if (!is_intact(state.bond_mode[p]))
      continue;
    const BondPoint& point = model.points[p];
    const geom::Vec3 t = traction(model, state, p);
    state.bond_mode[p] = static_cast<std::uint8_t>(load.ratio.mode);
    // The offset moves with the stress drop at once, so that the next step does not count it as sliding.
    settle(model, state, p);

    BreakRow row;
    row.stage = stage;
    row.time = state.time;
    row.mode = load.ratio.mode;
    row.place = model.point_position[p];
    row.normal = point.normal;
    row.area = point.area;
    row.normal_traction = t.dot(point.normal);
    row.shear_traction = (t - row.normal_traction * point.normal).norm();
    row.block_a = model.blocks[interface.block_a].id;
    row.block_b = model.blocks[interface.block_b].id;
    log.breaks.push_back(row);
    ++(load.ratio.mode == BondMode::broken_tension ? log.broken_tension : log.broken_shear);
    face.area += point.area;
    face.centroid += point.area * model.point_position[p];
  }
  face.centroid /= face.area;
  state.spent.breaking += before - spring_energy(model, state);
  return face;
}

} // namespace cdem
