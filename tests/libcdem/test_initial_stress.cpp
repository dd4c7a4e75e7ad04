// Stress that is there before anything moves.
#include "tests/libcdem/system.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

const std::array<double, 6> pre_stress = {-3e6, -5e6, -8e6, 5e5, -4e5, 3e5};
const geom::Mat3 in_situ_tensor = symmetric(-3e6, -5e6, -8e6, 5e5, -4e5, 3e5);

geom::Assembly cells() {
  geom::VoronoiOptions options;
  options.count = 25;
  return geom::voronoi(options);
}

void load_sides(cdem::Simulation& s, const geom::Mat3& stress) {
  for (const cdem::Traction& traction : on_six_sides(stress))
    s.traction(traction);
}

} // namespace

TEST_CASE("initial stress in equilibrium with the tractions moves nothing", "[initial_stress]") {
  cdem::Simulation s = simulation(cells());
  s.initial_stress(cdem::Selection::everything(), pre_stress);
  load_sides(s, in_situ_tensor);
  const cdem::RelaxResult r = s.relax({});
  CHECK(r.converged);
  CHECK(r.residual < 1e-10);
  CHECK(s.counts().intact == s.counts().bonds);
  // Against the displacement the same tractions would cause without it.
  CHECK(s.max("displacement.magnitude").value < 1e-10 * 8e6 / rock().youngs_modulus);
  for (const auto& row : s.blocks())
    for (int c = 0; c < 6; ++c)
      CHECK(row.stress[c] == Approx(pre_stress[c]).epsilon(1e-9));
}

TEST_CASE("a body let go of its initial stress moves back by the strain of that stress", "[initial_stress]") {
  cdem::Simulation s = simulation(geom::grid({0.4, 0.1, 0.1}, {1, 1, 1}));
  s.initial_stress(cdem::Selection::everything(), {-6e6, 0, 0, 0, 0, 0});
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  s.fix(fixed(at_place({0, 0, 0}), "yz"));
  s.fix(fixed(at_place({0, 0.1, 0}), "z"));
  const cdem::RelaxResult r = s.relax({});
  CAPTURE(r.steps, r.residual);
  CHECK(r.converged);
  CHECK(s.mean("displacement.x", cdem::Selection::side("x+")) ==
        Approx(0.4 * 6e6 / rock().youngs_modulus).epsilon(1e-5));
  CHECK(std::abs(s.blocks()[0].stress[0]) < 1e-5 * 6e6);
}

TEST_CASE("a free body let go of its initial stress finds its balance", "[initial_stress]") {
  cdem::Simulation s = simulation(geom::grid({0.4, 0.1, 0.1}, {1, 1, 1}));
  s.initial_stress(cdem::Selection::everything(), {-6e6, 0, 0, 0, 0, 0});
  cdem::RelaxOptions options;
  options.max_steps = 20000;
  const cdem::RelaxResult r = s.relax(options);
  CAPTURE(r.steps, r.residual);
  CHECK(r.converged);
  CHECK(std::abs(s.blocks()[0].stress[0]) < 1e-5 * 6e6);
}

TEST_CASE("initial stress adds up and belongs to the selected blocks alone", "[initial_stress]") {
  cdem::Simulation s = simulation(geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}));
  s.initial_stress(cdem::Selection::in_box({{0, 0, 0}, {0.1, 0.1, 0.1}}), {1e6, 0, 0, 0, 0, 0});
  s.initial_stress(cdem::Selection::everything(), {2e6, 0, 0, 3e6, 0, 0});
  CHECK(s.blocks()[0].stress == std::array<double, 6>{3e6, 0, 0, 3e6, 0, 0});
  CHECK(s.blocks()[1].stress == std::array<double, 6>{2e6, 0, 0, 3e6, 0, 0});
}

TEST_CASE("initial stress given layer by layer is that given at once, in any order", "[initial_stress]") {
  const auto stressed = [](const std::vector<int>& order) {
    cdem::Simulation s = simulation(geom::grid({0.2, 0.1, 0.3}, {2, 1, 3}));
    cdem::InitialStress field;
    field.gradient = 25e3;
    field.k0 = {0.6, 0.8};
    if (order.empty())
      s.initial_stress(field);
    for (const int layer : order) {
      field.on = cdem::Selection::in_box({{0, 0, 0.1 * layer}, {0.2, 0.1, 0.1 * (layer + 1)}});
      s.initial_stress(field);
    }
    return s.state_hash();
  };
  const auto whole = stressed({});
  CHECK(stressed({0, 1, 2}) == whole);
  CHECK(stressed({2, 0, 1}) == whole);
}
