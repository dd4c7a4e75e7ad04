// A number from place to place as a script gives it by a function.
#pragma once

#include "lua/binding/schema/schema.hpp"

#include <functional>

namespace cdem::script {

// Calls function(x, y, z) of the script. An answer that is not a finite number, or is below `least`, is an error that
// names the position. allowed: the range in words.
std::function<double(const geom::Vec3&)>
number_at_place(const std::shared_ptr<Reference>& function, const std::string& field,
                const std::string& allowed, double least = -std::numeric_limits<double>::infinity());

} // namespace cdem::script
