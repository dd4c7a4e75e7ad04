#include "apps/cdem/process/memory.hpp"

#include "apps/cdem/process/failure.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

#include <sys/resource.h>
#include <unistd.h>

namespace cdem::app {

namespace {

constexpr double usual_share = 0.9; // the rest is for the system

// The limit of a container, from either version of control groups; the largest number where there is none.
std::size_t container_memory() {
  auto most = std::numeric_limits<std::size_t>::max();
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::size_t bytes = 0;
    if (std::ifstream(file) >> bytes && bytes > 0)
      most = std::min(most, bytes);
  }
  return most;
}

// Bytes of this process that are its own and can be written, as the kernel counts them against the limit.
std::size_t held() {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;)
    if (std::size_t kilobytes = 0; word == "VmData:" && in >> kilobytes)
      return kilobytes << 10;
  return 0;
}

} // namespace

std::size_t machine_memory() {
  const auto pages = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES));
  return std::min(pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)), container_memory());
}

std::size_t memory_value(const std::string& option, const std::string& text) {
  static const std::string units = "KMGT";
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  double bytes = number;
  if (const auto unit = units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(*end))));
      *end != '\0' && unit != std::string::npos) {
    bytes = std::ldexp(number, 10 * (static_cast<int>(unit) + 1));
    ++end;
  }
  constexpr double most = 1e15;
  if (text.empty() || *end != '\0' || !(bytes >= static_cast<double>(least_memory)) || !(bytes <= most))
    throw UsageError(option + " = " + (text.empty() ? "\"\"" : text) +
                     ": must be at least 64M, as in 800M, 12G or 1.5T (or plain bytes)");
  return static_cast<std::size_t>(bytes);
}

std::size_t limit_memory(std::size_t bytes, int sharing) {
  if (bytes == 0)
    bytes = static_cast<std::size_t>(usual_share * static_cast<double>(machine_memory()));
  bytes = std::max(least_memory, bytes / static_cast<std::size_t>(sharing));
  rlimit data{};
  getrlimit(RLIMIT_DATA, &data);
  const rlim_t before = held();
  if (data.rlim_cur != RLIM_INFINITY && data.rlim_cur <= before + bytes)
    return data.rlim_cur > before ? data.rlim_cur - before : bytes;
  data.rlim_cur = before + bytes;
  setrlimit(RLIMIT_DATA, &data);
  return bytes;
}

} // namespace cdem::app
