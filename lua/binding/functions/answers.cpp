#include "lua/binding/functions/answers.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem::script {

namespace {

[[noreturn]] void refuse(const Reference& function, const std::string& name, const Values& arguments,
                         const Values& answer, const std::string& allowed) {
  std::string shown;
  for (const Value& argument : arguments)
    shown += (shown.empty() ? "" : ", ") + fmt::format("{:.4g}", argument.number());
  throw geom::InputError(name + "(" + shown + ") of " + function.place(),
                         answer.empty() ? "nothing" : describe(answer[0]), allowed);
}

} // namespace

double number_answered(const Reference& function, const std::string& name, const Values& arguments,
                       const std::string& allowed, double least) {
  const Values answer = function.call(arguments);
  const double x = !answer.empty() && answer[0].is_number() ? answer[0].number() : std::nan("");
  if (!std::isfinite(x) || !(x >= least))
    refuse(function, name, arguments, answer, allowed);
  return x;
}

geom::Vec3 vector_answered(const Reference& function, const std::string& name, const Values& arguments) {
  const Values answer = function.call(arguments);
  const Table* const three = answer.empty() ? nullptr : answer[0].table();
  geom::Vec3 v(std::nan(""), 0, 0);
  if (three && three->items.size() == 3)
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = three->items[axis].is_number() ? three->items[axis].number() : std::nan("");
  if (!v.allFinite())
    refuse(function, name, arguments, answer, "three finite numbers {x, y, z}");
  return v;
}

} // namespace cdem::script
