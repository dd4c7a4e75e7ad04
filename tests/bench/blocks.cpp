// Star blocks bonded on all faces, stepped with breaking on and nothing breaking: the cost of a step far from
// failure.
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/build.hpp"
#include "libcdem/step/run.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/bench/bench.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <unistd.h>

namespace bench {
namespace {

using namespace cdem;

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// A block of rock, nearly cubic, of about `count` blocks.
Model build(int count) {
  const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(count))));
  const int depth = std::max(1, count / (side * side));
  Model frame;
  Body body;
  body.name = "rock";
  body.material = {30e9, 0.25, 2500, 0};
  body.joint.cohesion = 8e6;
  body.joint.friction_angle = 0.5;
  body.joint.tensile_strength = 5e6;
  frame.bodies.push_back(body);
  frame.joints.push_back(body.joint);
  frame.pair_joint[{0, 0}] = 0;
  std::vector<BlockSeed> seeds;
  const geom::Vec3 size(0.1 * side, 0.1 * side, 0.1 * depth);
  for (const geom::Polyhedron& shape : geom::grid(size, {side, side, depth}).blocks) {
    BlockSeed seed;
    seed.shape = shape;
    seeds.push_back(seed);
  }
  return build_model(frame, std::move(seeds), default_traits);
}

// Repetitions per second; `repeat(n)` returns how long n of them took, n raised until that is long enough.
template <class Repeat>
double rate(double at_least, const Repeat& repeat) {
  for (std::int64_t n = 1;; n *= 2) {
    const double seconds = repeat(n);
    if (seconds >= at_least)
      return static_cast<double>(n) / seconds;
  }
}

double kernel_rate(const Model& model, const State& state, int threads, double at_least) {
  std::vector<Node> force(model.node_position.size());
  return rate(at_least, [&](std::int64_t n) {
    const auto start = std::chrono::steady_clock::now();
    for (std::int64_t i = 0; i < n; ++i)
      for_chunks(static_cast<std::int64_t>(model.chunks.size()), threads, [&](std::int64_t c) {
        const BlockChunk& chunk = model.chunks[c];
        add_small_strain_forces(model.batches.data() + chunk.batches.begin, chunk.batches.size(),
                                state.displacement.data(), force.data());
      });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  });
}

double step_rate(const Model& model, int threads, double at_least) {
  State state = initial_state(model), last_good;
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    state.velocity[i].x = 1e-3 * std::sin(static_cast<double>(i)); // far below what breaks a bond
  const Conditions none;
  Observer quiet;
  // From the first step to the last: what a stage does once, at its start and end, is left out.
  return rate(at_least, [&](std::int64_t n) {
    RunLog log;
    std::chrono::steady_clock::time_point first, last;
    RunOptions options;
    options.steps = n + 1;
    options.callback_every = 1;
    options.callback = [&] {
      last = std::chrono::steady_clock::now();
      if (first == std::chrono::steady_clock::time_point())
        first = last;
    };
    run({model, state, none, log, last_good, quiet, threads, 1}, options);
    return std::chrono::duration<double>(last - first).count();
  });
}

} // namespace

void blocks(const Settings& settings) {
  std::printf("\nbonded star blocks, full step, millions per second\n"
              "%8s %9s %9s %7s | %8s %8s %8s | %9s %7s | %11s\n",
              "blocks", "tets", "bonds", "threads", "blocks/s", "tets/s", "bonds/s", "kernel", "step /",
              "bytes per");
  std::printf("%8s %9s %9s %7s | %8s %8s %8s | %9s %7s | %11s\n", "", "", "", "", "", "", "", "tets/s",
              "kernel", "block");
  for (const int size : settings.sizes) {
    const double before = resident_bytes();
    const Model model = build(size);
    const State state = initial_state(model);
    const double bytes = resident_bytes() - before;
    const auto n_blocks = static_cast<double>(model.blocks.size()),
               n_tets = static_cast<double>(model.tets.size()),
               n_bonds = static_cast<double>(model.points.size());
    for (const int threads : settings.threads) {
      const int used = useful_threads(model, threads);
      if (used < threads)
        continue; // the solver would not share so small a model
      const double kernel = kernel_rate(model, state, used, 0.5 * settings.seconds) * n_tets;
      const double steps = step_rate(model, used, settings.seconds);
      std::printf("%8.0f %9.0f %9.0f %7d | %8.3f %8.2f %8.2f | %9.2f %7.2f | %11.0f\n", n_blocks, n_tets,
                  n_bonds, threads, steps * n_blocks / 1e6, steps * n_tets / 1e6, steps * n_bonds / 1e6,
                  kernel / 1e6, steps * n_tets / kernel, bytes / n_blocks);
      std::fflush(stdout);
    }
  }
  std::printf(
      "\nA model too small to keep a further thread busy is stepped by fewer; its row is left out.\n");
}

} // namespace bench
