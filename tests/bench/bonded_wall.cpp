#include "tests/bench/bonded_wall.hpp"

#include "libcdem/model/build.hpp"
#include "libcdem/step/workspace.hpp"
#include "libgeom/assembly/builders.hpp"

#include <malloc.h>
#include <map>
#include <memory>

namespace bench {
namespace {

constexpr double edge = 0.03; // m, of a cube

double heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

// Rock that does not break under the load below, so that every step does the same work.
cdem::Model build(const std::array<int, 3>& divisions) {
  cdem::Body body;
  body.name = "wall";
  body.material.youngs_modulus = 30e9;
  body.material.poissons_ratio = 0.25;
  body.material.density = 2500;
  body.joint.cohesion = 8e6;
  body.joint.friction_angle = 30 * 3.14159265358979323846 / 180;
  body.joint.tensile_strength = 5e6;

  cdem::Model frame;
  frame.pair_joint[{0, 0}] = 0;
  frame.joints.push_back(body.joint);
  frame.bodies.push_back(std::move(body));
  const geom::Vec3 size = edge * geom::Vec3(divisions[0], divisions[1], divisions[2]);
  std::vector<cdem::BlockSeed> seeds;
  for (geom::Polyhedron& block : geom::grid(size, divisions).blocks) {
    cdem::BlockSeed seed;
    seed.shape = std::move(block);
    seeds.push_back(std::move(seed));
  }
  return build_model(frame, std::move(seeds), cdem::default_traits);
}

cdem::Conditions press() {
  cdem::Conditions conditions;
  cdem::Fix foot;
  foot.on = cdem::Selection::side("z-");
  conditions.fixes.push_back(foot);
  cdem::Traction load;
  load.on = cdem::Selection::side("z+");
  load.stress = {0, 0, -1e6};
  conditions.tractions.push_back(load);
  return conditions;
}

} // namespace

const BondedWall& bonded_wall(int blocks) {
  static const std::map<int, std::array<int, 3>> divisions = {
      {100, {5, 5, 4}}, {10000, {25, 20, 20}}, {100000, {50, 50, 40}}};
  static std::unique_ptr<BondedWall> kept;
  if (kept && static_cast<int>(kept->model.blocks.size()) == blocks)
    return *kept;
  kept.reset();
  const double before = heap_bytes();
  kept = std::make_unique<BondedWall>();
  kept->model = build(divisions.at(blocks));
  kept->state = initial_state(kept->model);
  kept->conditions = press();
  const cdem::State last_good = kept->state;
  const cdem::Workspace work(kept->model, kept->state, kept->conditions);
  kept->bytes_per_block = (heap_bytes() - before) / blocks;
  return *kept;
}

} // namespace bench
