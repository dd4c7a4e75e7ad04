// Flow on outer faces, pieces, and the search for the flow that breaks a solid (Feng 2014 section 3).
#include "lua/binding/functions/answers.hpp"
#include "lua/binding/functions/mass_scaling.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/session/selections.hpp"

#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

std::function<double(double)> velocity_of(const Arguments& a, double now) {
  if (const Value& given = a.value("velocity"); given.is_number())
    return [v = given.number()](double) { return v; };
  const auto function = a.function("velocity");
  auto velocity = [function](double time) {
    return number_answered(*function, "velocity", {time}, "a finite number >= 0 m/s", 0);
  };
  velocity(now); // so that a slip in it is an error of the line that gave it
  return velocity;
}

Flow flow_of(const ModelObject& model, const Arguments& a) {
  Flow flow;
  flow.on = one_selection(model, a.value("on"), "on");
  flow.direction = a.vec3("direction");
  flow.water_density = a.number("water_density");
  flow.new_faces = a.flag("new_faces");
  return flow;
}

Flow flow_of_water(const ModelObject& model, const Arguments& a) {
  for (const char* const own : {"direction", "velocity"})
    if (a.has(own))
      throw InputError(std::string(own) + ": goes without water, whose field has its own");
  if (!a.flag("relative"))
    throw InputError("relative", "false", "left out beside water",
                     "drag depends on the motion of the surface");
  Flow flow;
  const std::vector<Selection> places = selections(model, a.value("on"), "on");
  flow.on = places.front();
  flow.also.assign(places.begin() + 1, places.end());
  flow.water = a.object<WaterObject>("water")->field;
  flow.drag = a.number("drag");
  flow.added_mass = a.number("added_mass");
  flow.new_faces = true; // a piece floats by all its faces
  return flow;
}

Flow flow_of_stream(const ModelObject& model, const Arguments& a) {
  for (const char* const own : {"direction", "velocity"})
    if (!a.has(own))
      throw InputError(std::string(own) + ": give it, or water = a field of cdem.water");
  Flow flow = flow_of(model, a);
  flow.velocity = velocity_of(a, model.time());
  flow.relative = a.flag("relative");
  flow.drag = 1;
  if (a.number("drag") != 1 || a.number("added_mass") != 0)
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
                                    " on " + flow.on.text);
  return {};
}

const Record<Fragment> fragment{"Fragment",
                                "A piece of a model that unbroken bonds hold together.",
                                {{number("volume").unit("m3"), &Fragment::volume},
                                 {vec3("centroid").unit("m"), &Fragment::centroid},
                                 {integer("tets"), &Fragment::tets},
                                 {flag("held").doc("some node of it is held"), &Fragment::held}}};

const Record<CriticalFlowSample> flow_sample{
    "CriticalFlowSample",
    "One moment of a search.",
    {{number("time").unit("s"), &CriticalFlowSample::time},
     {number("pressure").unit("Pa"), &CriticalFlowSample::pressure},
     {number("velocity").unit("m/s"), &CriticalFlowSample::velocity},
     {number("displacement").unit("m").doc("mean where the flow pushes, along it"),
      &CriticalFlowSample::displacement},
     {integer("broken").doc("bonds so far"), &CriticalFlowSample::broken}}};

const char* third(double fraction) {
  return fraction < 1.0 / 3 ? "root" : fraction < 2.0 / 3 ? "waist" : "top";
}

// Where the bonds broke, as fractions of the model's box; along `held` from that side on.
void add_place(const geom::Box& box, const std::string& held, const CriticalFlowResult& r, Table& row) {
  const geom::Vec3 fraction = (r.place - box.min).cwiseQuotient(box.size());
  row.named["place"] = r.place;
  row.named["place_fraction"] = fraction;
  if (held.empty())
    return;
  const double along = fraction[held[0] - 'x'], from_held = held[1] == '-' ? along : 1 - along;
  row.named["height_fraction"] = from_held;
  row.named["part"] = std::string(third(from_held));
}

