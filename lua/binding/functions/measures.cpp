// Results of a model as Lua values.
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

Selection place_of(const ModelObject& model, const Arguments& a) {
  return one_selection(model, a.value("on"), "on");
}

Value extreme(const FieldValue& found) {
  return Table{{"value", found.value}, {"place", found.place}, {"block", found.block}};
}

Value max(Session&, ModelObject& model, const Arguments& a) {
  return model.simulation.max(a.text("field"), place_of(model, a)).value;
}
Value min(Session&, ModelObject& model, const Arguments& a) {
  return model.simulation.min(a.text("field"), place_of(model, a)).value;
}
Value find_max(Session&, ModelObject& model, const Arguments& a) {
  return extreme(model.simulation.max(a.text("field"), place_of(model, a)));
}
Value find_min(Session&, ModelObject& model, const Arguments& a) {
  return extreme(model.simulation.min(a.text("field"), place_of(model, a)));
}
Value mean(Session&, ModelObject& model, const Arguments& a) {
  return model.simulation.mean(a.text("field"), place_of(model, a));
}
Value at(Session&, ModelObject& model, const Arguments& a) {
  return model.simulation.at(a.text("field"), a.vec3("place"));
}
Value reaction(Session&, ModelObject& model, const Arguments& a) {
  return model.simulation.reaction(place_of(model, a));
}

Value fields(Session&, ModelObject&, const Arguments&) {
  const auto names = Simulation::field_names();
  return Table::list(Values(names.begin(), names.end()));
}

Value energy(Session&, ModelObject& model, const Arguments&) {
  const EnergyLedger e = model.simulation.energy();
  return Table{{"elastic", e.elastic},
               {"springs", e.springs},
               {"bolts", e.bolts},
               {"kinetic", e.kinetic},
               {"damping", e.damping},
               {"radiated", e.radiated},
               {"friction", e.friction},
               {"breaking", e.breaking},
               {"plastic", e.plastic},
               {"yielding", e.yielding},
               {"cutting", e.cutting},
               {"fictitious", e.fictitious},
               {"external", e.external},
               {"external_peak", e.external_peak},
               {"total", e.total()},
               {"balance_error", e.balance_error()},
               {"one_way_error", model.simulation.impossible_energy(e).part}};
}

Value overlap(Session&, ModelObject& model, const Arguments&) {
  const Overlap o = model.simulation.overlap();
  Table table{{"volume", o.volume}, {"pairs", o.pairs}, {"largest", o.largest}, {"place", o.place}};
  if (o.pairs > 0)
    table.named["blocks"] = Table::list({o.largest_a, o.largest_b});
  return table;
}

Value blocks(Session&, ModelObject& model, const Arguments&) {
  Values rows;
  for (const auto& b : model.simulation.blocks())
    rows.emplace_back(Table{{"id", b.id},
                            {"parent", b.parent},
                            {"generation", b.generation},
                            {"body", b.body},
                            {"centroid", b.centroid},
                            {"volume", b.volume},
                            {"displacement", b.displacement},
                            {"stress", b.stress}});
  return Table::list(std::move(rows));
}

Value breaks(Session&, ModelObject& model, const Arguments&) {
  Values rows;
  for (const BreakRow& b : model.simulation.breaks())
    rows.emplace_back(Table{{"stage", b.stage},
                            {"step", b.step},
                            {"time", b.time},
                            {"mode", b.mode == BondMode::broken_shear ? "shear" : "tension"},
                            {"place", b.place},
                            {"normal", b.normal},
                            {"area", b.area},
                            {"normal_traction", b.normal_traction},
                            {"shear_traction", b.shear_traction},
                            {"block_a", b.block_a},
                            {"block_b", b.block_b}});
  return Table::list(std::move(rows));
}

Value history(Session&, ModelObject& model, const Arguments&) {
  Table table;
  for (auto& [name, values] : history_columns(model.simulation))
    table.named[name] = Table::list(Values(values.begin(), values.end()));
  return table;
}

