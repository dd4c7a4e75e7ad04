// Supports, loads and initial states of a model.
#include "lua/binding/functions/over_time.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/selections.hpp"

#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

std::array<bool, 3> axes_of(const std::string& text) {
  return {text.find('x') != std::string::npos, text.find('y') != std::string::npos,
          text.find('z') != std::string::npos};
}

void note(ModelObject& model, const std::string& line) {
  model.notes->conditions.push_back(line);
}

std::string shown(const Selection& s) {
  return s.text;
}

Field on() {
  return place("on").required().doc("where: a place or a list of places");
}
Field axes() {
  return choice("axes", {"x", "y", "z", "xy", "xz", "yz", "xyz"}).standard("xyz").doc("components held");
}

const Record<Fix> fix_record{
    {{on()},
     {axes()},
     {vec3("displacement", "m")
          .doc("total value to be held. A relaxation moves there through states of balance (move thin "
               "parts beside thick ones in a relaxation of their own, else they may break early); a run "
               "moves there at a steady velocity and arrives at its end (one that `stop` ends earlier does "
               "not)"),
      &Fix::displacement},
     {vec3("velocity", "m/s").doc("in real-time stepping; zero when left out, and in a relaxation"),
      &Fix::velocity},
     {amplitude_field()},
     {since_field()}}};

Value fix(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("fix");
  const Amplitude amplitude = amplitude_of(a, model.time());
  if (amplitude && !a.has("velocity"))
    throw InputError("amplitude: goes with velocity, which it multiplies");
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    Fix fix = fix_record.read(a);
    fix.on = on;
    fix.axes = axes_of(a.text("axes"));
    fix.amplitude = amplitude;
    model.simulation.fix(fix);
    note(model, "fix " + shown(on) + " in " + a.text("axes") +
                    (fix.displacement ? " at displacement " + describe(a.value("displacement")) + " m" : "") +
                    (fix.velocity ? " moving at " + describe(a.value("velocity")) + " m/s" : "") +
                    (fix.amplitude ? " times its amplitude" : ""));
  }
  return {};
}

Value release(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("release");
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    model.simulation.release(on, axes_of(a.text("axes")));
    note(model, "release " + shown(on) + " in " + a.text("axes"));
  }
  return {};
}

const Record<FacePressure> face_pressure{
    {{number_or_function("pressure", "(x: number, y: number, z: number): number")
          .unit("Pa")
          .doc("instead: along the inward normal, the same everywhere or at each undeformed place"),
      &FacePressure::pressure},
     {number("level", "m")
          .doc("instead: z of a free water surface; weight times the depth below it, none above. Water in "
               "joints is model:water's"),
      &FacePressure::level},
     {object("water_table", "WaterTable").doc("instead: a free water surface that is not level")},
     {water_weight_field("weight").doc("of the water"), &FacePressure::weight}}};

FacePressure face_pressure_of(const Arguments& a) {
  FacePressure pressure = face_pressure.read(a);
  if (const auto given = a.object<WaterTableObject>("water_table"))
    pressure.table = given->table;
  return pressure;
}

void warn_of_sum(Session& session, const char* call, const char* what) {
  session.warn(std::string("model:") + call + ": it acts on " + what + " that an earlier " + call +
               " already loads; the two add up. To replace it call model:clear_loads() first, which takes "
               "gravity and flows away too");
}

Value traction(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("traction");
  const Amplitude amplitude = amplitude_of(a, model.time());
  if (static_cast<int>(a.has("stress")) + static_cast<int>(a.has("pressure")) +
          static_cast<int>(a.has("level")) + static_cast<int>(a.has("water_table")) !=
      1)
    throw InputError("give one of stress = {x, y, z} (Pa), pressure = a number (Pa) or function(x, y, z), "
                     "level = z of the water (m), and water_table = cdem.water_table{...}");
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    Traction traction;
    traction.on = on;
    traction.amplitude = amplitude;
    std::string line;
    if (a.has("stress")) {
      traction.stress = a.vec3("stress");
      line = "traction " + describe(a.value("stress")) + " Pa";
    } else {
      traction.pressure = face_pressure_of(a);
      const auto table = a.object<WaterTableObject>("water_table");
      line = a.has("level") ? "pressure of water up to z = " + describe(a.value("level")) + " m"
             : table        ? "pressure of water up to a water table, " + table->words
             : a.value("pressure").is_number() ? "pressure " + describe(a.value("pressure")) + " Pa"
                                               : std::string("pressure after a function");
    }
    if (model.simulation.traction(traction))
      warn_of_sum(session, "traction", "faces");
    note(model, line + " on " + shown(on));
  }
  return {};
}

