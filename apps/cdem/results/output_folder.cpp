#include "apps/cdem/results/output_folder.hpp"

#include "lua/binding/files/files.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <random>
#include <regex>
#include <sstream>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace cdem::app {

namespace fs = std::filesystem;
using script::FileError;

namespace {

constexpr const char* failed_log_name = "failed.log";
constexpr const char* settings_name = "settings.json";

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[64];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S %z", &local);
  return text;
}

std::uint64_t new_number() {
  std::random_device draw;
  return (std::uint64_t{draw()} << 32 | draw()) | 1; // 0 is no number
}

// What a run that was stopped or failed leaves of its models (script::Engine::model_saved_after_failure).
bool is_last_state(const std::string& name) {
  static const std::regex pattern("last_good(_[0-9]+)?(_bonds)?[.]vtu");
  return std::regex_match(name, pattern);
}

// The file as seen from the folder; empty when it lies outside.
fs::path place_below(const fs::path& file, const fs::path& folder) {
  const auto resolved = [](const fs::path& path) {
    std::error_code error; // of a folder without permission
    const fs::path place = fs::weakly_canonical(fs::absolute(path), error);
    return error ? fs::absolute(path).lexically_normal() : place;
  };
  const fs::path inner = resolved(file), outer = resolved(folder);
  const auto [end, rest] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  if (end != outer.end())
    return {};
  fs::path place;
  for (auto part = rest; part != inner.end(); ++part)
    place /= *part;
  return place;
}

// A free name beside the file: x.edited, x.edited.2, ...
fs::path free_name(const fs::path& file) {
  fs::path name = file.string() + ".edited";
  for (int i = 2; fs::exists(name); ++i)
    name = file.string() + ".edited." + std::to_string(i);
  return name;
}

std::string hash_text(const std::string& text) { // FNV-1a, six digits
  std::uint64_t hash = 14695981039346656037ull;
  for (const unsigned char c : text)
    hash = (hash ^ c) * 1099511628211ull;
  char digits[8];
  std::snprintf(digits, sizeof digits, "%06x", static_cast<unsigned>(hash >> 40));
  return digits;
}

std::string system_reason() {
  return std::strerror(errno);
}

} // namespace

std::string case_name(const fs::path& script, const std::map<std::string, std::string>& settings) {
  const fs::path file = fs::absolute(script).lexically_normal();
  std::string name = file.parent_path().filename().string();
  const std::string stem = file.stem().string();
  if (stem != "case" || name.empty())
    name += (name.empty() ? "" : "-") + stem;
  std::string separator = "-";
  for (const auto& [key, value] : settings) {
    name += separator + key + "=" + value;
    separator = ",";
  }
  constexpr std::size_t longest = 120; // file systems take 255 bytes
  std::string clean = name.substr(0, longest);
  for (char& c : clean)
    if (std::strchr("+-=.,_", c) == nullptr && !std::isalnum(static_cast<unsigned char>(c)))
      c = '_';
  if (clean.front() == '.')
    clean.front() = '_';
  return clean == name ? clean : clean + "-" + hash_text(name);
}

OutputFolder::OutputFolder(fs::path folder, const fs::path& script, const std::string& command, Start start,
                           const fs::path& source)
    : folder_(std::move(folder)), script_(script) {
  const std::string shown = folder_.string();
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_))
    throw FileError("output folder " + shown + " is a file; choose another with --output");
  if (!place_below(script_, folder_).empty())
    throw FileError("output folder " + shown + " holds the script itself; choose another with --output");
  script_text_ = script::read_file_here(source.empty() ? script_ : source);
  for (fs::path made = fs::absolute(folder_).lexically_normal();
       !made.empty() && !fs::exists(made, error) && made != made.parent_path(); made = made.parent_path())
    first_made_ = made;
  fs::create_directories(folder_, error);
  if (error)
    throw FileError("output folder " + shown + " cannot be made: " + error.message());
  old_results_ = is_run_log(folder_ / run_log_name);
  if (!old_results_ && !fs::is_empty(folder_))
    throw FileError("output folder " + shown +
                    " holds files that are not results of cdem; choose another with --output, or empty it");
  lock_ = open(shown.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    throw FileError("output folder " + shown + " is in use by another run; choose another with --output");
  }
  if (start == Start::goes_on && old_results_)
    go_on(command);
  else
    open_log(folder_ / (old_results_ ? failed_log_name : run_log_name), command);
  if (!old_results_)
    begin_results();
}

OutputFolder::~OutputFolder() {
  if (log_ != nullptr)
    std::fclose(log_);
  if (lock_ >= 0)
    close(lock_);
}

void OutputFolder::open_log(const fs::path& file, const std::string& command) {
  log_ = std::fopen(file.c_str(), "we");
  if (log_ == nullptr)
    throw FileError(file.string() + " cannot be written: " + system_reason());
  log_path_ = file;
  run_ = new_number();
  std::fprintf(log_, "%s%s\nstarted %s\n%s%016llx\n", run_log_head, command.c_str(), date_now().c_str(),
               run_log_run, static_cast<unsigned long long>(run_));
  std::fflush(log_);
}