std::string column_name(const Arguments& a) {
  const std::string& name = a.text("name");
  if (name.empty() || name.find_first_of(",\n\"") != std::string::npos)
    throw InputError("name", describe(a.value("name")),
                     "a word: it begins the names of columns of history.csv");
  return name;
}

Value probe(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("probe");
  std::vector<std::string> taken = model.simulation.probe_names();
  for (const auto& [name, values] : history_columns(model.simulation))
    taken.push_back(name);
  const std::string& name = a.text("name");
  if (name.empty() || name.find_first_of(",\n\"") != std::string::npos)
    throw InputError("name", describe(a.value("name")), "a word: it becomes a column of history.csv");
  if (std::find(taken.begin(), taken.end(), name) != taken.end())
    throw InputError("name", describe(a.value("name")), "a new name",
                     "the history has these: " + joined(taken));
  model.simulation.probe(name, a.text("field"), a.vec3("at"));
  return {};
}

Value record_reaction(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("record_reaction");
  model.simulation.record_reaction(column_name(a), a.text("on"));
  return {};
}
Value record_momentum(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("record_momentum");
  model.simulation.record_momentum(column_name(a), a.text("body"));
  return {};
}

void bind_rows(Module& m) {
  m.records.push_back({"Extreme",
                       "Where a field is largest or smallest.",
                       {number("value").required(), vec3("place").unit("m").required().doc("undeformed"),
                        integer("block").required().doc("id")}});
  m.records.push_back(
      {"Energy",
       "Energy ledger, J: what is stored, what was spent, what was given.",
       {number("elastic").unit("J").required().doc("stored in the blocks"),
        number("springs").unit("J").required().doc("stored in bonds and contacts"),
        number("bolts").unit("J").required().doc("stored in bolts and their grout"),
        number("kinetic").unit("J").required().doc(
            "of the real masses, or of a relaxation's fictitious ones"),
        number("damping").unit("J").required(),
        number("radiated").unit("J").required().doc("left through quiet boundaries and free fields"),
        number("friction").unit("J").required(),
        number("breaking").unit("J").required().doc("lost by bonds that broke or softened"),
        number("plastic").unit("J").required().doc("plastic work of blocks that yield"),
        number("yielding").unit("J").required().doc("lost by the steel of bolts that yielded"),
        number("cutting").unit("J").required().doc("lost when blocks were cut or removed"),
        number("fictitious").unit("J").required().doc("kinetic energy a relaxation threw away at its end"),
        number("external").unit("J").required().doc("work of loads, gravity and moving supports"),
        number("external_peak").unit("J").required().doc("largest |external| so far"),
        number("total").unit("J").required().doc("sum of all but external"),
        number("balance_error").required().doc("|total - external| over the largest energy above"),
        number("one_way_error")
            .required()
            .doc("the largest so far of: how far damping, friction, breaking, plastic or yielding, which can "
                 "only rise, fell; how far kinetic and stored energy were above what was given; over the "
                 "largest energy above")}});
  m.records.push_back(
      {"Overlap",
       "Volume that two blocks occupy at once, as they stand now.",
       {number("volume").unit("m3").required().doc("of all pairs of blocks"), integer("pairs").required(),
        number("largest").unit("m3").required().doc("of one pair"),
        vec3("place").unit("m").required().doc("of that pair"),
        list("blocks", text_type(), 2).doc("names of that pair; nil where nothing overlaps")}});
  m.records.push_back(
      {"BlockState",
       "A block of a model.",
       {integer("id").required(), integer("parent").required().doc("id of the block it was cut from"),
        integer("generation").required().doc("how often it was cut"), text("body").required(),
        vec3("centroid").unit("m").required().doc("undeformed"), number("volume").unit("m3").required(),
        vec3("displacement").unit("m").required().doc("of the centroid"),
        list("stress", number_type(), 6).unit("Pa").required().doc("{xx, yy, zz, xy, yz, xz}")}});
  m.records.push_back(
      {"Break",
       "A bond that broke.",
       {integer("stage").required(), integer("step").required().doc("within the stage"),
        number("time").unit("s").required(), choice("mode", {"tension", "shear"}).required(),
        vec3("place").unit("m").required().doc("undeformed"), vec3("normal").required(),
        number("area").unit("m2").required(),
        number("normal_traction").unit("Pa").required().doc("when it broke, tension positive"),
        number("shear_traction").unit("Pa").required().doc("when it broke"),
        integer("block_a").required().doc("id"), integer("block_b").required().doc("id")}});
}

} // namespace

