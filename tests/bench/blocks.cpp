// Star blocks bonded on all faces, stepped with breaking on and nothing breaking: the cost of a step far from
// failure.
#include "libcdem/element/small_strain.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/step/stage.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/bench/measure.hpp"

#include <cmath>
#include <cstdio>

namespace bench {
namespace {

using namespace cdem;

// A block of rock, nearly cubic, of about `count` blocks.
Model build(int count) {
  const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(count))));
  const int depth = std::max(1, count / (side * side));
  BodySpec body;
  body.name = "rock";
  body.material = {30e9, 0.25, 2500, 0};
  body.element = Element::small_strain;
  body.joint.cohesion = 8e6;
  body.joint.friction_angle = 0.5;
  body.joint.tensile_strength = 5e6;
  body.shape = geom::grid(geom::Vec3(0.1 * side, 0.1 * side, 0.1 * depth), {side, side, depth});
  ModelSpec spec;
  spec.bodies.push_back(std::move(body));
  return first_model(spec);
}

double kernel_rate(const Model& model, const State& state, int threads, double at_least) {
  std::vector<Node> force(model.node_position.size());
  return rate(at_least, [&](std::int64_t n) {
    const Stopwatch watch(threads);
    for (std::int64_t i = 0; i < n; ++i)
      for_chunks(static_cast<std::int64_t>(model.chunks.size()), threads, [&](std::int64_t c) {
        const BlockChunk& chunk = model.chunks[c];
        add_small_strain_forces(model.batches.data() + chunk.batches.begin, chunk.batches.size(),
                                state.displacement.data() + chunk.nodes.begin,
                                force.data() + chunk.nodes.begin);
      });
    return watch.seconds();
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
      std::string times;
      const double steps = step_rate(model, used, settings.seconds, &times);
      std::printf("%8.0f %9.0f %9.0f %7d | %8.3f %8.2f %8.2f | %9.2f %7.2f | %11.0f\n", n_blocks, n_tets,
                  n_bonds, threads, steps * n_blocks / 1e6, steps * n_tets / 1e6, steps * n_bonds / 1e6,
                  kernel / 1e6, steps * n_tets / kernel, bytes / n_blocks);
      std::printf("%8s %s\n", "", times.c_str());
      std::fflush(stdout);
    }
  }
  std::printf(
      "\nA model too small to keep a further thread busy is stepped by fewer; its row is left out.\n");
}

} // namespace bench
