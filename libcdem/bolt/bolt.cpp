#include "libcdem/bolt/bolt.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem {
void validate(const Bolt& b) {
  if (!(b.length() > 0) || !std::isfinite(b.length()))
    throw geom::InputError("to", geom::shown(b.to), "another place than `from`");
  geom::require(b.segments >= 1 && b.segments <= 1000, "segments", b.segments, "from 1 to 1000");
  geom::require_above("area", b.area, 0, "m2", "a bar of 25 mm has 4.9e-4");
  geom::require_above("youngs_modulus", b.youngs_modulus, 0, "Pa");
  geom::require(b.yield_force > 0, "yield_force", b.yield_force, "> 0 N");
  geom::require_above("grout_stiffness", b.grout_stiffness, 0, "N/m per m");
  geom::require(b.grout_strength > 0, "grout_strength", b.grout_strength, "> 0 N per m");
  geom::require(std::isfinite(b.pretension) && b.pretension >= 0 && b.pretension < b.yield_force,
                "pretension", b.pretension, "from 0 N to below the yield_force");
  geom::require(b.free_length >= 0 && b.free_length < b.length(), "free_length", b.free_length,
                "from 0 m to below the bolt's length");
  if (b.pretension > 0 && !b.plate)
    throw geom::InputError("pretension: needs plate = true, which holds the tensioned end");
}

} // namespace cdem
