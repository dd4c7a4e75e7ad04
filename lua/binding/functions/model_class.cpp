// What a model tells of itself: its properties, counts, box, process zones, and places with a name.
#include "libcdem/results/process_zone.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cstdio>

namespace cdem::script {

namespace {

using geom::InputError;

const Record<ModelCounts> counts_record{
    "Counts",
    "Each bond (spring point) stands in exactly one of intact, broken_tension, broken_shear and contacts. "
    "These are the springs of the model as it is now: faces of blocks that are cut or have slid have got new "
    "ones, so that more or fewer are broken now than have broken (`model:breaks`).",
    {{integer("bodies"), &ModelCounts::bodies},
     {integer("blocks"), &ModelCounts::blocks},
     {integer("nodes"), &ModelCounts::nodes},
     {integer("tets"), &ModelCounts::tets},
     {integer("interfaces"), &ModelCounts::interfaces},
     {integer("bonds"), &ModelCounts::bonds},
     {integer("intact"), &ModelCounts::intact},
     {integer("broken_tension"), &ModelCounts::broken_tension},
     {integer("broken_shear"), &ModelCounts::broken_shear},
     {integer("contacts"), &ModelCounts::contacts},
     {integer("damaged").doc("of the intact ones: have begun to soften"), &ModelCounts::damaged}}};

const Record<ProcessZone> process_zone{
    "ProcessZone",
    "The process zone of a law that softens beside the faces that carry it; medians over the faces.",
    {{text("of").doc("body, regions or pair of bodies"), &ProcessZone::of},
     {number("length", "m").doc("E' G_I / T^2, E' = E / (1 - nu^2)"), &ProcessZone::length},
     {number("face_size", "m").doc("edge of an equilateral triangle of the face's area"),
      &ProcessZone::face_size},
     {number("largest_face_size", "m").doc("that leaves three faces in the cohesive zone"),
      &ProcessZone::largest_face_size},
     {number("faces_in_zone").doc("faces in the cohesive zone, 0.88 of the length"),
      &ProcessZone::faces_in_zone}}};

Table process_zones(ModelObject& model) {
  return process_zone.list(cdem::process_zones(model.simulation.model()));
}

Value select(Session&, ModelObject& model, const Arguments& a) {
  const std::string& name = a.text("name");
  const bool body =
      std::find(model.body_names.begin(), model.body_names.end(), name) != model.body_names.end();
  const bool side = name.size() == 2 && (name[1] == '-' || name[1] == '+');
  if (name.empty() || name == "all" || body || side || model.places.count(name) > 0)
    throw InputError("name", "\"" + name + "\"", "a new name",
                     body || side || name == "all" || name.empty() ? "that one stands for something else"
                                                                   : "it was given before");
  model.places[name] = selections(model, a.value("on"), "on");
  return {};
}

Table counts(ModelObject& model) {
  return counts_record(model.simulation.counts());
}

void add_properties(Class& model) {
  Property memory{
      "memory", "table", "",
      "What callbacks must remember: only booleans, numbers, strings and tables of them. It is saved with "
      "the model, a local variable is not.",
      [](Session&, Object& self) -> Value { return static_cast<ModelObject&>(self).memory; }};
  memory.set = [](Session& session, Object& self, const Value& value) {
    if (!value.table())
      throw InputError("memory", describe(value), "a table");
    check_value(value, plain("memory").type, "memory");
    static_cast<ModelObject&>(self).memory = session.new_memory(value);
  };
  model.property("time", "number", "s", "in a check: what the runs before would have come to",
                 [](const ModelObject& m) { return m.time(); });
  model.property("residual", "number", "", "out-of-balance force norm over applied force norm",
                 [](const ModelObject& m) { return m.simulation.residual(); });
  model.property("steps", "integer", "", "of all stages so far",
                 [](const ModelObject& m) { return m.simulation.steps(); });
  model.property("stable_time_step", "number", "s", "of real-time stepping",
                 [](const ModelObject& m) { return m.simulation.stable_time_step(); });
  model.property("state_hash", "string", "", "of every state field, bit for bit", [](const ModelObject& m) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(m.simulation.state_hash()));
    return std::string(text);
  });
  model.properties.push_back(memory);
}

} // namespace

void bind_model_class(Module& m) {
  m.records.insert(m.records.end(), {counts_record, process_zone});
  Class model{"Model", "Made by cdem.model."};
  add_properties(model);
  model.text = [](const Object& self) {
    const auto& object = static_cast<const ModelObject&>(self);
    const ModelCounts c = object.simulation.counts();
    return "cdem.Model (" + geom::counted(c.bodies, "body", "bodies") + ", " +
           geom::counted(c.blocks, "block") + ", " + geom::counted(c.tets, "tet") + ", " +
           geom::counted(c.bonds, "bond") + ")";
  };
  model
      .add("select", "Gives a place a name that `on` understands from now on.",
           {text("name").required(), place("on").required()}, select)
      .replayed(Replay::again);
  model.add("counts", "How many there are of everything.", {}, counts, "cdem.Counts");
  model.add("process_zones",
            "Whether faces resolve the process zone E' G_I / T^2 of what softens, by body and pair.", {},
            process_zones, "cdem.ProcessZone[]");
  model.add(
      "box", "Smallest axis-aligned box around the undeformed model.", {},
      [](ModelObject& self) { return self.simulation.model().box; }, "cdem.Box");
  m.classes.push_back(model);
}

} // namespace cdem::script
