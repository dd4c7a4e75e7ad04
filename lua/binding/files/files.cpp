#include "lua/binding/files/files.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/regular_file.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/schema/errors.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace cdem::script {

namespace fs = std::filesystem;

namespace {

// As weakly_canonical, but a dangling link is followed too: writing through it would land outside.
fs::path resolved(const fs::path& path) {
  fs::path place = fs::absolute(path).lexically_normal();
  for (int links = 0; links < 40; ++links) {
    std::error_code error;
    fs::path canonical = fs::weakly_canonical(place, error);
    if (error)
      throw FileError(path.string() + ": " + error.message());
    if (!fs::is_symlink(fs::symlink_status(canonical, error)))
      return canonical;
    const fs::path target = fs::read_symlink(canonical, error);
    place = target.is_absolute() ? target : canonical.parent_path() / target;
  }
  throw FileError(path.string() + ": too many symbolic links");
}

bool below(const fs::path& path, const fs::path& folder) {
  if (folder.empty())
    return false;
  const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  static_cast<void>(unused);
  return end == folder.end();
}

} // namespace

Files::Files(const fs::path& script, const fs::path& output, const fs::path& results, bool unsafe,
             const fs::path& sweep)
    : script_folder_(script.empty() ? fs::path() : resolved(script).parent_path()),
      output_(resolved(output.empty() ? fs::current_path() : output)),
      results_(results.empty() ? fs::path() : resolved(results)),
      sweep_(sweep.empty() ? fs::path() : resolved(sweep)), unsafe_(unsafe) {}

bool Files::may_read(const fs::path& path) const {
  return unsafe_ || below(path, script_folder_) || below(path, output_) || below(path, results_) ||
         below(path, sweep_);
}

fs::path Files::would_write(const std::string& name) const {
  if (name.empty() || name.find('\0') != std::string::npos)
    throw geom::InputError("file", "\"" + name.substr(0, name.find('\0')) + "\"", "a file name");
  fs::path path = resolved(output_ / name);
  if (!unsafe_ && !below(path, output_))
    throw geom::InputError("file", "\"" + name + "\"", "inside the output folder " + output_.string(),
                           "give a name without .. and without a leading /, or run with --unsafe");
  return path;
}

fs::path Files::to_write(const std::string& name) const {
  return led_bytes("file", [&] { return allowed(name).string(); });
}

fs::path Files::allowed(const std::string& name) const {
  fs::path path = would_write(name);
  if (will_write)
    will_write(path); // first, as it clears the folder of old results
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error)
    throw FileError(path.parent_path().string() + ": the folder cannot be made: " + error.message());
  if (fs::is_directory(path, error))
    throw FileError(path.string() + ": is a folder, not a file");
  return path;
}

fs::path Files::to_read(const std::string& name) const {
  return led_bytes("file", [&] { return found(name).string(); });
}

fs::path Files::found(const std::string& name) const {
  if (name.empty() || name.find('\0') != std::string::npos)
    throw geom::InputError("file", "\"" + name.substr(0, name.find('\0')) + "\"", "a file name");
  std::vector<fs::path> places;
  if (!script_folder_.empty())
    places.push_back(script_folder_ / name);
  places.push_back(output_ / name);
  if (!results_.empty()) {
    places.push_back(results_.parent_path() / name);
    places.push_back(results_ / name);
  }
  if (unsafe_)
    places.push_back(fs::current_path() / name);
  bool refused = false;
  std::string special; // what stands there and is no file
  for (const fs::path& candidate : places) {
    std::error_code error;
    fs::path path = resolved(candidate);
    if (!may_read(path)) {
      refused = true;
      continue;
    }
    if (fs::is_regular_file(path, error)) {
      if (faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0)
        throw FileError(path.string() + ": cannot be read: " + std::strerror(errno));
      return path;
    }
    if (fs::exists(path, error))
      special = path.string() + ": " + geom::why_not_regular(path);
  }
  if (!special.empty())
    throw FileError(special);
  if (refused &&
      (fs::path(name).is_absolute() || fs::path(name).lexically_normal().string().rfind("..", 0) == 0))
    throw geom::InputError("file", "\"" + name + "\"",
                           "beside the script, in the output folder or below the results",
                           "copy it beside the script, or run with --unsafe");
  throw FileError("file \"" + name + "\": not found beside the script (" + script_folder_.string() +
                  "), in the output folder or below the results");
}

std::string resume_command(const fs::path& folder, bool unsafe) {
  std::string word = folder.string();
  const auto plain = [](unsigned char c) {
    return c > 127 || std::isalnum(c) != 0 || std::strchr("_-+=.,:@%/", c) != nullptr;
  };
  if (word.empty() || !std::all_of(word.begin(), word.end(), plain)) {
    std::string quoted = "'";
    for (const char c : word)
      quoted += c == '\'' ? "'\\''" : std::string(1, c);
    word = quoted + "'";
  }
  return "cdem resume " + word + (unsafe ? " --unsafe" : "");
}

std::string shown_name(const fs::path& script) {
  std::error_code error;
  const fs::path relative = fs::relative(script, fs::current_path(), error);
  std::string name =
      error || relative.empty() || *relative.begin() == ".." ? script.string() : relative.string();
  // Lua itself shortens names of 60 characters and more to their tail.
  return name.size() < 58 ? name : script.filename().string();
}

namespace {

void write_here(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + ".part";
  {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out)
      throw FileError(path.string() + ": cannot be written: " + std::strerror(errno));
  }
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error)
    throw FileError(path.string() + ": cannot be written: " + error.message());
}

} // namespace

std::string read_file_here(const fs::path& path) {
  try {
    return geom::read_regular(path);
  } catch (const std::runtime_error& error) {
    throw FileError(error.what());
  }
}

void write_file(const fs::path& path, const std::string& text) {
  led_act("write", [&] { write_here(path, text); });
}

std::string read_file(const fs::path& path) {
  return led_bytes("read", [&] { return read_file_here(path); });
}

} // namespace cdem::script
