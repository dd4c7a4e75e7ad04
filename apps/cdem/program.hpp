// The whole program: reads the command line, runs one command, turns what it throws into one line and an exit
// code.
#pragma once

namespace cdem::app {

int run_program(int argc, char** argv);

} // namespace cdem::app
