// Pages of arrays that are given back read as zeros, whatever stood behind them before.
#include "libcdem/parallel/pages.hpp"
#include "libcdem/parallel/residency.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

TEST_CASE("memory that is given back reads as zeros, also where a file was once mapped") {
  const std::size_t page = cdem::page_size(), pages = 8;
  std::vector<char> memory(pages * page, 'm');
  const cdem::Pages whole(memory.data(), 0, static_cast<std::int64_t>(memory.size()));
  std::string path = "/tmp/cdem_residency_XXXXXX";
  const int file = mkstemp(path.data());
  REQUIRE(file >= 0);
  unlink(path.c_str());
  const std::string content(whole.size(), 'f');
  REQUIRE(write(file, content.data(), content.size()) == static_cast<ssize_t>(content.size()));
  REQUIRE(mmap(whole.data(), whole.size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_FIXED, file, 0) !=
          MAP_FAILED);
  close(file);
  CHECK(whole.data()[page] == 'f');
  // An array that uses this memory anew.
  std::fill(memory.begin(), memory.end(), '\0');
  const auto zeros = [&] { return std::all_of(memory.begin(), memory.end(), [](char c) { return c == 0; }); };

  SECTION("zeros stay zeros") {
    cdem::release_zeros(memory);
    CHECK(zeros());
  }
  SECTION("the pages of others become zeros, the own ones stay") {
    std::fill(memory.begin(), memory.end(), 'n');
    const auto size = static_cast<std::int64_t>(page);
    const std::int64_t first = whole.data() - memory.data();
    cdem::release_outside(memory, {{first + size, first + 2 * size}});
    CHECK(std::all_of(whole.data(), whole.data() + page, [](char c) { return c == 0; }));
    CHECK(std::all_of(whole.data() + page, whole.data() + 2 * page, [](char c) { return c == 'n'; }));
    CHECK(std::all_of(whole.data() + 2 * page, whole.data() + whole.size(), [](char c) { return c == 0; }));
  }
}
