// Settling of piles, and the watch over units that leave their place.
#include "lua/binding/functions/angles.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/module.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

// A list that grows while the model runs: of the model's own record, which a checkpoint keeps.
struct WatchObject final : Object {
  std::shared_ptr<ModelObject> model;
  std::size_t number = 0;
  const char* class_name() const override { return "Watch"; }
  const std::vector<Departure>& left() const { return model->simulation.departures(number); }
};

const WatchObject& watch_of(const Object& self) {
  return static_cast<const WatchObject&>(self);
}

Value departure_row(const Departure& d) {
  Table row{{"unit", d.unit},
            {"time", d.time},
            {"displacement", d.displacement},
            {"place", d.place},
            {"share", d.share}};
  if (!std::isnan(d.velocity))
    row.named["velocity"] = d.velocity;
  return row;
}

std::shared_ptr<ModelObject> shared(const Session& session, const ModelObject& model) {
  for (const auto& known : session.models)
    if (auto object = known.lock(); object.get() == &model)
      return object;
  throw InputError("watch: the model is gone");
}

Value watch(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("watch");
  auto object = std::make_shared<WatchObject>();
  object->model = shared(session, model);
  object->number = model.simulation.watch(a.text("bodies"), a.number("leaves"));
  return object;
}

Value settle_result(const SettleResult& r) {
  Values phases;
  for (const SettlePhase& phase : r.phases)
    phases.emplace_back(Table{{"name", phase.name},
                              {"steps", phase.steps},
                              {"time", phase.time},
                              {"kinetic_ratio", phase.kinetic_ratio},
                              {"residual", phase.residual}});
  return Table{{"converged", r.converged},
               {"kinetic_ratio", r.kinetic_ratio},
               {"peak_kinetic", r.peak_kinetic},
               {"steps", r.steps},
               {"time", r.time},
               {"made_rigid", r.made_rigid},
               {"phases", Table::list(std::move(phases))},
               {"wall_time", r.wall_time}};
}

double out_of_balance(const SettleResult& r) {
  return r.phases.empty() ? 0 : r.phases.back().residual;
}

Value settle(Session& session, ModelObject& model, const Arguments& a) {
  SettleOptions options;
  options.kinetic_energy_ratio = a.number("kinetic_energy_ratio");
  options.rigid = a.flag("rigid");
  options.local_damping = a.number("local_damping");
  if (const auto angle = a.optional_number("friction_angle"))
    options.friction_angle = radians(*angle);
  options.max_time = a.number("max_time");
  options.safety = a.number("safety");
  options.time_step = a.optional_number("time_step").value_or(0);
  if (const auto function = a.function("callback")) {
    options.callback_every = a.has("every") ? a.integer("every") : 100;
    options.callback = [&session, function] { session.checkpoints.call_back("callback", *function, {}); };
  } else if (a.has("every")) {
    throw InputError("every = " + describe(a.value("every")) +
                     ": says how often callback is called; give one");
  }
  warn_if_nothing_acts(session, model, "settle");
  warn_of_slivers(session, model);
  return stage(session, model, "settle", a, settle_result({}),
               [&](Simulation& simulation) {
                 const SettleResult result = simulation.settle(options);
                 if (!result.converged)
                   session.warn("settle: after " + number_text(options.max_time) +
                                " s the kinetic energy is " + three_digits(result.kinetic_ratio) +
                                " of its peak, for a goal of " + number_text(options.kinetic_energy_ratio) +
                                ", and " + three_digits(out_of_balance(result)) +
                                " of the loads are out of balance; " + result.fastest + " moves most, at " +
                                three_digits(result.fastest_speed) +
                                " m/s; look whether it falls off, or raise max_time");
                 return settle_result(result);
               },
               {{"callback", a.function("callback")}});
}

} // namespace

void bind_settling(Module& m) {
  m.records.push_back({"Departure",
                       "A unit that has left its place, or a piece of one that broke.",
                       {integer("unit").required().doc("number of the unit in its body, from 1"),
                        number("time").unit("s").required(),
                        number("velocity").unit("m/s").doc("of the flow then; nil without one"),
                        vec3("displacement").unit("m").required().doc("relative to what it touched"),
                        vec3("place").unit("m").required().doc("of its centroid"),
                        number("share").required().doc("of the unit's volume; below 1: a piece of it")}});
  Class watched{"Watch", "Units that have left their place, in order: grows while the model runs."};
  watched.length = [](const Object& self) { return static_cast<std::int64_t>(watch_of(self).left().size()); };
  watched.item = [](const Object& self, std::int64_t i) {
    return departure_row(watch_of(self).left()[i - 1]);
  };
  watched.item_type = "cdem.Departure";
  watched.text = [](const Object& self) {
    return "cdem.Watch (" + std::to_string(watch_of(self).left().size()) + " left)";
  };
  m.classes.push_back(watched);

  m.records.push_back(
      {"SettlePhase",
       "A part of settling.",
       {text("name").required(), integer("steps").required(),
        number("time").unit("s").required().doc("it took"),
        number("kinetic_ratio").required().doc("kinetic energy over its peak, at its end"),
        number("residual").required().doc("forces out of balance over the loads, at its end")}});
  m.records.push_back(
      {"SettleResult",
       "What settling came to.",
       {flag("converged").required(), number("kinetic_ratio").required().doc("kinetic energy over its peak"),
        number("peak_kinetic").unit("J").required(), integer("steps").required(),
        number("time").unit("s").required().doc("it took of the model's"),
        integer("made_rigid").required().doc("units, while they fell"),
        plain("phases").required().doc("a list of cdem.SettlePhase"),
        number("wall_time").unit("s").required()}});

  Class& model = m.the_class("Model");
  model.add("watch",
            "Watches the units of a body from now on. A unit has left when its centroid has moved by "
            "`leaves` against the ground and relative to the mean motion of the bodies that it touched when "
            "the watch began, ground and units, of those that stay.",
            {text("bodies").required().doc("name of a body of meshes"),
             number("leaves").above(0).unit("m").required().doc("half a unit's height is usual")},
            watch, "cdem.Watch", "#watch, watch[i]: the units that have left so far, in order");
  model.add(
      "settle",
      "Lets units fall and come to rest: free ones as rigid bodies first, then deformable, until they are "
      "slow and carry their weight. Rigid units, damping and a lower friction are off afterwards.",
      {number("kinetic_energy_ratio")
           .between(0, 1)
           .standard(1e-6)
           .doc("goal: kinetic energy over the largest there was"),
       flag("rigid").standard(true).doc("free units fall as rigid bodies"),
       number("local_damping")
           .from(0, 1)
           .standard(0.5)
           .doc("of what touches: force against the motion as a fraction of the out-of-balance force "
                "(Cundall)"),
       number("friction_angle")
           .from(0, 90)
           .unit("deg")
           .doc("contacts have no more of it while units settle, so that they slide until they lean on more; "
                "each its own when left out, and afterwards"),
       number("max_time").above(0).standard(60.0).unit("s").doc("of the model, then a warning"),
       number("safety").within(0, 1).standard(0.5).doc(
           "time step over the stable one; with more, contacts that open and close keep shaking"),
       number("time_step")
           .above(0)
           .unit("s")
           .doc("of the rigid fall, at most the stable one, which it is by default"),
       integer("every").at_least(1).doc("steps between calls, 100 by default; in whole twenties"),
       function("callback", "()").doc("called every so many steps; may read the model and write files")},
      settle, "cdem.SettleResult");
}

} // namespace cdem::script
