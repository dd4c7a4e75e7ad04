// Pressure on the faces of cracks: the opening of a penny-shaped crack, its work, the pressure of a pumped volume, and a
// pressurised borehole that breaks.
#include "libcdem/fracture/notch.hpp"
#include "libcdem/load/crack_pressure.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// A quarter of a cylinder with a round crack of the radius 1 m in its middle plane z = 0. It is strong, so that the crack does
// not grow. Cells are small at the edge of the crack. A thin hole along the axis keeps them from ending in a point.
struct Penny {
  static constexpr double hole = 0.05, wall = 6; // m, radii

  // cells: from the hole to the edge of the crack.
  explicit Penny(int cells) : s(build({body_of(cells)})) {
    const auto in_crack = [](const Vec3& x, int) { return std::abs(x.z()) < 1e-6 && x.norm() < 1; };
    cdem::notch(s.model, s.state, in_crack);
    each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
      if (!cdem::holds(s.state.faces[batch].stage[lane]))
        area += 3 * s.model.mesh.faces[batch].area[lane];
    });
    s.hold(cdem::Selection::where([](const Vec3& x) { return std::abs(x.x()) < 1e-9; }, "x = 0"), "x");
    s.hold(cdem::Selection::where([](const Vec3& x) { return std::abs(x.y()) < 1e-9; }, "y = 0"), "y");
    s.hold(cdem::Selection::side("z-"), "z");
  }

  static cdem::BodySpec body_of(int cells) {
    const int beyond = cells, along = cells, around = cells;
    geom::TetMesh mesh = geom::box_mesh({1.0 * (cells + beyond), 1.0 * around, 2.0 * along},
                                        {cells + beyond, around, 2 * along}, 0);
    const double first = 0.5 / cells;                    // m, of the cells at the edge of the crack
    const auto grown = [&](double part, double length) { // a first cell of that size, then a cube
      const double linear = std::min(1.0, first * cells / length);
      return length * (linear * part + (1 - linear) * part * part * part);
    };
    for (Vec3& x : mesh.nodes) {
      const double from = (x.x() - cells) / cells;
      const double r = from < 0 ? 1 - grown(-from, 1 - hole) : 1 + grown(from, wall - 1);
      const double z = (x.z() - along) / along, angle = 0.5 * pi * x.y() / around;
      x = Vec3(r * std::cos(angle), r * std::sin(angle), (z < 0 ? -1 : 1) * grown(std::abs(z), wall));
    }
    cdem::BodySpec body = concrete_body(std::move(mesh), cdem::Softening::none);
    body.joint.tensile_strength = body.joint.cohesion = 1e12;
    return body;
  }

  double volume() {
    return cdem::crack_volume(s.model, s.state,
                              cdem::resolve(s.model, s.state, s.conditions.crack_pressures.front()));
  }

  System s;
  double area = 0; // m2, of the quarter
};

cdem::CrackPressure constant(double pressure) {
  cdem::CrackPressure load;
  load.pressure = [pressure](double) { return pressure; };
  return load;
}

} // namespace

TEST_CASE("crack pressure: a penny-shaped crack opens as Sneddon says", "[crack_pressure]") {
  Penny penny(14);
  const double p = 1e5, e = 30e9 / (1 - 0.04);
  penny.s.conditions.crack_pressures = {constant(p)};
  REQUIRE(penny.s.relax(1e-4).converged);
  // Sneddon 1946 (Proc. R. Soc. A 187): opening 8 p a / (pi E') sqrt(1 - (r / a)^2), volume 16 p a^3 / (3 E'). The radius is
  // that of a disc with the area of the cracked faces.
  const double a = std::sqrt(4 * penny.area / pi + Penny::hole * Penny::hole);
  double above = 0, below = 0, nearest = 1e9;
  for (std::size_t i = 0; i < penny.s.model.node_position.size(); ++i) {
    const Vec3& x = penny.s.model.node_position[i];
    if (std::abs(x.z()) > 1e-9 || x.norm() > nearest + 1e-6)
      continue;
    nearest = std::min(nearest, x.norm()); // to the axis
    above = std::max(above, penny.s.state.displacement[i].z);
    below = std::min(below, penny.s.state.displacement[i].z);
  }
  const double volume = 4 * penny.volume() / (16 * p * a * a * a / (3 * e)),
               opening = (above - below) / (8 * p * a / (pi * e));
  INFO("radius " << a << ", volume " << volume << ", opening " << opening << " of Sneddon's");
  CHECK(volume == Approx(1).epsilon(0.05));
  CHECK(opening == Approx(1).epsilon(0.05));
  // A pressure put on at once does the work p V: half is stored, the relaxation takes the other half.
  const cdem::EnergyLedger energy = cdem::energy(penny.s.model, penny.s.state);
  CHECK(energy.balance_error() < 1e-3);
  CHECK(energy.external == Approx(p * penny.volume()).epsilon(0.01));
  CHECK(energy.elastic + energy.springs == Approx(0.5 * p * penny.volume()).epsilon(0.02));
}

