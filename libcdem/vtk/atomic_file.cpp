#include "libcdem/vtk/atomic_file.hpp"

#include "libcdem/vtk/file_error.hpp"
#include "libgeom/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace cdem {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(const std::string& path) : path_(path), temporary_(path + ".part") {
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    throw FileError(path + " cannot be written: there is no folder " + folder.string());
  if (path.empty())
    throw geom::InputError("file", "\"\"", "the name of a file");
  if (fs::is_directory(path, ignored))
    throw FileError(path + " cannot be written: it is a folder");
  // Asked before libraries write, since they say less about what went wrong.
  if (!std::ofstream(temporary_))
    throw FileError(path + " cannot be written: " + std::strerror(errno));
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code failure;
  fs::rename(temporary_, path_, failure);
  if (failure)
    throw FileError(path_ + " cannot be written: " + failure.message());
}

void AtomicFile::refuse() const {
  throw FileError(path_ + " cannot be written: is there room on the disk?");
}

void require_extension(const std::string& path, const std::string& extension) {
  if (fs::path(path).extension() != extension)
    throw geom::InputError("file", '"' + path + '"', "a name ending in " + extension);
}

} // namespace cdem
