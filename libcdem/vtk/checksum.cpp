// FNV-1a, 64 bits: every step is one to one, so no single changed byte goes unseen.
#include "libcdem/vtk/checksum.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>

namespace cdem {
namespace {

constexpr const char* form = "<!-- cdem checksum %016llx -->\n";
constexpr std::size_t line_length = 40;
constexpr const char* opening = "<!-- cdem checksum ";

std::string last_line(std::uint64_t hash) {
  char text[64];
  std::snprintf(text, sizeof text, form, static_cast<unsigned long long>(hash));
  return text;
}

std::uint64_t hash_of(std::ifstream& in, std::uint64_t length) {
  std::uint64_t hash = 14695981039346656037ull;
  std::vector<char> buffer(1 << 20);
  while (length > 0) {
    const std::uint64_t part = std::min<std::uint64_t>(length, buffer.size());
    if (!in.read(buffer.data(), static_cast<std::streamsize>(part)))
      break;
    for (std::uint64_t i = 0; i < part; ++i)
      hash = (hash ^ static_cast<unsigned char>(buffer[i])) * 1099511628211ull;
    length -= part;
  }
  return hash;
}

std::uint64_t length_of(std::ifstream& in) {
  in.seekg(0, std::ios::end);
  const auto length = in.tellg();
  in.seekg(0);
  return length > 0 ? static_cast<std::uint64_t>(length) : 0;
}

} // namespace

bool add_checksum(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::uint64_t hash = hash_of(in, length_of(in));
  std::ofstream out(path, std::ios::binary | std::ios::app);
  out << last_line(hash);
  out.close();
  return static_cast<bool>(out);
}

Checksum check_checksum(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::uint64_t length = length_of(in);
  if (length < line_length)
    return Checksum::none;
  const std::uint64_t hash = hash_of(in, length - line_length);
  std::string line(line_length, ' ');
  in.read(line.data(), static_cast<std::streamsize>(line_length));
  if (line == last_line(hash))
    return Checksum::right;
  return line.rfind(opening, 0) == 0 ? Checksum::wrong : Checksum::none;
}

} // namespace cdem
