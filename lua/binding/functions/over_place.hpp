// A number from place to place as a script gives it by a function.
#pragma once

#include "lua/binding/schema/schema.hpp"

#include <functional>

namespace cdem::script {

// Of function(x, y, z); an answer that is no finite number, or below `least`, is an error that names the place.
// allowed: in words.
std::function<double(const geom::Vec3&)>
number_at_place(const std::shared_ptr<Reference>& function, const std::string& field,
                const std::string& allowed, double least = -std::numeric_limits<double>::infinity());

} // namespace cdem::script
