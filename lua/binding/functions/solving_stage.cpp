#include "lua/binding/functions/solving_stage.hpp"

#include "libcdem/step/errors.hpp"
#include "lua/binding/replay/led.hpp"

#include <cstdio>

namespace cdem::script {

namespace {

// A model whose stage ended early: its state and its history are worth saving.
void keep_unfinished(Session& session, ModelObject& model) {
  session.failed.push_back(session.held(model));
  model.write_history(session);
  session.write_films();
}

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

// A mistake in one would end a run after hours.
void try_callbacks(const Checkpoints::Callbacks& callbacks, const Values& arguments) {
  for (const auto& [name, callback] : callbacks)
    if (callback)
      callback->call(arguments);
}

} // namespace

const Record<Stage> stage_record{
    "Stage",
    "A solving call.",
    {{integer("number").doc("over all models"), &Stage::number},
     {text("kind"), &Stage::kind},
     {text("hash").doc("of its arguments"), [](const Stage& stage) { return hash_text(stage.hash); }},
     {plain("result").required(), &Stage::result}}};

Value stage(Session& session, ModelObject& model, const char* kind, const Arguments& arguments,
            const Value& empty, const std::function<Value(Simulation&)>& solve,
            const Checkpoints::Callbacks& callbacks, const Values& tried) {
  model.require_idle(kind);
  model.check_memory();
  session.check_set_names();
  Stage stage;
  stage.number = static_cast<int>(session.stages.size()) + 1;
  stage.model = model.number;
  stage.kind = kind;
  stage.hash = fnv1a(std::string(kind) + " " + std::to_string(model.number) + " " + arguments.canonical());
  stage.result = empty;
  require_same("what " + std::string(kind) + " is called with, stage " + std::to_string(stage.number) + ",",
               std::to_string(stage.hash));
  session.stages.push_back(stage);
  const std::size_t index = session.stages.size() - 1;
  struct Solving {
    ModelObject& model;
    explicit Solving(ModelObject& m) : model(m) { model.solving = true; }
    ~Solving() { model.solving = false; }
  };
  Value result = empty;
  try {
    Solving solving(model);
    const Doing solves(session.settings.observer.get(), Activity::stage);
    if (session.settings.check_only) {
      model.simulation.check_stage();
      try_callbacks(callbacks, tried);
    } else
      result =
          session.checkpoints.stage(kind, stage.hash, callbacks, [&] { return solve(model.simulation); });
  } catch (const SolutionError&) {
    keep_unfinished(session, model);
    throw;
  } catch (const Interrupted&) {
    keep_unfinished(session, model);
    throw;
  }
  session.stages[index].result = result;
  if (!session.settings.check_only && !session.checkpoints.replaying()) {
    warn_after_stage(session, model, stage);
    model.write_history(session);
    try {
      check_energy(session, model, stage);
    } catch (const SolutionError&) {
      keep_unfinished(session, model);
      throw;
    }
  }
  {
    Solving solving(model);
    session.checkpoints.listen([&] {
      for (const auto& callback : model.after_stage)
        callback->call({stage_record(session.stages[index])});
    });
  }
  model.check_memory();
  return result;
}

} // namespace cdem::script