Value force(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("force");
  PointForce force;
  force.on = one_selection(model, a.value("on"), "on");
  force.force = a.vec3("force");
  force.amplitude = amplitude_of(a, model.time());
  if (model.simulation.force(force))
    warn_of_sum(session, "force", "nodes");
  note(model, "force " + describe(a.value("force")) + " N on " + shown(force.on));
  return {};
}

// A minus sign is missing: z is up, or y where nothing acts along z.
bool pulls_up(const geom::Vec3& gravity) {
  const double up = gravity.z() != 0 ? gravity.z() : gravity.y();
  return up > 0 && up >= gravity.cwiseAbs().maxCoeff();
}

Field gravity_vector() {
  return vec3_or_function("vector", "(time: number): number[]")
      .unit("m/s2")
      .doubted(5e3, largest_quantity, "On Earth it is {0, 0, -9.81}")
      .required()
      .doc("acceleration, e.g. {0, 0, -9.81}, or a function of time (s) that gives it");
}

Value gravity(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("gravity");
  Gravity gravity;
  if (a.function("vector")) {
    read(a, gravity_vector(), gravity.turning);
    gravity.turning(model.time()); // so that a slip in it is an error of the line that gave it
  } else {
    gravity.acceleration = a.vec3("vector");
  }
  if (pulls_up(gravity.acceleration))
    session.warn("gravity: vector = " + describe(a.value("vector")) +
                 ": it pulls upwards; downwards is negative, {0, 0, -9.81}");
  gravity.water_density = a.number("water_density");
  gravity.amplitude = amplitude_of(a, model.time());
  model.simulation.gravity(gravity);
  note(model,
       "gravity " + describe(a.value("vector")) + " m/s2" +
           (gravity.water_density > 0 ? ", in water of " + number_text(gravity.water_density) + " kg/m3"
                                      : ""));
  return {};
}

Value clear_loads(Session&, ModelObject& model, const Arguments&) {
  model.require_idle("clear_loads");
  model.simulation.clear_loads();
  note(model, "loads cleared");
  return {};
}

const Record<CrackPressure> crack_record{
    {{place("on").standard("all").doc("where: a place or a list of places, by the centroids of faces")},
     {number("pressure", "Pa").at_least(0)},
     {number("volume", "m3").at_least(0).doc("instead: pumped in, in model:run")},
     {number("bulk_modulus", "Pa")
          .above(0)
          .doc("of the fluid; water has 2.2e9")
          .doubted(0, 1e4, "Water has 2.2e9, air 1e5"),
      &CrackPressure::bulk_modulus},
     {number("reservoir", "m3").above(0).doc("what the fluid fills beside the cracks, such as a borehole"),
      &CrackPressure::reservoir},
     {amplitude_field()},
     {since_field()}}};

Value crack_pressure(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("crack_pressure");
  const bool pumped = a.has("volume");
  if (a.has("pressure") == pumped)
    throw InputError("give one of pressure = Pa and volume = m3");
  for (const char* const of_fluid : {"bulk_modulus", "reservoir"})
    if (a.has(of_fluid) != pumped)
      throw InputError(std::string(of_fluid) + ": goes with volume, which gives the pressure by it");
  const std::string field = pumped ? "volume" : "pressure";
  CrackPressure pressure = crack_record.read(a);
  (pumped ? pressure.volume : pressure.pressure) = [value = a.number(field),
                                                    amplitude = amplitude_of(a, model.time())](double time) {
    return amplitude ? value * amplitude(time) : value;
  };
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    pressure.on = on;
    model.simulation.crack_pressure(pressure);
    note(model, (pumped ? "fluid of " + describe(a.value("volume")) + " m3"
                        : "pressure of " + describe(a.value("pressure")) + " Pa") +
                    " in the cracks of " + shown(on));
  }
  return {};
}

