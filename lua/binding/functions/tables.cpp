// Small helpers: tables of numbers as .csv, lines for the log, the version.
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/csv.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/text_table.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

Value read_csv(Session& session, Object*, const Arguments& a) {
  const std::string& name = a.text("file");
  const geom::TextTable read(read_file(session.files.to_read(name)), name);
  if (read.names().empty())
    read.refuse("its first row holds numbers; it must name the columns");
  Table table;
  for (std::size_t c = 0; c < read.columns(); ++c) {
    const std::vector<double> values = read.numbers(c);
    if (!table.named.emplace(read.names()[c], Table::list(Values(values.begin(), values.end()))).second)
      read.refuse("two columns are named " + read.column_text(c) + "; give each a name of its own");
  }
  return table;
}

Value write_csv(Session& session, Object*, const Arguments& a) {
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  for (const Arguments& given : a.records("columns")) {
    const std::string& name = given.text("name");
    if (name.empty() || name.find_first_of("\r\n") != std::string::npos)
      throw InputError("columns: name", describe(given.value("name")), "a name of one line");
    std::vector<double> values;
    for (const Value& value : given.list("values")) {
      if (!value.is_number())
        throw InputError("column \"" + name + "\": " + describe(value) + ": must be a number");
      values.push_back(value.number());
    }
    if (!columns.empty() && columns.front().second.size() != values.size())
      throw InputError("column \"" + name + "\" has " + geom::counted(values.size(), "value") + ": must be " +
                       std::to_string(columns.front().second.size()) + ", as many as \"" +
                       columns.front().first + "\"");
    columns.emplace_back(name, std::move(values));
  }
  if (!session.settings.check_only)
    write_file(session.files.to_write(a.text("file")), csv(columns));
  return {};
}

Value log(Session& session, Object*, const Arguments& a) {
  session.message(a.text("text"));
  return {};
}

} // namespace

void bind_tables(Module& m) {
  m.add("read_csv",
        "Reads columns of numbers from a table as spreadsheets write it (docs/output-files.md); its first "
        "row has their names. Empty cells are nan.",
        {text("file").required().doc("beside the script, in the output folder or below the results")},
        read_csv, "table<string, number[]>", "lists by name")
      .ordered()
      .replayed(Replay::recorded)
      .by_rank_0();
  m.add("write_csv", "Writes columns of numbers.",
        {text("file").required().output(),
         list("columns", record_type({text("name").required(),
                                      list("values", scalar_type(), 0)
                                          .required()
                                          .doc("as many as in the others; nan leaves an empty cell")}))
             .required()},
        write_csv)
      .replayed(Replay::recorded)
      .by_rank_0();
  m.add("log", "Writes a line to the log and the terminal.", {text("text").required()}, log).ordered();
  m.add(
       "linspace", "Numbers at equal distances.",
       {number("first").required(), number("last").required(), integer("count").at_least(2).required()},
       [](Session&, Object*, const Arguments& a) -> Value {
         const double first = a.number("first"), last = a.number("last");
         const auto count = a.integer("count");
         if (count > 10000000)
           throw InputError("count", std::to_string(count), "<= 10000000");
         Values values;
         for (std::int64_t i = 0; i < count; ++i)
           values.emplace_back(i + 1 == count ? last
                                              : first + (last - first) * static_cast<double>(i) /
                                                            static_cast<double>(count - 1));
         return Table::list(std::move(values));
       },
       "number[]", "count numbers, both ends included")
      .ordered();
  m.add("describe", "Any value as readable text, tables with their contents.", {plain("value")}, {}, "string")
      .ordered();
  m.add(
       "elapsed", "Wall-clock time since the script began, s.", {},
       [](Session& session, Object*, const Arguments&) -> Value { return session.elapsed(); }, "number")
      .replayed(Replay::recorded)
      .by_rank_0();
  m.constants.push_back({"version", "Version of the toolkit.", CDEM_VERSION});
}

} // namespace cdem::script
