// Ctrl-C and SIGTERM. The first asks the run to stop at the next whole step; a second one ends the program at once.
//
// Some calls of a script cannot check for the request to stop: patterns of strings, table.move, a builder. So a second
// thread runs. If the run has not reacted to the first signal after some time, this thread closes the log and ends the
// program, with all its ranks. It waits until a stage has finished its step and the solved state is saved, however long
// this takes.
#pragma once

#include "apps/cdem/process/exit_code.hpp"
#include "libcdem/step/observer.hpp"

#include <functional>
#include <string>

namespace cdem::app::interrupt {

void install();   // handlers of SIGINT and SIGTERM, and the thread that waits
bool requested(); // a signal has come; does not return once the waiting thread ends the program
// The same of several ranks, which all ask at the same place: one of them has been told to stop. Rank 0 alone, where it
// works for all.
bool requested_of_any();
void join_ranks();    // SIGUSR1, which mpirun and Slurm pass on, asks to stop too; the waiting is rank 0's
void with_parent();   // SIGTERM comes when the program that started this one ends, as by kill -9
void clear();         // forget it (the next line of the repl)
ExitCode exit_code(); // interrupted or terminated

Activity doing(Activity); // what the run is about from now on; gives back what it was before
void finished();          // the run has come to its end by itself: nothing is waited for any more

// What the waiting thread does before it ends the program, innermost first: `line` is what the user will be told.
class WhenStuck {
public:
  explicit WhenStuck(std::function<void(ExitCode, std::string& line)>);
  ~WhenStuck();
  WhenStuck(const WhenStuck&) = delete;
  WhenStuck& operator=(const WhenStuck&) = delete;
};

// Ends the program after what WhenStuck says, from any thread: for a failure that cannot be thrown.
[[noreturn]] void end_now(ExitCode, std::string line);

} // namespace cdem::app::interrupt
