// Meshed cubes and piles of rigid units stepped by several processes, beside as many threads of one: rates, what they tell each other in a step,
// how long they wait, and what that would be among many more, from counts and stated speeds of a network. That is a
// projection, no measurement, and the table says so.
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/ranks/partition.hpp"
#include "tests/bench/laid_units.hpp"
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <unistd.h>

namespace bench {
namespace {

using namespace cdem;

constexpr double latency = 2e-6, bandwidth = 10e9; // s, bytes/s and direction, of a network of today
constexpr double messages_deep = 2;                // exchanges that wait for each other in a step
constexpr double bytes_of_sums = 9 * 72 * 8;       // exact sums of a step (parallel/exact_sum.hpp)
constexpr int rounds = 3;
constexpr std::int64_t pile_steps = 1500; // in which units that have been laid come to lie on each other
constexpr std::int64_t least_steps = 64;  // memory is that of a stage that nobody has looked at for a while

struct Case {
  const char* name;
  Model model;
  State state;
  Conditions conditions;
  bool begins_anew = false; // each time, and takes so many steps
  std::int64_t steps = 0;
};

// By all ranks together, or by this one alone, of a step, the most of any rank; the best of some rounds by the clock.
Stepped measured(const Case& of, int threads, double at_least) {
  State state = of.state;
  std::int64_t steps = least_steps;
  Stepped best;
  for (int round = 0; round <= rounds; ++round) {
    if (of.begins_anew)
      state = of.state;
    Stepped now = stepped(of.model, of.conditions, state, threads, steps);
    double most[] = {now.clock,
                     now.processor,
                     now.messages,
                     now.bytes,
                     now.waited,
                     static_cast<double>(now.memory.all),
                     static_cast<double>(now.memory.anonymous),
                     static_cast<double>(now.memory.most)};
    ranks().largest(most, std::size(most));
    now = {most[0],
           most[1],
           most[2],
           most[3],
           most[4],
           {static_cast<std::size_t>(most[5]), static_cast<std::size_t>(most[6]),
            static_cast<std::size_t>(most[7])},
           now.times};
    if (round == 1 || (round > 1 && now.clock < best.clock))
      best = now;
    if (round == 0) // to see how many it takes
      steps = of.begins_anew
                  ? of.steps
                  : std::max<std::int64_t>(least_steps, std::lround(at_least / rounds / now.clock));
  }
  return best;
}

// While it lives the other ranks, of the same machine, sleep: those that wait for a message take processor time.
class Others {
public:
  Others()
      : file_(std::filesystem::temp_directory_path().string() + "/cdem_bench_" + std::to_string(getpid())) {
    if (ranks().leads())
      std::ofstream(file_) << "a bench runs\n";
    ranks().broadcast(file_);
    while (!ranks().leads() && std::filesystem::exists(file_))
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ~Others() {
    if (ranks().leads())
      std::filesystem::remove(file_);
  }
  Others(const Others&) = delete;
  Others& operator=(const Others&) = delete;

private:
  std::string file_;
};

// s, of a step of so many tets on each of many ranks: the measured computing and what the surface of a compact part costs.
// Sums go through a tree.
double projected(double tets_each, double seconds_per_tet, double bytes_per_surface, double ranks_among) {
  const double surface = std::pow(tets_each, 2.0 / 3);
  const double depth = std::ceil(std::log2(ranks_among));
  const double neighbours = std::min(26.0, ranks_among - 1);
  const double exchange = messages_deep * neighbours * latency + bytes_per_surface * surface / bandwidth;
  const double sums = depth * (latency + bytes_of_sums / bandwidth);
  return tets_each * seconds_per_tet + exchange + sums;
}

void beside_threads(const Case& of, const Settings& settings) {
  const int size = ranks().size(), threads = settings.threads.front();
  const bool says = ranks().leads();
  const auto n = static_cast<double>(of.model.tets.size());
  Stepped together, alone, one, memory;
  // In turn, as what else the machine does takes away from both.
  for (int turn = 0; turn < 2; ++turn) {
    const Stepped here = measured(of, threads, settings.seconds);
    if (turn == 0) // before rank 0 does anything alone
      memory = here;
    if (turn == 0 || here.clock < together.clock)
      together = here;
    const Others sleeping;
    if (says) {
      const AloneForNow now;
      const Stepped by_threads = measured(of, size * threads, settings.seconds);
      if (turn == 0 || by_threads.clock < alone.clock)
        alone = by_threads;
      const Stepped by_one = measured(of, 1, settings.seconds);
      if (turn == 0 || by_one.processor < one.processor)
        one = by_one;
    }
  }
  if (!says)
    return;
  std::printf("%10s %8.0f | %8.1f %8.1f %7.2f | %9.1f %9.1f %7.2f | %9.0f %9.3g %6.0f%%\n", of.name, n,
              1 / together.clock, 1 / alone.clock, alone.clock / together.clock, 1e6 * together.processor,
              1e6 * one.processor, one.processor / (size * together.processor), together.messages,
              together.bytes, 100 * together.waited);
  std::printf("%10s memory of a rank: %.0f MB between steps, %.0f MB of that in no file; %.0f MB at most\n",
              "", static_cast<double>(memory.memory.all) / 1e6,
              static_cast<double>(memory.memory.anonymous) / 1e6,
              static_cast<double>(memory.memory.most) / 1e6);
  std::printf("%10s ranks: %s\n%10s one:   %s\n", "", together.times.c_str(), "", one.times.c_str());
  if (of.begins_anew) // what piles tell goes to all ranks, not through surfaces
    return;
  const double per_tet = size * together.clock / n * (1 - together.waited);
  const double sums = bytes_of_sums * (size - 1);
  const double per_surface =
      std::max(0.0, together.bytes - sums) / std::pow(n / size, 2.0 / 3) * (size == 2 ? 6 : 1);
  const double weak = projected(n / size, per_tet, 0, 1);
  std::printf("%10s projection, no measurement (%.0f us, %.0f GB/s):", "", 1e6 * latency, bandwidth / 1e9);
  for (const double many : {64.0, 1024.0, 16384.0})
    std::printf("  %.0f ranks weak %.2f, strong %.2f", many,
                weak / projected(n / size, per_tet, per_surface, many),
                n * per_tet / many / projected(n / many, per_tet, per_surface, many));
  std::printf("\n");
  std::fflush(stdout);
}

} // namespace

void among_ranks(const Settings& settings) {
  const int size = ranks().size(), threads = settings.threads.front();
  if (ranks().leads())
    std::printf("%d ranks of %d thread%s beside one process of %d threads by the clock, and the slowest "
                "rank, without "
                "waiting, beside one process of one thread in processor time\n"
                "%10s %8s | %8s %8s %7s | %9s %9s %7s | %9s %9s %7s\n%10s %8s | %8s %8s %7s | %9s %9s %7s | "
                "%9s %9s %7s\n",
                size, threads, threads == 1 ? "" : "s", size * threads, "", "tets", "ranks", "threads",
                "ranks /", "a rank", "one", "of", "messages", "bytes", "waited", "", "", "steps/s", "steps/s",
                "threads", "us", "us", "even", "a step", "a step", "");
  for (const bool bonded : {false, true})
    for (const int tets : settings.tets) {
      Model model = meshed_cube(tets, bonded);
      State state = shaken(model);
      beside_threads({bonded ? "bonded" : "continuous", std::move(model), std::move(state), {}}, settings);
    }
  for (const int count : settings.units) {
    Laid laid = laid_units(count, true);
    Model model = first_model(laid.spec);
    State state = initial_state(model);
    beside_threads({"pile", std::move(model), std::move(state), std::move(laid.conditions), true, pile_steps},
                   settings);
  }
}

} // namespace bench
