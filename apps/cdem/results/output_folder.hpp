// The folder a run writes into, and its log cdem.log.
//
// The user's files are never lost: a folder that holds files but no cdem.log is refused. The results of the last run
// stay until this run begins to produce its own. So a script with a typo does not delete them; its log is then
// failed.log. Exactly the files that the last run wrote are deleted, by the list in its log. A file that was edited
// since is kept under another name.
#pragma once

#include "apps/cdem/process/exit_code.hpp"
#include "apps/cdem/results/run_log.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace cdem::app {

// Name of the case: the script's folder, with "-script" unless the script is case.lua, with "-name=value,..."
// of the settings. Characters that do not belong into a file name become "_", and then a short hash keeps
// cases apart.
std::string case_name(const std::filesystem::path& script,
                      const std::map<std::string, std::string>& settings);

class OutputFolder {
public:
  enum class Start { anew, goes_on }; // goes_on: with the results and the log that are there
  // Makes the folder, locks it and opens the log. command: for the log's head. source: holds the script's text; empty:
  // the script itself. Throws script::FileError.
  OutputFolder(std::filesystem::path folder, const std::filesystem::path& script, const std::string& command,
               Start = Start::anew, const std::filesystem::path& source = {});
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  bool begun() const { return begun_; }
  std::uint64_t run() const { return run_; } // its number, which no other run has; one that goes on keeps it

  void log(const std::string& text); // with the seconds since the start in front of each line

  // From here on the folder is this run's: the old files go, the script's copy comes. Does nothing the second
  // time.
  void begin_results();

  // Before a file is written: the results begin, and the file goes on the list.
  void will_write(const std::filesystem::path& file);

  // Writes the list of files and the end line. A resumed run that has ended well takes the last good states away that
  // the stopped one left. A run that bad input ended before it said or made anything leaves
  // no folder that it had to make. Throws script::FileError when the log could not be written
  // whole.
  void finish(ExitCode, const std::string& error);

private:
  void require_log_in_place() const;
  void open_log(const std::filesystem::path&, const std::string& command);
  void go_on(const std::string& command);
  void write_to_log(const std::string& text);
  void write_script(); // a copy of it
  void take_away();
  void remove_last_states();
  void remove_old_results();

  std::filesystem::path folder_, script_, log_path_;
  std::string script_text_;             // as it was at the start: the copy shows what ran
  std::set<std::string> written_;       // relative to the folder
  std::vector<LoggedFile> last_states_; // of the run that this one goes on from
  // Guards the log and the lists: if the run does not return, another thread closes the log.
  mutable std::recursive_mutex one_at_a_time_;
  int lock_ = -1;
  std::uint64_t run_ = 0;
  std::FILE* log_ = nullptr;
  bool old_results_ = false, begun_ = false, has_said_ = false;
  std::filesystem::path first_made_; // outermost folder that was made for this run; empty: none
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace cdem::app
