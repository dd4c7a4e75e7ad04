#include "lua/binding/functions/solving_stage.hpp"

#include "libcdem/step/errors.hpp"
#include "lua/binding/functions/angles.hpp"

#include <cstdio>

namespace cdem::script {

namespace {

// A model whose stage ended early: its state and its history are worth saving.
void keep_unfinished(Session& session, ModelObject& model) {
  for (const auto& known : session.models)
    if (known.lock().get() == &model)
      session.failed.push_back(known.lock());
  model.write_history(session);
}

constexpr double small_strain = 0.01;
constexpr double small_turn = 1;                            // degree
constexpr double small_departure = 0.1;                     // of a face's size
constexpr double open_balance = 0.01, broken_balance = 0.1; // of the largest external work

// One line a stage, of what small strain cannot hold (results/deformation.hpp says why these limits).
void warn_of_large_deformation(Session& session, const ModelObject& model, const Stage& stage) {
  const Deformation d = model.simulation.deformation();
  std::string found;
  if (d.strain > small_strain)
    found = "block " + std::to_string(d.strain_block) + " is strained by " + three_digits(100 * d.strain) +
            " % (more than 1 %)";
  if (degrees(d.turn) > small_turn)
    found += (found.empty() ? "block " : ", block ") + std::to_string(d.turn_block) + " has turned by " +
             three_digits(degrees(d.turn)) + " degrees (more than 1), a false strain of " +
             three_digits(50 * d.turn * d.turn) + " %";
  if (d.departure > small_departure)
    found += (found.empty() ? "block " : ", block ") + std::to_string(d.departure_block) +
             " has left a neighbour by " + three_digits(100 * d.departure) +
             " % of their face's size, and meets nothing new";
  if (!found.empty())
    session.warn("stage " + std::to_string(stage.number) + " (" + stage.kind +
                 "): beyond small strain: " + found);
}

// A relaxation that did not converge.
bool stopped_short(const Value& result) {
  const Table* const table = result.table();
  if (!table)
    return false;
  const auto found = table->named.find("converged");
  const bool* const converged = found == table->named.end() ? nullptr : found->second.get<bool>();
  return converged && !*converged;
}

// The ledger has to close: what is stored and spent is the work of the loads. A balance that is open says that the
// solution is not to be trusted.
// One of a relaxation that stopped short of its balance says nothing: that one is told of anyway.
void check_energy(Session& session, const ModelObject& model, const Stage& stage) {
  if (stopped_short(stage.result))
    return;
  const double open = model.simulation.energy().balance_error();
  if (open <= open_balance)
    return;
  const std::string found = "stage " + std::to_string(stage.number) + " (" + stage.kind +
                            "): the energy balance is open by " + three_digits(100 * open) +
                            " % of the largest work of the loads";
  if (open > broken_balance)
    throw SolutionError(found + "; take a smaller safety or time_step, a finer mesh, or softer contacts");
  session.warn(found + " (more than 1 %)");
}

// A mistake in one would end a run after hours.
void try_callbacks(const Checkpoints::Callbacks& callbacks, const Values& arguments) {
  for (const auto& [name, callback] : callbacks)
    if (callback)
      callback->call(arguments);
}

} // namespace

std::string three_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

void warn_if_nothing_acts(Session& session, const ModelObject& model, const std::string& kind) {
  if (!model.simulation.anything_acts())
    session.warn(
        kind + ": nothing acts on the model: no load, no support that moves it, no initial stress; it stays "
               "as it is");
}

Value stage_row(const Stage& stage) {
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(stage.hash));
  return Table{
      {"number", stage.number}, {"kind", stage.kind}, {"hash", std::string(hash)}, {"result", stage.result}};
}

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
    if (session.settings.check_only)
      try_callbacks(callbacks, tried);
    else
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
    warn_of_large_deformation(session, model, stage);
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
        callback->call({stage_row(session.stages[index])});
    });
  }
  model.check_memory();
  return result;
}

} // namespace cdem::script
