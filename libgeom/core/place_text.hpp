// A place in a message: four digits, to be found again and not to be computed with.
#pragma once

#include "libgeom/core/types.hpp"

#include <cstdio>
#include <string>

namespace geom {

inline std::string place_text(const Vec3& x) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) m", x.x(), x.y(), x.z());
  return text;
}

} // namespace geom
