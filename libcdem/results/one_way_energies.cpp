#include "libcdem/results/one_way_energies.hpp"

#include <algorithm>
#include <numeric>

namespace cdem {
namespace {

constexpr std::array<const char*, 5> one_way_names = {"damping", "friction", "breaking", "plastic",
                                                      "yielding"};
constexpr std::size_t breaking = 2;

std::array<double, 5> one_way(const EnergyLedger& e) {
  return {e.damping, e.friction, e.breaking, e.plastic, e.yielding};
}

double sum(const std::array<double, 5>& energies) {
  return std::accumulate(energies.begin(), energies.end(), 0.0);
}

void deepen(OneWayEnergies::Fall& fall, double energy, double time) {
  if (energy > fall.energy)
    fall = {energy, time};
}

} // namespace

void OneWayEnergies::look(const EnergyLedger& now, double time) {
  const std::array<double, 5> spent = one_way(now);
  for (std::size_t i = 0; i < spent.size(); ++i) {
    largest[i] = std::max(largest[i], spent[i]);
    deepen(fallen[i], largest[i] - spent[i], time);
  }
  deepen(surplus, -sum(spent), time);
}

ImpossibleEnergy impossible_energy(const EnergyLedger& now, double time, const OneWayEnergies& seen) {
  OneWayEnergies::Fall surplus = seen.surplus;
  deepen(surplus, now.total() - sum(one_way(now)) - now.external, time);
  ImpossibleEnergy worst{"kinetic and stored energy rose above what was given", surplus.energy, surplus.time,
                         0, false};
  for (std::size_t i = 0; i < one_way_names.size(); ++i)
    if (const OneWayEnergies::Fall& fall = seen.fallen[i]; fall.energy > worst.energy)
      worst = {std::string("the energy of ") + one_way_names[i] + ", which can only rise, fell", fall.energy,
               fall.time, 0, i == breaking};
  worst.part = worst.energy > 0 ? worst.energy / now.scale() : 0;
  return worst;
}

} // namespace cdem
