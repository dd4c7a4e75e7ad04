#include "libcdem/ranks/ranks.hpp"

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <malloc.h>
#include <memory>
#include <stdexcept>

namespace cdem {
namespace {

class Alone : public Ranks {
public:
  Alone() : Ranks(0, 1) {}
  void exchange(const std::vector<Parcel>&, const std::vector<Parcel>&) override {}
  void share(void*, const std::vector<std::size_t>&) override {}
  std::vector<std::string> gather(const std::string& mine, Subject) override { return {mine}; }
  std::vector<std::string> deal(const std::vector<std::string>& to) override { return to; }
  void broadcast(std::string&) override {}
  void largest(double*, std::size_t) override {}
  void sum(std::int64_t*, std::size_t) override {}
  bool all_fail(double) override { return true; }
  [[noreturn]] void abort(int exit_code) override { std::_Exit(exit_code); }
};

std::unique_ptr<Ranks>& joined() {
  static std::unique_ptr<Ranks> ranks;
  return ranks;
}

int alone_for_now = 0;

// Where the build and the installation put it.
std::filesystem::path module_path() {
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* const place : {"cdem_mpi.so", "../lib/cdem/cdem_mpi.so"})
    if (std::filesystem::exists(folder / place))
      return folder / place;
  return {};
}

int number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  return text ? std::atoi(text) : 0;
}

} // namespace

Ranks& ranks() {
  static Alone alone;
  return joined() && alone_for_now == 0 ? *joined() : alone;
}

AloneForNow::AloneForNow() {
  ++alone_for_now;
}

AloneForNow::~AloneForNow() {
  --alone_for_now;
}

int processes_started() {
  for (const char* const variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"})
    if (const int size = number_in(variable); size > 0)
      return size;
  // srun sets these of every task; a batch script that calls the program by itself has the first alone.
  return std::getenv("PMIX_RANK") || std::getenv("PMI_RANK") ? std::max(1, number_in("SLURM_STEP_NUM_TASKS"))
                                                             : 1;
}

std::string module_of_ranks() {
  return module_path().string();
}

void join_ranks() {
  const int started = processes_started();
  const std::filesystem::path path = module_path();
  if (path.empty())
    throw std::runtime_error(fmt::format("this is one of {} processes, and the program was built without "
                                         "MPI: install libopenmpi-dev and build it "
                                         "again, or run it by itself",
                                         started));
  // Open MPI loads parts of itself that look for its symbols among those of the program.
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!module)
    throw std::runtime_error(fmt::format("cannot load {}: {}", path.filename().string(), dlerror()));
  const auto* const declaration = static_cast<const char*>(dlsym(module, "cdem_declaration_of_ranks"));
  auto* const join = reinterpret_cast<Ranks* (*)()>(dlsym(module, "cdem_join_ranks"));
  if (!join || !declaration || std::strcmp(declaration, CDEM_DECLARATION_OF_RANKS) != 0)
    throw std::runtime_error(
        fmt::format("{} is of another build than this program: build or install both anew", path.string()));
  // Large arrays have pages of their own, so that what a rank frees or does not need goes back to the system.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 8 << 20);
  joined().reset(join());
  if (const int size = joined()->size(); size != started) {
    joined().reset();
    throw std::runtime_error(fmt::format(
        "started as one of {} processes, but MPI knows of {}: mpirun is of another MPI than cdem, which uses "
        "that of its machine's package libopenmpi3",
        started, size));
  }
}

void leave_ranks() {
  joined().reset();
}

} // namespace cdem
