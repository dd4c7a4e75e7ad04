// Line charts: of a model's histories, and of any lists.
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libcdem/vtk/chart.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

const Record<ChartOptions> chart_record{
    {{drawing_field()},
     {text("title").doc("_{...} and ^{...} set sub- and superscripts"), &ChartOptions::title},
     {text("x_label").doc(
          "ending in an SI unit, \"opening (m)\", the axis is shown with the prefix that suits: mm"),
      &ChartOptions::x_label},
     {text("y_label"), &ChartOptions::y_label},
     {text("right_label").doc("of the axis on the right"), &ChartOptions::right_label},
     {flag("log_x").standard(), &ChartOptions::log_x},
     {flag("log_y").standard(), &ChartOptions::log_y},
     {flag("log_right").standard(), &ChartOptions::log_right},
     {list("x_range", number_type(), 2)},
     {list("y_range", number_type(), 2)},
     {list("right_range", number_type(), 2)},
     {choice("legend", {"auto", "top_left", "top_right", "bottom_left", "bottom_right", "none"})
          .standard("auto"),
      &ChartOptions::legend},
     {size_field()},
     {dpi_field(), &ChartOptions::dpi}}};

ChartOptions chart_options(const Arguments& a) {
  ChartOptions options = chart_record.read(a);
  options.x_range = limits_of(a, "x_range");
  options.y_range = limits_of(a, "y_range");
  options.right_range = limits_of(a, "right_range");
  options.size = size_of(a, false);
  return options;
}

Value chart_of_lists(Session& session, Object*, const Arguments& a) {
  require_drawing(a.text("file"));
  const ChartOptions options = chart_options(a);
  std::vector<Series> all;
  for (const Arguments& given : a.records("series")) {
    Series series;
    series.name = given.text("name");
    // Lists may hold nan or inf: they leave a gap in the line.
    for (const char* axis : {"x", "y"}) {
      for (const Value& value : given.list(axis)) {
        if (!value.is_number())
          throw InputError("series \"" + series.name + "\": " + axis + ": " + describe(value) +
                           ": must be a number");
        (*axis == 'x' ? series.x : series.y).push_back(value.number());
      }
    }
    if (series.x.size() != series.y.size())
      throw InputError("series \"" + series.name + "\": x has " + std::to_string(series.x.size()) +
                       " values, y has " + std::to_string(series.y.size()) + ": must be as many");
    series.right_axis = given.flag("right_axis");
    series.style = given.text("style");
    series.colour = colour_of(given);
    all.push_back(std::move(series));
  }
  if (!session.settings.check_only)
    draw(session, a.text("file"), [&](const std::string& path) { chart(all, options, path); });
  return {};
}

const std::vector<double>& column(const std::vector<std::pair<std::string, std::vector<double>>>& columns,
                                  const std::string& name, const std::string& key) {
  std::vector<std::string> names;
  for (const auto& [other, values] : columns) {
    if (other == name)
      return values;
    names.push_back(other);
  }
  throw InputError(key + " = \"" + name + "\": no such history" + which_there_are(name, names));
}

// Where the stages of a model began, over time or steps.
std::vector<ChartMark> marks_of_stages(const Session& session, const ModelObject& model,
                                       const std::vector<double>& x) {
  std::vector<ChartMark> marks;
  auto stage = session.stages.begin();
  const auto& rows = model.simulation.log().history;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (row > 0 && rows[row].stage == rows[row - 1].stage)
      continue;
    stage =
        std::find_if(stage, session.stages.end(), [&](const Stage& s) { return s.model == model.number; });
    if (stage == session.stages.end())
      break;
    marks.push_back({x[row], std::to_string(stage->number) + " " + stage->kind});
    std::replace(marks.back().name.begin(), marks.back().name.end(), '_', ' ');
    ++stage;
  }
  return marks;
}

