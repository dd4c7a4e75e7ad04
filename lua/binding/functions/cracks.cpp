// Results of fracture: area and energy of cracks, their tip and speed.
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libcdem/material/wave_speeds.hpp"
#include "libcdem/results/crack_tip.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;
using geom::Vec3;

// Default of `reach`, over the usual distance of broken points: about the edge of a tetrahedron.
constexpr double usual_reach = 1.5;
// Default of `window`, over the time that the crack has run.
constexpr double usual_window = 0.1;

const Record<Cracks> crack_sum{
    "CrackSum",
    "How much has cracked, and what it took.",
    {{number("area", "m2").doc("of all cracks: the three below together"), &Cracks::area},
     {number("tension_area", "m2").doc("broken in tension"), &Cracks::tension},
     {number("shear_area", "m2").doc("broken in shear"), &Cracks::shear},
     {number("damaged_area", "m2").doc("damage times area of what softens and is not broken"),
      &Cracks::damaged},
     {number("projected_area", "m2")
          .doc("area as the planes that failed see it: a cohesive crack takes its fracture energy on this "
               "one"),
      &Cracks::projected},
     {number("energy", "J").doc("taken by breaking and damage"),
      [](const Cracks& c) { return c.energy.tension + c.energy.shear; }},
     {number("tension_energy", "J"), [](const Cracks& c) { return c.energy.tension; }},
     {number("shear_energy", "J"), [](const Cracks& c) { return c.energy.shear; }}}};

Value cracks(Session&, ModelObject& model, const Arguments&) {
  const CracksByBody found = model.simulation.cracks();
  Table row = crack_sum(found.all()), bodies;
  for (std::size_t b = 0; b < found.bodies.size(); ++b)
    bodies.named[model.body_names[b]] = crack_sum(found.bodies[b]);
  row.named["bodies"] = std::move(bodies);
  row.named["between"] = crack_sum(found.between);
  return row;
}

Value record_cracks(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("record_cracks");
  model.simulation.record_cracks(column_name(a), a.text_or("body", ""));
  return {};
}

std::vector<Vec3> corners_of(const ModelObject& model, const Arguments& a) {
  std::vector<Vec3> corners;
  for (const Value& corner : a.list("path"))
    corners.push_back(to_vec3(corner));
  const bool line = a.has("point") || a.has("direction");
  if (corners.empty() != line || a.has("point") != a.has("direction"))
    throw InputError("path: give either path, a list of places, or point and direction");
  if (line) {
    const Vec3 direction = a.vec3("direction");
    if (!(direction.norm() > 0))
      throw InputError("direction", describe(a.value("direction")), "longer than zero");
    corners = {a.vec3("point"),
               a.vec3("point") + model.simulation.model().box.size().norm() * direction.normalized()};
  }
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (corners[i] == corners[i - 1])
      throw InputError("path[" + std::to_string(i + 1) + "]: the same place as path[" + std::to_string(i) +
                       "]; leave one out");
  return corners;
}

// The body named, or the only one; nil where there are several.
Value rayleigh_of(const ModelObject& model, const Arguments& a) {
  if (a.has("body"))
    return rayleigh_speed(model.simulation.material(a.text("body")));
  return model.body_names.size() == 1 ? Value(rayleigh_speed(model.simulation.material(model.body_names[0])))
                                      : Value();
}

const Record<CrackTipRow> tip_row{
    "CrackTip",
    "The tip of a crack along a path: lists with an entry for each step at which it moved on.",
    {{number("time", "s"), &CrackTipRow::time},
     {number("position", "m").doc("along the path"), &CrackTipRow::position},
     {number("speed", "m/s")
          .doc("least-squares slope over the window; nan where no time passes, as in a relaxation"),
      &CrackTipRow::speed},
     {vec3("place", "m").doc("of the broken point, undeformed"), &CrackTipRow::place},
     {number("stage"), &CrackTipRow::stage},
     {number("step").doc("within the stage"), &CrackTipRow::step}}};

