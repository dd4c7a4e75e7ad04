// A file that appears under its name only when it is complete.
#pragma once

#include <string>

namespace cdem {

class AtomicFile {
public:
  // Throws FileError (file_error.hpp) when `path` is a folder, in none, or not writable.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile(); // without commit: the temporary file is removed
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const { return temporary_; } // write here
  void commit();                                              // FileError when the rename fails
  [[noreturn]] void refuse() const;                           // throws FileError: not written to the end

private:
  std::string path_, temporary_;
};

// Throws geom::InputError unless the name of `path` ends with `extension` (".png").
void require_extension(const std::string& path, const std::string& extension);

} // namespace cdem
