// This process as one of several ranks (libcdem/ranks/ranks.hpp). Rank 0 alone prints; an error that all have is told
// once, one that a rank has alone ends all of them.
#pragma once

#include "apps/cdem/process/failure.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace cdem::app {

// Joins the others where mpirun, srun or `cdem run --ranks` has started several, with the same program and the same command
// line. Throws UsageError, geom::InputError.
void join_other_ranks(int argc, const char* const* argv);
// At the end of the program, with its exit code. Gives back what the process ends with: for the starter of --ranks, who
// is told, 0, since mpirun takes a second to end what has failed.
int leave_other_ranks(int exit_code);

// All ranks have failed, and this is what rank 0 ends with; or this one has failed alone, and after some seconds ends all.
Failure failure_of_all(const Failure&);

// Ends the process and all other ranks, from any thread.
[[noreturn]] void end_all_ranks(int exit_code);
// The same once `line` has been written to the user's stderr: by rank 0 as it stands, by another only where rank 0 does
// not come to say the same.
void say_as_rank(const std::string& text);

// Tells who started the ranks with --ranks how rank 0 ends. May be called from a signal handler.
void tell_starter(int exit_code);

// stdout is the user's, and no pipe of mpirun's, which looks like a terminal whatever lies behind it.
bool stdout_is_users();

// Ranks that share the cores of this process.
int ranks_on_these_cores();

std::string ranks_text(int threads); // "2 ranks of 4 threads", "1 thread"

// What each rank has sent to the others, and how long it has waited for them, by rank; empty of one alone.
struct RankLoad {
  std::string host;
  std::int64_t messages = 0, bytes = 0;
  double waited = 0, passed = 0; // s
};
std::vector<RankLoad> loads_of_ranks(); // all ranks come to it
std::string load_text(int rank, const RankLoad&);

} // namespace cdem::app
