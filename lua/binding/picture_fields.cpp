#include "lua/binding/picture_fields.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

using geom::InputError;

Field size_field() {
  return list("size", number_type(), 2)
      .standard(Value(Table::list({1600, 1200})))
      .doc("{width, height} in pixels; height 0: as high as it needs to be");
}

Field colour_field() {
  return list("colour", number_type(), 3).doc("{red, green, blue}, each 0 .. 1");
}

std::array<int, 2> size_of(const Arguments& a) {
  const auto size = a.numbers("size");
  const auto whole = [](double x, double low) { return x == std::floor(x) && x >= low && x <= 20000; };
  if (size.size() != 2 || !whole(size[0], 16) || !(whole(size[1], 16) || size[1] == 0))
    throw InputError("size", describe(a.value("size")), "{width, height} in pixels, each 16 to 20000");
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

std::optional<Colour> colour_of(const Arguments& a) {
  if (!a.has("colour"))
    return std::nullopt;
  const auto c = a.numbers("colour");
  if (c.size() != 3)
    throw InputError("colour", describe(a.value("colour")), "{red, green, blue}");
  for (const double x : c)
    if (x < 0 || x > 1)
      throw InputError("colour", describe(a.value("colour")), "numbers from 0 to 1");
  return Colour{c[0], c[1], c[2]};
}

std::optional<std::array<double, 2>> limits_of(const Arguments& a, const std::string& name) {
  if (!a.has(name))
    return std::nullopt;
  const auto limits = a.numbers(name);
  if (limits.size() != 2 || !(limits[0] < limits[1]))
    throw InputError(name, describe(a.value(name)), "{lowest, highest}");
  return std::array<double, 2>{limits[0], limits[1]};
}

void require_ending(const std::string& file, const std::string& ending) {
  if (file.size() <= ending.size() || file.compare(file.size() - ending.size(), ending.size(), ending) != 0)
    throw InputError("file", "\"" + file + "\"", "a name that ends in " + ending);
}

} // namespace cdem::script
