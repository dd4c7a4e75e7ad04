#include "libcdem/vtk/png_resolution.hpp"

#include <cmath>
#include <cstdint>
#include <zlib.h>

namespace cdem {
namespace {

constexpr std::size_t after_header =
    8 + 25; // signature, and IHDR, which comes first: length, name, 13 bytes, checksum

std::string big_endian(std::uint32_t x) {
  return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
          static_cast<char>(x)};
}

} // namespace

std::string with_resolution(const std::string& png, double dpi) {
  const std::string pixels = big_endian(static_cast<std::uint32_t>(std::lround(dpi / 0.0254))); // in a metre
  const std::string body = "pHYs" + pixels + pixels + '\1';
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  const std::string chunk = big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body +
                            big_endian(static_cast<std::uint32_t>(sum));
  return png.substr(0, after_header) + chunk + png.substr(after_header);
}

} // namespace cdem
