#include "libcdem/vtk/atomic_file.hpp"

#include "libgeom/core/error.hpp"

#include <filesystem>

namespace cdem {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(const std::string& path) : path_(path), temporary_(path + ".part") {
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    throw geom::InputError("file", '"' + path + '"', "in a folder that exists",
                           "make the folder " + folder.string());
  if (path.empty() || fs::is_directory(path, ignored))
    throw geom::InputError("file", '"' + path + '"', "the name of a file");
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code failure;
  fs::rename(temporary_, path_, failure);
  if (failure)
    throw geom::InputError("file", '"' + path_ + '"', "writable", failure.message());
}

void require_extension(const std::string& path, const std::string& extension) {
  if (fs::path(path).extension() != extension)
    throw geom::InputError("file", '"' + path + '"', "a name ending in " + extension);
}

} // namespace cdem
