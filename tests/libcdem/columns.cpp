#include "tests/libcdem/columns.hpp"

#include "libgeom/assembly/builders.hpp"

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

double mean_velocity_x(const System& s, const std::vector<int>& nodes) {
  double sum = 0;
  for (const int i : nodes)
    sum += s.state.velocity[i].x;
  return sum / static_cast<double>(nodes.size());
}

} // namespace testing