void OutputFolder::go_on(const std::string& command) {
  log_path_ = folder_ / run_log_name;
  run_ = run_of_log(log_path_);
  for (const auto& listed : files_of_run_log(log_path_)) {
    written_.insert(listed.name);
    if (is_last_state(listed.name) && is_unchanged(folder_ / listed.name, listed))
      last_states_.push_back(listed);
  }
  log_ = std::fopen(log_path_.c_str(), "ae");
  if (log_ == nullptr)
    throw FileError(log_path_.string() + " cannot be written: " + system_reason());
  std::fprintf(log_, "%s%s, %s\n", run_log_resumed, command.c_str(), date_now().c_str());
  std::fflush(log_);
  begun_ = has_said_ = true;
  write_script(); // mended, perhaps, after the error that ended the run
}

void OutputFolder::write_script() {
  const fs::path copy = folder_ / script_.filename();
  will_write(copy);
  std::ofstream out(copy, std::ios::binary);
  if (!out.write(script_text_.data(), static_cast<std::streamsize>(script_text_.size())).flush())
    throw FileError(copy.string() + " cannot be written: " + system_reason());
}

void OutputFolder::log(const std::string& text) {
  const std::lock_guard<std::recursive_mutex> lock(one_at_a_time_);
  has_said_ = true;
  write_to_log(text);
}

void OutputFolder::write_to_log(const std::string& text) {
  if (log_ == nullptr)
    return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    std::fprintf(log_, "[%10.3f] %s\n", elapsed.count(), line.c_str());
  std::fflush(log_); // a run that is killed leaves what it said
}

void OutputFolder::begin_results() {
  const std::lock_guard<std::recursive_mutex> lock(one_at_a_time_);
  if (begun_)
    return;
  begun_ = true;
  if (old_results_) {
    remove_old_results();
    std::error_code error;
    fs::rename(log_path_, folder_ / run_log_name, error);
    if (error)
      throw FileError((folder_ / run_log_name).string() + " cannot be written: " + error.message());
    log_path_ = folder_ / run_log_name;
  }
  write_script();
}

void OutputFolder::will_write(const fs::path& file) {
  const std::lock_guard<std::recursive_mutex> lock(one_at_a_time_);
  begin_results();
  const std::string name = place_below(file, folder_).string();
  // --unsafe may write elsewhere; a line feed would break the list.
  if (!name.empty() && name.find('\n') == std::string::npos && written_.insert(name).second)
    write_to_log(run_log_writes + name);
}

void OutputFolder::remove_old_results() {
  std::set<fs::path> parents;
  for (const auto& listed : files_of_run_log(folder_ / run_log_name)) {
    const fs::path file = folder_ / listed.name;
    std::error_code error;
    if (place_below(file, folder_).empty() || !fs::is_regular_file(file, error))
      continue;
    if (is_unchanged(file, listed)) {
      fs::remove(file, error);
    } else {
      const fs::path kept = free_name(file);
      fs::rename(file, kept, error);
      log("kept " + listed.name + ", which was edited since the last run, as " + kept.filename().string());
    }
    for (fs::path parent = fs::path(listed.name).parent_path(); !parent.empty();
         parent = parent.parent_path())
      parents.insert(parent);
  }
  // Deepest first; remove() leaves a folder that is not empty.
  for (auto parent = parents.rbegin(); parent != parents.rend(); ++parent) {
    std::error_code not_empty;
    fs::remove(folder_ / *parent, not_empty);
  }
}

void OutputFolder::remove_last_states() {
  for (const LoggedFile& listed : last_states_) {
    std::error_code none;
    if (is_unchanged(folder_ / listed.name, listed))
      fs::remove(folder_ / listed.name, none);
  }
}

// Only what stands in it by our hand: log, script and settings; then the folders that were made for it.
void OutputFolder::take_away() {
  std::fclose(log_);
  log_ = nullptr;
  std::error_code not_empty;
  fs::remove(log_path_, not_empty);
  for (const auto& name : written_)
    fs::remove(folder_ / name, not_empty);
  for (fs::path folder = fs::absolute(folder_).lexically_normal(); fs::remove(folder, not_empty);
       folder = folder.parent_path())
    if (folder == first_made_)
      return;
}

// A log that was deleted can be written to all the same, and nobody will find what was.
void OutputFolder::require_log_in_place() const {
  struct stat written {
  }, found{};
  if (fstat(fileno(log_), &written) != 0 || stat(log_path_.c_str(), &found) != 0 ||
      written.st_ino != found.st_ino || written.st_dev != found.st_dev)
    throw FileError("output folder " + folder_.string() +
                    " was deleted or moved while the run wrote to it: its results are lost or incomplete");
}

void OutputFolder::finish(ExitCode code, const std::string& error) {
  const std::lock_guard<std::recursive_mutex> lock(one_at_a_time_);
  if (log_ == nullptr)
    return;
  const bool made_something = std::any_of(written_.begin(), written_.end(), [&](const std::string& name) {
    return name != script_.filename().string() && name != settings_name;
  });
  if (code == ExitCode::bad_input && !has_said_ && !made_something && !first_made_.empty())
    return take_away();
  if (code == ExitCode::success) {
    require_log_in_place();
    begin_results();
    remove_last_states();
  }
  if (!error.empty())
    log("error: " + error);
  for (const auto& name : written_)
    std::fputs(run_log_file_line(folder_, name).c_str(), log_);
  std::fprintf(log_, "%s%d, %s\n", run_log_end, to_int(code), date_now().c_str());
  const bool written = std::fflush(log_) == 0 && std::ferror(log_) == 0;
  std::fclose(log_);
  log_ = nullptr;
  if (begun_) {
    std::error_code none;
    fs::remove(folder_ / failed_log_name, none);
  }
  if (!written)
    throw FileError(log_path_.string() + " cannot be written: the disk may be full");
}

} // namespace cdem::app