TEST_CASE("crack pressure: a pumped fluid presses by its bulk modulus and keeps the time step stable",
          "[crack_pressure]") {
  const double p = 1e5, bulk = 2.2e9;
  Penny given(4);
  given.s.conditions.crack_pressures = {constant(p)};
  REQUIRE(given.s.relax(1e-5).converged);
  const double volume = given.volume();
  const double softer = GENERATE(1.0, 0.02); // of the reservoir's stiffness p / V: a stiff fluid too
  const double reservoir = softer * bulk * volume / p;
  Penny pumped(4);
  cdem::CrackPressure load;
  load.volume = [=](double time) { return std::min(1.0, time / 0.015) * (volume + p * reservoir / bulk); };
  load.bulk_modulus = bulk;
  load.reservoir = reservoir;
  pumped.s.conditions.crack_pressures = {load};
  cdem::RunOptions options;
  options.duration = 0.03;
  options.local_damping = 0.3;
  pumped.s.run(options);
  CHECK(pumped.volume() == Approx(volume).epsilon(5e-3));
  CHECK(balance(pumped.s) < 2e-3);
  // The fluid keeps the volume in a relaxation too, where it is refused: its stiffness is none of the elements'.
  CHECK_THROWS_WITH(pumped.s.relax(1e-3), Catch::Contains("in model:run"));
}

namespace {

const Vec3 notched(0.4, 0.2, 0.1); // m, a free block with a notch to half its height

bool in_notch(const Vec3& x) {
  return std::abs(x.x() - 0.5 * notched.x()) < 1e-6 && x.y() < 0.5 * notched.y() + 1e-6;
}

geom::TetMesh notched_mesh() {
  return geom::box_mesh(notched, {8, 4, 2}, 0);
}

// Largest part of the whole work of a gas by which the balance was open, and how many springs of faces broke. strength: over
// that of concrete.
std::pair<double, std::int64_t> opened_by_gas(double strength, cdem::Softening softening, double pressure) {
  cdem::BodySpec body = concrete_body(notched_mesh(), softening);
  body.joint.tensile_strength *= strength;
  body.joint.cohesion *= strength;
  System s(build({body}));
  cdem::notch(s.model, s.state, [](const Vec3& x, int) { return in_notch(x); });
  cdem::CrackPressure gas;
  gas.pressure = [=](double time) {
    return 0.5 * pressure * (1 - std::cos(pi * std::min(1.0, time / 4e-5)));
  };
  s.conditions.crack_pressures = {gas};
  double open = 0; // J
  cdem::RunOptions options;
  options.duration = 1.5e-4;
  options.callback_every = 8;
  options.callback = [&] {
    const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
    open = std::max(open, std::abs(e.total() - e.external));
  };
  s.run(options);
  return {open / cdem::energy(s.model, s.state).external, s.log.broken_tension + s.log.broken_shear};
}

} // namespace

TEST_CASE("crack pressure: the work of a gas is what the body takes, whether its crack grows or not",
          "[crack_pressure][energy]") {
  const auto [still, none] = opened_by_gas(1e3, cdem::Softening::none, 1e6);
  INFO("open by " << still << " of the work");
  CHECK(none == 0);
  CHECK(still < 1e-3);
  for (const cdem::Softening softening : {cdem::Softening::none, cdem::Softening::linear}) {
    const auto [open, broken] = opened_by_gas(1, softening, 1e7);
    INFO("open by " << open << " of the work, " << broken << " broken");
    CHECK(broken > 50);
    CHECK(open < 5e-3);
  }
}

TEST_CASE("crack pressure: runs one after the other end like one, to the last bit", "[crack_pressure][run]") {
  const bool pumped = GENERATE(false, true);
  const auto run_in = [&](int runs) {
    cdem::ModelSpec spec;
    spec.bodies = {concrete_body(notched_mesh())};
    cdem::Simulation s(spec, 1, nullptr);
    s.break_bonds(cdem::Selection::where(in_notch, "notch"), true);
    cdem::CrackPressure load;
    (pumped ? load.volume : load.pressure) = [&](double time) {
      return (pumped ? 1e-5 : 1e7) * std::min(1.0, time / 4e-5);
    };
    load.bulk_modulus = 2.2e9;
    load.reservoir = 1e-3;
    s.crack_pressure(load);
    cdem::RunOptions options;
    options.steps = 48 / runs;
    for (int i = 0; i < runs; ++i)
      s.run(options);
    CHECK(s.log().breaks.size() > 10);
    return s;
  };
  const cdem::Simulation whole = run_in(1);
  for (const int runs : {2, 16}) {
    const cdem::Simulation divided = run_in(runs);
    CHECK(divided.state_hash() == whole.state_hash());
    CHECK(divided.energy().external == whole.energy().external);
    CHECK(divided.log().history.back().external == whole.log().history.back().external);
  }
}

