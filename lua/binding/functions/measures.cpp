// Results of a model as Lua values.
#include "libcdem/results/overlap.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

const Record<FieldValue> extreme{"Extreme",
                                 "Where a field is largest or smallest.",
                                 {{number("value"), &FieldValue::value},
                                  {vec3("place", "m").doc("undeformed"), &FieldValue::place},
                                  {integer("block").doc("id"), &FieldValue::block}}};

const Record<EnergyLedger> energy_record{
    "Energy",
    "Energy ledger, J: what is stored, what was spent, what was given.",
    {{number("elastic", "J").doc("stored in the blocks"), &EnergyLedger::elastic},
     {number("springs", "J").doc("stored in bonds and contacts"), &EnergyLedger::springs},
     {number("bolts", "J").doc("stored in bolts and their grout"), &EnergyLedger::bolts},
     {number("kinetic", "J").doc("of the real masses, or of a relaxation's fictitious ones"),
      &EnergyLedger::kinetic},
     {number("damping", "J"), &EnergyLedger::damping},
     {number("radiated", "J").doc("left through quiet boundaries and free fields"), &EnergyLedger::radiated},
     {number("friction", "J"), &EnergyLedger::friction},
     {number("breaking", "J").doc("lost by bonds that broke or softened"), &EnergyLedger::breaking},
     {number("plastic", "J").doc("plastic work of blocks that yield"), &EnergyLedger::plastic},
     {number("yielding", "J").doc("lost by the steel of bolts that yielded"), &EnergyLedger::yielding},
     {number("cutting", "J").doc("lost when blocks were cut or removed, or freed nodes joined again"),
      &EnergyLedger::cutting},
     {number("fictitious", "J").doc("kinetic energy a relaxation threw away at its end"),
      &EnergyLedger::fictitious},
     {number("external", "J").doc("work of loads, gravity and moving supports"), &EnergyLedger::external},
     {number("external_peak", "J").doc("largest |external| so far"), &EnergyLedger::external_peak},
     {number("total", "J").doc("sum of all but external"), &EnergyLedger::total},
     {number("balance_error").doc("|total - external| over the largest energy above"),
      &EnergyLedger::balance_error},
     {number("one_way_error")
          .required()
          .doc("the largest so far of: how far damping, friction, breaking, plastic or yielding, which can "
               "only rise, fell; how far kinetic and stored energy were above what was given; over the "
               "largest energy above")}}};

const Record<Overlap> overlap_record{
    "Overlap",
    "Volume that two blocks, or two pieces of one, occupy at once, as they stand now.",
    {{number("volume", "m3").doc("of all pairs of blocks, and of each block with itself"), &Overlap::volume},
     {integer("pairs"), &Overlap::pairs},
     {number("largest", "m3").doc("of one pair"), &Overlap::largest},
     {vec3("place", "m").doc("of that pair"), &Overlap::place},
     {list("blocks", text_type(), 2)
          .doc("names of that pair, twice the same for pieces of one block; nil where nothing overlaps"),
      [](const Overlap& o) {
        return o.pairs > 0 ? Value(Table::list({o.largest_a, o.largest_b})) : Value();
      }}}};

const Record<Simulation::BlockRow> block_state{
    "BlockState",
    "A block of a model.",
    {{integer("id"), &Simulation::BlockRow::id},
     {integer("parent").doc("id of the block it was cut from"), &Simulation::BlockRow::parent},
     {integer("generation").doc("how often it was cut"), &Simulation::BlockRow::generation},
     {text("body"), &Simulation::BlockRow::body},
     {vec3("centroid", "m").doc("undeformed"), &Simulation::BlockRow::centroid},
     {number("volume", "m3"), &Simulation::BlockRow::volume},
     {vec3("displacement", "m").doc("of the centroid"), &Simulation::BlockRow::displacement},
     {list("stress", number_type(), 6).unit("Pa").doc("{xx, yy, zz, xy, yz, xz}"),
      &Simulation::BlockRow::stress}}};

