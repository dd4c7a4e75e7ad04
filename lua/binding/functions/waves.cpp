// Earthquakes in scripts: records from files, quiet boundaries with waves that enter, free fields.
#include "lua/binding/functions/over_time.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"

#include "libcdem/load/record.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/text_table.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>

namespace cdem::script {

namespace {

using geom::InputError;

// A column by its name, or by its number where the file has no names.
std::size_t find_column(const geom::TextTable& table, const std::string& column, const char* field,
                        const std::string& file) {
  if (const auto found = table.find(column))
    return *found;
  const auto number = geom::plain_number(column);
  if (table.names().empty() && number && *number >= 1 && *number <= static_cast<double>(table.columns()) &&
      *number == std::floor(*number))
    return static_cast<std::size_t>(*number) - 1;
  if (table.names().empty())
    throw InputError(field, "\"" + column + "\"",
                     "the number of a column, from \"1\" to \"" + std::to_string(table.columns()) +
                         "\", as the file \"" + file + "\" has no names");
  std::string have;
  for (const std::string& name : table.names())
    have += (have.empty() ? "" : ", ") + name;
  throw InputError(field, "\"" + column + "\"", "a column of the file \"" + file + "\"", "it has: " + have);
}

std::vector<double> finite_column(const geom::TextTable& table, std::size_t column) {
  std::vector<double> values = table.numbers(column);
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isfinite(values[row]))
      table.refuse(row, column, "a finite number; drop the row, or fill in what was not measured");
  return values;
}

// A record of the PEER data base: four lines of head, the last with "NPTS= 4000, DT= .01 SEC", then values in g.
TimeTable peer_record(const std::string& file, const std::string& text) {
  const auto refuse = [&](const std::string& why) -> void {
    throw InputError("record \"" + file + "\": " + why);
  };
  std::istringstream in(text);
  std::string line;
  double step = std::nan("");
  std::int64_t count = -1;
  for (int i = 0; i < 4 && std::getline(in, line); ++i) {
    std::smatch found;
    static const std::regex points("NPTS *= *([0-9]+)", std::regex::icase),
        interval("DT *= *([0-9.eE+-]+)", std::regex::icase);
    if (line.size() > 200)
      continue;
    if (std::regex_search(line, found, points) && found[1].length() < 10)
      count = std::atoll(found[1].str().c_str());
    if (std::regex_search(line, found, interval))
      step = geom::plain_number(found[1]).value_or(step);
  }
  if (count < 2 || !(step > 0))
    refuse("must have \"NPTS= number, DT= seconds SEC\" in its fourth line, as files of the PEER data base "
           "have");
  TimeTable table;
  for (std::string word; in >> word;) {
    const auto value = geom::plain_number(word);
    if (!value || !std::isfinite(*value))
      refuse("value " + std::to_string(table.value.size() + 1) + ": \"" + word.substr(0, 30) +
             "\": must be a finite number");
    table.time.push_back(step * static_cast<double>(table.value.size()));
    table.value.push_back(*value);
  }
  if (static_cast<std::int64_t>(table.value.size()) != count)
    refuse("has " + std::to_string(table.value.size()) + " values: must be " + std::to_string(count) +
           ", as NPTS says");
  return table;
}

TimeTable table_record(const std::string& file, const std::string& text, const Arguments& a,
                       std::vector<int>& lines) {
  if (!a.has("value"))
    throw InputError("value: missing; it names the column, or gives its number in a file without names");
  const geom::TextTable columns(text, file);
  if (columns.rows() == 0)
    columns.refuse("holds no rows of numbers");
  TimeTable table;
  table.time = finite_column(columns, find_column(columns, a.text("time"), "time", file));
  table.value = finite_column(columns, find_column(columns, a.text("value"), "value", file));
  for (std::size_t row = 0; row < columns.rows(); ++row)
    lines.push_back(columns.line(row));
  return table;
}

struct Unit {
  const char* name;
  double factor; // to SI
  const char* si;
};
constexpr double standard_gravity = 9.80665; // m/s2
constexpr Unit known_units[] = {{"m/s2", 1, "m/s2"},   {"cm/s2", 0.01, "m/s2"},
                                {"Gal", 0.01, "m/s2"}, {"g", standard_gravity, "m/s2"},
                                {"m/s", 1, "m/s"},     {"cm/s", 0.01, "m/s"},
                                {"Pa", 1, "Pa"},       {"kPa", 1000, "Pa"},
                                {"MPa", 1e6, "Pa"},    {"1", 1, "1"}};

const Unit& unit_of(const std::string& name) {
  for (const Unit& unit : known_units)
    if (name == unit.name)
      return unit;
  return known_units[0]; // the schema has let through what stands there only
}

// An acceleration becomes a velocity. Tells what the baseline took off, and where the motion ends.
void to_velocity(Session& session, const std::string& head, const std::string& baseline, Recorded& record) {
  const VelocityRecord r = integrate(record, baseline == "straight");
  std::string line = head + " integrated to velocity, peak " + three_digits(peak(r.velocity)) +
                     " m/s; at its end " + three_digits(r.raw_end_velocity) + " m/s and " +
                     three_digits(r.raw_end_displacement) + " m";
  if (baseline == "straight")
    line += "; a baseline of " + three_digits(r.baseline.constant) + " m/s2 + " +
            three_digits(r.baseline.slope) + " m/s3 t taken off brings both to " +
            three_digits(r.end_velocity) + " m/s and " + three_digits(r.end_displacement) + " m";
  session.message(line);
  static_cast<TimeTable&>(record) = r.velocity;
  record.end_velocity = r.end_velocity;
  record.end_displacement = r.end_displacement;
  record.baseline = {r.baseline.constant, r.baseline.slope};
}

Value read_record(Session& session, Object*, const Arguments& a) {
  const std::string& file = a.text("file");
  const std::filesystem::path path = session.files.to_read(file);
  const std::string text = read_file(path);
  const bool peer = path.extension() == ".AT2" || path.extension() == ".at2";
  std::vector<int> lines;
  Recorded record{peer ? peer_record(file, text) : table_record(file, text, a, lines)};
  if (peer && a.has("value"))
    throw InputError("value", describe(a.value("value")), "left out", "a file .AT2 has no columns");
  record.zero_outside = true;
  try {
    validate(record);
    require_no_gaps(record, a.optional_number("longest_step").value_or(0), lines);
  } catch (const InputError& e) {
    throw InputError("record \"" + file + "\": " + e.what());
  }
  const Unit& unit = unit_of(a.text("unit"));
  for (double& value : record.value)
    value *= a.number("scale") * unit.factor;
  const bool acceleration = std::string(unit.si) == "m/s2", integrates = a.has("to");
  if (integrates && !acceleration)
    throw InputError("to", "\"velocity\"", "left out",
                     "only an acceleration (unit \"m/s2\", \"cm/s2\", \"g\") is "
                     "integrated, and this is in " +
                         std::string(unit.name));
  if (a.text("baseline") != "none" && !integrates)
    throw InputError("baseline: goes with to = \"velocity\"");
  const double first = record.time.front(), last = record.time.back();
  const std::string head = "record \"" + file + "\": " + std::to_string(record.time.size()) +
                           " samples from " + three_digits(first) + " to " + three_digits(last) +
                           " s, peak " + three_digits(peak(record)) + " " + unit.si + ";";
  if (integrates)
    to_velocity(session, head, a.text("baseline"), record);
  else
    session.message(head.substr(0, head.size() - 1));
  record.peak = peak(record);
  record.duration = last - first;
  record.unit = integrates ? "m/s" : unit.si;
  return recorded()(record);
}

const Record<Quiet> quiet_record{
    {{place("on").required().doc("where: a place or a list of places")},
     {vec3("velocity", "m/s").doc("of the particles in the entering wave alone"), &Quiet::velocity},
     {vec3("stress", "Pa")
          .doc("traction of the entering wave alone on these faces; the boundary adds 2 of it"),
      &Quiet::stress},
     {amplitude_field()},
     {since_field()}}};

Value quiet(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("quiet");
  if (a.has("velocity") && a.has("stress"))
    throw InputError("velocity and stress: give one of them; a stress wave has 'rho c' times its velocity");
  Quiet quiet = quiet_record.read(a);
  quiet.amplitude = amplitude_of(a, model.time());
  if (quiet.amplitude && !a.has("velocity") && !a.has("stress"))
    throw InputError("amplitude: goes with velocity or stress, which it multiplies");
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    quiet.on = on;
    model.simulation.quiet(quiet);
    model.notes->conditions.push_back(
        "quiet boundary " + on.text +
        (a.has("velocity") ? ", a wave of " + describe(a.value("velocity")) + " m/s enters"
         : a.has("stress") ? ", a wave of " + describe(a.value("stress")) + " Pa enters"
                           : ""));
  }
  return {};
}

