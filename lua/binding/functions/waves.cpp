// Earthquakes in scripts: records from files, quiet boundaries with waves that enter, free fields.
#include "lua/binding/functions/over_time.hpp"
#include "lua/binding/functions/selections.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/objects/model_object.hpp"
#include "lua/binding/runtime/module.hpp"

#include "libcdem/load/record.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

namespace cdem::script {

namespace {

using geom::InputError;

// Two columns of a .csv, by the names in its first row, or by number where it has no names.
class CsvColumns {
public:
  CsvColumns(std::string name, const std::string& text) : name_(std::move(name)) {
    std::istringstream in(text);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.find_first_not_of(" \t\r,") == std::string::npos || line[0] == '#')
        continue;
      std::vector<std::string> cells = split(line);
      if (rows_.empty() && names_.empty() && !number_in(cells[0])) {
        names_ = std::move(cells);
        continue;
      }
      rows_.push_back({number, std::move(cells)});
    }
    if (rows_.empty())
      refuse("holds no rows of numbers");
  }

  std::vector<int> lines() const { // of the rows, in the file
    std::vector<int> numbers;
    for (const Row& row : rows_)
      numbers.push_back(row.line);
    return numbers;
  }

  std::size_t find(const std::string& column, const char* field) const {
    const auto named = std::find(names_.begin(), names_.end(), column);
    if (named != names_.end())
      return static_cast<std::size_t>(named - names_.begin());
    if (const auto number = number_in(column); names_.empty() && number && *number >= 1)
      return static_cast<std::size_t>(*number) - 1;
    std::string have;
    for (const std::string& n : names_)
      have += (have.empty() ? "" : ", ") + n;
    throw InputError(field, "\"" + column + "\"",
                     names_.empty()
                         ? "the number of a column, from \"1\", as the file \"" + name_ + "\" has no names"
                         : "a column of the file \"" + name_ + "\"",
                     names_.empty() ? "" : "it has: " + have);
  }

  std::vector<double> column(std::size_t index) const {
    std::vector<double> values;
    for (const auto& [line, cells] : rows_) {
      const auto number = index < cells.size() ? number_in(cells[index]) : std::nullopt;
      if (!number || !std::isfinite(*number))
        refuse(
            "line " + std::to_string(line) + ": " +
            (index < cells.size() && !cells[index].empty() ? "\"" + cells[index] + "\"" : "an empty cell") +
            " in column " + (names_.empty() ? std::to_string(index + 1) : "\"" + names_[index] + "\"") +
            ": must be a finite number; drop the row, or fill in what was not measured");
      values.push_back(*number);
    }
    return values;
  }

private:
  [[noreturn]] void refuse(const std::string& text) const {
    throw InputError("file \"" + name_ + "\": " + text);
  }
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line)
      if (c == ',' || c == ';')
        cells.emplace_back();
      else if (c != ' ' && c != '\t' && c != '\r' && c != '"')
        cells.back() += c;
    return cells;
  }
  static std::optional<double> number_in(const std::string& cell) {
    double x = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), x);
    return error == std::errc() && end == cell.data() + cell.size() && !cell.empty()
               ? std::optional<double>(x)
               : std::nullopt;
  }

  struct Row {
    int line;
    std::vector<std::string> cells;
  };
  std::string name_;
  std::vector<std::string> names_;
  std::vector<Row> rows_;
};

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
TimeTable integrated(Session& session, const std::string& head, const TimeTable& table,
                     const std::string& baseline, Table& result) {
  const VelocityRecord r = integrate(table, baseline == "straight");
  std::string line = head + " integrated to velocity, peak " + three_digits(peak(r.velocity)) +
                     " m/s; at its end " + three_digits(r.raw_end_velocity) + " m/s and " +
                     three_digits(r.raw_end_displacement) + " m";
  if (baseline == "straight")
    line += "; a baseline of " + three_digits(r.baseline.constant) + " m/s2 + " +
            three_digits(r.baseline.slope) + " m/s3 t taken off brings both to " +
            three_digits(r.end_velocity) + " m/s and " + three_digits(r.end_displacement) + " m";
  session.message(line);
  result.named["end_velocity"] = r.end_velocity;
  result.named["end_displacement"] = r.end_displacement;
  result.named["baseline"] = Table::list({r.baseline.constant, r.baseline.slope});
  return r.velocity;
}

