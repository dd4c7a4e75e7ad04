// Errors of the standard library in a user's words: their own text names functions ("vector::_M_default_append", "stoi").
#pragma once

#include <exception>
#include <string>

namespace geom {

std::string plain_reason(const std::exception&);

} // namespace geom
