#include "lua/binding/schema/answers.hpp"

#include "lua/binding/schema/errors.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem::script {

namespace {

std::string call_text(const Reference& function, const std::string& name, const Values& arguments) {
  std::string shown;
  for (const Value& argument : arguments)
    shown += (shown.empty() ? "" : ", ") + fmt::format("{:.4g}", argument.number());
  return name + "(" + shown + ") of " + function.place();
}

// "a finite number >= 0 m/s", "a finite number (Pa)"
std::string finite_number(const Field& field) {
  const std::string range = field.type.range.text(), unit = field.unit_text;
  return "a finite number" + (range.empty() ? "" : " " + range) +
         (unit.empty()    ? ""
          : range.empty() ? " (" + unit + ")"
                          : " " + unit);
}

} // namespace

Value answer_of(const Reference& function, const std::string& name, const Values& arguments) {
  try {
    const Values answer = function.call(arguments);
    return answer.empty() ? Value() : answer[0];
  } catch (const ScriptError& error) {
    throw ScriptError(error.what() + (", in " + call_text(function, name, arguments)));
  }
}

void refuse_answer(const Reference& function, const std::string& name, const Values& arguments,
                   const Value& answer, const std::string& allowed) {
  throw geom::InputError(call_text(function, name, arguments), answer.is_nil() ? "nothing" : describe(answer),
                         allowed);
}

double number_answered(const Reference& function, const Field& field, const Values& arguments) {
  const Value answer = answer_of(function, field.name, arguments);
  const double x = answer.is_number() ? answer.number() : std::nan("");
  if (!std::isfinite(x) || !field.type.range.holds(x))
    refuse_answer(function, field.name, arguments, answer, finite_number(field));
  return x;
}

geom::Vec3 vector_answered(const Reference& function, const Field& field, const Values& arguments) {
  const Value answer = answer_of(function, field.name, arguments);
  const Table* const three = answer.table();
  geom::Vec3 v(std::nan(""), 0, 0);
  if (three && three->items.size() == 3)
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = three->items[axis].is_number() ? three->items[axis].number() : std::nan("");
  if (!v.allFinite())
    refuse_answer(function, field.name, arguments, answer, "three finite numbers {x, y, z}");
  return v;
}

} // namespace cdem::script