Value read_record(Session& session, Object*, const Arguments& a) {
  const std::string& file = a.text("path");
  const CsvColumns csv(file, read_file(session.files.to_read(file)));
  TimeTable table;
  table.time = csv.column(csv.find(a.text("time"), "time"));
  table.value = csv.column(csv.find(a.text("value"), "value"));
  table.zero_outside = true;
  try {
    validate(table);
    require_no_gaps(table, a.optional_number("longest_step").value_or(0), csv.lines());
  } catch (const InputError& e) {
    throw InputError("record \"" + file + "\": " + e.what());
  }
  const Unit& unit = unit_of(a.text("unit"));
  for (double& value : table.value)
    value *= a.number("scale") * unit.factor;
  const bool acceleration = std::string(unit.si) == "m/s2", to_velocity = a.text_or("to", "") == "velocity";
  if (to_velocity && !acceleration)
    throw InputError("to", "\"velocity\"", "left out",
                     "only an acceleration (unit \"m/s2\", \"cm/s2\", \"g\") is "
                     "integrated, and this is in " +
                         std::string(unit.name));
  if (a.text("baseline") != "none" && !to_velocity)
    throw InputError("baseline: goes with to = \"velocity\"");
  const double first = table.time.front();
  const std::string head = "record \"" + file + "\": " + std::to_string(table.time.size()) +
                           " samples from " + three_digits(first) + " to " + three_digits(table.time.back()) +
                           " s, peak " + three_digits(peak(table)) + " " + unit.si + ";";
  Table result;
  if (to_velocity)
    table = integrated(session, head, table, a.text("baseline"), result);
  else
    session.message(head.substr(0, head.size() - 1));
  result.named["peak"] = peak(table);
  result.named["duration"] = table.time.back() - first;
  result.named["unit"] = to_velocity ? "m/s" : unit.si;
  result.named["outside"] = "zero";
  result.named["times"] = Table::list(Values(table.time.begin(), table.time.end()));
  result.named["values"] = Table::list(Values(table.value.begin(), table.value.end()));
  return result;
}

Value quiet(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("quiet");
  if (a.has("velocity") && a.has("stress"))
    throw InputError("velocity and stress: give one of them; a stress wave has 'rho c' times its velocity");
  Quiet quiet;
  quiet.velocity = a.optional_vec3("velocity").value_or(geom::Vec3::Zero());
  quiet.stress = a.optional_vec3("stress").value_or(geom::Vec3::Zero());
  quiet.amplitude = amplitude_of(a);
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
  m.records.push_back(
      {"Record",
       "A quantity over time, from a file or of your own; what an amplitude takes.",
       {list("times", number_type(), 2).required().doc("s, ascending"),
        list("values", number_type(), 2).required().doc("as many"),
        choice("outside", {"hold", "zero"})
            .standard("hold")
            .doc("before the first and after the last time: those values, or 0"),
        number("peak").doc("largest magnitude"), number("duration").unit("s"), text("unit"),
        number("end_velocity").unit("m/s").doc("of an integrated acceleration"),
        number("end_displacement").unit("m"),
        list("baseline", number_type(), 2).doc("{a0, a1}: a0 + a1 t has been taken off, m/s2 and m/s3")}});
  m.functions.push_back(
      {"record",
       "Reads a record over time from two columns of a .csv, in SI units from then on; outside its times it "
       "is 0. Times "
       "must grow without gaps. With to = \"velocity\" an acceleration is integrated by the trapezoidal "
       "rule.",
       {text("path").required().doc("beside the script, in the output folder or below the results"),
        text("time").standard("time").doc(
            "name of its column (s); the number of it, \"1\", where the file has no names"),
        text("value").required().doc("name of its column"),
        number("scale").standard(1.0).doc("factor on the values"),
        choice("unit", {"m/s2", "cm/s2", "Gal", "g", "m/s", "cm/s", "Pa", "kPa", "MPa", "1"})
            .required()
            .doc("of the values in the file"),
        choice("to", {"velocity"}).doc("velocity: an acceleration is integrated"),
        choice("baseline", {"none", "straight"})
            .standard("none")
            .doc("straight: takes the line a0 + a1 t off the acceleration that brings the last velocity and "
                 "the "
                 "last displacement to zero"),
        number("longest_step")
            .above(0)
            .unit("s")
            .doc("two samples further apart are a gap; 2.5 times the median "
                 "step when left out")},
       false,
       "cdem.Record",
       "",
       read_record,
       false,
       Replay::recorded});
  Class& model = m.the_class("Model");
  const auto add = [&](std::string name, std::string doc, std::vector<Field> fields, auto body) {
    model.methods.push_back(
        {std::move(name), std::move(doc), std::move(fields), false, "", "", method<ModelObject>(body)});
    model.methods.back().replay = Replay::again;
  };
  const Field on = place("on").required().doc("where: a place or a list of places");
  add("quiet",
      "Quiet boundary (Lysmer and Kuhlemeyer 1969): dashpots on outer faces let waves out, and a wave may "
      "enter through "
      "them. It takes the place of a fix of the same place, whose reactions stay as loads. For real-time "
      "stepping.",
      {on, vec3("velocity").unit("m/s").doc("of the particles in the entering wave alone"),
       vec3("stress").unit("Pa").doc(
           "traction of the entering wave alone on these faces; the boundary adds 2 of it"),
       amplitude_field(), since_field()},
      quiet);
  add("free_field",
      "Vertical sides that move as if the rock went on beyond them: a column in one dimension, with the foot "
      "of the "
      "model (quiet or fix on z-, given before), moves each side through dashpots. It takes the place of a "
      "fix of the "
      "same side, whose reactions stay as loads.",
      {place("on").required().doc("\"x-\", \"x+\", \"y-\", \"y+\", or a list of them")}, free_field);
}

} // namespace cdem::script
