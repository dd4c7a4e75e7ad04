#include "apps/cdem/process/rank.hpp"

#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/standard_files.hpp"
#include "apps/cdem/text/text.hpp"
#include "libcdem/checkpoint/xxh64.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libgeom/core/error.hpp"
#include "lua/binding/replay/led.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <new>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cdem::app {

namespace {

using std::chrono::seconds;

constexpr seconds rank_0_speaks_in{1};
constexpr unsigned abort_takes = 3; // s

int starter = -1;                 // socket to who started us by --ranks
int users_stderr = STDERR_FILENO; // of ranks that print nothing
std::chrono::steady_clock::time_point joined_at;
std::atomic<bool> known_to_all{false}; // that this rank has failed
volatile std::sig_atomic_t code_if_stuck = 0;
// Given up where memory is short, for what ends the program; in pieces that the heap keeps.
std::vector<std::string> reserve;
constexpr std::size_t reserve_pieces = 32, reserve_piece = 65536; // bytes

// The rank has not joined yet.
int rank_by_starter() {
  for (const char* const variable : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (const char* const text = std::getenv(variable))
      return std::atoi(text);
  return 0;
}

void print_nothing() {
  users_stderr = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    dup2(nothing, file);
  close(nothing);
}

extern "C" void end_if_stuck(int) {
  _exit(code_if_stuck);
}

// A rank that fails within a step cannot tell the others.
void end_for_want_of_memory() {
  reserve.clear();
  if (!script::with_others())
    throw std::bad_alloc();
  std::set_new_handler(nullptr);
  interrupt::end_now(ExitCode::bad_input, not_enough_memory);
}

std::string hash_of_program() {
  std::ifstream in("/proc/self/exe", std::ios::binary);
  Xxh64 sum;
  std::vector<char> part(std::size_t{1} << 20);
  while (in.read(part.data(), static_cast<std::streamsize>(part.size())) || in.gcount() > 0)
    sum.add(part.data(), static_cast<std::size_t>(in.gcount()));
  return version() + " " + std::to_string(sum.value());
}

std::string host_name() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return host.data();
}

} // namespace

void join_other_ranks(int argc, const char* const* argv) {
  if (processes_started() == 1)
    return;
  const bool first = rank_by_starter() == 0;
  if (first)
    starter = take_standard_files();
  if (!first)
    print_nothing();
  setenv("OMPI_MCA_mpi_warn_on_fork", "0", 0); // geometry is made in child processes, which do not use MPI
  try {
    join_ranks();
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
  joined_at = std::chrono::steady_clock::now();
  interrupt::join_ranks();
  reserve.assign(reserve_pieces, std::string(reserve_piece, ' '));
  std::set_new_handler(end_for_want_of_memory);
  script::require_same("the program", hash_of_program());
  std::string line;
  for (int i = 1; i < argc; ++i)
    line += std::string(argv[i]) + '\0';
  script::require_same("the command line", line);
}

int leave_other_ranks(int exit_code) {
  const bool told = !ranks().alone() && std::getenv(starter_variable) != nullptr;
  if (ranks().leads())
    tell_starter(exit_code);
  leave_ranks();
  return told ? 0 : exit_code;
}

Failure failure_of_all(const Failure& failure) {
  if (ranks().alone() || known_to_all.exchange(true))
    return failure;
  if (!ranks().all_fail(Ranks::patience))
    interrupt::end_now(failure.code, failure.line);
  Failure first = failure;
  first.code = static_cast<ExitCode>(std::stoi(ranks().gather(std::to_string(to_int(failure.code))).front()));
  return first;
}

void end_all_ranks(int exit_code) {
  if (ranks().leads())
    tell_starter(exit_code);
  if (ranks().alone())
    _exit(exit_code);
  code_if_stuck = exit_code; // where MPI itself is
  std::signal(SIGALRM, end_if_stuck);
  alarm(abort_takes);
  ranks().abort(exit_code);
  _exit(exit_code);
}

void say_as_rank(const std::string& text) {
  std::string said = text;
  if (!ranks().leads()) {
    std::this_thread::sleep_for(rank_0_speaks_in);
    said = "cdem: error: rank " + std::to_string(ranks().rank()) +
           said.substr(said.find_first_of(':', said.find("error")));
  }
  [[maybe_unused]] const auto written =
      write(ranks().leads() ? STDERR_FILENO : users_stderr, said.data(), said.size());
}

void tell_starter(int exit_code) {
  if (starter < 0)
    return;
  const auto code = static_cast<unsigned char>(exit_code);
  [[maybe_unused]] const auto sent = send(starter, &code, 1, MSG_NOSIGNAL);
}

bool stdout_is_users() {
  return ranks().alone() || starter >= 0;
}

int ranks_on_these_cores() {
  if (ranks().alone())
    return 1;
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof cores, &cores);
  const std::string mine =
      host_name() + '\0' + std::string(reinterpret_cast<const char*>(&cores), sizeof cores);
  int same = 0;
  for (const std::string& place : ranks().gather(mine))
    same += place == mine ? 1 : 0;
  return same;
}

std::string ranks_text(int threads) {
  const std::string text = geom::counted(threads, "thread");
  return ranks().alone() ? text : std::to_string(ranks().size()) + " ranks of " + text;
}

std::vector<RankLoad> loads_of_ranks() {
  if (ranks().alone())
    return {};
  const Ranks::Traffic& mine = ranks().traffic();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - joined_at;
  std::ostringstream told;
  told.precision(17);
  told << host_name() << ' ' << mine.messages << ' ' << mine.bytes << ' ' << mine.waited << ' '
       << passed.count();
  std::vector<RankLoad> all;
  for (const std::string& text : ranks().gather(told.str())) {
    RankLoad load;
    std::istringstream(text) >> load.host >> load.messages >> load.bytes >> load.waited >> load.passed;
    all.push_back(load);
  }
  return all;
}

std::string load_text(int rank, const RankLoad& load) {
  const double share = load.passed > 0 ? load.waited / load.passed : 0;
  return "rank " + std::to_string(rank) + " on " + load.host + ": " + count_text(load.messages) +
         " messages of " + number_text(1e-6 * static_cast<double>(load.bytes)) + " MB in all, waited " +
         std::to_string(std::lround(100 * share)) + " % of " + duration_text(load.passed);
}

} // namespace cdem::app
