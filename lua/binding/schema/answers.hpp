// The answer of a function of the script, checked. Errors name the call as the user would write it and the function's
// place: "velocity(0.5) of case.lua:7".
#pragma once

#include "lua/binding/schema/schema.hpp"

namespace cdem::script {

// The first value that it returns; nil for none. An error inside it is thrown on with the call behind it.
Value answer_of(const Reference&, const std::string& name, const Values& arguments);
[[noreturn]] void refuse_answer(const Reference&, const std::string& name, const Values& arguments,
                                const Value& answer, const std::string& allowed);

// A finite number in the range of the field.
double number_answered(const Reference&, const Field&, const Values& arguments);
geom::Vec3 vector_answered(const Reference&, const Field&, const Values& arguments);

} // namespace cdem::script
