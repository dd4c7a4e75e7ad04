#include "libgeom/core/stop.hpp"

#include <utility>

namespace geom {
namespace {

std::function<bool()>& stop_check() {
  static std::function<bool()> wanted;
  return wanted;
}

} // namespace

void set_stop_check(std::function<bool()> wanted) {
  stop_check() = std::move(wanted);
}

void throw_if_stopped() {
  if (stop_check() && stop_check()())
    throw Stopped();
}

} // namespace geom
