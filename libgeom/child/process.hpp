// Work in a child process: a copy of this process (fork) does the work, returns its result as bytes over a pipe, and
// ends. A crash, an abort or a limit ends only the child, and becomes one InputError here.
//
// A separate program would have to be found and started (0.3 s for the libraries of gmsh), and would need all arguments
// as bytes; a copy has them. Only the calling thread lives on in a copy, so the work must not wait for another thread:
// it runs with one OpenMP thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace geom {

struct ChildLimits {
  std::uint64_t memory =
      0;                // bytes beyond what the process holds when the work begins; 0: no limit of its own
  unsigned seconds = 0; // of processor time; 0: no limit
  std::string blame = "the geometry kernel cannot do it"; // what a crash means for the user; follows "what: "
  std::string worker = "the geometry kernel";             // who crashed
};

// For a file that somebody else made: memory and time grow with its size.
ChildLimits limits_of_file(const std::string& path);

// The bytes that `work` returns. `what` begins the messages. Exceptions of the work arrive here as InputError,
// std::bad_alloc or std::runtime_error with the same text; a crash or a limit as InputError. Throws Stopped when the
// user asks to stop meanwhile (core/stop.hpp): the child is ended then.
std::string run_in_child(const std::string& what, const ChildLimits& limits,
                         const std::function<std::string()>& work);

// If several processes reach the same work, one of them may do it and send the bytes of its result to the others.
// `share` receives the function that does the work here, and returns the result. Empty: every process does the work.
void set_sharing(std::function<std::string(const std::function<std::string()>&)> share);

} // namespace geom
