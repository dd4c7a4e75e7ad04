#include "libcdem/bolt/bolt.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

void require(bool holds, const char* field, double value, const char* allowed, const char* advice = "") {
  if (!holds)
    throw geom::InputError(field, fmt::format("{:g}", value), allowed, advice);
}

} // namespace

void validate(const Bolt& b) {
  const auto positive = [](double x) { return x > 0; };
  const auto finite = [](double x) { return std::isfinite(x) && x > 0; };
  if (!(b.length() > 0) || !std::isfinite(b.length()))
    throw geom::InputError("to", fmt::format("({:g}, {:g}, {:g})", b.to.x(), b.to.y(), b.to.z()),
                           "another place than `from`");
  require(b.segments >= 1 && b.segments <= 1000, "segments", b.segments, "from 1 to 1000");
  require(finite(b.area), "area", b.area, "a finite number > 0 m2", "a bar of 25 mm has 4.9e-4");
  require(finite(b.youngs_modulus), "youngs_modulus", b.youngs_modulus, "a finite number > 0 Pa");
  require(positive(b.yield_force), "yield_force", b.yield_force, "> 0 N");
  require(finite(b.grout_stiffness), "grout_stiffness", b.grout_stiffness, "a finite number > 0 N/m per m");
  require(positive(b.grout_strength), "grout_strength", b.grout_strength, "> 0 N per m");
  require(std::isfinite(b.pretension) && b.pretension >= 0 && b.pretension < b.yield_force, "pretension",
          b.pretension, "from 0 N to below the yield_force");
  require(b.free_length >= 0 && b.free_length < b.length(), "free_length", b.free_length,
          "from 0 m to below the bolt's length");
  if (b.pretension > 0 && !b.plate)
    throw geom::InputError("pretension: needs plate = true, which holds the tensioned end");
}

} // namespace cdem
