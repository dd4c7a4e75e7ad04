// Settling of piles, and the watch over units that leave their place.
#include "lua/binding/functions/films.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/schema/angles.hpp"

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
  const std::vector<Departure>& left() const { return model->simulation.log().watches.at(number).left; }
};

const WatchObject& watch_of(const Object& self) {
  return static_cast<const WatchObject&>(self);
}

const Record<Departure> departure{
    "Departure",
    "A unit that has left its place, or a piece of one that broke.",
    {{integer("unit").doc("number of the unit in its body, from 1"), &Departure::unit},
     {number("time", "s"), &Departure::time},
     {number("velocity", "m/s").doc("of the flow then; nil without one"),
      [](const Departure& d) { return if_finite(d.velocity); }},
     {vec3("displacement", "m").doc("relative to what it touched"), &Departure::displacement},
     {vec3("place", "m").doc("of its centroid"), &Departure::place},
     {number("share").doc("of the unit's volume; below 1: a piece of it"), &Departure::share}}};

const Record<SettlePhase> settle_phase{
    "SettlePhase",
    "A part of settling.",
    {{text("name"), &SettlePhase::name},
     {integer("steps"), &SettlePhase::steps},
     {number("time", "s").doc("it took"), &SettlePhase::time},
     {number("kinetic_ratio").doc("kinetic energy over its peak, at its end"), &SettlePhase::kinetic_ratio},
     {number("residual").doc("forces out of balance over the loads, at its end"), &SettlePhase::residual}}};

const Record<SettleResult> settle_record{
    "SettleResult",
    "What settling came to.",
    {{flag("converged"), &SettleResult::converged},
     {number("kinetic_ratio").doc("kinetic energy over its peak"), &SettleResult::kinetic_ratio},
     {number("peak_kinetic", "J"), &SettleResult::peak_kinetic},
     {integer("steps"), &SettleResult::steps},
     {number("time", "s").doc("it took of the model's"), &SettleResult::time},
     {integer("made_rigid").doc("units, while they fell"), &SettleResult::made_rigid},
     {plain("phases").doc("a list of cdem.SettlePhase"), &SettleResult::phases, settle_phase},
     {number("wall_time", "s"), &SettleResult::wall_time}}};

Value watch(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("watch");
  auto object = std::make_shared<WatchObject>();
  object->model = session.held(model);
  object->number = model.simulation.watch(a.text("body"), a.number("leaves"));
  return object;
}

double out_of_balance(const SettleResult& r) {
  return r.phases.empty() ? 0 : r.phases.back().residual;
}

const Record<SettleOptions> settle_options{
    {{number("kinetic_energy_ratio")
          .between(0, 1)
          .standard()
          .doc("goal: kinetic energy over the largest there was"),
      &SettleOptions::kinetic_energy_ratio},
     {flag("rigid").standard().doc("free units fall as rigid bodies"), &SettleOptions::rigid},
     {number("local_damping")
          .from(0, 1)
          .standard()
          .doc("of what touches: force against the motion as a fraction of the out-of-balance force "
               "(Cundall)"),
      &SettleOptions::local_damping},
     {friction_field("friction_angle")
          .doc("contacts have no more of it while units settle, so that they slide until they lean on more; "
               "each its own when left out, and afterwards"),
      &SettleOptions::friction_angle},
     {number("max_time", "s").above(0).standard().doc("of the model, then a warning"),
      &SettleOptions::max_time},
     {number("safety").within(0, 1).standard().doc(
          "time step over the stable one; with more, contacts that open and close keep shaking"),
      &SettleOptions::safety},
     {number("time_step", "s")
          .above(0)
          .doc("of the rigid fall, at most the stable one, which it is by default"),
      &SettleOptions::time_step},
     {integer("every").at_least(1).doc("steps between calls, 100 by default; in whole twenties")},
     {function("callback", "()").doc("called every so many steps; may read the model and write files")}}};

Value settle(Session& session, ModelObject& model, const Arguments& a) {
  SettleOptions options = settle_options.read(a);
  if (const auto function = a.function("callback")) {
    options.callback_every = a.has("every") ? a.integer("every") : 100;
    options.callback = [&session, function] { session.checkpoints.call_back("callback", *function, {}); };
  } else if (a.has("every")) {
    throw InputError("every = " + describe(a.value("every")) +
                     ": says how often callback is called; give one");
  }
  options.looks = film_looks(session, model);
  warn_if_nothing_acts(session, model, "settle");
  warn_of_slivers(session, model);
  return stage(session, model, "settle", a, settle_record(SettleResult()),
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
                 return settle_record(result);
               },
               {{"callback", a.function("callback")}});
}

} // namespace

void bind_settling(Module& m) {
  m.records.insert(m.records.end(), {departure, settle_phase, settle_record});
  Class watched{"Watch", "Units that have left their place, in order: grows while the model runs."};
  watched.length = [](const Object& self) { return static_cast<std::int64_t>(watch_of(self).left().size()); };
  watched.item = [](const Object& self, std::int64_t i) { return departure(watch_of(self).left()[i - 1]); };
  watched.item_type = "cdem.Departure";
  watched.text = [](const Object& self) {
    return "cdem.Watch (" + std::to_string(watch_of(self).left().size()) + " left)";
  };
  m.classes.push_back(watched);

  Class& model = m.the_class("Model");
  model.add("watch",
            "Watches the units of a body from now on. A unit has left when its centroid has moved by "
            "`leaves` in two measures: relative to the ground, and relative to its neighbours. The "
            "neighbours are the units and the ground that it touched when the watch began; their mean motion "
            "counts, without that of units that have left.",
            {text("body").formerly("bodies").required().doc("name of a body of meshes"),
             number("leaves", "m").above(0).required().doc("half a unit's height is usual")},
            watch, "cdem.Watch", "#watch, watch[i]: the units that have left so far, in order");
  model.add(
      "settle",
      "Lets units fall and come to rest: free ones as rigid bodies first, then deformable, until they are "
      "slow and carry their weight. Rigid units, damping and a lower friction are off afterwards.",
      settle_options.fields(), settle, "cdem.SettleResult");
}

} // namespace cdem::script