Value initial_velocity(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("initial_velocity");
  if (!a.has("velocity") && !a.has("angular_velocity"))
    throw InputError("give velocity (m/s), angular_velocity (rad/s) or both");
  if (a.has("about") && !a.has("angular_velocity"))
    throw InputError("about: goes with angular_velocity, the point to turn about");
  const geom::Vec3 none = geom::Vec3::Zero();
  for (const Selection& on : selections(model, a.value("on"), "on")) {
    model.simulation.initial_velocity(on, a.optional_vec3("velocity").value_or(none),
                                      a.optional_vec3("angular_velocity").value_or(none),
                                      a.optional_vec3("about"));
    std::string given;
    if (a.has("velocity"))
      given = "initial velocity " + describe(a.value("velocity")) + " m/s";
    if (a.has("angular_velocity"))
      given += (given.empty() ? "initial angular velocity " : ", angular velocity ") +
               describe(a.value("angular_velocity")) + " rad/s about " +
               (a.has("about") ? describe(a.value("about")) + " m" : "the centroid");
    note(model, given + " of " + shown(on));
  }
  return {};
}

// Acts on each of the places of `on`, or on none; notes "3 bodies made rigid".
template <class Act>
Value act_on_places(const Session& session, ModelObject& model, const Arguments& a, const Act& act,
                    const std::string& one, const std::string& more, const std::string& done) {
  const std::vector<Selection> places = selections(model, a.value("on"), "on");
  std::int64_t count = 0;
  all_or_none(session, model, places.size(), [&](Simulation& simulation, std::size_t i) {
    const std::int64_t here = act(simulation, places[i]);
    count += &simulation == &model.simulation ? here : 0;
  });
  note(model, geom::counted(count, one, more) + done);
  return count;
}

const Record<Excavation> excavation_record{
    {{number("relaxed").within(0, 1).standard().doc(
          "share of the excavation's forces that goes, from the beginning (lambda of "
          "convergence-confinement); the rest stays as a load"),
      &Excavation::relaxed},
     {number("over", "s")
          .above(0)
          .doc("time of model:run, from now on, in which this share goes evenly; at once when left out. A "
               "relaxation takes no time"),
      &Excavation::over}}};

Excavation excavation_of(const Arguments& a) {
  const Excavation excavation = excavation_record.read(a);
  if (excavation.relaxed == 0 && excavation.over > 0)
    throw InputError("over: goes with relaxed > 0, the share of the forces that falls in this time");
  return excavation;
}

std::string in_words(const Excavation& excavation) {
  std::string text;
  if (excavation.relaxed < 1)
    text += ", forces relaxed by " + number_text(excavation.relaxed);
  if (excavation.over > 0)
    text += (text.empty() ? ", forces relaxed over " : " over ") + number_text(excavation.over) + " s";
  return text;
}

Value remove(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("remove");
  const Excavation excavation = excavation_of(a);
  return act_on_places(
      session, model, a,
      [&](Simulation& simulation, const Selection& on) { return simulation.remove(on, excavation); }, "block",
      "blocks", " removed" + in_words(excavation));
}

Value relax_excavation(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("relax_excavation");
  const Excavation excavation = excavation_of(a);
  if (model.simulation.relax_excavation(excavation) == 0)
    session.warn(
        "model:relax_excavation: no forces of an excavation are kept; model:remove{ relaxed = } or over = "
        "keeps those of rock that bears something");
  note(model, "excavation" + (excavation.relaxed == 1 && excavation.over == 0 ? ", forces relaxed"
                                                                              : in_words(excavation)));
  return {};
}

Value make_rigid(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("make_rigid");
  return act_on_places(session, model, a, std::mem_fn(&Simulation::make_rigid), "body", "bodies",
                       " made rigid");
}

Value make_deformable(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("make_deformable");
  return act_on_places(session, model, a, std::mem_fn(&Simulation::make_deformable), "body", "bodies",
                       " made deformable");
}

Value break_bonds(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("break_bonds");
  return act_on_places(
      session, model, a,
      [&](Simulation& simulation, const Selection& on) {
        return simulation.break_bonds(on, a.flag("whole_faces"));
      },
      "bond", "bonds", " broken");
}

// The name of break_bonds until 0.2.
Value unbond(Session& session, ModelObject& model, const Arguments& a) {
  session.warn("model:unbond is named model:break_bonds now; the next release no longer knows the old name");
  return break_bonds(session, model, a);
}

Field one_place() {
  return place("on").required().doc("where: one place");
}
} // namespace

