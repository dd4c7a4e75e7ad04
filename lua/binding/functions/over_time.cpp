#include "lua/binding/functions/over_time.hpp"

#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

Amplitude of_table(const TimeTable& table) {
  try {
    validate(table);
  } catch (const InputError& e) {
    throw InputError(std::string("amplitude: ") + e.what());
  }
  return [table](double time) { return table.at(time); };
}

} // namespace

const Record<Recorded>& recorded() {
  static const Record<Recorded> members{
      "Record",
      "A quantity over time, from a file or of your own; what an amplitude takes.",
      {{list("times", number_type(), 2).required().doc("s, ascending"), &Recorded::time},
       {list("values", number_type(), 2).required().doc("as many"), &Recorded::value},
       {choice("outside", {"hold", "zero"})
            .standard("hold")
            .doc("before the first and after the last time: those values, or 0"),
        &Recorded::zero_outside},
       {number("peak").doc("largest magnitude"), &Recorded::peak},
       {number("duration", "s"), &Recorded::duration},
       {text("unit"), &Recorded::unit},
       {number("end_velocity", "m/s").doc("of an integrated acceleration"), &Recorded::end_velocity},
       {number("end_displacement", "m"), &Recorded::end_displacement},
       {list("baseline", number_type(), 2).doc("{a0, a1}: a0 + a1 t has been taken off, m/s2 and m/s3"),
        &Recorded::baseline}}};
  return members;
}

Field amplitude_field() {
  return function_or_record("amplitude", "(time: number): number", recorded().fields())
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
  if (a.value("amplitude").table()) {
    amplitude = of_table(recorded().read(*a.record("amplitude")));
  } else {
    read(a, amplitude_field(), amplitude);
    if (amplitude)
      amplitude(now - since.value_or(0));
  }
  if (since && !amplitude)
    throw InputError("since: goes with amplitude, whose times begin there");
  if (!since)
    return amplitude;
  return [amplitude = std::move(amplitude), since = *since](double time) { return amplitude(time - since); };
}

} // namespace cdem::script
