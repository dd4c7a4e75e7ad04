#include "apps/cdem/results/run_log.hpp"

#include "lua/binding/runtime/engine.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

const std::string head = run_log_head, writes = run_log_writes, ended = run_log_end,
                  resumed = run_log_resumed;

bool starts_with(const std::string& line, const std::string& start) {
  return line.compare(0, start.size(), start) == 0;
}

long long stamp_of(const fs::path& file) {
  std::error_code none;
  return static_cast<long long>(fs::last_write_time(file, none).time_since_epoch().count());
}

// The text behind "[    12.345] ", or "" for another line.
std::string message_of(const std::string& line) {
  const auto end = starts_with(line, "[") ? line.find("] ") : std::string::npos;
  return end == std::string::npos ? std::string() : line.substr(end + 2);
}

} // namespace

bool is_run_log(const fs::path& log) {
  std::error_code none;
  if (std::filesystem::exists(log, none) && !std::filesystem::is_regular_file(log, none))
    return false;
  errno = 0;
  std::ifstream in(log);
  if (!in && errno == EACCES)
    throw script::FileError(log.string() + " cannot be read: " + std::strerror(errno));
  std::string line;
  return std::getline(in, line) && starts_with(line, head);
}

std::uint64_t run_of_log(const fs::path& log) {
  const std::string start = run_log_run;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);)
    if (starts_with(line, start))
      return std::strtoull(line.c_str() + start.size(), nullptr, 16);
  return 0;
}

std::vector<LoggedFile> files_of_run_log(const fs::path& log) {
  std::vector<LoggedFile> listed;
  std::set<std::string> announced;
  bool has_ended = false;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    if (const std::string message = message_of(line); starts_with(message, writes))
      announced.insert(message.substr(writes.size()));
    has_ended = has_ended || starts_with(line, ended);
    if (starts_with(line, resumed)) { // what the run before says of its files no longer holds
      has_ended = false;
      for (const LoggedFile& file : listed)
        announced.insert(file.name);
      listed.clear();
    }
    std::istringstream words(line);
    std::string keyword;
    LoggedFile file;
    if (starts_with(line, "file ") && words >> keyword >> file.bytes >> file.stamp &&
        std::getline(words >> std::ws, file.name)) {
      file.known = true;
      listed.push_back(file);
    }
  }
  if (has_ended)
    return listed;
  listed.clear();
  for (const auto& name : announced) {
    LoggedFile file;
    file.name = name;
    file.log_stamp = stamp_of(log);
    listed.push_back(file);
  }
  return listed;
}

bool is_unchanged(const fs::path& file, const LoggedFile& listed) {
  std::error_code none;
  return listed.known ? fs::file_size(file, none) == listed.bytes && stamp_of(file) == listed.stamp
                      : stamp_of(file) <= listed.log_stamp;
}

std::string run_log_file_line(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const auto bytes = fs::file_size(folder / name, error);
  if (error)
    return "";
  return "file " + std::to_string(bytes) + " " + std::to_string(stamp_of(folder / name)) + " " + name + "\n";
}

RunLogSummary summary_of_run_log(const fs::path& log) {
  const std::string started = "started ", error = "error: ";
  RunLogSummary summary;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    if (starts_with(line, head))
      summary.command = line.substr(head.size());
    else if (starts_with(line, started))
      summary.started = line.substr(started.size());
    else if (starts_with(line, resumed)) {
      summary.exit_code.reset();
      summary.error.clear();
    } else if (starts_with(line, ended))
      summary.exit_code = std::atoi(line.c_str() + ended.size());
    else if (const std::string message = message_of(line);
             starts_with(message, error) && summary.error.empty())
      summary.error = message.substr(error.size());
    else if (message.find(": warning: ") != std::string::npos || starts_with(message, "warning: "))
      ++summary.warnings;
  }
  return summary;
}

} // namespace cdem::app