Value chart_of_histories(Session& session, ModelObject& model, const Arguments& a) {
  require_drawing(a.text("file"));
  ChartOptions options = chart_options(a);
  const auto columns = history_columns(model.simulation);
  const std::string& x_name = a.text("x");
  const auto& x = column(columns, x_name, "x");
  if (options.x_label.empty())
    options.x_label = x_name == "time" ? "time (s)" : x_name;
  std::vector<Series> all;
  const auto add = [&](const char* key, bool right) {
    for (const Value& item : a.list(key)) {
      const std::string& name = *item.get<std::string>();
      Series series;
      series.name = name;
      std::replace(series.name.begin(), series.name.end(), '_', ' ');
      series.x = x;
      series.y = column(columns, name, key);
      series.right_axis = right;
      all.push_back(std::move(series));
    }
  };
  add("y", false);
  add("right", true);
  constexpr std::size_t readable = 8;
  if (a.has("stages") && a.flag("stages") && x_name != "time" && x_name != "step")
    throw InputError("stages: are marked over time and steps; give x = \"time\" or x = \"step\" too");
  if (a.has("stages") ? a.flag("stages") : x_name == "time")
    options.marks = marks_of_stages(session, model, x);
  if (!a.has("stages") && (options.marks.size() < 2 || options.marks.size() > readable))
    options.marks.clear();
  if (!session.settings.check_only)
    draw(session, a.text("file"), [&](const std::string& path) { chart(all, options, path); });
  return {};
}

// Without held bodies in one piece, such as a floor on which others shatter; all of them where nothing else is there.
std::vector<FragmentMotion> fragments_of_broken(const std::vector<FragmentMotion>& all) {
  const auto in_one_piece = [&](int body) {
    return std::count_if(all.begin(), all.end(), [&](const FragmentMotion& f) { return f.body == body; }) ==
           1;
  };
  std::vector<FragmentMotion> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [&](const FragmentMotion& f) { return !(f.held && f.body >= 0 && in_one_piece(f.body)); });
  return some.empty() ? all : some;
}

// Steps at the diameters of the fragments.
Value chart_of_fragments(Session& session, ModelObject& model, const Arguments& a) {
  require_drawing(a.text("file"));
  ChartOptions options = chart_options(a);
  if (options.x_label.empty())
    options.x_label = "diameter (m)";
  if (options.y_label.empty())
    options.y_label = "mass passing (%)";
  if (!options.y_range)
    options.y_range = {{0, 100}};
  const std::vector<PassingRow> rows = mass_passing(fragments_of_broken(model.simulation.fragment_motions()));
  Series series;
  series.name = geom::counted(rows.size(), "fragment");
  series.style = rows.size() == 1 ? "points" : "line";
  double passing = 0;
  for (const PassingRow& row : rows) {
    if (rows.size() > 1) {
      series.x.push_back(row.diameter);
      series.y.push_back(100 * passing);
    }
    passing = row.passing;
    series.x.push_back(row.diameter);
    series.y.push_back(100 * passing);
  }
  if (!session.settings.check_only)
    draw(session, a.text("file"), [&](const std::string& path) { chart({series}, options, path); });
  return {};
}

} // namespace

void bind_charts(Module& m) {
  const std::vector<Field> series{text("name").required().doc("in the legend"),
                                  list("x", scalar_type(), 0).required(),
                                  list("y", scalar_type(), 0).required().doc("as many; nan leaves a gap"),
                                  flag("right_axis").standard(false).doc("read y on the right"),
                                  choice("style", {"line", "dashed", "points", "both"}).standard("line"),
                                  colour_field()};
  std::vector<Field> lists = chart_record.fields();
  lists.insert(lists.begin() + 1, list("series", record_type(series)).required());
  m.add("chart", "Line chart of lists of numbers.", lists, chart_of_lists)
      .replayed(Replay::recorded)
      .by_rank_0();

  std::vector<Field> histories = chart_record.fields();
  histories.insert(
      histories.begin() + 1,
      {list("y", text_type()).required().doc("histories, e.g. {\"residual\"}; model:history() has all"),
       list("right", text_type(), 0).doc("histories read on the right"),
       text("x").standard("step").doc("history along the x axis"),
       flag("stages").doc(
           "over time or steps, a thin line with its name where each stage began; when left out over time "
           "where there are two to eight of them")});
  m.the_class("Model").add("chart", "Line chart of histories.", histories, chart_of_histories).by_rank_0();

  std::vector<Field> fragments = chart_record.fields();
  for (Field& field : fragments)
    if (field.name == "log_x")
      field = flag("log_x").standard(true);
  m.the_class("Model")
      .add("chart_fragments",
           "Chart of the fragments by size: the part of the mass in fragments up to each diameter, that of "
           "the sphere with their volume. Held bodies in one piece, such as a floor, are left out.",
           fragments, chart_of_fragments)
      .by_rank_0();
}

} // namespace cdem::script