void bind_conditions(Module& m) {
  Class& model = m.the_class("Model");
  model
      .add("fix",
           "Holds nodes, or moves them as told. A later call wins over an earlier one where they meet.",
           fix_record.fields(), fix)
      .replayed(Replay::again);
  model.add("release", "Undoes fixes.", {on(), axes().doc("components set free")}, release)
      .replayed(Replay::again);
  model
      .add("traction",
           "Force per undeformed area on outer faces: a stress, or a pressure along their inward normals, "
           "such as that of a reservoir. It acts on faces that are free as the stage begins and does not "
           "follow them; faces between blocks that have parted and the sides of cracks take none. "
           "Several tractions on a face add up.",
           std::vector<Field>{on(), vec3("stress", "Pa").doc("force over area")} + face_pressure.fields() +
               std::vector<Field>{amplitude_field(), since_field()},
           traction)
      .replayed(Replay::again);
  model
      .add("force", "A total force, shared among the nodes of a place. Several forces on a node add up.",
           {one_place(), vec3("force", "N").required().doc("total"), amplitude_field(), since_field()}, force)
      .replayed(Replay::again);
  model
      .add("gravity", "Weight of all blocks; one at a time, the last call counts.",
           {gravity_vector(),
            water_density_field("water_density")
                .at_least(0)
                .standard(0.0)
                .doc("buoyancy: takes from the weight, never from the inertia"),
            amplitude_field(), since_field()},
           gravity)
      .replayed(Replay::again);
  model
      .add("crack_pressure",
           "Pressure of a gas or a fluid on the faces of cracks in cohesive bodies, from the moment they "
           "open. The pressure is given, or it is that of a fluid which fills the cracks and a reservoir: "
           "bulk_modulus (pumped volume - volume of the cracks) / reservoir. It is the same in all cracks of "
           "the place (docs/theory.md, section 22). Several pressures in a crack add up.",
           crack_record.fields(), crack_pressure)
      .replayed(Replay::again);
  model
      .add("clear_loads", "Takes away tractions, forces, gravity, flows and pressures in cracks.", {},
           clear_loads)
      .replayed(Replay::again);
  model.add(
      "initial_velocity",
      "Gives blocks, meshes and rigid bodies the motion v + w x (x - about) of a rigid body, as velocities "
      "before the first real-time step. It replaces the velocities that they had.",
      {place("on").standard("all").doc("where: a place or a list of places, each by itself"),
       vec3("velocity", "m/s").doc("v"),
       vec3("angular_velocity", "rad/s").doc("w, right-handed about its direction; a full turn is 2 pi"),
       vec3("about", "m")
           .doc("the point that w turns about; the centroid of what is selected when left out")},
      initial_velocity);
  model.add("remove",
            "Takes blocks and whole meshes out of the model (an excavation): those whose undeformed centroid "
            "is selected. Their forces on the rock that stays go at once, unless `relaxed` and `over` say "
            "otherwise (docs/settling-and-loading.md, \"Excavating\").",
            std::vector<Field>{on()} + excavation_record.fields(), remove, "integer", "how many");
  model.add("relax_excavation",
            "Lets go of forces that earlier calls of model:remove have kept with `relaxed` or `over`, for "
            "instance after a lining is set. Forces that are relaxed further already stay so.",
            excavation_record.fields(), relax_excavation);
  model.add("make_rigid",
            "Makes the meshed bodies rigid whose undeformed centroid is selected: they keep the shape and "
            "the stress of this moment, and move as a whole.",
            {on()}, make_rigid, "integer", "how many changed");
  model.add("make_deformable",
            "Makes the rigid bodies deformable whose undeformed centroid is selected. They keep the motion "
            "that they have.",
            {on()}, make_deformable, "integer", "how many changed");
  const auto whole_faces = [] {
    return flag("whole_faces")
        .standard(false)
        .doc("only faces that are selected with all their points, so that faces that meet the notch at its "
             "tip stay bonded");
  };
  model.add("break_bonds",
            "Breaks bonds (a notch): those whose point is selected. They are contacts from then on, which "
            "keep the pressure that they carry and the shear that its friction holds.",
            {on(), whole_faces()}, break_bonds, "integer", "how many");
  model.add("unbond", "The old name of model:break_bonds; it warns.", {on(), whole_faces()}, unbond,
            "integer", "how many");
}

} // namespace cdem::script
