// Flow on outer faces, pieces, and the search for the flow that breaks a solid (Feng 2014 section 3).
#include "lua/binding/functions/mass_scaling.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/session/selections.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

Field water_density() {
  return water_density_field("water_density").standard(Flow().water_density).doc("sea water by default");
}

const Record<Flow> stream{
    {{vec3("direction").required().doc("of the flow; made a unit vector"), &Flow::direction},
     {place("on").standard(std::string("all")).doc("outer faces that may take it: one place")},
     {water_density(), &Flow::water_density},
     {flag("new_faces")
          .standard()
          .doc("faces of cracks, and faces between blocks that no bond holds, take the pressure too where "
               "their sides have parted by a hundredth of the block or unit"),
      &Flow::new_faces}}};

// The members of a flow that are not searched for.
const Record<Flow> steady{
    {{number_or_function("velocity", "(time: number): number").at_least(0).unit("m/s"), &Flow::velocity},
     {object("water", "Water")
          .doc("a field of water in place of direction, velocity and density: drag, pressure and with it "
               "buoyancy on the wet part of each face, and added mass, as far as the field knows them")},
     {number("drag").within(0, 100).standard().doc(
          "C_D; scales the traction, which by itself gives a convex body C_D = 1 of its silhouette"),
      &Flow::drag},
     {number("added_mass")
          .within(0, 100)
          .standard()
          .doc("C_A = C_M - 1, of the volume under water: sphere 0.5, cylinder across the stream 1, cube "
               "0.67; on whole units only"),
      &Flow::added_mass},
     {flag("relative")
          .standard()
          .doc("in a run the water meets each point of the surface at its velocity less that of the surface, "
               "u, "
               "and the traction is rho/2 (u . n)+ u: a unit that the flow carries gains on it no more, and "
               "one "
               "that moves in still water is slowed down. false: the pressure of the flow alone, however the "
               "surface moves"),
      &Flow::relative}}};

Flow flow_of(const ModelObject& model, const Arguments& a) {
  Flow flow = stream.read(a);
  flow.on = {one_selection(model, a.value("on"), "on")};
  return flow;
}

Flow flow_of_water(const ModelObject& model, const Arguments& a) {
  for (const char* const own : {"direction", "velocity"})
    if (a.has(own))
      throw InputError(std::string(own) + ": goes without water, whose field has its own");
  if (!a.flag("relative"))
    throw InputError("relative", "false", "left out beside water",
                     "drag depends on the motion of the surface");
  Flow flow = steady.read(a);
  flow.on = selections(model, a.value("on"), "on");
  flow.water = a.object<WaterObject>("water")->field;
  flow.new_faces = true; // a piece floats by all its faces
  return flow;
}

Flow flow_of_stream(const ModelObject& model, const Arguments& a) {
  for (const char* const own : {"direction", "velocity"})
    if (!a.has(own))
      throw InputError(std::string(own) + ": give it, or water = a field of cdem.water");
  Flow flow = flow_of(model, a);
  steady.read(a, flow);
  flow.velocity(model.time()); // so that a slip in it is an error of the line that gave it
  if (flow.drag != 1 || flow.added_mass != 0)
    throw InputError("drag and added_mass: go with water = a field, such as cdem.water.uniform");
  return flow;
}

Value flow(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("flow");
  const auto water = a.object<WaterObject>("water");
  const Flow flow = water ? flow_of_water(model, a) : flow_of_stream(model, a);
  if (model.simulation.flow(flow))
    session.warn("model:flow: it meets faces that another flow already meets; their pressures add up");
  model.notes->conditions.push_back((water ? water->words : "flow along " + describe(a.value("direction"))) +
                                    " on " + flow.places());
  return {};
}

const Record<Fragment> fragment{"Fragment",
                                "A piece of a model that unbroken bonds hold together.",
                                {{number("volume", "m3"), &Fragment::volume},
                                 {vec3("centroid", "m"), &Fragment::centroid},
                                 {integer("tets"), &Fragment::tets},
                                 {flag("held").doc("some node of it is held"), &Fragment::held}}};

