// A cube with bonds on every face that hits a rigid floor and shatters: how fast it steps before, while its bonds break,
// and after, once it is fragments that touch each other; where the time goes, and how far the energy balance is open.
#include "libcdem/first_model.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/bench/phases.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace bench {
namespace {

using namespace cdem;

constexpr double side = 0.5, gap = 2e-3,
                 speed = 8; // m, m, m/s: some 30 MPa at the impact, six times the strength
// Of all bonds: the end of the first breaking, and that of breaking, if time does not end it.
constexpr double first_part = 0.3, most_part = 0.97;

Model build(int tets) {
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(tets / 6.0))));
  BodySpec cube, floor;
  cube.name = "cube";
  cube.material = {30e9, 0.2, 2400, 0};
  cube.joint.cohesion = 8e6;
  cube.joint.friction_angle = 0.5;
  cube.joint.tensile_strength = 5e6;
  cube.bonding.everywhere = true;
  cube.meshes = {geom::box_mesh({side, side, side}, {n, n, n}, 0.15)};
  cube.element = Element::finite_volume;
  floor.name = "floor";
  floor.material = cube.material;
  floor.meshes = {geom::box_mesh({3 * side, 3 * side, 0.2 * side}, {6, 6, 1})};
  for (geom::Vec3& x : floor.meshes[0].nodes)
    x -= geom::Vec3(side, side, 0.2 * side + gap);
  floor.element = Element::rigid;
  Joint friction;
  friction.bonded = false;
  friction.friction_angle = 0.5;
  return first_model({{cube, floor}, {{"cube", "cube", friction}, {"cube", "floor", friction}}});
}

} // namespace

void shatter(const Settings& settings) {
  print_head_of_phases("a cube of bonded tetrahedra that hits a floor and shatters");
  for (const int size : settings.shatter) {
    Phases phases(fmt::format("cube of {}", size), build(size));
    const Model& model = phases.model;
    double bonds = 0;
    for (const MeshChunk& chunk : model.mesh.chunks)
      bonds += 3 * chunk.faces;
    State& state = phases.state;
    for (Node& v : state.velocity)
      v.z = -speed;
    for (std::size_t b = 0; b < model.blocks.size(); ++b) // the floor stands
      if (model.blocks[b].rigid >= 0)
        std::fill(state.velocity.begin() + model.blocks[b].node_begin,
                  state.velocity.begin() + model.blocks[b].node_end, Node{});
    Fix held;
    held.on = Selection::of_body("floor");
    held.axes = {true, true, true};
    phases.conditions.fixes = {held};
    const std::int64_t steps = steps_of_whole(model.tets.size(), settings.seconds);
    phases.run("whole", 20 * steps, [&] { return !phases.log.breaks.empty(); });
    const auto broken = [&](double part) {
      return [&, part] { return static_cast<double>(phases.log.breaks.size()) > part * bonds; };
    };
    phases.run("breaks", 2 * steps, broken(first_part));
    phases.run("shatters", 2 * steps, broken(most_part));
    phases.run("after", steps, [] { return false; });
  }
}

} // namespace bench
