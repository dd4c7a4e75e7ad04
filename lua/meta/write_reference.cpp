// write_reference ANNOTATIONS PAGE: the two texts that are generated from the binding's declarations.
#include "lua/binding/module/topics.hpp"

#include <cstdio>
#include <fstream>

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: write_reference ANNOTATIONS.lua PAGE.md\n");
    return 1;
  }
  std::ofstream annotations(arguments[1]), page(arguments[2]);
  annotations << cdem::script::annotations();
  page << cdem::script::reference();
  annotations.close();
  page.close();
  if (!annotations || !page) {
    std::fprintf(stderr, "write_reference: cannot write %s or %s\n", arguments[1], arguments[2]);
    return 1;
  }
}