const Record<CriticalFlowSample> flow_sample{
    "CriticalFlowSample",
    "One moment of a search.",
    {{number("time", "s"), &CriticalFlowSample::time},
     {number("pressure", "Pa"), &CriticalFlowSample::pressure},
     {number("velocity", "m/s"), &CriticalFlowSample::velocity},
     {number("displacement", "m").doc("mean where the flow pushes, along it"),
      &CriticalFlowSample::displacement},
     {integer("broken").doc("bonds so far"), &CriticalFlowSample::broken}}};

const char* third(double fraction) {
  return fraction < 1.0 / 3 ? "root" : fraction < 2.0 / 3 ? "waist" : "top";
}

// What scripts get: where the bonds broke in the model's box, and along `held` from that side on.
struct FlowFound : CriticalFlowResult {
  geom::Box box;
  std::string held;

  bool broke() const { return broken_area > 0; }
  geom::Vec3 fraction() const { return (place - box.min).cwiseQuotient(box.size()); }
  std::optional<double> height() const {
    if (!broke() || held.empty())
      return std::nullopt;
    const double along = fraction()[held[0] - 'x'];
    return held[1] == '-' ? along : 1 - along;
  }
  template <class X>
  std::optional<X> if_broken(const X& x) const {
    return broke() ? std::optional<X>(x) : std::nullopt;
  }
};

const Record<FlowFound> flow_record{
    "CriticalFlowResult",
    "What the search for the critical flow came to.",
    {{choice("reason", {"fragment", "compliance", "limit"})
          .doc("a piece came off; the compliance grew; or max_velocity was reached"),
      &FlowFound::reason},
     {number("velocity", "m/s"), &FlowFound::velocity},
     {number("pressure", "Pa"), &FlowFound::pressure},
     {number("time", "s"), &FlowFound::time},
     {number("period", "s").doc("of the first mode"), &FlowFound::period},
     {number("compliance", "m/Pa").doc("of the unbroken solid at rest"), &FlowFound::compliance},
     {list("fragments", object_type("Fragment"), 0).doc("largest first"), &FlowFound::fragments, fragment},
     {number("broken_area", "m2"), &FlowFound::broken_area},
     {vec3("place", "m").doc("centroid of the broken area; nil when nothing broke"),
      [](const FlowFound& r) { return r.if_broken(r.place); }},
     {vec3("place_fraction").doc("the same in parts of the model's box, 0 to 1"),
      [](const FlowFound& r) { return r.if_broken(r.fraction()); }},
     {number("height_fraction").doc("along the held side's normal, from that side on"), &FlowFound::height},
     {choice("part", {"root", "waist", "top"}).doc("third of that height"),
      [](const FlowFound& r) { return r.height() ? Value(third(*r.height())) : Value(); }},
     {number("first_break_velocity", "m/s").doc("when the first bond broke; nil when none did"),
      [](const FlowFound& r) { return r.if_broken(r.first_break_velocity); }},
     {number("first_break_pressure", "Pa"),
      [](const FlowFound& r) { return r.if_broken(r.first_break_pressure); }},
     {vec3("first_break_place", "m").doc("undeformed"),
      [](const FlowFound& r) { return r.if_broken(r.first_break_place); }},
     {integer("broken_tension"), &FlowFound::broken_tension},
     {integer("broken_shear"), &FlowFound::broken_shear},
     {integer("steps"), &FlowFound::steps},
     {list("curve", object_type("CriticalFlowSample"), 0).doc("every 100 steps"), &FlowFound::curve,
      flow_sample},
     {mass_scaling_result_field()}}};

