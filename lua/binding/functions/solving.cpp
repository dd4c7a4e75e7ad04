// Solving calls: numbered stages, hashed by their arguments. In a check they return typed, empty results.
#include "lua/binding/functions/films.hpp"
#include "lua/binding/functions/mass_scaling.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/record.hpp"

#include "libcdem/step/stage.hpp"
#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

std::function<void()> callback_of(Session& session, const Arguments& a) {
  const auto function = a.function("callback");
  if (!function)
    return {};
  return [&session, function] { session.checkpoints.call_back("callback", *function, {}); };
}

std::int64_t callback_interval(const Arguments& a) {
  if (a.has("callback") || a.has("stop"))
    return a.has("every") ? a.integer("every") : 100;
  return 0;
}

// Without a callback `every` is of the history.
std::int64_t history_interval(const Arguments& a) {
  return a.has("every") && !a.has("callback") && !a.has("stop") ? a.integer("every") : 0;
}

Value relax_result(const RelaxResult& r, const std::string& trial) {
  Table table = relax_record(r);
  if (!trial.empty())
    table.named["trial"] = trial;
  return table;
}

// The moving block, for messages.
std::string moving_text(const RelaxResult& r) {
  return "block " + std::to_string(r.moving_block) + " at " + place_text(r.moving_place) + " m moved " +
         three_digits(r.moving) + " m in the last " + std::to_string(watch_every) + " steps";
}

void tell_verdict(Session& session, const RelaxOptions& options, const RelaxResult& r) {
  const std::string found = "relax" + (options.note.empty() ? "" : ", " + options.note) + ": " +
                            name(r.verdict) + " after " + geom::counted(r.steps, "step") + ", residual " +
                            three_digits(r.residual);
  if (r.verdict == Verdict::undecided && r.residual <= options.residual)
    session.warn(found + ": not converged; the model as a whole is in balance, but not each of its pieces: " +
                 moving_text(r) + "; raise max_steps, or look whether it moves freely");
  else if (r.verdict == Verdict::undecided)
    session.warn(found + " above " + number_text(options.residual) +
                 ": not converged; raise max_steps, give a larger residual, or look whether something moves "
                 "freely");
  else if (r.verdict == Verdict::failing && options.note.empty())
    session.warn(found + ": it runs away, " + moving_text(r) +
                 "; the script goes on, and result.verdict is \"failing\"");
  else if (!options.note.empty())
    session.message(found);
  if (r.way_done < 1)
    session.warn("relax: moved supports have gone " + three_digits(100 * r.way_done) +
                 " % of their way; the next relax or run moves them the rest, a run within its own time");
  if (r.broken_while_drawn > 0)
    session.warn("relax: " + geom::counted(r.broken_while_drawn, "bond") +
                 " broke while supports went on though forces were out of balance, perhaps too early; move "
                 "supports in smaller increments, with a relax after each, or by run");
}

Field breaking() {
  return flag("breaking").standard().doc("bonds may break");
}
Field every() {
  return integer("every").at_least(1).doc("steps between calls, 100 by default; without a callback steps "
                                          "between samples of the history from here on, 10 at first");
}
Field callback() {
  return function("callback", "()").doc("called every so many steps; may read the model and write files");
}

const Record<RelaxOptions> relax_options{
    {{number("residual")
          .between(0, 1)
          .standard()
          .doc("goal: out-of-balance force norm over applied force norm"),
      &RelaxOptions::residual},
     {breaking(), &RelaxOptions::breaking},
     {integer("max_steps").at_least(1).standard().doc("gives up with converged = false, undecided"),
      &RelaxOptions::max_steps},
     {flag("stop_on_failure")
          .standard(true)
          .doc(
              "ends where the model runs away, with the verdict \"failing\"; false: goes on, for a fall that "
              "something may catch"),
      &RelaxOptions::stop_on_failure},
     {text("trial").doc(
          "name of a trial, \"F = 1.2\", for progress, log and report; that it fails is then an "
          "answer and no warning"),
      &RelaxOptions::note},
     {every()},
     {callback()}}};

Value relax(Session& session, ModelObject& model, const Arguments& a) {
  RelaxOptions options = relax_options.read(a);
  options.callback_every = callback_interval(a);
  options.callback = callback_of(session, a);
  options.history_every = history_interval(a);
  options.looks = film_looks(session, model);
  model.trial = model.trial || !options.note.empty();
  warn_if_nothing_acts(session, model, "relax");
  return stage(session, model, "relax", a, relax_result({}, options.note),
               [&](Simulation& simulation) {
                 const RelaxResult result = simulation.relax(options);
                 tell_verdict(session, options, result);
                 if (result.verdict == Verdict::failing)
                   model.failing_since = static_cast<int>(session.stages.size());
                 else if (result.verdict == Verdict::stable)
                   model.failing_since = 0;
                 return relax_result(result, options.note);
               },
               {{"callback", a.function("callback")}});
}

const Record<RunResult> run_record{
    "RunResult",
    "What real-time stepping came to.",
    {{integer("steps"), &RunResult::steps},
     {number("time", "s").doc("of the model"), &RunResult::time},
     {number("time_step", "s"), &RunResult::time_step},
     {integer("broken_tension").doc("bonds, in this stage"), &RunResult::broken_tension},
     {integer("broken_shear").doc("bonds, in this stage"), &RunResult::broken_shear},
     {number("wall_time", "s"), &RunResult::wall_time},
     {mass_scaling_result_field()}}};

