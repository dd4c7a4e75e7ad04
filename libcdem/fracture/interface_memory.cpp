#include "libcdem/fracture/interface_memory.hpp"

#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace cdem {
namespace {

constexpr double uneven = 0.01; // of the mean closure

SpringMemory memory_of(const Model& model, const State& state, int p) {
  const geom::Vec3& n = model.points[p].normal;
  const geom::Vec3& offset = state.bond_offset[p];
  const geom::Vec3 stretch = local_jump(model, state.displacement, p) - offset,
                   moved = movement_past(model, state, p);
  SpringMemory m;
  m.preload = offset.dot(n);
  m.shear = stretch - stretch.dot(n) * n;
  m.slid = moved - moved.dot(n) * n;
  m.mode = state.bond_mode[p];
  if (!state.joint_history.empty())
    m.history = state.joint_history[p];
  if (!state.bond_damage.empty()) {
    m.damage = state.bond_damage[p];
    m.bond_slip = state.bond_slip[p];
  }
  if (!state.water_pressure.empty())
    m.water = state.water_pressure[p];
  m.usual = state.usual_force[p] / model.points[p].area;
  m.rested = state.rested[p];
  return m;
}

// weights: >= 0, of the three. Rounding leaves no mean beyond the numbers it is of: bounds that all of them keep hold on.
SpringMemory mean_of(const std::array<const SpringMemory*, 3>& of, const geom::Vec3& weights) {
  SpringMemory m;
  for (int k = 0; k < 3; ++k) {
    m.shear += weights[k] * of[k]->shear;
    m.slid += weights[k] * of[k]->slid;
    m.history.slip += weights[k] * of[k]->history.slip;
    m.bond_slip += weights[k] * of[k]->bond_slip;
  }
  const auto average = [&](const auto& number) {
    const geom::Vec3 all(number(*of[0]), number(*of[1]), number(*of[2]));
    number(m) = std::clamp(weights.dot(all), all.minCoeff(), all.maxCoeff());
  };
  average([](auto& s) -> auto& { return s.preload; });
  average([](auto& s) -> auto& { return s.history.path; });
  average([](auto& s) -> auto& { return s.history.dilation; });
  average([](auto& s) -> auto& { return s.history.parted; });
  average([](auto& s) -> auto& { return s.damage; });
  average([](auto& s) -> auto& { return s.water; });
  average([](auto& s) -> auto& { return s.usual; });
  average([](auto& s) -> auto& { return s.rested; });
  Eigen::Index heaviest = 0;
  weights.maxCoeff(&heaviest);
  m.mode = of[static_cast<std::size_t>(heaviest)]->mode;
  return m;
}

double covered(const Model& model, int block, int face, double area) {
  return area / geom::face_area(model.blocks[block].shape, face);
}

} // namespace

geom::Vec3 place_on_side(const Model& model, int point, bool side_b) {
  const BondPoint& p = model.points[point];
  const auto& nodes = side_b ? p.node_b : p.node_a;
  const auto& weights = side_b ? p.weight_b : p.weight_a;
  geom::Vec3 place = geom::Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    place += weights[k] * model.node_position[nodes[k]];
  return place;
}

InterfaceMemory::InterfaceMemory(const Model& model, const State& state, const Interface& interface)
    : rotation_(interface_rotation(model, state.displacement.data(), interface)) {
  double area = 0;
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    area += model.points[p].area;
  on_b_ = covered(model, interface.block_b, interface.face_b, area) >
          covered(model, interface.block_a, interface.face_a, area);
  for (int p = interface.point_begin; p < interface.point_end; ++p) {
    places_.push_back(place_on_side(model, p, on_b_));
    springs_.push_back(memory_of(model, state, p));
    mean_pressure_ +=
        model.points[p].area / area * std::max(0.0, -traction(model, state, p).dot(model.points[p].normal));
  }
  const auto [least, most] =
      std::minmax_element(springs_.begin(), springs_.end(),
                          [](const SpringMemory& a, const SpringMemory& b) { return a.preload < b.preload; });
  evenly_preloaded_ = interface.kn * (most->preload - least->preload) <= uneven * mean_pressure_;
  for (int t = interface.triangle_begin; t < interface.triangle_end; ++t) {
    geom::Triangle triangle = model.bond_triangles[t];
    for (int& corner : triangle)
      corner -= interface.point_begin;
    triangles_.push_back(triangle);
  }
}

SpringMemory InterfaceMemory::at(const Model& model, int point) const {
  const geom::Vec3 place = place_on_side(model, point, on_b_);
  geom::Triangle nearest{0, 0, 0};
  geom::Vec3 weights{1, 0, 0};
  double least2 = std::numeric_limits<double>::infinity();
  for (const geom::Triangle& t : triangles_) {
    const geom::Vec3 w =
        geom::nearest_on_triangle(place, places_[t[0]], places_[t[1]], places_[t[2]]).weights;
    const double distance2 =
        (w[0] * places_[t[0]] + w[1] * places_[t[1]] + w[2] * places_[t[2]] - place).squaredNorm();
    if (distance2 < least2) {
      least2 = distance2;
      nearest = t;
      weights = w;
    }
  }
  return mean_of({&springs_[nearest[0]], &springs_[nearest[1]], &springs_[nearest[2]]}, weights);
}

} // namespace cdem
