#include "libcdem/vtk/picture_room.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>

#include <sys/resource.h>

namespace cdem {
namespace {

// Measured with Mesa 22.3 (llvmpipe) and LLVM 15 on two cores: what the first picture takes whatever its size, and what
// each pixel takes of the largest so far. Address space counts libraries and what is set aside, data what can be written.
constexpr std::uint64_t mega = 1'000'000;
constexpr std::uint64_t first_address_space = 800 * mega, first_data = 100 * mega, per_pixel = 250;

struct Held {
  std::uint64_t address_space = 0, data = 0; // bytes
};

Held held() {
  Held now;
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == "VmSize:" && in >> kilobytes)
      now.address_space = 1024 * kilobytes;
    else if (word == "VmData:" && in >> kilobytes)
      now.data = 1024 * kilobytes;
  }
  return now;
}

void require(int resource, const char* option, std::uint64_t has, std::uint64_t needs) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return;
  const std::uint64_t left = limit.rlim_cur > has ? limit.rlim_cur - has : 0;
  if (left < needs)
    throw NoRoomForPicture("it needs about " + std::to_string(needs / mega) + " MB of memory and " + option +
                           " leaves " + std::to_string(left / mega) +
                           " MB; allow more, or draw fewer pixels");
}

bool is_first = true;
std::uint64_t kept = 0; // pixels: what was taken for them stays

} // namespace

void require_room_for_picture(const std::array<int, 2>& pixels) {
  const std::uint64_t wanted = static_cast<std::uint64_t>(pixels[0]) * static_cast<std::uint64_t>(pixels[1]);
  const std::uint64_t more = per_pixel * (wanted - std::min(wanted, kept));
  const Held now = held();
  require(RLIMIT_AS, "ulimit -v", now.address_space, more + (is_first ? first_address_space : 0));
  require(RLIMIT_DATA, "--memory", now.data, more + (is_first ? first_data : 0));
  is_first = false;
  kept = std::max(kept, wanted);
}

void forget_kept_pixels() {
  kept = 0;
}

} // namespace cdem
