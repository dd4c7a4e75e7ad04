#include "tests/libcdem/columns.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace testing {

cdem::Elastic Bar::material() const {
  cdem::Elastic m = rock();
  m.poissons_ratio = poissons_ratio;
  return m;
}

cdem::Joint Bar::joint() const {
  cdem::Joint j = rock_joint();
  j.thickness_ratio = thickness_ratio;
  return j;
}

geom::Assembly Bar::shape() const {
  return geom::grid({length, h(), h()}, {blocks, 1, 1});
}

System Bar::system() const {
  return System(build({body("bar", shape(), material(), joint())}));
}

double Bar::effective(double modulus) const {
  return modulus / (1 + thickness_ratio * modulus / material().youngs_modulus);
}

std::vector<int> nodes_at(const cdem::Model& model, double x, double tolerance) {
  std::vector<int> nodes;
  for (int i = 0; i < static_cast<int>(model.node_position.size()); ++i)
    if (std::abs(model.node_position[i].x() - x) < tolerance)
      nodes.push_back(i);
  return nodes;
}

double axial_frequency(System& s, double length, const cdem::Elastic& material) {
  const auto mode = [&](std::size_t i) { return std::sin(0.5 * pi * s.model.node_position[i].x() / length); };
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.velocity[i].x = 1e-3 * mode(i);
  std::vector<double> crossings; // s
  double before = 0;
  cdem::RunOptions options;
  options.breaking = false;
  options.duration = 2.2 * 4 * length / std::sqrt(material.youngs_modulus / material.density);
  options.safety = 0.5;
  options.callback_every = 1;
  options.callback = [&] {
    double q = 0;
    for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
      q += s.model.node_mass[i] * mode(i) * s.state.displacement[i].x;
    const double step = s.state.time / static_cast<double>(s.state.step);
    if (before * q < 0)
      crossings.push_back(s.state.time - step * q / (q - before));
    before = q;
  };
  s.run(options);
  REQUIRE(crossings.size() >= 4);
  return 1 / (crossings[3] - crossings[1]);
}

double mean_velocity_x(const System& s, const std::vector<int>& nodes) {
  double sum = 0;
  for (const int i : nodes)
    sum += s.state.velocity[i].x;
  return sum / static_cast<double>(nodes.size());
}

} // namespace testing
