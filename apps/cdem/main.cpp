#include "apps/cdem/program.hpp"

int main(int argc, char** argv) {
  return cdem::app::run_program(argc, argv);
}
