#include "libcdem/integrate/move_columns.hpp"

#include "libcdem/integrate/central_difference.hpp"
#include "libcdem/load/free_field.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <limits>

namespace cdem {
namespace {

double amplitude_at(const Amplitude& amplitude, double time) {
  return amplitude ? amplitude(time) : 1;
}

void require_columns(const ResolvedConditions& r, const State& state) {
  if (state.column_displacement.size() != column_levels(r))
    throw geom::InputError(
        "free_field: the state that was saved has columns of other heights; the sides of the "
        "model have changed since free_field was called");
}

// Stress of each layer, with Rayleigh's beta times its rate.
std::vector<geom::Vec3> layer_strains(const Column& column, const Node* u, const Node* v) {
  std::vector<geom::Vec3> strain;
  for (std::size_t i = 0; i < column.layers.size(); ++i)
    strain.emplace_back(
        (vec(u[i + 1]) - vec(u[i]) + column.layers[i].stiffness_damping * (vec(v[i + 1]) - vec(v[i]))) /
        column.layers[i].height);
  return strain;
}

// Z v_ff + sigma_ff n; velocity: m/s, of the levels.
void put_side_forces(const Column& column, const std::vector<geom::Vec3>& strain,
                     const std::vector<geom::Vec3>& velocity, ResolvedConditions& r) {
  auto& forces = r.varying[column.load].forces;
  const double outward = column.upper ? 1 : -1;
  for (std::size_t k = 0; k < column.shares.size(); ++k) {
    const ColumnShare& share = column.shares[k];
    const ColumnLayer& layer = column.layers[share.layer];
    const geom::Vec3& e = strain[share.layer];
    geom::Vec3 traction = geom::Vec3::Zero();
    traction[column.axis] = layer.lambda * e.z();
    traction.z() = layer.shear * e[column.axis];
    const geom::Vec3 at_node =
        (1 - share.above) * velocity[share.level] + share.above * velocity[share.level + 1];
    forces[k] = {share.node, share.area * (outward * traction + share.impedance * at_node)};
  }
}

} // namespace

void find_side_forces(ResolvedConditions& r, const State& state) {
  if (r.columns.empty())
    return;
  require_columns(r, state);
  for (const Column& column : r.columns) {
    const Node* const v = state.column_velocity.data() + column.first;
    std::vector<geom::Vec3> velocity;
    for (std::size_t i = 0; i < column.z.size(); ++i)
      velocity.push_back(vec(v[i]));
    put_side_forces(column, layer_strains(column, state.column_displacement.data() + column.first, v),
                    velocity, r);
  }
}

double column_time_step(const ResolvedConditions& r) {
  double least = std::numeric_limits<double>::infinity();
  for (const Column& column : r.columns)
    for (const ColumnLayer& layer : column.layers) {
      const double half = 1 / (layer.height * std::sqrt(layer.density / layer.p_modulus)), // w / 2
          z = layer.stiffness_damping * half;
      least = std::min(least, (std::sqrt(1 + z * z) - z) / half);
    }
  return least;
}

void advance_columns(ResolvedConditions& r, State& state, const ColumnStep& step) {
  if (r.columns.empty())
    return;
  require_columns(r, state);
  for (const Column& column : r.columns) {
    Node* const u = state.column_displacement.data() + column.first;
    Node* const v = state.column_velocity.data() + column.first;
    const std::size_t levels = column.z.size();
    std::vector<geom::Vec3> force(levels, geom::Vec3::Zero()), mean(levels);
    const std::vector<geom::Vec3> strain = layer_strains(column, u, v);
    std::vector<double> rate(levels, 0.0); // kg/m2/s, mass damping
    for (std::size_t i = 0; i < column.layers.size(); ++i) {
      const ColumnLayer& layer = column.layers[i];
      const geom::Vec3 stress = geom::Vec3(layer.shear, layer.shear, layer.p_modulus).cwiseProduct(strain[i]);
      force[i] += stress;
      force[i + 1] -= stress;
      for (const std::size_t level : {i, i + 1})
        rate[level] += 0.5 * layer.mass_damping * layer.density * layer.height;
    }
    for (const auto& [traction, amplitude] : column.entering)
      force[0] += amplitude_at(amplitude, step.time) * traction;
    for (std::size_t i = 0; i < levels; ++i) {
      geom::Vec3 now = vec(v[i]);
      const geom::Vec3 before = now;
      for (int axis = 0; axis < 3; ++axis) {
        if (i == 0 && column.held[axis]) {
          const auto& [velocity, amplitude] = column.support[axis];
          now[axis] = velocity * amplitude_at(amplitude, step.time + 0.5 * step.time_step);
        } else {
          const double dashpot = rate[i] + (i == 0 ? column.foot_impedance[axis] : 0);
          now[axis] = central_difference::velocity_after(before[axis], force[i][axis],
                                                         column.mass[i] / step.kick, dashpot, 0)
                          .velocity;
        }
      }
      mean[i] = 0.5 * (before + now);
      v[i] = node(now);
      u[i] = node(vec(u[i]) + step.time_step * now);
    }
    put_side_forces(column, strain, mean, r);
  }
}

} // namespace cdem
