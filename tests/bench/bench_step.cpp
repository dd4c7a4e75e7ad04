// Block-steps, tet-steps and bond-steps per second of the solver's own full step, and beside them, since
// absolute rates differ from machine to machine, the bare kernels of the same model and a plain copy:
//   kernels/step   time of the element and spring kernels alone over the time of the full step; 1 is the most
#include "libcdem/element/small_strain.hpp"
#include "libcdem/interface/spring_forces.hpp"
#include "libcdem/step/relax.hpp"
#include "libcdem/step/run.hpp"
#include "tests/bench/bonded_wall.hpp"

#include <benchmark/benchmark.h>
#include <chrono>
#include <cstring>
#include <utility>

namespace {

using bench::BondedWall;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// About half a second on one core.
int steps_for(int blocks) {
  return std::max(10, 2000000 / blocks);
}

void element_kernel(const BondedWall& wall, cdem::Workspace& work, int threads) {
  const cdem::Model& model = wall.model;
  cdem::for_chunks(static_cast<std::int64_t>(model.chunks.size()), threads, [&](std::int64_t c) {
    const cdem::Range batches = model.chunks[c].batches;
    cdem::add_small_strain_forces(model.batches.data() + batches.begin, batches.size(),
                                  wall.state.displacement.data(), work.force.data());
  });
}

void spring_kernel(const BondedWall& wall, cdem::State& state, cdem::Workspace& work, int threads) {
  const auto& chunks = wall.model.point_chunks;
  cdem::for_chunks(static_cast<std::int64_t>(chunks.size()), threads, [&](std::int64_t c) {
    cdem::spring_forces(wall.model, state, work, chunks[c], work.spring_sums[c], true);
  });
}

// What a solving call needs around the wall.
struct Solving {
  explicit Solving(const BondedWall& wall) : state(wall.state), last_good(wall.state) {}
  cdem::State state, last_good;
  cdem::RunLog log;
  cdem::Observer observer;

  cdem::StageContext context(const BondedWall& wall, int threads) {
    return {wall.model, state, wall.conditions, log, last_good, observer, threads, 1};
  }
};

// Seconds of a call: the best of three, after one to warm up.
template <class Call>
double best_time(int repeats, const Call& call) {
  double best = 1e300;
  for (int attempt = 0; attempt < 4; ++attempt) {
    const auto start = Clock::now();
    for (int i = 0; i < repeats; ++i)
      call();
    if (attempt > 0)
      best = std::min(best, seconds_since(start) / repeats);
  }
  return best;
}

template <class Solve>
void full_step(benchmark::State& timing, const Solve& solve) {
  const int blocks = static_cast<int>(timing.range(0)), threads = static_cast<int>(timing.range(1));
  const BondedWall& wall = bench::bonded_wall(blocks);
  Solving solving(wall);
  double steps = 0, time = 0;
  for (auto _ : timing) {
    const auto result = solve(solving.context(wall, threads), steps_for(blocks));
    timing.SetIterationTime(result.wall_time);
    steps += static_cast<double>(result.steps);
    time += result.wall_time;
  }

  cdem::Workspace work(wall.model, solving.state, wall.conditions);
  const int repeats = std::max(2, steps_for(blocks) / 10);
  const double elements = best_time(repeats, [&] { element_kernel(wall, work, threads); });
  const double springs = best_time(repeats, [&] { spring_kernel(wall, solving.state, work, threads); });

  const auto tets = static_cast<double>(wall.model.tets.size()),
             bonds = static_cast<double>(wall.model.points.size());
  const double rate = steps / time;
  timing.counters["blocks/s"] = rate * blocks;
  timing.counters["tets/s"] = rate * tets;
  timing.counters["bonds/s"] = rate * bonds;
  timing.counters["bytes/block"] = wall.bytes_per_block;
  timing.counters["kernel tets/s"] = tets / elements;
  timing.counters["kernel bonds/s"] = bonds / springs;
  timing.counters["kernels/step"] = (elements + springs) * rate;
}

void relax(benchmark::State& timing) {
  full_step(timing, [](const cdem::StageContext& context, int steps) {
    cdem::RelaxOptions options;
    options.residual = 1e-300; // never reached
    options.max_steps = steps;
    return cdem::relax(context, options);
  });
}

void run(benchmark::State& timing) {
  full_step(timing, [](const cdem::StageContext& context, int steps) {
    cdem::RunOptions options;
    options.steps = steps;
    return cdem::run(context, options);
  });
}

// Memory bandwidth, read and written, of arrays that no cache holds.
void copy(benchmark::State& timing) {
  constexpr std::int64_t pieces = 256, piece = 1 << 20;
  std::vector<char> from(pieces * piece, 1), to(pieces * piece, 2);
  for (auto _ : timing) {
    cdem::for_chunks(pieces, static_cast<int>(timing.range(0)), [&](std::int64_t c) {
      std::memcpy(to.data() + c * piece, from.data() + c * piece, piece);
    });
    benchmark::ClobberMemory();
  }
  timing.SetBytesProcessed(timing.iterations() * 2 * pieces * piece);
}

// Size by size, so that each wall is built once.
void register_all() {
  for (const std::int64_t threads : {1, 2})
    benchmark::RegisterBenchmark("copy", copy)->Arg(threads)->ArgName("threads")->UseRealTime();
  for (const std::int64_t blocks : {100, 10000, 100000})
    for (const std::int64_t threads : {1, 2})
      for (const auto& [name, function] : {std::pair("relax", relax), std::pair("run", run)})
        benchmark::RegisterBenchmark(name, function)
            ->Args({blocks, threads})
            ->ArgNames({"blocks", "threads"})
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
}

} // namespace

int main(int count, char** values) {
  std::vector<char*> arguments(values, values + count);
  char tabular[] = "--benchmark_counters_tabular=true";
  arguments.insert(arguments.begin() + 1, tabular); // before the user's, which win
  int n = static_cast<int>(arguments.size());
  benchmark::Initialize(&n, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(n, arguments.data()))
    return 2;
  register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
