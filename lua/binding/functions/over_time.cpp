#include "lua/binding/functions/over_time.hpp"

#include "lua/binding/functions/answers.hpp"

#include "libcdem/load/time_table.hpp"
#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

Amplitude of_table(const Arguments& given) {
  TimeTable table{given.numbers("times"), given.numbers("values"), given.text("outside") == "zero"};
  try {
    validate(table);
  } catch (const InputError& e) {
    throw InputError(std::string("amplitude: ") + e.what());
  }
  return [table = std::move(table)](double time) { return table.at(time); };
}

Amplitude of_function(const std::shared_ptr<Reference>& function, double now) {
  Amplitude amplitude = [function](double time) { return number_answered(*function, "amplitude", {time}); };
  amplitude(now); // so that a slip in it is an error of the line that gave it
  return amplitude;
}

} // namespace

Field amplitude_field() {
  return function_or_record("amplitude", "(time: number): number")
      .doc("factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between "
           "and its first and last value outside, or a function, called once a step; a relaxation asks once "
           "at its start; 1 when left out");
}

Field since_field() {
  return number("since", "s")
      .doc("time of the model at which the amplitude's times begin, 0 when left "
           "out; since = model.time lets it begin now, in a later stage");
}

Amplitude amplitude_of(const Arguments& a, double now) {
  Amplitude amplitude;
  const auto since = a.optional_number("since");
  if (const auto table = a.value("amplitude").table() ? a.record("amplitude") : std::nullopt)
    amplitude = of_table(*table);
  else if (const auto function = a.function("amplitude"))
    amplitude = of_function(function, now - since.value_or(0));
  if (since && !amplitude)
    throw InputError("since: goes with amplitude, whose times begin there");
  if (!since)
    return amplitude;
  return [amplitude = std::move(amplitude), since = *since](double time) { return amplitude(time - since); };
}

std::function<geom::Vec3(double)> vector_over_time(const std::shared_ptr<Reference>& function,
                                                   const std::string& field, double now) {
  const auto vector = [function, field](double time) { return vector_answered(*function, field, {time}); };
  vector(now);
  return vector;
}

} // namespace cdem::script
