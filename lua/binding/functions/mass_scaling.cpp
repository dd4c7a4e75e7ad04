#include "lua/binding/functions/mass_scaling.hpp"

#include "lua/binding/functions/solving_warnings.hpp"

#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

// Usual limits of quasi-static work: shares of mass added and of kinetic over stored energy that are warned of.
constexpr double most_added = 0.05, most_moving = 0.05;

std::string percent(double share) {
  return three_digits(100 * share) + " %";
}

} // namespace

Field mass_scaling_field() {
  return record("mass_scaling",
                {number("step", "s").above(0).doc("the time step"),
                 number("factor").doc("instead: over the step that the true masses allow, at least 1")})
      .doc("for quasi-static stages: nodes that need a shorter time step get more inertia, not more weight; "
           "instead of time_step");
}

Field mass_scaling_result_field() {
  return record("mass_scaling",
                {number("added_mass").required().doc("share of the mass of all that deforms, at the end"),
                 text("body").doc("the one with the largest share added; nil when nothing was"),
                 number("body_added_mass").required().doc("that share"),
                 number("kinetic_energy")
                     .required()
                     .doc("share: over elastic and spring energy, mean over the stage")})
      .doc("of a stage with mass_scaling");
}

MassScaling mass_scaling_of(const Arguments& a) {
  MassScaling scaling;
  const auto given = a.record("mass_scaling");
  if (!given)
    return scaling;
  scaling.step = given->optional_number("step").value_or(0);
  scaling.factor = given->optional_number("factor").value_or(0);
  if (!given->has("step") && !given->has("factor"))
    throw geom::InputError("mass_scaling: give step (s) or factor");
  if (given->has("factor") && !(scaling.factor >= 1))
    throw geom::InputError("mass_scaling.factor", describe(given->value("factor")), "at least 1",
                           "it is the time step over the one that the true masses allow");
  return scaling;
}

void add_mass_scaling(Session& session, const char* kind, const MassScaling& scaling, double time_step,
                      const ScaledMasses& scaled, Value& result) {
  if (!scaling.on())
    return;
  Table row{{"added_mass", scaled.added_share},
            {"body_added_mass", scaled.body_share},
            {"kinetic_energy", scaled.kinetic_share}};
  if (!scaled.body.empty())
    row.named["body"] = scaled.body;
  Table with = *result.table();
  with.named["mass_scaling"] = std::move(row);
  result = std::move(with);

  const std::string who = scaled.body.empty() ? std::string() : " of \"" + scaled.body + "\"";
  const std::string head = std::string(kind) + ": mass_scaling: ";
  session.message(head + "time step " + three_digits(time_step) + " s; " + percent(scaled.added_share) +
                  " of the mass added" +
                  (who.empty() ? "" : ", " + percent(scaled.body_share) + " of that" + who) +
                  "; kinetic energy " + percent(scaled.kinetic_share) + " of the stored");
  std::string found;
  if (scaled.body_share > most_added)
    found = percent(scaled.body_share) + " of the mass" + who + " was added (more than " +
            percent(most_added) + "): take a shorter step, or a mesh without slivers";
  if (scaled.kinetic_share > most_moving)
    found += (found.empty() ? "" : "; ") + ("the kinetic energy is " + percent(scaled.kinetic_share)) +
             " of the stored (more than " + percent(most_moving) +
             "): the stage is not quasi-static; load more slowly, or with local_damping";
  if (!found.empty())
    session.warn(head + found);
}

} // namespace cdem::script
