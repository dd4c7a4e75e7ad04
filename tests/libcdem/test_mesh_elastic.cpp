// Elasticity and waves in meshed bodies against formulas: a bar's first mode, a cantilever, a plane P wave.
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/columns.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::Elastic without_poisson() {
  cdem::Elastic m = rock();
  m.poissons_ratio = 0;
  return m;
}

// First natural frequency of a bar fixed at x-, Hz, from the zero crossings of its modal displacement.
double measured_frequency(int elements, double length, const cdem::Elastic& material) {
  const double h = length / elements;
  System s(build({meshed("bar", geom::box_mesh({length, 2 * h, 2 * h}, {elements, 2, 2}), {}, material)}));
  s.hold(cdem::Selection::side("x-"), "xyz");
  return axial_frequency(s, length, material);
}

// A box of five tetrahedra a cell, one in the middle and four at corners, mirrored from cell to cell.
geom::TetMesh five_tets_a_cell(const Vec3& size, const std::array<int, 3>& n) {
  geom::TetMesh mesh = geom::box_mesh(size, n); // for its nodes
  mesh.tets.clear();
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const bool mirrored = (i + j + k) % 2 == 1;
        const auto corner = [&](int x, int y, int z) {
          return i + (mirrored ? 1 - x : x) + (n[0] + 1) * (j + y + (n[1] + 1) * (k + z));
        };
        const auto add = [&](int a, int b, int c, int d) {
          mesh.tets.push_back(mirrored ? geom::Tet{a, b, d, c} : geom::Tet{a, b, c, d});
        };
        const int o = corner(0, 0, 0), xy = corner(1, 1, 0), xz = corner(1, 0, 1), yz = corner(0, 1, 1);
        add(o, xy, yz, xz);
        add(corner(1, 0, 0), o, xz, xy);
        add(corner(0, 1, 0), o, xy, yz);
        add(corner(0, 0, 1), o, yz, xz);
        add(corner(1, 1, 1), xy, xz, yz);
      }
  mesh.region.assign(mesh.tets.size(), 0);
  return mesh;
}

geom::TetMesh six_tets_a_cell(const Vec3& size, const std::array<int, 3>& n) {
  return geom::box_mesh(size, n);
}

// End deflection over P L^3 / 3 E I + P L / k G A (Timoshenko; k for a rectangle after Cowper 1966).
template <class Mesh>
double relative_deflection(int cells_high, const Mesh& mesh) {
  const double height = 0.8, length = 3 * height, width = height / cells_high, shear_stress = 1e4;
  const cdem::Elastic m = rock();
  System s(build({meshed("beam", mesh({length, height, width}, {3 * cells_high, cells_high, 1}), {}, m)}));
  s.hold(cdem::Selection::side("x-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("x+"), {0, shear_stress, 0})};
  REQUIRE(s.relax(1e-4).converged);
  const double p = shear_stress * height * width, inertia = width * std::pow(height, 3) / 12;
  const double k = 10 * (1 + m.poissons_ratio) / (12 + 11 * m.poissons_ratio);
  const double exact = p * std::pow(length, 3) / (3 * m.youngs_modulus * inertia) +
                       p * length / (k * m.shear_modulus() * height * width);
  return cdem::mean_value(s.model, s.state, "displacement.y", cdem::Selection::side("x+")) / exact;
}

// Mean velocity along x of the nodes at x, m/s.
double velocity_at(const System& s, double x) {
  double momentum = 0, mass = 0;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (std::abs(s.model.node_position[i].x() - x) < 1e-9) {
      momentum += s.model.node_mass[i] * s.state.velocity[i].x;
      mass += s.model.node_mass[i];
    }
  return momentum / mass;
}

} // namespace

TEST_CASE("finite volume: a fixed-free bar swings at sqrt(E / rho) / 4 L, of second order", "[bar][mesh]") {
  const cdem::Elastic material = without_poisson();
  const double length = 2;
  const double exact = std::sqrt(material.youngs_modulus / material.density) / (4 * length);
  const auto error = [&](int elements) {
    return std::abs(measured_frequency(elements, length, material) / exact - 1);
  };
  const double coarse = error(5), middle = error(10), fine = error(20);
  INFO("errors " << coarse << ", " << middle << ", " << fine);
  CHECK(fine < 0.005);
  CHECK(std::log2(coarse / middle) >= 1.8);
}

TEST_CASE("finite volume: a cantilever's deflection closes on P L^3 / 3 E I + P L / k G A",
          "[cantilever][mesh]") {
  const double coarse = relative_deflection(4, six_tets_a_cell),
               middle = relative_deflection(8, six_tets_a_cell),
               fine = relative_deflection(16, six_tets_a_cell);
  const double order = std::log2((middle - coarse) / (fine - middle));
  const double limit = fine + (fine - middle) / (std::pow(2.0, order) - 1);
  INFO("deflection over exact " << coarse << ", " << middle << ", " << fine << " at H / 4, 8, 16; order "
                                << order << ", extrapolated " << limit);
  // Constant-strain tets are stiff in bending: 6 % at H / 8, 2 % at H / 16; the order is 1.6 on its way to 2.
  CHECK(order > 1.5);
  CHECK(fine < 1);
  CHECK(fine == Approx(1).epsilon(0.05));
  CHECK(limit == Approx(1).epsilon(0.02));
}

TEST_CASE("finite volume: five tets a cell, mirrored from cell to cell, bend within 5 % at H / 8",
          "[cantilever][mesh]") {
  const double relative = relative_deflection(8, five_tets_a_cell);
  CHECK(relative < 1);
  CHECK(relative == Approx(1).epsilon(0.05));
}

TEST_CASE("finite volume: a pressure step runs at sqrt((lambda + 2 mu) / rho) with v = sigma0 / (rho c)",
          "[waves][mesh]") {
  const cdem::Elastic m = rock();
  const double modulus = m.lame_lambda() + 2 * m.shear_modulus(), c = std::sqrt(modulus / m.density);
  const int cells = 150;
  const double h = 0.01, length = cells * h, sigma0 = 1e6, v = sigma0 / (m.density * c);
  System s(build({meshed("column", geom::box_mesh({length, h, h}, {cells, 1, 1}), {}, m)}));
  s.hold(cdem::Selection::everything(), "yz");
  s.conditions.tractions = {traction(cdem::Selection::side("x-"), {sigma0, 0, 0})};
  const double near = 0.2 * length, far = 0.8 * length;
  double before[2] = {0, 0}, arrival[2] = {-1, -1}, sum = 0;
  int count = 0;
  cdem::RunOptions options;
  options.duration = 0.95 * length / c;
  options.callback_every = 1;
  options.callback = [&] {
    // Velocities stand half a step before the time of the displacements.
    const double dt = s.state.time / static_cast<double>(s.state.step), time = s.state.time - 0.5 * dt;
    const double now[2] = {velocity_at(s, near), velocity_at(s, far)};
    for (int k = 0; k < 2; ++k) {
      if (arrival[k] < 0 && now[k] >= v / 2)
        arrival[k] = time - dt * (now[k] - v / 2) / (now[k] - before[k]);
      before[k] = now[k];
    }
    if (time > 0.4 * length / c) {
      sum += now[0];
      ++count;
    }
  };
  s.run(options);
  REQUIRE(arrival[1] > 0);
  CHECK((far - near) / (arrival[1] - arrival[0]) == Approx(c).epsilon(0.01));
  CHECK(sum / count == Approx(v).epsilon(0.01));
}
