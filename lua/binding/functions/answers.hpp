// What a function of the script answers, checked: InputError with the call as the user would write it, "velocity(0.5)",
// and the function's place.
#pragma once

#include "lua/binding/schema/value.hpp"

#include <limits>

namespace cdem::script {

// allowed: what the message says, such as "a finite number >= 0 m/s".
double number_answered(const Reference& function, const std::string& name, const Values& arguments,
                       const std::string& allowed = "a finite number",
                       double least = -std::numeric_limits<double>::infinity());
geom::Vec3 vector_answered(const Reference& function, const std::string& name, const Values& arguments);

} // namespace cdem::script