Value crack_tip(Session&, ModelObject& model, const Arguments& a) {
  const auto& breaks = model.simulation.log().breaks;
  CrackLine path{corners_of(model, a), a.number("width"), 0};
  const double distance = usual_distance(breaks, path.corners, path.width);
  path.reach = a.optional_number("reach").value_or(distance > 0 ? usual_reach * distance : path.width);
  std::vector<CrackTipRow> rows = cdem::crack_tip(breaks, path);
  const double ran = rows.empty() ? 0 : rows.back().time - rows.front().time;
  const double window = a.optional_number("window").value_or(usual_window * ran);
  if (window > 0)
    add_speeds(rows, window);
  double fastest = 0;
  for (const CrackTipRow& row : rows)
    fastest = std::fmax(fastest, row.speed);
  Table result = tip_row.columns(rows);
  result.named.insert({{"reach", path.reach}, {"window", window}, {"fastest", fastest}});
  if (!rows.empty())
    result.named["tip"] = Table{{"position", rows.back().position}, {"place", rows.back().place}};
  result.named["rayleigh_speed"] = rayleigh_of(model, a);
  return result;
}

void bind_crack_records(Module& m) {
  m.records.push_back(crack_sum);
  RecordType all = crack_sum, tip = tip_row.of_columns();
  all.name = "Cracks";
  all.doc = "How much has cracked, of the model and of each body.";
  all.fields.push_back(record("between", all.fields).required().doc("in joints between two bodies"));
  all.fields.insert(all.fields.end() - 1,
                    plain("bodies").required().doc("a cdem.CrackSum for each body, by its name"));
  m.records.push_back(std::move(all));
  tip.fields = tip.fields +
               std::vector<Field>{
                   record("tip", {number("position", "m").required(), vec3("place", "m").required()})
                       .doc("the last of them; nil where nothing broke at the start of the path"),
                   number("fastest", "m/s").required().doc("largest speed; 0 where there is none"),
                   number("rayleigh_speed", "m/s").doc("of the body, which no crack in tension can exceed"),
                   number("reach", "m").required(), number("window", "s").required()};
  m.records.push_back(std::move(tip));
}

void bind_tip(Class& model) {
  model.add(
      "crack_tip",
      "Where the tip of a crack was along a path, and how fast it ran, from the bonds that broke. The tip is "
      "the farthest broken point that hangs together with the start of the path; a microcrack ahead counts "
      "once the crack has met it.",
      {vec3("point", "m").doc("where the crack starts, undeformed; the path runs on to the end of the model"),
       vec3("direction").doc("of that straight path"),
       list("path", vec3_type(), 2)
           .unit("m")
           .doc("instead of point and direction: its corners, undeformed, the first where the crack starts. "
                "Along a face of a body it follows what shows there"),
       number("width", "m").above(0).required().doc("how far from the path a broken point may lie"),
       number("reach", "m")
           .above(0)
           .doc("points nearer than this hang together; about the edge of a tetrahedron when left out"),
       number("window", "s")
           .above(0)
           .doc("over which the speed is fitted; several times what the crack takes for one element. A tenth "
                "of "
                "the time it ran when left out"),
       text("body").doc("whose Rayleigh speed is told; the only one when left out")},
      crack_tip, "cdem.CrackTip");
}

} // namespace

void bind_cracks(Module& m) {
  bind_crack_records(m);
  m.add(
       "rayleigh_speed",
       "Speed of waves along the free surface of a material, m/s: the exact root of Rayleigh's equation. A "
       "crack in tension cannot run faster.",
       {object("material", "Material").required()},
       [](Session&, Object*, const Arguments& a) -> Value {
         return rayleigh_speed(a.object<MaterialObject>("material")->elastic);
       },
       "number")
      .ordered();
  Class& model = m.the_class("Model");
  model.add("cracks", "Area of all cracks and the energy they took, of the model and of each body.", {},
            cracks, "cdem.Cracks");
  model.add("record_cracks",
            "Samples the area and energy of cracks into the history, as columns <name>_area, "
            "<name>_tension_area, <name>_shear_area, <name>_damaged_area, <name>_projected_area, "
            "<name>_energy, <name>_tension_energy and <name>_shear_energy (as in cdem.CrackSum).",
            {text("name").standard(std::string("crack")),
             text("body").doc("by name; the whole model when left out")},
            record_cracks);
  bind_tip(model);
}

} // namespace cdem::script
