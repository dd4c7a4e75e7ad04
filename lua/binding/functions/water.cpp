// Water in joints.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

const Record<Water> water_record{
    {{number("level", "m").doc("z of a level water table: weight times the depth below it"), &Water::level},
     {object("water_table", "WaterTable")
          .doc("instead: one that is not level; weight times the vertical depth below it")},
     {number_or_function("pressure", "(x: number, y: number, z: number): number")
          .at_least(0)
          .unit("Pa")
          .doc("instead: the same everywhere, or at each place; 0 takes the water away"),
      &Water::pressure},
     {list("table", tuple_type({number_type(), number_type()}), 2)
          .doc("instead: rows {z (m), pressure (Pa)}, upwards; straight between them, constant beyond")},
     {list("joints", text_type(), 1)
          .doc("names of joint sets and cuts that hold it; all joints when left out, glued cuts never"),
      &Water::sets},
     {place("on").standard("all").doc("where: one place; joints elsewhere keep what they have")},
     {water_weight_field("weight").doc("of the water"), &Water::weight}}};

Water water_of(const ModelObject& model, const Arguments& a, std::string& line) {
  Water water = water_record.read(a);
  water.on = one_selection(model, a.value("on"), "on");
  if (static_cast<int>(a.has("level")) + static_cast<int>(a.has("water_table")) +
          static_cast<int>(a.has("pressure")) + static_cast<int>(a.has("table")) !=
      1)
    throw InputError(
        "give one of level = z of the water (m), water_table = cdem.water_table{...}, pressure = a "
        "number (Pa) or function(x, y, z), "
        "and table = rows {z, pressure}");
  line = "water in joints";
  if (a.has("level")) {
    line += " up to z = " + describe(a.value("level")) + " m";
  } else if (const auto given = a.object<WaterTableObject>("water_table")) {
    water.table = given->table;
    line += " up to a water table, " + given->words;
  } else if (a.has("table")) {
    std::vector<std::array<double, 2>> rows;
    for (const Value& row : a.list("table"))
      rows.push_back({row.table()->items[0].number(), row.table()->items[1].number()});
    water.pressure = pressure_over_height(std::move(rows));
    line += " after a table";
  } else {
    line += a.value("pressure").is_number() ? " at " + describe(a.value("pressure")) + " Pa"
                                            : std::string(" after a function");
  }
  for (const std::string& set : water.sets)
    line += (&set == water.sets.data() ? " in \"" : ", \"") + set + "\"";
  line += ", " + water.on.text;
  return water;
}

const Record<WaterInJoints> water_sum{
    "WaterInJoints",
    "All the water in the joints of a model.",
    {{integer("points").doc("of joints, under pressure"), &WaterInJoints::points},
     {number("area", "m2"), &WaterInJoints::area},
     {number("largest", "Pa").doc("pressure"), &WaterInJoints::largest},
     {number("force", "N").doc("sum of pressure times area"), &WaterInJoints::force}}};

Value water(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("water");
  std::string line;
  const WaterInJoints sum = model.simulation.water(water_of(model, a, line));
  model.notes->conditions.push_back(line);
  if (sum.points > 0 && model.simulation.conditions().gravity.value_or(Gravity()).water_density > 0)
    session.warn(
        "water: gravity has a water_density too, whose buoyancy holds for blocks that water surrounds; "
        "where joints carry the pressure it counts twice: leave water_density out");
  return water_sum(sum);
}

} // namespace

void bind_water(Module& m) {
  m.records.push_back(water_sum);
  Class& model = m.the_class("Model");
  model
      .add("water",
           "Water in the joints between blocks. Its pressure pushes the two faces of a joint apart, open or "
           "closed, and the joint's law bears the rest, the effective stress. It is taken at the undeformed "
           "places, once, and stays until it is set again; call it between stages to raise or lower the "
           "water.",
           water_record.fields(), water, "cdem.WaterInJoints")
      .replayed(Replay::again);
}

} // namespace cdem::script