const Record<BreakRow> break_row{
    "Break",
    "A bond that broke.",
    {{integer("stage"), &BreakRow::stage},
     {integer("step").doc("within the stage"), &BreakRow::step},
     {number("time", "s"), &BreakRow::time},
     {choice("mode", {"tension", "shear"}),
      [](const BreakRow& b) { return b.mode == BondMode::broken_shear ? "shear" : "tension"; }},
     {vec3("place", "m").doc("undeformed"), &BreakRow::place},
     {vec3("normal"), &BreakRow::normal},
     {number("area", "m2"), &BreakRow::area},
     {number("normal_traction", "Pa").doc("when it broke, tension positive"), &BreakRow::normal_traction},
     {number("shear_traction", "Pa").doc("when it broke"), &BreakRow::shear_traction},
     {integer("block_a").doc("id"), &BreakRow::block_a},
     {integer("block_b").doc("id"), &BreakRow::block_b}}};

Selection place_of(const ModelObject& model, const Arguments& a) {
  return one_selection(model, a.value("on"), "on");
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

Value fields(ModelObject&) {
  return as_value(cdem::field_names());
}

Value energy(Session&, ModelObject& model, const Arguments&) {
  const EnergyLedger e = model.simulation.energy();
  Table table = energy_record(e);
  table.named["one_way_error"] =
      cdem::impossible_energy(e, model.simulation.time(), model.simulation.log().one_way).part;
  return table;
}

Table overlap(ModelObject& model) {
  return overlap_record(cdem::overlap(model.simulation.model(), model.simulation.state()));
}

Table blocks(ModelObject& model) {
  return block_state.list(model.simulation.blocks());
}

Table breaks(ModelObject& model) {
  return break_row.list(model.simulation.log().breaks);
}

Value history(Session&, ModelObject& model, const Arguments&) {
  Table table;
  for (auto& [name, values] : history_columns(model.simulation))
    table.named[name] = Table::list(Values(values.begin(), values.end()));
  return table;
}

Value probe(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("probe");
  std::vector<std::string> taken;
  for (const auto& [name, values] : history_columns(model.simulation))
    taken.push_back(name);
  const std::string name = column_name(a, "it becomes a column");
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

} // namespace

void bind_measures(Module& m) {
  m.records.insert(m.records.end(), {extreme, energy_record, overlap_record, block_state, break_row});
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
      .add("at",
           "Value of a field at an undeformed place, interpolated in the block there. Where two bodies share "
           "a "
           "face, it is the value of one of them, and a warning names it.",
           {field, vec3("place", "m").required()}, at, "number")
      .ordered_or_named();
  model
      .add("reaction",
           "Force that holds a place from outside: the force of its supports. A quiet boundary or a free "
           "field gives the force of the support that it replaced, of its dashpots, and of the waves that "
           "enter. The reaction balances everything that acts on the held nodes. A rigid body is held as a "
           "whole, so its reaction includes its weight; a held side includes the weight of the nodes on it. "
           "A node on an edge counts in both sides.",
           {place("on").required().doc("where: one place")}, reaction, "number[]", "N, {x, y, z}")
      .ordered_or_named();
  model.add("fields", "Names that max, min, mean, at and probe understand.", {}, fields, "string[]");
  model.add("energy", "Energy ledger.", {}, energy, "cdem.Energy");
  model.add("overlap",
            "How far contacts let blocks into each other, and the pieces of a broken body, as a volume.", {},
            overlap, "cdem.Overlap");
  model.add("blocks", "One table per block.", {}, blocks, "cdem.BlockState[]");
  model.add("breaks", "One table per broken bond, the oldest first.", {}, breaks, "cdem.Break[]");
  model.add("history",
            "Histories as lists by name: stage, step, time, residual, kinetic_energy, external_work, "
            "broken_tension, broken_shear and the probes. The first sample of a run is its beginning. The "
            "same are in history.csv after each stage.",
            {}, history, "table<string, number[]>");
  model.add("probe", "Samples a field at a place into the history.",
            {text("name").required().doc("of the column"), field,
             vec3("at", "m").required().doc("undeformed place")},
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
