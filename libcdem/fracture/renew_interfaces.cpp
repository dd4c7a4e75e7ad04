#include "libcdem/fracture/renew_interfaces.hpp"

#include "libcdem/bond/bond_work.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/bond/water_work.hpp"
#include "libcdem/model/build/interface_springs.hpp"
#include "libcdem/model/face_fan.hpp"
#include "libcdem/state/carry.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <utility>

namespace cdem {
namespace {

constexpr double least_area = 1e-3; // of what the interface covered when it was made
constexpr double same_place = 1e-7; // of a block's size: places nearer than this are one

std::vector<geom::Vec3> present_nodes(const Model& model, const State& state, const Block& block) {
  std::vector<geom::Vec3> places;
  for (int node = block.node_begin; node < block.node_end; ++node)
    places.push_back(place_of(model, state, node));
  return places;
}

geom::FaceOverlap present_overlap(const Model& model, const State& state, const Interface& interface,
                                  const geom::Mat3& rotation) {
  const Block &a = model.blocks[interface.block_a], &b = model.blocks[interface.block_b];
  geom::FaceOverlap faces =
      geom::overlap(present_nodes(model, state, a), fan_of(model, interface.block_a, interface.face_a),
                    present_nodes(model, state, b), fan_of(model, interface.block_b, interface.face_b),
                    rotation * interface.normal, same_place * std::min(a.size, b.size));
  const double size = model.frames[interface.frame].size;
  if (faces.area < least_area * size * size)
    faces = {};
  return faces;
}

// The fixed direction of one side is from now on what points along `along` now.
std::array<double, 2> in_edges(const Model& model, const State& state, const std::array<int, 3>& nodes,
                               const geom::Vec3& along) {
  const geom::Vec3 x0 = place_of(model, state, nodes[0]), e1 = place_of(model, state, nodes[1]) - x0,
                   e2 = place_of(model, state, nodes[2]) - x0, n = e1.cross(e2);
  const double n2 = n.squaredNorm();
  return {along.cross(e2).dot(n) / n2, e1.cross(along).dot(n) / n2};
}

// Both sides have turned about the normal by different angles: from now on they count from here.
void renew_frame(Model& model, const State& state, const Interface& interface, const geom::Mat3& rotation,
                 double area) {
  InterfaceFrame& frame = model.frames[interface.frame];
  const geom::Vec3 along = rotation * frame.along;
  frame.along_a = in_edges(model, state, frame.nodes_a, along);
  frame.along_b = in_edges(model, state, frame.nodes_b, along);
  frame.area = area;
  frame.renewed = true;
}

// Springs that have ridden up by different amounts stand apart by much more than they are closed, and what lies between
// them is not known to that precision: all offsets are raised or lowered by the one length with which the mean pressure
// stays what it was.
void keep_pressure(const Model& model, State& state, const Interface& interface, double mean_pressure) {
  if (mean_pressure == 0)
    return;
  const InterfaceLaw own = law_of_interface(model, interface);
  std::vector<double> open; // m, of each spring
  double area = 0;
  for (int p = interface.point_begin; p < interface.point_end; ++p) {
    open.push_back((local_jump(model, state.displacement, p) - state.bond_offset[p]).dot(interface.normal));
    area += model.points[p].area;
  }
  const auto pressure_of = [&](double closure) {
    if (own.law)
      return with_law(*own.law, [&](const auto& law) { return law.pressure(own.spring, closure); });
    return interface.kn * closure;
  };
  const auto mean_at = [&](double raised) {
    double mean = 0;
    for (std::size_t i = 0; i < open.size(); ++i)
      if (open[i] < raised)
        mean += model.points[interface.point_begin + static_cast<int>(i)].area / area *
                pressure_of(raised - open[i]);
    return mean;
  };
  double low = *std::min_element(open.begin(), open.end()), step = mean_pressure / interface.kn;
  while (mean_at(low + step) < mean_pressure && step < model.frames[interface.frame].size)
    step *= 2;
  double high = low + step;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (mean_at(middle) < mean_pressure ? low : high) = middle;
  }
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    state.bond_offset[p] += high * interface.normal;
}

void take_up(const Model& model, State& state, int p, const SpringMemory& m) {
  const geom::Vec3& n = model.points[p].normal;
  const geom::Vec3 jump = local_jump(model, state.displacement, p), past = jump - jump.dot(n) * n;
  state.bond_mode[p] = m.mode;
  state.bond_offset[p] = m.preload * n + past - m.shear;
  state.slid_before[p] = m.slid - past;
  if (!state.joint_history.empty())
    state.joint_history[p] = m.history;
  if (!state.bond_damage.empty()) {
    state.bond_damage[p] = m.damage;
    state.bond_slip[p] = m.bond_slip;
  }
  if (!state.water_pressure.empty())
    state.water_pressure[p] = m.water;
  state.usual_force[p] = model.points[p].area * m.usual;
  state.rested[p] = m.rested;
}

void leave_to_contact(const Model& model, State& state, const InterfaceToRenew& of) {
  const Interface& interface = model.interfaces[of.interface];
  state.released[interface.frame] = 1;
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    state.bond_mode[p] = of.before.at(model, p).mode;
}

// Springs and their triangles of the whole model, with those of some interfaces (by place in `renewed`, -1: as they were)
// taken from new overlaps.
std::vector<int> replace_springs(Model& model, const std::vector<int>& renewed,
                                 const std::vector<geom::FaceOverlap>& overlaps) {
  const std::vector<BondPoint> points = std::exchange(model.points, {});
  const std::vector<geom::Vec3> positions = std::exchange(model.point_position, {}),
                                apart = std::exchange(model.point_apart, {});
  const std::vector<geom::Triangle> triangles = std::exchange(model.bond_triangles, {});
  std::vector<int> old_point;
  for (int i = 0; i < static_cast<int>(model.interfaces.size()); ++i) {
    Interface& interface = model.interfaces[i];
    if (renewed[i] >= 0) {
      append_springs(model, i, interface, overlaps[renewed[i]]);
      old_point.resize(model.points.size(), -1);
      for (int p = interface.point_begin; p < interface.point_end; ++p) {
        const geom::Vec3 a = place_on_side(model, p, false), b = place_on_side(model, p, true);
        model.point_position[p] = 0.5 * (a + b);
        model.point_apart.emplace_back(b - a);
      }
      continue;
    }
    const int shift = static_cast<int>(model.points.size()) - interface.point_begin;
    for (int p = interface.point_begin; p < interface.point_end; ++p) {
      model.points.push_back(points[p]);
      model.point_position.push_back(positions[p]);
      model.point_apart.push_back(apart.empty() ? geom::Vec3(geom::Vec3::Zero()) : apart[p]);
      old_point.push_back(p);
    }
    const int first = static_cast<int>(model.bond_triangles.size());
    for (int t = interface.triangle_begin; t < interface.triangle_end; ++t) {
      geom::Triangle triangle = triangles[t];
      for (int& corner : triangle)
        corner += shift;
      model.bond_triangles.push_back(triangle);
    }
    interface.point_begin += shift;
    interface.point_end += shift;
    interface.triangle_begin = first;
    interface.triangle_end = static_cast<int>(model.bond_triangles.size());
  }
  index_springs(model);
  return old_point;
}

} // namespace

