// cdem_bench: how fast the solver steps, beside what the machine allows, measured in the same run.
#include "libcdem/ranks/ranks.hpp"
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <thread>

#include <unistd.h>

namespace bench {

double copy_rate(int threads) {
  constexpr std::size_t count = std::size_t{1} << 24; // 128 MiB an array, beyond any cache
  std::vector<double> from(count, 1.0), to(count, 0.0);
  double best = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Stopwatch watch(threads);
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::size_t i = 0; i < count; ++i)
      to[i] = from[i];
    const double seconds = watch.seconds();
    best = std::max(best, 2 * sizeof(double) * static_cast<double>(count) / seconds);
    from[static_cast<std::size_t>(repeat)] = to[count - 1 - static_cast<std::size_t>(repeat)] + repeat;
  }
  return best;
}

} // namespace bench

namespace {

std::vector<int> numbers(const char* option, const std::string& text) {
  std::vector<int> list;
  if (text == "0" && std::strcmp(option, "--threads") != 0 && std::strcmp(option, "--seconds") != 0 &&
      std::strcmp(option, "--body-divisions") != 0)
    return list;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const int value = std::atoi(text.substr(begin, end - begin).c_str());
    if (value < 1) {
      std::fprintf(stderr, "cdem bench: error: %s = %s: must be a list of integers >= 1, e.g. 100,10000\n",
                   option, text.c_str());
      std::exit(2);
    }
    list.push_back(value);
    begin = end + 1;
  }
  return list;
}

constexpr const char* help =
    R"(Usage: cdem bench [--sizes 100,10000,100000] [--tets 10000,105000] [--bodies 1000,10000]
                  [--body-divisions 1] [--heaps 100,300,1000] [--settle 1000] [--shatter 6000]
                  [--discs 6000] [--prisms 5000] [--threads 1,2] [--seconds 1]
       cdem bench --ranks 2 [--tets 105000] [--settle 200] [--threads 1] [--seconds 1]

Steps plates of bonded blocks, meshed cubes, continuous and with every face bonded, lattices of cubes that touch,
heaps of loose blocks, and discs and prisms that crack, and prints rates beside the bare element kernels and a copy
of memory.
  --sizes    blocks in the plates; 0: none
  --tets     tetrahedra in the cubes, e.g. 10000,105000,1000000; 0: none
  --bodies   cubes that touch, e.g. 1000,10000,100000; 0: none
  --body-divisions  cells along an edge of each of them, of six tetrahedra
  --heaps    loose rigid blocks; prints by which power of their number a step grows; 0: none
  --settle   armour units laid on a slope that come to rest, e.g. 1000, with the most threads given; none by
             default
  --shatter  tetrahedra in a cube that hits a floor and breaks everywhere, e.g. 6000; none by default
  --discs    tetrahedra in a disc that splits between two plates; 0: none
  --prisms   tetrahedra in a prism that is crushed between two plates, e.g. 5000,50000; 0: none
  --threads  thread counts to compare
  --seconds  stepping time per figure, at least; bodies that break: as many steps as whole ones make in about that time
  --ranks    processes that step the cubes of --tets and the units of --settle, rigid, together, by mpirun, beside as many
             threads of one process
)";

// This program again, by mpirun.
[[noreturn]] void start_ranks(const std::string& count, char** argv) {
  if (geteuid() == 0) { // Open MPI asks for it
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  std::vector<std::string> words{"mpirun", "-q",    "--oversubscribe",     "--bind-to",
                                 "none",   "--mca", "mpi_yield_when_idle", "1",
                                 "-n",     count};
  for (char** word = argv; *word; ++word)
    words.emplace_back(*word);
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp("mpirun", arguments.data());
  std::fprintf(stderr, "cdem bench: error: --ranks needs mpirun (package openmpi-bin)\n");
  std::exit(1);
}

// Where all ranks fail alike the first one says it; an error of one rank alone ends all.
int fail(const char* why) {
  const bool alike = cdem::ranks().all_fail(cdem::Ranks::patience);
  const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
  if (!alike || !rank || std::atoi(rank) == 0)
    std::fprintf(stderr, "cdem bench: error: %s\n", why);
  if (!alike)
    cdem::ranks().abort(1);
  cdem::leave_ranks();
  return 1;
}

int run(int argc, char** argv) {
  bench::Settings settings;
  std::string ranks;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help" || option == "-h") {
      std::fputs(help, stdout);
      return 0;
    }
    if (i + 1 == argc ||
        (option != "--sizes" && option != "--tets" && option != "--bodies" && option != "--body-divisions" &&
         option != "--heaps" && option != "--settle" && option != "--shatter" && option != "--discs" &&
         option != "--prisms" && option != "--ranks" && option != "--threads" && option != "--seconds")) {
      std::fprintf(
          stderr,
          "cdem bench: error: %s: must be --sizes, --tets, --bodies, --body-divisions, --heaps, --settle, "
          "--shatter, --discs, --prisms, --ranks, --threads or --seconds with a value\n%s",
          option.c_str(), help);
      return 2;
    }
    const std::string value = argv[++i];
    if (option == "--sizes")
      settings.sizes = numbers("--sizes", value);
    else if (option == "--tets")
      settings.tets = numbers("--tets", value);
    else if (option == "--bodies")
      settings.bodies = numbers("--bodies", value);
    else if (option == "--body-divisions")
      settings.body_divisions = numbers("--body-divisions", value)[0];
    else if (option == "--heaps")
      settings.heaps = numbers("--heaps", value);
    else if (option == "--settle")
      settings.units = numbers("--settle", value);
    else if (option == "--shatter")
      settings.shatter = numbers("--shatter", value);
    else if (option == "--discs")
      settings.discs = numbers("--discs", value);
    else if (option == "--prisms")
      settings.prisms = numbers("--prisms", value);
    else if (option == "--ranks")
      ranks = std::to_string(numbers("--ranks", value)[0]);
    else if (option == "--threads")
      settings.threads = numbers("--threads", value);
    else
      settings.seconds = numbers("--seconds", value)[0];
  }
  if (!ranks.empty() && cdem::processes_started() == 1 && ranks != "1")
    start_ranks(ranks, argv);
  if (cdem::processes_started() > 1)
    cdem::join_ranks();
  if (cdem::processes_started() > 1 || ranks == "1") {
    bench::among_ranks(settings);
    cdem::leave_ranks();
    return 0;
  }
  std::printf("%u processors; rates of one thread by its processor time, of more by the clock\n\nmemory copy "
              "(read + written)\n",
              std::thread::hardware_concurrency());
  for (const int threads : settings.threads)
    std::printf("  %d thread%s  %5.1f GB/s\n", threads, threads == 1 ? " " : "s",
                bench::copy_rate(threads) / 1e9);
  if (!settings.sizes.empty())
    bench::blocks(settings);
  if (!settings.tets.empty())
    bench::meshes(settings);
  if (!settings.bodies.empty())
    bench::contacts(settings);
  if (!settings.heaps.empty())
    bench::heaps(settings);
  if (!settings.units.empty())
    bench::piles(settings);
  if (!settings.shatter.empty())
    bench::shatter(settings);
  if (!settings.discs.empty() || !settings.prisms.empty())
    bench::cracking(settings);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
