// What cdem.log says about the files of its run:
//
//     cdem log 1: cdem 0.1.0 (Release, GNU 12.2.0), cdem run examples/uniaxial_compression/case.lua
//     started 2025-01-31 12:00:00 +0100
//     run 8f14e45fceea167a                           a number that its checkpoints have too
//     [     0.012] writes case.lua
//     file 1234 1769857200000000000 case.lua         size in bytes, stamp of its last change, name
//     ended with exit code 0, 2025-01-31 12:00:40 +0100
//
// A run that was killed has no "file" and "ended" lines: then the "writes" lines count. One that goes on from a
// checkpoint adds to the log of the first, after a line
//     resumed cdem 0.1.0 (Release, GNU 12.2.0), cdem resume results/plate, 2025-01-31 12:01:00 +0100
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cdem::app {

constexpr const char* run_log_name = "cdem.log";
constexpr const char* run_log_head = "cdem log 1: ";
constexpr const char* run_log_resumed = "resumed ";
constexpr const char* run_log_writes = "writes ";
constexpr const char* run_log_run = "run "; // a number that no other run has; its checkpoints have it too
constexpr const char* run_log_end = "ended with exit code ";

bool is_run_log(const std::filesystem::path&);

// The number of its run; 0: it says none.
std::uint64_t run_of_log(const std::filesystem::path&);

struct LoggedFile {
  std::string name; // relative to the folder
  std::uintmax_t bytes = 0;
  long long stamp = 0;     // of its last change, the file system's count
  bool known = false;      // bytes and stamp are; otherwise the run was killed and
  long long log_stamp = 0; // this is the last sign of it
};
std::vector<LoggedFile> files_of_run_log(const std::filesystem::path& log);

// The file is as its run left it.
bool is_unchanged(const std::filesystem::path& file, const LoggedFile&);

// "file ..." for one that exists, else "".
std::string run_log_file_line(const std::filesystem::path& folder, const std::string& name);

struct RunLogSummary {
  std::string command, started;
  std::optional<int> exit_code; // none: still running, or killed
  std::string error;            // the first line of what it ended with
  int warnings = 0;
};
RunLogSummary summary_of_run_log(const std::filesystem::path& log);

} // namespace cdem::app
