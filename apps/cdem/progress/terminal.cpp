#include "apps/cdem/progress/terminal.hpp"

#include <cmath>
#include <cstdlib>
#include <sys/ioctl.h>
#include <unistd.h>

namespace cdem::app {

namespace {

winsize window() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0)
    size = {};
  return size;
}

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  const int value = text != nullptr ? std::atoi(text) : 0;
  return value > 0 ? value : otherwise;
}

} // namespace

bool is_live_terminal() {
  const char* kind = std::getenv("TERM");
  return isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::string(kind) != "dumb";
}

int terminal_columns() {
  const int columns = window().ws_col;
  return columns > 0 ? columns : from_environment("COLUMNS", 80);
}

int terminal_rows() {
  const int rows = window().ws_row;
  return rows > 0 ? rows : from_environment("LINES", 24);
}

std::string bar_text(double fraction, int width) {
  const int filled = static_cast<int>(std::lround(fraction * width));
  std::string bar(static_cast<std::size_t>(filled), '=');
  bar.resize(static_cast<std::size_t>(width), ' ');
  if (filled > 0 && filled < width)
    bar[static_cast<std::size_t>(filled)] = '>';
  return "[" + bar + "]";
}

} // namespace cdem::app
