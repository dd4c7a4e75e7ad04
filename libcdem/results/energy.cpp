#include "libcdem/results/energy.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/bond/water_work.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/state/carried_mass.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// A strain that no load of interest makes and rounding does not reach: 3 Pa in rock, 1e-10 m in a metre.
constexpr double least_strain = 1e-10;

// J, of the whole model at that strain.
double least_energy(const Model& model) {
  double energy = 0;
  for (const Block& block : model.blocks) {
    const Elastic& material = model.bodies[block.body].material;
    energy += 0.5 * material.youngs_modulus * least_strain * least_strain * block.mass.volume;
  }
  return energy;
}

} // namespace

double EnergyLedger::scale() const {
  double largest = std::max(external_peak, least);
  for (const double entry : {elastic, springs, bolts, kinetic, damping, radiated, friction, breaking, plastic,
                             yielding, cutting, fictitious})
    largest = std::max(largest, std::abs(entry));
  return largest;
}

double EnergyLedger::balance_error() const {
  const double open = std::abs(total() - external);
  return open > 0 ? open / scale() : 0;
}

double elastic_energy(const Model& model, const State& state, double lag) {
  double energy = mesh_elastic_energy(model, state, lag);
  const int star_tets = model.mesh.empty() ? static_cast<int>(model.tets.size()) : model.mesh.first_tet;
  const std::vector<Node> then = displacement_ago(state, lag);
  for (int tet = 0; tet < star_tets; ++tet) {
    const int block = model.tet_block[tet];
    const geom::Mat3 h = displacement_gradient(model, then, tet);
    const geom::Mat3 strain = 0.5 * (h + h.transpose());
    const Stress elastic = elastic_stress(model.bodies[model.blocks[block].body].material, h);
    const geom::Mat3 work = 0.5 * matrix(elastic) + matrix(state.initial_stress[tet]);
    energy += tet_volume(model, tet) * work.cwiseProduct(strain).sum();
  }
  return energy;
}

double kinetic_energy(const Model& model, const State& state) {
  const std::vector<double>& mass = moving_mass(model, state);
  double kinetic = 0;
  for (int i = 0; i < static_cast<int>(state.velocity.size()); ++i) {
    if (model.blocks[block_of(model, i)].rigid >= 0)
      continue;
    const Node& v = state.velocity[i];
    kinetic += 0.5 * mass[i] * (v.x * v.x + v.y * v.y + v.z * v.z);
  }
  for (std::size_t i = 0; i < model.rigid.size(); ++i)
    kinetic += kinetic_energy(model.rigid[i], state.rigid[i], state.velocity_lag) +
               0.5 * carried_mass(model, state, model.blocks[model.rigid[i].block]) *
                   vec(state.rigid[i].velocity).squaredNorm();
  return kinetic;
}

std::vector<double> speeds_of_blocks(const Model& model, const State& state) {
  std::vector<double> speeds;
  for (const Block& block : model.blocks) {
    double mass = 0, twice_energy = 0;
    for (int i = block.node_begin; i < block.node_end; ++i) {
      const Node& v = state.velocity[i];
      mass += model.node_mass[i];
      twice_energy += model.node_mass[i] * (v.x * v.x + v.y * v.y + v.z * v.z);
    }
    if (block.rigid >= 0)
      twice_energy =
          2 * kinetic_energy(model.rigid[block.rigid], state.rigid[block.rigid], state.velocity_lag);
    speeds.push_back(std::sqrt(twice_energy / mass));
  }
  return speeds;
}

EnergyLedger energy(const Model& model, const State& state) {
  // Central differences keep the balance where velocities and work stand, half a step before the displacements: there
  // the stored terms are taken too. Taken at the displacements they would be off by half a step's work, 0.2 % for a bar.
  const double lag = state.velocity_lag;
  EnergyLedger ledger = state.spent;
  ledger.elastic = elastic_energy(model, state, lag);
  if (!model.points.empty() || !model.mesh.faces.empty()) {
    const State moved = moved_back(state, lag);
    ledger.springs = spring_energy(model, moved) + mesh_spring_energy(model, moved);
    ledger.external += water_work(model, moved);
  }
  ledger.springs += contact_energy(model, state, lag);
  ledger.kinetic = kinetic_energy(model, state);
  ledger.external_peak = std::max(ledger.external_peak, std::abs(ledger.external));
  ledger.least = least_energy(model);
  return ledger;
}

} // namespace cdem
