// Tells long work in libgeom that the user has asked to stop.
#pragma once

#include <exception>
#include <functional>

namespace geom {

// The user has asked to stop; nothing is wrong.
class Stopped : public std::exception {
public:
  const char* what() const noexcept override { return "stopped by the user"; }
};

// Asked every tenth of a second or so by work that takes long, from the thread that started it. Empty: never.
void set_stop_check(std::function<bool()> wanted);

void throw_if_stopped(); // Stopped

} // namespace geom
