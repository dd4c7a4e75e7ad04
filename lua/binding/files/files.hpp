// Which files a script may touch: it writes below the output folder only, and reads beside itself, below the
// output folder, below the results and, when it is a run of a sweep, below the sweep's folder. `..` and symbolic links
// are resolved before the path is checked. With several ranks only the first checks, reads and writes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cdem::script {

class Files {
public:
  // Relative folders are taken from the current one. results and sweep may be empty.
  Files(const std::filesystem::path& script, const std::filesystem::path& output,
        const std::filesystem::path& results, bool unsafe, const std::filesystem::path& sweep = {});

  // Full path of a file to be written; makes its folder. A relative name is taken from the output folder.
  // Throws geom::InputError when the place is not allowed, FileError when the folder cannot be made.
  std::filesystem::path to_write(const std::string& name) const;
  // The same, for a check: nothing is made and nobody is told.
  std::filesystem::path would_write(const std::string& name) const;
  // Full path of an existing file to be read: looked for beside the script, in the output folder, from the
  // folder that holds the results, and in the results. Throws geom::InputError when the place is not allowed,
  // FileError when there is no such file.
  std::filesystem::path to_read(const std::string& name) const;

  // Told of each file that to_write allows; may be empty.
  std::function<void(const std::filesystem::path&)> will_write;

  const std::filesystem::path& output() const { return output_; }
  const std::filesystem::path& script_folder() const { return script_folder_; }

private:
  std::filesystem::path allowed(const std::string& name) const;
  std::filesystem::path found(const std::string& name) const;
  bool may_read(const std::filesystem::path&) const;

  std::filesystem::path script_folder_, output_, results_, sweep_;
  bool unsafe_;
};

// A script's path as messages show it: relative to the current folder when it lies below, the bare name when
// long.
std::string shown_name(const std::filesystem::path& script);

// What to type to go on with a run that has a checkpoint in this folder, which is quoted where a shell would part it.
std::string resume_command(const std::filesystem::path& folder, bool unsafe);

// Writes through a temporary file and a rename, so that a reader never sees half a file. FileError on
// failure.
void write_file(const std::filesystem::path& path, const std::string& text);
// FileError on failure, and where it is a folder, a named pipe or a device.
std::string read_file(const std::filesystem::path& path);
std::string read_file_here(const std::filesystem::path& path); // by this rank alone

} // namespace cdem::script
