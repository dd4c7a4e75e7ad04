// fuzz_corpus TARGET FOLDER RUNS: every file of the folder, then so many changes of them, the same in every run; for
// ctest, where no libFuzzer is. What crashes ends the program: the change is printed before it is tried with -v.
#include "tests/fuzz/targets.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

namespace {

std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> all;
  for (const auto& path : paths) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    all.push_back(text.str());
  }
  return all;
}

// One to four changes of bytes, pieces and lengths.
std::string changed(std::string bytes, const std::vector<std::string>& all, std::mt19937_64& random) {
  static const char special[] = {0, 1, -1, 127, -128, '0', '9', '-', 'e', '\n', ' ', '"'};
  for (auto n = random() % 4 + 1; n > 0; --n) {
    const std::size_t at = bytes.empty() ? 0 : random() % bytes.size();
    switch (random() % 6) {
    case 0:
      if (!bytes.empty())
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      break;
    case 1:
      if (!bytes.empty())
        bytes[at] = special[random() % sizeof special];
      break;
    case 2:
      bytes.insert(at, random() % 8 + 1, special[random() % sizeof special]);
      break;
    case 3:
      bytes.erase(at, random() % 16 + 1);
      break;
    case 4: {
      const std::uint64_t number = random() % 2 == 0 ? ~std::uint64_t{0} : random() >> random() % 64;
      const std::size_t size = std::min<std::size_t>(random() % 2 == 0 ? 4 : 8, bytes.size() - at);
      if (size > 0)
        std::memcpy(&bytes[at], &number, size);
      break;
    }
    default: {
      const std::string& other = all[random() % all.size()];
      const std::size_t from = other.empty() ? 0 : random() % other.size();
      bytes.insert(at, other.substr(from, random() % 64));
    }
    }
  }
  return bytes;
}

} // namespace

int main(int argc, char** argv) {
  const bool shows = argc == 5 && std::strcmp(argv[4], "-v") == 0;
  const auto target = argc >= 4 ? fuzz::targets().find(argv[1]) : fuzz::targets().end();
  if (target == fuzz::targets().end()) {
    std::fputs("usage: fuzz_corpus TARGET FOLDER RUNS [-v]\n", stderr);
    return 2;
  }
  const std::vector<std::string> all = files_of(argv[2]);
  if (all.empty()) {
    std::fprintf(stderr, "%s: no files\n", argv[2]);
    return 2;
  }
  std::mt19937_64 random(7);
  for (const std::string& bytes : all)
    fuzz::run(target->second, bytes);
  const long runs = std::strtol(argv[3], nullptr, 10);
  for (long i = 0; i < runs; ++i) {
    const std::string bytes = changed(all[random() % all.size()], all, random);
    if (shows)
      std::ofstream("fuzz_last", std::ios::binary) << bytes;
    fuzz::run(target->second, bytes);
  }
  std::printf("%zu files and %ld changes of them\n", all.size(), runs);
  return 0;
}