namespace {

// A quarter of a thick-walled cylinder, strained in its plane only. Rings are thin at the hole: faces are judged by the mean
// stress of the tets beside them, which falls with 1 / r^2.
struct Borehole {
  static constexpr double inner = 0.1, outer = 1, thickness = 0.02;

  static cdem::BodySpec body_of(int rings, int sectors) {
    geom::TetMesh mesh = geom::box_mesh({1, 1, thickness}, {rings, sectors, 1}, 0);
    for (Vec3& x : mesh.nodes) {
      const double r = inner * std::pow(outer / inner, std::pow(x.x(), 1.5)), angle = 0.5 * pi * x.y();
      x = Vec3(r * std::cos(angle), r * std::sin(angle), x.z());
    }
    return concrete_body(std::move(mesh), cdem::Softening::none);
  }
  static bool is_wall(const Vec3& x, double radius) {
    return std::abs(std::hypot(x.x(), x.y()) - radius) < 0.01 * radius;
  }

  explicit Borehole(int sectors) : s(build({body_of(20, sectors)})) {
    s.hold(cdem::Selection::where([](const Vec3& x) { return std::abs(x.x()) < 1e-9; }, "x = 0"), "x");
    s.hold(cdem::Selection::where([](const Vec3& x) { return std::abs(x.y()) < 1e-9; }, "y = 0"), "y");
    s.hold(cdem::Selection::side("z-"), "z");
    s.hold(cdem::Selection::side("z+"), "z");
  }
  void press(double inside, double outside) {
    s.conditions.tractions.clear();
    for (const auto& [radius, pressure] : {std::pair{inner, inside}, std::pair{outer, outside}}) {
      cdem::Traction wall;
      wall.on = cdem::Selection::where([r = radius](const Vec3& x) { return is_wall(x, r); }, "wall");
      wall.pressure = cdem::FacePressure{};
      wall.pressure->pressure = [p = pressure](const Vec3&) { return p; };
      s.conditions.tractions.push_back(wall);
    }
    s.conditions.crack_pressures = {constant(inside)};
  }

  System s;
};

} // namespace

TEST_CASE("crack pressure: a pressurised borehole breaks at its formula, and the fluid splits it",
          "[crack_pressure]") {
  const double outside = GENERATE(0.0, 2e6);
  // Lame: the hoop stress of the wall is (p (R^2 + a^2) - 2 p_o R^2) / (R^2 - a^2); at T it breaks (Hubbert and Willis 1957:
  // T + 2 p_o for R / a without end).
  const double r2 = Borehole::outer * Borehole::outer, a2 = Borehole::inner * Borehole::inner;
  const double breakdown = (tension * (r2 - a2) + 2 * outside * r2) / (r2 + a2);
  Borehole hole(14);
  const auto broken_at = [&](double part) {
    hole.press(part * breakdown, outside);
    cdem::RelaxOptions options;
    options.residual = 1e-4;
    options.max_steps = 3000; // it may split to the outside
    cdem::relax(hole.s.next_stage(), options, "relax");
    return hole.s.log.broken_tension + hole.s.log.broken_shear;
  };
  for (const double part : {0.5, 0.8, 0.95})
    CHECK(broken_at(part) == 0);
  std::int64_t broken = 0;
  double at = 0.95;
  while (broken == 0 && at < 1.1)
    broken = broken_at(at += 0.01);
  INFO("outside " << outside << " Pa, breaks at " << at << " of the formula");
  CHECK(at < 1.05);
}

TEST_CASE("crack pressure: wrong input is refused", "[crack_pressure][input]") {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("rock", geom::box_mesh({1, 1, 1}, {2, 2, 2}, 0))};
  cdem::Simulation bare(spec, 1, nullptr);
  CHECK_THROWS_WITH(bare.crack_pressure(constant(1e5)), Catch::Contains("inner faces of a cohesive body"));
  spec.bodies = {concrete_body(geom::box_mesh({1, 1, 1}, {2, 2, 2}, 0))};
  cdem::Simulation s(spec, 1, nullptr);
  cdem::CrackPressure load = constant(1e5);
  load.on = cdem::Selection::in_box({Vec3(2, 2, 2), Vec3(3, 3, 3)});
  CHECK_THROWS_WITH(s.crack_pressure(load), Catch::Contains("inner faces of a cohesive body"));
  CHECK_THROWS_WITH(s.crack_pressure(constant(-1e5)), Catch::Contains("a finite pressure >= 0"));
  load = {};
  load.volume = [](double) { return 1e-3; };
  CHECK_THROWS_WITH(s.crack_pressure(load), Catch::Contains("bulk_modulus"));
}