const Record<CriticalFlowOptions> search_record{
    {{choice("mode", {"hold", "ramp"})
          .standard("hold")
          .doc("hold: the pressure rises only while no bond broke for hold_periods, near the static "
               "strength; ramp: always, and inertia has its part")},
     {choice("held", {"x-", "x+", "y-", "y+", "z-", "z+"})
          .doc("the side that is fixed: then the result says at which part of the height the solid broke")},
     {number("pressure_rate", "Pa/s").above(0).standard(), &CriticalFlowOptions::pressure_rate},
     {number("hold_periods").above(0).standard().doc("hold time in periods of the first mode"),
      &CriticalFlowOptions::hold_periods},
     {number("fragment_fraction").between(0, 1).standard().doc("of the volume: what counts as broken off"),
      &CriticalFlowOptions::fragment_fraction},
     {number("compliance_ratio")
          .above(1)
          .standard()
          .doc("to the unbroken, static one: what counts as broken"),
      &CriticalFlowOptions::compliance_ratio},
     {number("max_velocity", "m/s").above(1).standard().doc("gives up there"),
      &CriticalFlowOptions::max_velocity},
     {number("safety").within(0, 1).standard().doc("time step over the stable one"),
      &CriticalFlowOptions::safety},
     {mass_scaling_field()},
     {number("local_damping").from(0, 1).standard().doc("above 0.2 it acts as added mass"),
      &CriticalFlowOptions::local_damping}}};

Value critical_flow(Session& session, ModelObject& model, const Arguments& a) {
  CriticalFlowOptions options = search_record.read(a);
  options.flow = flow_of(model, a);
  options.hold = a.text("mode") == "hold";
  options.mass_scaling = mass_scaling_of(a);
  const std::string held = a.text_or("held", "");
  if (!held.empty())
    options.held = Selection::side(held);
  warn_of_slivers(session, model);
  return stage(session, model, "critical_flow", a, flow_record({}), [&](Simulation& simulation) {
    const CriticalFlowResult result = simulation.critical_flow(options);
    if (result.reason == CriticalFlowResult::Reason::limit)
      session.warn(
          "critical_flow: nothing broke off up to max_velocity = " + number_text(options.max_velocity) +
          (simulation.counts().bonds > 0 ? " m/s; raise it"
                                         : " m/s: the model has no bonds; give its bodies a joint"));
    Value row = flow_record({result, simulation.model().built_box, held});
    add_mass_scaling(session, "critical_flow", options.mass_scaling, result.time_step, result.scaled, row);
    return row;
  });
}

Value pressure(Session&, Object*, const Arguments& a) {
  return flow_pressure(a.number("velocity"), a.number("water_density"));
}
Value velocity(Session&, Object*, const Arguments& a) {
  return flow_velocity(a.number("pressure"), a.number("water_density"));
}

} // namespace

void bind_flow(Module& m) {
  m.records.insert(m.records.end(), {fragment, flow_sample, flow_record});
  m.add("flow_pressure", "Pressure of a stream, rho V^2 / 2 (Feng 2014 eq 20), Pa.",
        {number("velocity", "m/s").at_least(0).required(), water_density()}, pressure, "number")
      .ordered();
  m.add("flow_velocity", "Velocity of a stream from its pressure, sqrt(2 F / rho), m/s.",
        {number("pressure", "Pa").at_least(0).required(), water_density()}, velocity, "number")
      .ordered();
  Class& model = m.the_class("Model");
  std::vector<Field> fields = stream.fields() + steady.fields();
  std::rotate(fields.begin() + 1, fields.begin() + 4,
              fields.begin() + 5); // the velocity beside the direction
  fields[0].must = false;          // water has its own
  fields[2].doc("outer faces that may take it: one place; of water: a place or a list of places");
  fields[4].doc("faces of cracks, and faces between blocks that no bond holds, take the pressure too where "
                "their sides have parted by a hundredth of the block or unit; always with water, whose own "
                "pressure gets in at once");
  model
      .add("flow",
           "Pressure of a flow on the outer faces that look towards it, as they stand at each moment: alpha "
           "F along the flow, alpha the cosine to the inward normal (Feng 2014 eqs 19-20), on a surface at "
           "rest. With water = a field, the forces of waves. Shielding is not modelled.",
           fields, flow)
      .replayed(Replay::again);
  model.add("critical_flow",
            "Raises a flow from 1 m/s until a held solid breaks: a piece of it comes off, or it has become "
            "compliant. The pressure is that on a surface at rest.",
            stream.fields() + search_record.fields(), critical_flow, "cdem.CriticalFlowResult");
}

} // namespace cdem::script