Value flow_result(const CriticalFlowResult& r, const geom::Box& box, const std::string& held) {
  static const char* const reasons[] = {"fragment", "compliance", "limit"};
  Table row{{"reason", std::string(reasons[static_cast<int>(r.reason)])},
            {"velocity", r.velocity},
            {"pressure", r.pressure},
            {"time", r.time},
            {"period", r.period},
            {"compliance", r.compliance},
            {"fragments", fragment.list(r.fragments)},
            {"broken_area", r.broken_area},
            {"broken_tension", r.broken_tension},
            {"broken_shear", r.broken_shear},
            {"steps", r.steps},
            {"curve", flow_sample.list(r.curve)}};
  if (r.broken_area > 0) {
    add_place(box, held, r, row);
    row.named["first_break_velocity"] = r.first_break_velocity;
    row.named["first_break_pressure"] = r.first_break_pressure;
    row.named["first_break_place"] = r.first_break_place;
  }
  return row;
}

Value critical_flow(Session& session, ModelObject& model, const Arguments& a) {
  CriticalFlowOptions options;
  options.flow = flow_of(model, a);
  options.hold = a.text("mode") == "hold";
  options.pressure_rate = a.number("pressure_rate");
  options.hold_periods = a.number("hold_periods");
  options.fragment_fraction = a.number("fragment_fraction");
  options.compliance_ratio = a.number("compliance_ratio");
  options.max_velocity = a.number("max_velocity");
  options.safety = a.number("safety");
  options.local_damping = a.number("local_damping");
  options.mass_scaling = mass_scaling_of(a);
  const std::string held = a.text_or("held", "");
  if (!held.empty())
    options.held = Selection::side(held);
  warn_of_slivers(session, model);
  return stage(session, model, "critical_flow", a, flow_result({}, {}, held), [&](Simulation& simulation) {
    const CriticalFlowResult result = simulation.critical_flow(options);
    if (result.reason == CriticalFlowResult::Reason::limit)
      session.warn(
          "critical_flow: nothing broke off up to max_velocity = " + number_text(options.max_velocity) +
          (simulation.counts().bonds > 0 ? " m/s; raise it"
                                         : " m/s: the model has no bonds; give its bodies a joint"));
    Value row = flow_result(result, simulation.box(), held);
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

Field water_density() {
  return water_density_field("water_density").standard(1025.0).doc("sea water by default");
}

std::vector<Field> flow_fields() {
  return {vec3("direction").required().doc("of the flow; made a unit vector"),
          place("on").standard(std::string("all")).doc("outer faces that may take it: one place"),
          water_density(),
          flag("new_faces").standard(false).doc("faces opened by cracks take the pressure too")};
}

void bind_flow_records(Module& m) {
  m.records.insert(m.records.end(), {fragment, flow_sample});
  m.records.push_back(
      {"CriticalFlowResult",
       "What the search for the critical flow came to.",
       {choice("reason", {"fragment", "compliance", "limit"})
            .required()
            .doc("a piece came off; the compliance grew; or max_velocity was reached"),
        number("velocity").unit("m/s").required(),
        number("pressure").unit("Pa").required(),
        number("time").unit("s").required(),
        number("period").unit("s").required().doc("of the first mode"),
        number("compliance").unit("m/Pa").required().doc("of the unbroken solid at rest"),
        list("fragments", object_type("Fragment"), 0).required().doc("largest first"),
        number("broken_area").unit("m2").required(),
        vec3("place").unit("m").doc("centroid of the broken area; nil when nothing broke"),
        vec3("place_fraction").doc("the same in parts of the model's box, 0 to 1"),
        number("height_fraction").doc("along the held side's normal, from that side on"),
        choice("part", {"root", "waist", "top"}).doc("third of that height"),
        number("first_break_velocity").unit("m/s").doc("when the first bond broke; nil when none did"),
        number("first_break_pressure").unit("Pa"),
        vec3("first_break_place").unit("m").doc("undeformed"),
        integer("broken_tension").required(),
        integer("broken_shear").required(),
        integer("steps").required(),
        list("curve", object_type("CriticalFlowSample"), 0).required().doc("every 100 steps"),
        mass_scaling_result_field()}});
}

} // namespace

void bind_flow(Module& m) {
  bind_flow_records(m);
  m.add("flow_pressure", "Pressure of a stream, rho V^2 / 2 (Feng 2014 eq 20), Pa.",
        {number("velocity").at_least(0).unit("m/s").required(), water_density()}, pressure, "number")
      .ordered();
  m.add("flow_velocity", "Velocity of a stream from its pressure, sqrt(2 F / rho), m/s.",
        {number("pressure").at_least(0).unit("Pa").required(), water_density()}, velocity, "number")
      .ordered();
  Class& model = m.the_class("Model");
  std::vector<Field> steady = flow_fields();
  steady[0] = vec3("direction").doc("of the flow; made a unit vector");
  steady[1].doc("outer faces that may take it: one place; of water: a place or a list of places");
  steady[3].doc("faces opened by cracks take the pressure too; always with water");
  steady.insert(steady.begin() + 1,
                number_or_function("velocity", "(time: number): number").at_least(0).unit("m/s"));
  steady.push_back(
      object("water", "Water")
          .doc("a field of water in place of direction, velocity and density: drag, pressure and with it "
               "buoyancy on the wet part of each face, and added mass, as far as the field knows them"));
  steady.push_back(number("drag").within(0, 100).standard(1.0).doc(
      "C_D; scales the traction, which by itself gives a convex body C_D = 1 of its silhouette"));
  steady.push_back(number("added_mass")
                       .within(0, 100)
                       .standard(0.0)
                       .doc("C_A = C_M - 1, of the volume under water: sphere 0.5, cylinder across the "
                            "stream 1, cube 0.67"));
  steady.push_back(flag("relative")
                       .standard(true)
                       .doc("in a run the water meets each point of the surface at its velocity less that of "
                            "the surface, u, and the traction is rho/2 (u . n)+ u: a unit that the flow "
                            "carries gains on it no more, and one that moves in still water is slowed down. "
                            "false: the pressure of the flow alone, however the surface moves"));
  model
      .add("flow",
           "Pressure of a flow on the outer faces that look towards it, as they stand at each moment: alpha "
           "F along the flow, alpha the cosine to the inward normal (Feng 2014 eqs 19-20), on a surface at "
           "rest. With water = a field, the forces of waves. Shielding is not modelled.",
           steady, flow)
      .replayed(Replay::again);
  std::vector<Field> search = flow_fields();
  for (const Field& field :
       {choice("mode", {"hold", "ramp"})
            .standard("hold")
            .doc("hold: the pressure rises only while no bond broke for hold_periods, near the static "
                 "strength; ramp: always, and inertia has its part"),
        choice("held", {"x-", "x+", "y-", "y+", "z-", "z+"})
            .doc("the side that is fixed: then the result says at which part of the height the solid broke"),
        number("pressure_rate").above(0).standard(5e6).unit("Pa/s"),
        number("hold_periods").above(0).standard(3.0).doc("hold time in periods of the first mode"),
        number("fragment_fraction")
            .between(0, 1)
            .standard(0.1)
            .doc("of the volume: what counts as broken off"),
        number("compliance_ratio")
            .above(1)
            .standard(10.0)
            .doc("to the unbroken, static one: what counts as broken"),
        number("max_velocity").above(1).standard(100.0).unit("m/s").doc("gives up there"),
        number("safety").within(0, 1).standard(0.9).doc("time step over the stable one"),
        mass_scaling_field(),
        number("local_damping").from(0, 1).standard(0.1).doc("above 0.2 it acts as added mass")})
    search.push_back(field);
  model.add("critical_flow",
            "Raises a flow from 1 m/s until a held solid breaks: a piece of it comes off, or it has become "
            "compliant. The pressure is that on a surface at rest.",
            search, critical_flow, "cdem.CriticalFlowResult");
}

} // namespace cdem::script
