// Cubes of finite-volume tets, all nodes shared or every face bonded, stepped with breaking on and nothing breaking.
//
// The bare kernel: forces of tets and faces from given positions into the chunks' own partial forces; it neither adds
// those up nor moves a node. Operations are counted in the sources: 364 a tet (elements of vectors that are added,
// multiplied or divided), 112 a bonded face that is far from its strength, with Ks = Kn; those of nodes are left out.
#include "libcdem/model/build/build_model.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/stage.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bench {
namespace {

using namespace cdem;

constexpr double flops_per_tet = 364, flops_per_face = 112;
// Measurements in turn, of which the best counts: what else the machine does takes away from single ones.
constexpr int rounds = 3;

} // namespace

Model meshed_cube(int tets, bool bonded) {
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(tets / 6.0))));
  Model frame;
  Body body;
  body.name = "cube";
  body.material = {30e9, 0.2, 2400, 0};
  body.element = Element::finite_volume;
  body.bonding.everywhere = bonded;
  body.joint.cohesion = 8e6;
  body.joint.friction_angle = 0.5;
  body.joint.tensile_strength = 5e6;
  frame.bodies.push_back(body);
  frame.joints.push_back(body.joint);
  frame.pair_joint[{0, 0}] = 0;
  std::vector<MeshSeed> seeds(1);
  seeds[0].mesh = geom::box_mesh({1, 1, 1}, {n, n, n}, 0.15);
  return build_model(frame, {}, default_traits, std::move(seeds));
}

namespace {

double kernel_rate(const Model& model, int threads, double at_least) {
  State state = initial_state(model);
  Workspace work(model, state, {});
  work.strain_step = 1e-9;
  return rate(at_least, [&](std::int64_t n) {
    const Stopwatch watch(threads);
    for (std::int64_t i = 0; i < n; ++i)
      for_chunks(static_cast<std::int64_t>(model.mesh.chunks.size()), threads,
                 [&](std::int64_t c) { mesh_forces(model, state, work, c, true); });
    return watch.seconds();
  });
}

// What a step has to move if every array goes through memory once: connectivity and constants of tets and faces,
// places and masses of nodes read; displacement, velocity and stress read and written.
double bytes_per_step(const Model& model, const State& state) {
  const auto bytes = [](const auto& array) { return static_cast<double>(array.size() * sizeof(array[0])); };
  return bytes(model.mesh.batches) + bytes(model.mesh.faces) + bytes(model.node_position) +
         bytes(model.node_mass) + bytes(model.gravitational_mass) +
         2 * (bytes(state.displacement) + bytes(state.velocity) + bytes(state.stress));
}

double faces_of(const Model& model) {
  double faces = 0;
  for (const MeshChunk& chunk : model.mesh.chunks)
    faces += chunk.faces;
  return faces;
}

// Of all that a stage holds: model, state, its last good copy and the workspace.
double bytes_held(int tets, bool bonded) {
  const double before = resident_bytes();
  const Model model = meshed_cube(tets, bonded);
  const std::vector<State> states(2, initial_state(model));
  const Workspace work(model, states[0], {});
  return resident_bytes() - before;
}

} // namespace

void meshes(const Settings& settings) {
  std::printf(
      "\nmeshed cubes, full step, millions of tets per second; least memory traffic and its share of the copy"
      "\n%10s %8s %7s | %7s %7s %8s | %6s %6s | %7s | %9s\n",
      "faces", "tets", "threads", "tets/s", "kernel", "step /", "GB/s", "share", "Gflop/s", "bytes per");
  std::printf("%10s %8s %7s | %7s %7s %8s | %6s %6s | %7s | %9s\n", "", "", "", "", "tets/s", "kernel", "",
              "", "", "tet");
  for (const bool bonded : {false, true})
    for (const int size : settings.tets) {
      const double held = bytes_held(size, bonded);
      const Model model = meshed_cube(size, bonded);
      const auto n = static_cast<double>(model.tets.size());
      const double flops = flops_per_tet * n + flops_per_face * faces_of(model);
      const double moved = bytes_per_step(model, initial_state(model));
      for (const int threads : settings.threads) {
        if (useful_threads(model, threads) < threads)
          continue; // the solver would not share so small a model
        double kernel = 0, steps = 0, copy = 0;
        std::string times;
        for (int round = 0; round < rounds; ++round) {
          copy = std::max(copy, copy_rate(threads));
          kernel = std::max(kernel, kernel_rate(model, threads, 0.5 * settings.seconds / rounds));
          steps = std::max(steps, step_rate(model, threads, settings.seconds / rounds, &times));
        }
        std::printf("%10s %8.0f %7d | %7.2f %7.2f %8.2f | %6.1f %6.2f | %7.2f | %9.0f\n",
                    bonded ? "bonded" : "continuous", n, threads, steps * n / 1e6, kernel * n / 1e6,
                    steps / kernel, steps * moved / 1e9, steps * moved / copy, steps * flops / 1e9, held / n);
        std::printf("%10s %s\n", "", times.c_str());
        std::fflush(stdout);
      }
    }
}

} // namespace bench