void bind_measures(Module& m) {
  bind_rows(m);
  Class& model = m.the_class("Model");
  const Field field =
      text("field").required().doc("e.g. \"displacement.x\", \"stress.yy\"; model:fields() has all");
  const Field on =
      place("on").doc("where: one place; the whole model when left out. Stresses are those of blocks: on a "
                      "side, of those that have a face there; elsewhere of those whose centroid is there");
  model.add("max", "Largest value of a field.", {field, on}, max, "number").ordered_or_named();
  model.add("min", "Smallest value of a field.", {field, on}, min, "number").ordered_or_named();
  model.add("find_max", "Largest value of a field, and where it is.", {field, on}, find_max, "cdem.Extreme")
      .ordered_or_named();
  model.add("find_min", "Smallest value of a field, and where it is.", {field, on}, find_min, "cdem.Extreme")
      .ordered_or_named();
  model.add("mean", "Mean of a field: over nodes, or over blocks by volume.", {field, on}, mean, "number")
      .ordered_or_named();
  model
      .add("at", "Value of a field at an undeformed place, interpolated in the block there.",
           {field, vec3("place").unit("m").required()}, at, "number")
      .ordered_or_named();
  model
      .add("reaction",
           "Force of what holds a place from outside: of supports; of quiet boundaries and free fields the "
           "force of the support they took the place of, their dashpots, and the waves that enter. A node on "
           "an edge counts in both sides.",
           {place("on").required().doc("where: one place")}, reaction, "number[]", "N, {x, y, z}")
      .ordered_or_named();
  model.add("fields", "Names that max, min, mean, at and probe understand.", {}, fields, "string[]")
      .ordered_or_named();
  model.add("energy", "Energy ledger.", {}, energy, "cdem.Energy").ordered_or_named();
  model
      .add("overlap", "How far contacts let blocks into each other, as a volume.", {}, overlap,
           "cdem.Overlap")
      .ordered_or_named();
  model.add("blocks", "One table per block.", {}, blocks, "cdem.BlockState[]").ordered_or_named();
  model.add("breaks", "One table per broken bond, the oldest first.", {}, breaks, "cdem.Break[]")
      .ordered_or_named();
  model
      .add("history",
           "Histories as lists by name: stage, step, time, residual, kinetic_energy, external_work, "
           "broken_tension, broken_shear and the probes. The first sample of a run is its beginning. The "
           "same are in history.csv after each stage.",
           {}, history, "table<string, number[]>")
      .ordered_or_named();
  model.add("probe", "Samples a field at a place into the history.",
            {text("name").required().doc("of the column"), field,
             vec3("at").unit("m").required().doc("undeformed place")},
            probe);
  model.add("record_reaction",
            "Samples the force of the supports and boundaries (model:reaction) on a side or a body into the "
            "history (N), as columns <name>_x, <name>_y and <name>_z. Each sample costs some steps.",
            {text("name").required(), text("on").required().doc("\"x-\" .. \"z+\", or a body by name")},
            record_reaction);
  model.add(
      "record_momentum",
      "Samples the momentum of a body into the history (N s), as columns <name>_x, <name>_y and <name>_z.",
      {text("name").required(), text("body").required().doc("by name")}, record_momentum);
}

} // namespace cdem::script
