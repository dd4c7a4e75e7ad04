// What a model tells of itself: its properties, counts, box, process zones, and places with a name.
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cstdio>

namespace cdem::script {

namespace {

using geom::InputError;

Value process_zones(Session&, ModelObject& model, const Arguments&) {
  Values rows;
  for (const ProcessZone& zone : model.simulation.process_zones())
    rows.emplace_back(Table{{"of", zone.of},
                            {"length", zone.length},
                            {"face_size", zone.face_size},
                            {"largest_face_size", zone.largest_face_size},
                            {"faces_in_zone", zone.faces_in_zone()}});
  return Table::list(std::move(rows));
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

Value counts(Session&, ModelObject& model, const Arguments&) {
  const ModelCounts c = model.simulation.counts();
  return Table{{"bodies", c.bodies},
               {"blocks", c.blocks},
               {"nodes", c.nodes},
               {"tets", c.tets},
               {"interfaces", c.interfaces},
               {"bonds", c.bonds},
               {"intact", c.intact},
               {"broken_tension", c.broken_tension},
               {"broken_shear", c.broken_shear},
               {"contacts", c.contacts},
               {"damaged", c.damaged}};
}

Value model_box(Session&, ModelObject& model, const Arguments&) {
  const geom::Box box = model.simulation.box();
  return Table{{"min", box.min}, {"max", box.max}};
}

template <class Get>
Property simulation_property(std::string name, std::string type, std::string unit, std::string doc, Get get) {
  return {std::move(name), std::move(type), std::move(unit), std::move(doc),
          [get](Session&, Object& self) -> Value { return get(static_cast<ModelObject&>(self).simulation); }};
}

std::vector<Property> model_properties() {
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
  return {simulation_property("time", "number", "s", "", [](const Simulation& s) { return s.time(); }),
          simulation_property("residual", "number", "", "out-of-balance force norm over applied force norm",
                              [](const Simulation& s) { return s.residual(); }),
          simulation_property("steps", "integer", "", "of all stages so far",
                              [](const Simulation& s) { return s.steps(); }),
          simulation_property("stable_time_step", "number", "s", "of real-time stepping",
                              [](const Simulation& s) { return s.stable_time_step(); }),
          simulation_property("state_hash", "string", "", "of every state field, bit for bit",
                              [](const Simulation& s) {
                                char text[17];
                                std::snprintf(text, sizeof text, "%016llx",
                                              static_cast<unsigned long long>(s.state_hash()));
                                return std::string(text);
                              }),
          memory};
}

} // namespace

void bind_model_class(Module& m) {
  m.records.push_back(
      {"Counts",
       "Each bond (spring point) stands in exactly one of intact, broken_tension, broken_shear and contacts.",
       {integer("bodies").required(), integer("blocks").required(), integer("nodes").required(),
        integer("tets").required(), integer("interfaces").required(), integer("bonds").required(),
        integer("intact").required(), integer("broken_tension").required(),
        integer("broken_shear").required(), integer("contacts").required(),
        integer("damaged").required().doc("of the intact ones: have begun to soften")}});
  m.records.push_back(
      {"ProcessZone",
       "The process zone of a law that softens beside the faces that carry it; medians over the faces.",
       {text("of").required().doc("body, regions or pair of bodies"),
        number("length").unit("m").required().doc("E' G_I / T^2, E' = E / (1 - nu^2)"),
        number("face_size").unit("m").required().doc("edge of an equilateral triangle of the face's area"),
        number("largest_face_size").unit("m").required().doc("that leaves three faces in the cohesive zone"),
        number("faces_in_zone").required().doc("faces in the cohesive zone, 0.88 of the length")}});
  Class model{"Model", "Made by cdem.model."};
  model.properties = model_properties();
  model.text = [](const Object& self) {
    const auto& object = static_cast<const ModelObject&>(self);
    const ModelCounts c = object.simulation.counts();
    return "cdem.Model (" + std::to_string(c.bodies) + (c.bodies == 1 ? " body, " : " bodies, ") +
           std::to_string(c.blocks) + (c.blocks == 1 ? " block, " : " blocks, ") + std::to_string(c.tets) +
           (c.tets == 1 ? " tet, " : " tets, ") + std::to_string(c.bonds) +
           (c.bonds == 1 ? " bond)" : " bonds)");
  };
  model
      .add("select", "Gives a place a name that `on` understands from now on.",
           {text("name").required(), place("on").required()}, select)
      .replayed(Replay::again);
  model.add("counts", "How many there are of everything.", {}, counts, "cdem.Counts").ordered();
  model
      .add("process_zones",
           "Whether faces resolve the process zone E' G_I / T^2 of what softens, by body and pair.", {},
           process_zones, "cdem.ProcessZone[]")
      .ordered();
  model.add("box", "Smallest axis-aligned box around the undeformed model.", {}, model_box, "cdem.Box")
      .ordered();
  m.classes.push_back(model);
}

} // namespace cdem::script
