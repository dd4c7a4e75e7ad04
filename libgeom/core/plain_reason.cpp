#include "libgeom/core/plain_reason.hpp"

#include <new>
#include <stdexcept>

namespace geom {

std::string plain_reason(const std::exception& error) {
  const auto is = [&](auto* kind) { return dynamic_cast<decltype(kind)>(&error) != nullptr; };
  if (is(static_cast<const std::bad_alloc*>(nullptr)) || is(static_cast<const std::length_error*>(nullptr)))
    return "it asks for more memory than there is";
  if (is(static_cast<const std::out_of_range*>(nullptr)))
    return "a number in it is out of range";
  if (is(static_cast<const std::invalid_argument*>(nullptr)))
    return "a word in it should be a number";
  return error.what();
}

} // namespace geom