const Record<RunOptions> run_options{
    {{number("duration", "s").above(0), &RunOptions::duration},
     {integer("steps").at_least(1).doc("instead of duration"), &RunOptions::steps},
     {number("safety")
          .above(0)
          .up_to(1)
          .doc("time step over the stable one, at most 1; rigid bodies that touch take 0.5 at most")
          .standard(),
      &RunOptions::safety},
     {number("time_step", "s")
          .above(0)
          .doc("instead of safety; at most the stable one, half of it for rigid bodies that may touch"),
      &RunOptions::time_step},
     {mass_scaling_field()},
     {breaking(), &RunOptions::breaking},
     {number("local_damping")
          .from(0, 1)
          .standard()
          .doc("force against the motion as a fraction of the out-of-balance force (Cundall)"),
      &RunOptions::local_damping},
     {every()},
     {callback()},
     {function("stop", "(): boolean")
          .doc("ends the stage when it returns true; called every `every` steps, 100 by default")}}};

Value run(Session& session, ModelObject& model, const Arguments& a) {
  RunOptions options = run_options.read(a);
  if (a.has("duration") && a.has("steps"))
    throw InputError("duration and steps: give one of them");
  if (!a.has("duration") && !a.has("steps") && !a.has("stop"))
    throw InputError("duration: missing; give duration (s), steps, or stop = function() ... end");
  options.mass_scaling = mass_scaling_of(a);
  options.callback_every = callback_interval(a);
  options.callback = callback_of(session, a);
  options.history_every = history_interval(a);
  options.looks = film_looks(session, model);
  if (const auto stop = a.function("stop"))
    options.stop = [&session, stop] {
      const Values answer = session.checkpoints.call_back("stop", *stop, {});
      const bool* yes = answer.empty() ? nullptr : answer[0].get<bool>();
      if (!yes && !(answer.empty() || answer[0].is_nil()))
        throw InputError("stop() of " + stop->place(), describe(answer[0]), "true or false");
      return yes && *yes;
    };
  if (session.settings.check_only && options.duration > 0) {
    model.simulation.check_run(model.time(), model.time() + options.duration);
    model.checked += options.duration;
    model.notes->at_end.clear();
    note_dry_flows(model);
  }
  warn_of_slivers(session, model);
  if (!a.has("duration") && !a.has("steps"))
    options.steps = std::numeric_limits<std::int64_t>::max(); // until stop says so
  return stage(session, model, "run", a, run_record(RunResult()),
               [&](Simulation& simulation) {
                 const RunResult ran = simulation.run(options);
                 Value result = run_record(ran);
                 add_mass_scaling(session, "run", options.mass_scaling, ran.time_step, ran.scaled, result);
                 return result;
               },
               {{"callback", a.function("callback")}, {"stop", a.function("stop")}});
}

Value stages(Session& session, ModelObject& model, const Arguments&) {
  Values rows;
  for (const Stage& stage : session.stages)
    if (stage.model == model.number)
      rows.push_back(stage_record(stage));
  return Table::list(std::move(rows));
}

Value after_stage(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("after_stage");
  model.after_stage.push_back(a.function("callback"));
  return {};
}

template <class X>
std::optional<X> if_moving(const RelaxResult& r, const X& x) {
  return r.moving > 0 ? std::optional<X>(x) : std::nullopt;
}

} // namespace

const Record<RelaxResult> relax_record{
    "RelaxResult",
    "What a relaxation came to.",
    {{flag("converged"), &RelaxResult::converged},
     {choice("verdict", {"stable", "failing", "undecided"})
          .doc("stable: converged; failing: it runs away; undecided: max_steps came before either"),
      &RelaxResult::verdict},
     {integer("steps"), &RelaxResult::steps},
     {number("residual"), &RelaxResult::residual},
     {integer("broken_tension").doc("bonds, in this stage"), &RelaxResult::broken_tension},
     {integer("broken_shear").doc("bonds, in this stage"), &RelaxResult::broken_shear},
     {number("way_done").doc("part of the way that moved supports have gone, 1 where none moves"),
      &RelaxResult::way_done},
     {number("wall_time", "s"), &RelaxResult::wall_time},
     {number("moving", "m").doc("what the fastest node moved in the last 200 steps that were looked at"),
      [](const RelaxResult& r) { return if_moving(r, r.moving); }},
     {integer("moving_block").doc("its block"),
      [](const RelaxResult& r) { return if_moving(r, r.moving_block); }},
     {vec3("moving_place", "m").doc("where it was, undeformed"),
      [](const RelaxResult& r) { return if_moving(r, r.moving_place); }},
     {text("trial").doc("as given")}}};

void bind_solving(Module& m) {
  m.records.insert(m.records.end(), {relax_record, run_record, stage_record});
  Class& model = m.the_class("Model");
  model.add(
      "relax",
      "Dynamic relaxation to static balance, with fictitious masses and adaptive damping (Han 2010 eq 12). "
      "The verdict tells a model that stands from one that runs away (docs/theory.md, section 25).",
      relax_options.fields(), relax, "cdem.RelaxResult");
  model.add("run", "Explicit stepping in real time with the real masses.", run_options.fields(), run,
            "cdem.RunResult");
  model
      .add("after_stage",
           "Has a function called after every solving call from now on, for what each stage should leave "
           "behind.",
           {function("callback", "(stage: cdem.Stage)").required().doc("may read the model and write files")},
           after_stage)
      .ordered()
      .replayed(Replay::again);
  model.add("stages", "The model's solving calls so far.", {}, stages, "cdem.Stage[]");
}

} // namespace cdem::script
