// write_reference PAGE: the reference page, generated from the binding's declarations.
#include "lua/binding/module/topics.hpp"

#include <cstdio>
#include <fstream>

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: write_reference PAGE.md\n");
    return 1;
  }
  std::ofstream page(arguments[1]);
  page << cdem::script::reference();
  page.close();
  if (!page) {
    std::fprintf(stderr, "write_reference: cannot write %s\n", arguments[1]);
    return 1;
  }
}
