// cdem_fuzz TARGET [options and folders of libFuzzer]; without a target it lists them.
#include "tests/fuzz/targets.hpp"

#include <cstdio>
#include <cstdlib>

namespace {

fuzz::Target chosen;

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const auto found = *argc > 1 ? fuzz::targets().find((*argv)[1]) : fuzz::targets().end();
  if (found == fuzz::targets().end()) {
    std::fputs("usage: cdem_fuzz TARGET [libFuzzer's options and folders]; targets:\n", stderr);
    for (const auto& [name, target] : fuzz::targets())
      std::fprintf(stderr, "  %s\n", name.c_str());
    std::exit(2);
  }
  chosen = found->second;
  for (int i = 1; i + 1 < *argc; ++i)
    (*argv)[i] = (*argv)[i + 1];
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::run(chosen, std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
