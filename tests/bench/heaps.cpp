// A heap of rigid Voronoi blocks without bonds, each with a velocity of its own, so that all part and strike each other: what
// a step costs a block in small heaps and in large ones.
#include "libcdem/first_model.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/random.hpp"
#include "tests/bench/measure.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace bench {
namespace {

using namespace cdem;

constexpr double block_size = 0.25, speed = 2; // m, m/s
// Each phase has steps that pass uncounted and then counted ones; faces part everywhere in the first, in fewer places in the second.
constexpr std::int64_t uncounted = 250, counted = 250;
constexpr std::array<const char*, 2> phases{"parts", "flies"};

Model build(int blocks) {
  const double side = block_size * std::cbrt(blocks);
  geom::VoronoiOptions options;
  options.size = {side, side, side};
  options.count = blocks;
  BodySpec heap;
  heap.name = "heap";
  heap.material = {1e9, 0.2, 2500, 0};
  heap.joint.bonded = false;
  heap.joint.friction_angle = 0.5;
  heap.joint.normal_stiffness = heap.joint.shear_stiffness = 2e10;
  heap.element = Element::rigid;
  heap.shape = geom::voronoi(options);
  const Joint friction = heap.joint;
  return first_model({{heap}, {{"heap", "heap", friction}}});
}

void push(State& state) {
  for (std::size_t i = 0; i < state.rigid.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      state.rigid[i].velocity[axis] = speed * (2 * geom::uniform(1, axis, i) - 1);
}

} // namespace

void heaps(const Settings& settings) {
  std::printf("\nheaps of loose rigid blocks, one thread\n%8s %6s %14s %14s   %s\n", "blocks", "",
              "us/block/step", "grows like n^", "time of the steps");
  double last_blocks = 0;
  std::array<double, phases.size()> last{}; // s a step
  for (const int count : settings.heaps) {
    const Model model = build(count);
    State state = initial_state(model);
    push(state);
    const auto blocks = static_cast<double>(model.blocks.size());
    for (std::size_t phase = 0; phase < phases.size(); ++phase) {
      stepped(model, {}, state, 1, uncounted);
      const Stepped s = stepped(model, {}, state, 1, counted);
      std::printf("%8.0f %6s %14.2f ", blocks, phases[phase], 1e6 * s.processor / blocks);
      if (last_blocks > 0)
        std::printf("%14.2f", std::log(s.processor / last[phase]) / std::log(blocks / last_blocks));
      else
        std::printf("%14s", "");
      std::printf("   %s\n", s.times.c_str());
      std::fflush(stdout);
      last[phase] = s.processor;
    }
    last_blocks = blocks;
  }
}

} // namespace bench
