#include "lua/binding/session/model_object.hpp"

#include "lua/binding/replay/led.hpp"
#include "lua/binding/schema/schema.hpp"
#include "lua/binding/text/csv.hpp"

#include "libcdem/vtk/film.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace cdem::script {

std::string column_name(const Arguments& a, const std::string& what) {
  const std::string& name = a.text("name");
  if (name.empty() || name.find_first_of(",\n\"") != std::string::npos)
    throw geom::InputError("name", describe(a.value("name")), "a word: " + what + " of history.csv");
  return name;
}

std::string ModelObject::title(const Session& session) const {
  std::string text = session.report.case_name;
  for (auto it = session.stages.rbegin(); it != session.stages.rend(); ++it)
    if (it->model == number)
      return text + ", stage " + std::to_string(it->number) + " (" + it->kind + ")";
  return text;
}

void ModelObject::require_idle(const char* call) const {
  if (solving)
    throw geom::InputError(std::string(call) +
                           ": not from a callback of a running stage; a callback may read the "
                           "model and write files. End the stage first");
  touched = true;
}

void ModelObject::check_memory() const {
  const Field field = plain("model.memory");
  check_value(memory->copy(), field.type, field.name);
}

std::string ModelObject::history_name() const {
  return (trial ? "trials/" : "") +
         (number == 1 ? std::string("history.csv") : "history_" + std::to_string(number) + ".csv");
}

namespace {

// The bytes of numbers, NaN among them.
bool begins_with(const Columns& columns, const Columns& first) {
  const auto has = [](const auto& all, const auto& some) {
    const std::vector<double>&values = all.second, &before = some.second;
    return all.first == some.first && values.size() >= before.size() &&
           (before.empty() || std::memcmp(values.data(), before.data(), before.size() * sizeof(double)) == 0);
  };
  return std::equal(columns.begin(), columns.end(), first.begin(), first.end(), has);
}

} // namespace

// A script may run thousands of stages: rows that have been written keep their text.
void ModelObject::write_history(const Session& session) const {
  led_act("history", [&] {
    Columns columns = history_columns(simulation);
    if (begins_with(columns, written.columns))
      written.text += csv_rows(columns, written.columns.front().second.size());
    else
      written.text = csv(columns);
    written.columns = std::move(columns);
    write_file(session.files.to_write(history_name()), written.text);
  });
}

void ModelObject::write_films(const Session& session) {
  for (Film& film : films) {
    const std::vector<SeriesEntry>& frames = series[session.files.would_write(film.file).string()];
    if (frames.size() == film.written)
      continue;
    film.written = frames.size();
    led_act("film", [&] {
      std::vector<std::string> files;
      for (const SeriesEntry& frame : frames)
        if (const auto file = session.files.would_write(frame.file); std::filesystem::exists(file))
          files.push_back(file.string());
      if (!files.empty()) // else they could not be drawn, as the user was told
        write_film(files, film.frames_per_second, session.files.to_write(film.file).string());
    });
  }
}

Columns history_columns(const Simulation& simulation) {
  const auto& rows = simulation.log().history;
  Columns columns;
  const auto add = [&](const std::string& name, auto get) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const auto& row : rows)
      values.push_back(static_cast<double>(get(row)));
    columns.emplace_back(name, std::move(values));
  };
  add("stage", [](const auto& r) { return r.stage; });
  add("step", [](const auto& r) { return r.step; });
  add("time", [](const auto& r) { return r.time; });
  add("residual", [](const auto& r) { return r.residual; });
  add("kinetic_energy", [](const auto& r) { return r.kinetic; });
  add("external_work", [](const auto& r) { return r.external; });
  add("broken_tension", [](const auto& r) { return r.broken_tension; });
  add("broken_shear", [](const auto& r) { return r.broken_shear; });
  const std::vector<Probe>& probes = simulation.log().probes;
  for (std::size_t i = 0; i < probes.size(); ++i)
    add(probes[i].name, [i](const auto& r) {
      // Samples older than the probe have no value.
      return i < r.probes.size() ? r.probes[i] : std::nan("");
    });
  return columns;
}

std::string csv(const Columns& columns) {
  std::string head;
  for (const auto& [name, values] : columns)
    head += (head.empty() ? "" : ",") + csv_cell(name);
  return head + '\n' + csv_rows(columns, 0);
}

std::string csv_rows(const Columns& columns, std::size_t first) {
  std::string out;
  std::size_t rows = 0;
  for (const auto& [name, values] : columns)
    rows = std::max(rows, values.size());
  for (std::size_t r = first; r < rows; ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto& values = columns[c].second;
      if (c > 0)
        out += ',';
      if (r < values.size() && !std::isnan(values[r]))
        out += number_text(values[r]);
    }
    out += '\n';
  }
  return out;
}

} // namespace cdem::script