Value free_field(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("free_field");
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    model.simulation.free_field({on});
    model.notes->conditions.push_back("free field " + on.text);
  }
  return {};
}

} // namespace

void bind_waves(Module& m) {
  m.records.push_back(recorded());
  m.add("record",
        "Reads a record over time from two columns of a table as spreadsheets write it, or from a file .AT2 "
        "of the PEER data base (unit = \"g\"), in SI units from then on; outside its times it is 0. Times "
        "must grow without gaps. With to = \"velocity\" an acceleration is integrated by the trapezoidal "
        "rule.",
        {text("file").formerly("path").required().doc(
             "beside the script, in the output folder or below the results"),
         text("time").standard("time").doc(
             "name of its column (s); the number of it, \"1\", where the file has no names"),
         text("value").doc("name of its column; left out for a file .AT2"),
         number("scale").standard(1.0).doc("factor on the values"),
         choice("unit", {"m/s2", "cm/s2", "Gal", "g", "m/s", "cm/s", "Pa", "kPa", "MPa", "1"})
             .required()
             .doc("of the values in the file"),
         choice("to", {"velocity"}).doc("velocity: an acceleration is integrated"),
         choice("baseline", {"none", "straight"})
             .standard("none")
             .doc("straight: takes the line a0 + a1 t off the acceleration that brings the last velocity and "
                  "the last displacement to zero"),
         number("longest_step", "s")
             .above(0)
             .doc("two samples further apart are a gap; 2.5 times the median step when left out")},
        read_record, "cdem.Record")
      .replayed(Replay::recorded);
  Class& model = m.the_class("Model");
  model
      .add("quiet",
           "Quiet boundary (Lysmer and Kuhlemeyer 1969): dashpots on outer faces let waves out, and a wave "
           "may enter through them. It takes the place of a fix of the same place, whose reactions stay as "
           "loads. For real-time stepping.",
           quiet_record.fields(), quiet)
      .replayed(Replay::again);
  model
      .add("free_field",
           "Vertical sides that move as if the rock went on beyond them: a column in one dimension, with the "
           "foot of the model (quiet or fix on z-, given before), moves each side through dashpots. It takes "
           "the place of a fix of the same side, whose reactions stay as loads.",
           {place("on").required().doc("\"x-\", \"x+\", \"y-\", \"y+\", or a list of them")}, free_field)
      .replayed(Replay::again);
}

} // namespace cdem::script
