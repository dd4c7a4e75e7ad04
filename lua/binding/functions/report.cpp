// cdem.report: figures beside their references.
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem::script {

namespace {

// Numbers that are not finite cannot be written in JSON: null, and the script's author is told.
Value finite_or_nil(Session& session, const std::string& name, const char* field, const Value& value) {
  if (value.is_number() && !std::isfinite(value.number())) {
    if (!session.settings.check_only)
      session.warn("cdem.report: " + name + ": " + field + " is " + describe(value) + "; written as null");
    return {};
  }
  if (!value.is_nil() && !value.is_number() && !value.get<std::string>() && !value.get<bool>())
    throw geom::InputError(name + ": " + field + " = " + describe(value) +
                           ": must be a number, a string, a boolean or nil");
  return value;
}

// On the terminal and in the log too: who reads neither file must not take a miss for a hit.
void tell_misses(Session& session, const std::vector<std::string>& given) {
  std::string missed;
  for (const Figure& figure : session.report.figures)
    if (std::find(given.begin(), given.end(), figure.name) != given.end() && figure.within() == false)
      missed += (missed.empty() ? "" : ", ") + figure.name;
  if (!missed.empty() && !session.settings.check_only)
    session.message("outside its tolerance: " + missed + " (report.md)");
}

const Record<Figure> figure_record{
    {{text("name").required().doc("name of the figure, with its unit at the end, e.g. \"side_ux_max_m\""),
      &Figure::name},
     {plain("value").doc("number, text or boolean; leave out (nil) when there is none"), &Figure::value},
     {text("unit"), &Figure::unit},
     {plain("reference").doc("number, text or boolean to compare with"), &Figure::reference},
     {choice("kind", {"formula", "paper", "fe", "trial"})
          .doc("where the reference comes from; a trial figure is shown and never judged"),
      &Figure::kind},
     {text("source").doc("e.g. \"Han 2010 fig 7\""), &Figure::source},
     {number("tolerance").at_least(0).doc("allowed |value - reference| over |reference|"),
      &Figure::tolerance},
     {number("tolerance_absolute").at_least(0).doc("the same in the figure's unit, instead of tolerance")}}};

Value report(Session& session, Object*, const Arguments& arguments) {
  std::vector<std::string> names;
  for (const Arguments& given : arguments.records("figures")) {
    Figure figure = figure_record.read(given);
    figure.value = finite_or_nil(session, figure.name, "value", figure.value);
    figure.reference = finite_or_nil(session, figure.name, "reference", figure.reference);
    if (const auto absolute = given.optional_number("tolerance_absolute")) {
      if (figure.tolerance)
        throw geom::InputError(figure.name + ": give tolerance (relative) or tolerance_absolute, not both");
      figure.tolerance = absolute;
      figure.absolute = true;
    }
    if (figure.kind.empty() && !figure.reference.is_nil())
      throw geom::InputError(figure.name +
                             ": kind: missing; a reference needs its kind: \"formula\", \"paper\", "
                             "\"fe\" or \"trial\"");
    if (figure.kind == "trial" && figure.tolerance)
      throw geom::InputError(figure.name +
                             ": tolerance: a trial figure is shown beside ours and never judged; leave "
                             "the tolerance out");
    session.report.add(figure);
    names.push_back(figure.name);
  }
  session.write_report();
  tell_misses(session, names);
  return {};
}

} // namespace

void bind_report(Module& m) {
  m.add("report",
        "Writes figures beside their references to report.json and report.md in the output folder. Further "
        "calls add figures; a name given again takes the place of the earlier one. Numbers that are not "
        "finite become null, with a warning. Booleans are judged by equality. The warnings of the run stand "
        "in the report too.",
        {list("figures", record_type(figure_record.fields())).required().doc("the figures, in order")},
        report)
      .ordered();
}

} // namespace cdem::script
