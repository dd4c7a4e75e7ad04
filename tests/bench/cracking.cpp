// Bodies between two rigid plates that close in until they crack: a disc pressed across its diameter, which splits, and a
// prism, which is crushed. How fast they step while they are whole and nothing moves, under load until the first bond
// breaks, while they crack, when the plates go on as far again, and when the plates stand and the pieces lie between them;
// cohesive, and with the springs of a bonded body.
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/first_model.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "tests/bench/phases.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace bench {
namespace {

using namespace cdem;

constexpr double radius = 0.05, thickness = 0.025,        // m, of the disc
    side = 0.1, height = 0.2;                             // m, of the prism
constexpr double speed_of_disc = 0.4, speed_of_prism = 1; // m/s, of both plates together
constexpr std::size_t tets_of_plate = 96;
constexpr double left_of_peak = 0.5; // of the force on a plate, where a body has cracked

Joint law_between_tets(BondKind kind) {
  Joint joint;
  joint.cohesion = 8e6;
  joint.friction_angle = 0.5;
  joint.tensile_strength = 4e6;
  if (kind == BondKind::cohesive) {
    joint.softening = Softening::linear;
    joint.fracture_energy_1 = 30;
    joint.fracture_energy_2 = 300;
  }
  return joint;
}

// Between z = bottom and top two plates, `wide` around the axis.
Model between_plates(geom::TetMesh mesh, double bottom, double top, double wide, BondKind kind) {
  BodySpec body, lower, upper;
  body.name = "body";
  body.material = {30e9, 0.2, 2400, 0};
  body.joint = law_between_tets(kind);
  body.bonding.kind = kind;
  body.bonding.everywhere = true;
  body.bonding.stiffness_ratio = kind == BondKind::cohesive ? 1 : 10;
  body.meshes = {std::move(mesh)};
  const auto plate = [&](const char* name, double from) {
    BodySpec spec;
    spec.name = name;
    spec.material = body.material;
    spec.element = Element::rigid;
    spec.meshes = {geom::box_mesh({2 * wide, 2 * wide, 0.2 * wide}, {4, 4, 1})};
    for (geom::Vec3& x : spec.meshes[0].nodes)
      x += geom::Vec3(-wide, -wide, from);
    return spec;
  };
  lower = plate("lower", bottom - 0.2 * wide);
  upper = plate("upper", top);
  Joint friction;
  friction.bonded = false;
  friction.friction_angle = 0.4;
  return first_model({{body, lower, upper}, {}, friction});
}

geom::TetMesh meshed(const geom::Solid& solid, double volume, int tets) {
  geom::MeshSize size; // tets of edge a fill some a^3 / 5
  size.size = std::cbrt(5 * volume / tets);
  return geom::mesh_solid(solid, size);
}

double force_on(const Phases& phases, int block) { // N, of all its contacts along the axis
  double force = 0;
  for (const Contact& c : phases.state.contacts) {
    const auto [a, b] = blocks_of(phases.model, c);
    if (a == block || b == block)
      force += law_of(phases.model, c).kn * c.effective_penetration() * std::abs(c.normal.z());
  }
  return force;
}

void plates_move(double speed, Phases& phases) {
  phases.conditions.fixes.clear();
  for (const char* name : {"lower", "upper"}) {
    Fix led;
    led.on = Selection::of_body(name);
    led.velocity = geom::Vec3(0, 0, *name == 'l' ? 0.5 * speed : -0.5 * speed);
    phases.conditions.fixes.push_back(led);
  }
}

void cracks(const char* name, const Settings& settings, double speed, Model model) {
  const std::size_t tets = model.tets.size() - 2 * tets_of_plate;
  Phases phases(fmt::format("{} of {}", name, tets), std::move(model));
  plates_move(0, phases);
  const std::int64_t steps = steps_of_whole(tets, settings.seconds);
  phases.run("whole", steps, [] { return false; });
  plates_move(speed, phases);
  const auto plate = static_cast<int>(phases.model.blocks.size()) - 1;
  double peak = 0, end = 0; // N, s
  const double begin = phases.state.time;
  phases.run("loads", 20 * steps, [&] { return !phases.log.breaks.empty(); });
  phases.run("cracks", 2 * steps, [&] {
    const double force = force_on(phases, plate);
    peak = std::max(peak, force);
    return force < left_of_peak * peak;
  });
  end = 2 * phases.state.time - begin;
  phases.run("goes on", steps, [&] { return phases.state.time > end; });
  plates_move(0, phases);
  phases.run("rests", steps / 2, [] { return false; });
}

} // namespace

void cracking(const Settings& settings) {
  print_head_of_phases("bodies that crack between plates");
  for (const BondKind kind : {BondKind::cohesive, BondKind::springs}) {
    const bool cohesive = kind == BondKind::cohesive;
    for (const int tets : settings.discs) {
      const double turn = 0.1; // rad: no edge of the mesh stands along the axis
      const geom::Solid disc = geom::rotated(
          geom::cylinder({0, -0.5 * thickness, 0}, {0, thickness, 0}, radius), {0, 1, 0}, turn, {0, 0, 0});
      const double volume = M_PI * radius * radius * thickness;
      geom::TetMesh mesh = meshed(disc, volume, tets);
      double top = 0, bottom = 0;
      for (const geom::Vec3& x : mesh.nodes) {
        top = std::max(top, x.z());
        bottom = std::min(bottom, x.z());
      }
      cracks(cohesive ? "disc, cohesive" : "disc, springs", settings, speed_of_disc,
             between_plates(std::move(mesh), bottom, top, radius, kind));
    }
    for (const int tets : settings.prisms) {
      geom::TetMesh mesh =
          meshed(geom::box({side, side, height}, {-0.5 * side, -0.5 * side, 0}), side * side * height, tets);
      cracks(cohesive ? "prism, cohesive" : "prism, springs", settings, speed_of_prism,
             between_plates(std::move(mesh), 0, height, side, kind));
    }
  }
}

} // namespace bench
