// Ctrl-C and SIGTERM: the first asks the run to stop at the next whole step, a second one ends the program at
// once.
#pragma once

#include "apps/cdem/exit_code.hpp"

namespace cdem::app::interrupt {

void install();       // handlers of SIGINT and SIGTERM
bool requested();     // a signal has come
void with_parent();   // SIGTERM comes when the program that started this one ends, as by kill -9
void clear();         // forget it (the next line of the repl)
ExitCode exit_code(); // interrupted or terminated

} // namespace cdem::app::interrupt
