#include "apps/cdem/process/terminal.hpp"

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

std::string with_tone(const std::string& line, Tone tone) {
  const char* const none = std::getenv("NO_COLOR");
  const std::string word = tone == Tone::error ? "error:" : "warning:";
  const auto at = line.find(word);
  if (!is_live_terminal() || isatty(STDERR_FILENO) != 1 || (none != nullptr && *none != '\0') ||
      at == std::string::npos)
    return line;
  const std::string colour = tone == Tone::error ? "\033[1;31m" : "\033[1;33m";
  return line.substr(0, at) + colour + word + "\033[0m" + line.substr(at + word.size());
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