RenewedInterfaces renew_interfaces(Model& model, State& state, const std::vector<InterfaceToRenew>& list,
                                   int threads) {
  RenewedInterfaces result;
  std::vector<geom::FaceOverlap> overlaps(list.size());
  for_chunks(static_cast<std::int64_t>(list.size()), threads, [&](std::int64_t k) {
    const Interface& interface = model.interfaces[list[k].interface];
    if (!released(state, interface))
      overlaps[k] = present_overlap(model, state, interface, list[k].before.rotation());
  });
  std::vector<int> renewed(model.interfaces.size(), -1);
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (!overlaps[k].points.empty()) {
      renewed[list[k].interface] = static_cast<int>(k);
      continue;
    }
    leave_to_contact(model, state, list[k]);
    ++result.left;
  }
  result.old_point = replace_springs(model, renewed, overlaps);
  if (state.slid_before.empty())
    state.slid_before.assign(state.bond_offset.size(), geom::Vec3::Zero());
  TopologyMap map;
  map.bond = result.old_point;
  carry(model, model, map, state);
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (overlaps[k].points.empty())
      continue;
    const Interface& interface = model.interfaces[list[k].interface];
    renew_frame(model, state, interface, list[k].before.rotation(), overlaps[k].area);
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      take_up(model, state, p, list[k].before.at(model, p));
    if (!list[k].before.evenly_preloaded())
      keep_pressure(model, state, interface, list[k].before.mean_pressure());
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      settle(model, state, p);
  }
  return result;
}

RenewedInterfaces renew_interfaces(Model& model, State& state, const std::vector<int>& interfaces,
                                   int threads) {
  const auto stored = [&] {
    double energy = 0;
    for (const int i : interfaces)
      for (int p = model.interfaces[i].point_begin; p < model.interfaces[i].point_end; ++p)
        energy += spring_energy(model, state, p);
    return energy;
  };
  const auto by_water = [&] {
    double work = 0;
    for (const int i : interfaces)
      work += water_work(model, state, model.interfaces[i]);
    return work;
  };
  std::vector<InterfaceToRenew> list;
  list.reserve(interfaces.size());
  for (const int i : interfaces)
    list.push_back({i, InterfaceMemory(model, state, model.interfaces[i])});
  const double stored_before = stored(), water_before = by_water();
  RenewedInterfaces result = renew_interfaces(model, state, list, threads);
  result.lost = stored_before - stored();
  result.water = water_before - by_water();
  return result;
}

} // namespace cdem
