#include "libcdem/results/cracks.hpp"

#include "libcdem/results/crack_points.hpp"

#include <cassert>

namespace cdem {

Cracks& Cracks::operator+=(const Cracks& other) {
  tension += other.tension;
  shear += other.shear;
  damaged += other.damaged;
  projected += other.projected;
  energy += other.energy;
  return *this;
}

Cracks CracksByBody::all() const {
  Cracks sum;
  for (const Cracks& some : bodies)
    sum += some;
  sum += between;
  return sum;
}

CracksByBody cracks(const Model& model, const State& state) {
  CracksByBody all;
  all.bodies.resize(model.bodies.size());
  const auto of = [&](std::size_t body) -> Cracks& {
    return body < all.bodies.size() ? all.bodies[body] : all.between;
  };
  each_crack_point(model, state, [&](const CrackPoint& p) {
    if (p.damage == 0)
      return;
    Cracks& sum = of(static_cast<std::size_t>(p.body));
    (p.mode == BondMode::broken_tension ? sum.tension
     : p.mode == BondMode::broken_shear ? sum.shear
                                        : sum.damaged) += p.damage * p.area;
    sum.projected += p.projection * p.damage * p.area;
  });
  for (std::size_t body = 0; body < state.crack_energy.size(); ++body)
    of(body).energy = state.crack_energy[body];
  return all;
}

namespace {

struct Quantity {
  const char* name;
  double (*of)(const Cracks&);
};

constexpr Quantity quantities[] = {
    {"area", [](const Cracks& c) { return c.area(); }},
    {"tension_area", [](const Cracks& c) { return c.tension; }},
    {"shear_area", [](const Cracks& c) { return c.shear; }},
    {"damaged_area", [](const Cracks& c) { return c.damaged; }},
    {"projected_area", [](const Cracks& c) { return c.projected; }},
    {"energy", [](const Cracks& c) { return c.energy.tension + c.energy.shear; }},
    {"tension_energy", [](const Cracks& c) { return c.energy.tension; }},
    {"shear_energy", [](const Cracks& c) { return c.energy.shear; }},
};

} // namespace

const std::vector<std::string>& crack_quantities() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Quantity& quantity : quantities)
      list.emplace_back(quantity.name);
    return list;
  }();
  return names;
}

double crack_quantity(const Cracks& cracks, const std::string& name) {
  for (const Quantity& quantity : quantities)
    if (name == quantity.name)
      return quantity.of(cracks);
  assert(false);
  return 0;
}

} // namespace cdem
