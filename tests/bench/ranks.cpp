// Meshed cubes stepped by several processes, beside as many threads of one: rates, what they tell each other in a step,
// how long they wait, and what that would be among many more, from counts and stated speeds of a network. That is a
// projection, no measurement, and the table says so.
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/ranks/partition.hpp"
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
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
constexpr std::int64_t least_steps = 64; // memory is that of a stage that nobody has looked at for a while

struct Measured {
  double steps = 0;               // a second, by the clock
  double messages = 0, bytes = 0; // that a rank sends in a step, the most of any
  double waited = 0;              // share of the time, likewise
  double resident = 0, anonymous = 0,
         most = 0; // bytes of memory of a rank between steps, and since it began, likewise
};

// By all ranks together, or by this one alone; the best of some rounds.
Measured measured(const Model& model, int threads, double at_least) {
  State state = shaken(model);
  std::int64_t steps = least_steps;
  Measured best;
  for (int round = 0; round <= rounds; ++round) {
    const Ranks::Traffic before = ranks().traffic();
    Resident memory;
    double seconds = stepping_seconds(model, state, threads, steps, true, nullptr, &memory);
    const Ranks::Traffic after = ranks().traffic();
    const auto n = static_cast<double>(steps);
    double most[7] = {seconds,
                      static_cast<double>(after.messages - before.messages) / n,
                      static_cast<double>(after.bytes - before.bytes) / n,
                      (after.waited - before.waited) / seconds,
                      static_cast<double>(memory.all),
                      static_cast<double>(memory.anonymous),
                      static_cast<double>(memory.most)};
    ranks().largest(most, 7);
    seconds = most[0];
    if (round > 0 && n / seconds > best.steps)
      best = {n / seconds, most[1], most[2], most[3], most[4], most[5], most[6]};
    if (round == 0) // to see how many it takes
      steps = std::max<std::int64_t>(least_steps, std::lround(n * at_least / rounds / seconds));
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

} // namespace

void among_ranks(const Settings& settings) {
  const int size = ranks().size(), threads = settings.threads.front();
  const bool says = ranks().leads();
  if (says)
    std::printf("meshed cubes, %d ranks of %d thread%s beside one process of %d threads, by the clock\n"
                "%10s %8s | %8s %8s %7s | %9s %9s %7s\n%10s %8s | %8s %8s %7s | %9s %9s %7s\n",
                size, threads, threads == 1 ? "" : "s", size * threads, "faces", "tets", "ranks", "threads",
                "ranks /", "messages", "bytes", "waited", "", "", "steps/s", "steps/s", "threads", "a step",
                "a step", "");
  for (const bool bonded : {false, true})
    for (const int tets : settings.tets) {
      const Model model = meshed_cube(tets, bonded);
      const auto n = static_cast<double>(model.tets.size());
      Measured together, alone, memory;
      // In turn, as what else the machine does takes away from both.
      for (int turn = 0; turn < 2; ++turn) {
        const Measured here = measured(model, threads, settings.seconds);
        if (turn == 0) // before rank 0 does anything alone
          memory = here;
        if (here.steps > together.steps)
          together = here;
        if (size == 1)
          continue;
        const Others sleeping;
        if (says) {
          const AloneForNow now;
          const Measured by_threads = measured(model, size * threads, settings.seconds);
          if (by_threads.steps > alone.steps)
            alone = by_threads;
        }
      }
      if (!says)
        continue;
      std::printf("%10s %8.0f | %8.1f %8.1f %7.2f | %9.0f %9.3g %6.0f%%\n", bonded ? "bonded" : "continuous",
                  n, together.steps, alone.steps, together.steps / alone.steps, together.messages,
                  together.bytes, 100 * together.waited);
      std::printf(
          "%10s memory of a rank: %.0f MB between steps, %.0f MB of that in no file; %.0f MB at most\n", "",
          memory.resident / 1e6, memory.anonymous / 1e6, memory.most / 1e6);
      const double per_tet = size / (together.steps * n) * (1 - together.waited);
      const double sums = bytes_of_sums * (size - 1);
      const double per_surface =
          std::max(0.0, together.bytes - sums) / std::pow(n / size, 2.0 / 3) * (size == 2 ? 6 : 1);
      const double weak = projected(n / size, per_tet, 0, 1);
      std::printf("%10s projection, no measurement (%.0f us, %.0f GB/s):", "", 1e6 * latency,
                  bandwidth / 1e9);
      for (const double many : {64.0, 1024.0, 16384.0})
        std::printf("  %.0f ranks weak %.2f, strong %.2f", many,
                    weak / projected(n / size, per_tet, per_surface, many),
                    n * per_tet / many / projected(n / many, per_tet, per_surface, many));
      std::printf("\n");
      std::fflush(stdout);
    }
}

} // namespace bench
