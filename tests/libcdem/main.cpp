// Started by mpirun the tests are run by all ranks together, which then solve every model of them as one. Each says what
// it finds wrong.
#include "libcdem/ranks/ranks.hpp"

#include <cstdio>

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

int main(int argc, char** argv) {
  if (cdem::processes_started() > 1)
    cdem::join_ranks();
  const int failed = Catch::Session().run(argc, argv);
  cdem::leave_ranks();
  return failed;
}
