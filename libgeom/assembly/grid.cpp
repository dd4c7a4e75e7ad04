#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <string>

namespace geom {

Assembly grid(const Vec3& size, const std::array<int, 3>& divisions, const Vec3& origin) {
  require_positive("size", size);
  require_finite("origin", origin);
  const std::string value = "{" + std::to_string(divisions[0]) + ", " + std::to_string(divisions[1]) + ", " +
                            std::to_string(divisions[2]) + "}";
  double blocks = 1;
  for (int n : divisions) {
    if (n < 1)
      throw InputError("divisions", value, "three whole numbers >= 1");
    blocks *= n;
  }
  require_block_count("divisions", value, blocks, "use fewer divisions");

  // One formula for every grid line, so that neighbours share their corners to the last bit.
  const auto corner = [&](int i, int j, int k) {
    const Vec3 share(static_cast<double>(i) / divisions[0], static_cast<double>(j) / divisions[1],
                     static_cast<double>(k) / divisions[2]);
    return Vec3(origin + size.cwiseProduct(share));
  };
  Assembly assembly;
  assembly.blocks.reserve(static_cast<std::size_t>(blocks));
  for (int k = 0; k < divisions[2]; ++k)
    for (int j = 0; j < divisions[1]; ++j)
      for (int i = 0; i < divisions[0]; ++i)
        assembly.blocks.push_back(make_box(corner(i, j, k), corner(i + 1, j + 1, k + 1)));
  return assembly;
}

} // namespace geom
