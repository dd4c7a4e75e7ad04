#include "libcdem/checkpoint/file.hpp"

#include "libcdem/checkpoint/archive.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libgeom/core/regular_file.hpp"

#include <cerrno>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

namespace cdem {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t format = 33;
constexpr std::size_t head_size = 16 + sizeof(std::uint32_t) + sizeof(std::uint64_t),
                      checksum_size = sizeof(std::uint64_t);

std::string magic(SavedKind kind) {
  std::string text = kind == SavedKind::checkpoint ? "cdem checkpoint" : "cdem state";
  text.resize(16);
  return text;
}

const char* name(SavedKind kind) {
  return kind == SavedKind::checkpoint ? "a checkpoint of cdem" : "a saved state of cdem";
}

[[noreturn]] void fail(const fs::path& path) {
  throw FileError(path.string() + ": cannot be written: " + std::strerror(errno));
}

// A descriptor that is closed whatever happens.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0)
      close(number);
  }
};

void write_all(const Descriptor& file, const std::string& part, const fs::path& path) {
  for (std::size_t done = 0; done < part.size();) {
    const ssize_t n = ::write(file.number, part.data() + done, part.size() - done);
    if (n < 0 && errno != EINTR)
      fail(path);
    done += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
}

} // namespace

void write_saved(const fs::path& path, SavedKind kind, const std::string& content) {
  Writer head;
  const std::string word = magic(kind);
  head.raw(word.data(), word.size());
  archive_const(head, format);
  archive_const(head, static_cast<std::uint64_t>(content.size()));
  Xxh64 sum;
  sum.add(head.text().data(), head.text().size());
  sum.add(content.data(), content.size());
  Writer tail;
  archive_const(tail, sum.value());

  const fs::path beside = path.string() + ".part";
  {
    const Descriptor file{open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (file.number < 0)
      fail(path);
    write_all(file, head.text(), path);
    write_all(file, content, path);
    write_all(file, tail.text(), path);
    if (fsync(file.number) != 0)
      fail(path);
  }
  if (std::rename(beside.c_str(), path.c_str()) != 0)
    fail(path);
  // The rename itself must not be lost either; a file system that cannot say so is left alone.
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const Descriptor directory{open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (directory.number >= 0)
    fsync(directory.number);
}

std::string read_saved(const fs::path& path, SavedKind kind) {
  std::string text;
  try {
    text = geom::read_regular(path);
  } catch (const std::runtime_error& error) {
    throw FileError(error.what());
  }
  const std::string word = magic(kind);
  if (text.compare(0, word.size(), word) != 0)
    throw FileError(path.string() + ": not " + name(kind));
  const auto damaged = [&] {
    return FileError(path.string() +
                     ": damaged: cut short or changed since it was written; its checksum does "
                     "not hold");
  };
  if (text.size() < head_size + checksum_size)
    throw damaged();
  Reader head(std::string_view(text).substr(word.size()));
  std::uint32_t written_as = 0;
  std::uint64_t length = 0, sum = 0;
  archive_all(head, written_as, length);
  Reader tail(std::string_view(text).substr(text.size() - checksum_size));
  archive(tail, sum);
  if (length != text.size() - head_size - checksum_size ||
      sum != xxh64(text.data(), text.size() - checksum_size))
    throw damaged();
  if (written_as != format)
    throw FileError(path.string() + ": of format " + std::to_string(written_as) +
                    ", this cdem reads format " + std::to_string(format));
  return text.substr(head_size, static_cast<std::size_t>(length));
}

} // namespace cdem
