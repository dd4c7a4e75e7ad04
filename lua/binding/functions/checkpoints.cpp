// Checkpoints of a run, and states that other scripts start from.
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libcdem/checkpoint/file.hpp"
#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

Value checkpoint(Session& session, ModelObject& model, const Arguments&) {
  model.require_idle("checkpoint");
  if (session.settings.script.empty())
    throw InputError("checkpoint: only in a script, which cdem resume can run again; save_state works here");
  session.checkpoints.ask();
  return {};
}

Value save_state(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("save_state");
  require_ending(a.text("file"), ".cdem");
  if (!session.settings.check_only)
    write_saved(session.files.to_write(a.text("file")), SavedKind::state, model.simulation.save());
  return {};
}

Value load_state(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("load_state");
  const std::string& name = a.text("file");
  require_ending(name, ".cdem");
  if (session.settings.check_only)
    return {};
  const std::string saved =
      led_bytes("state", [&] { return read_saved(session.files.to_read(name), SavedKind::state); });
  try {
    model.simulation.restore_state(saved);
  } catch (const InputError& error) {
    throw InputError("file = \"" + name + "\": " + error.what());
  }
  return {};
}

} // namespace

void bind_checkpoints(Module& m) {
  Class& model = m.the_class("Model");
  model.add(
      "checkpoint",
      "Writes a checkpoint of the whole run, from which `cdem resume` goes on. One is written every few "
      "minutes of a solving call too, and when a run is stopped. A resumed run executes the script "
      "again from its beginning. Calls that the script had made return what they returned before, "
      "without solving.",
      {}, checkpoint);
  model
      .add("save_state",
           "Writes the state of the model to a file that other scripts start from: motion, stress, broken "
           "bonds, contacts, time, and how it was cut. Conditions and histories stay behind.",
           {text("file").required().doc("ends in .cdem").output()}, save_state)
      .by_rank_0();
  model.add("load_state",
            "Takes the state from a file of save_state. The model must have been built from the same shapes, "
            "materials, joints and contacts.",
            {text("file").required().doc("beside the script, in the output folder or below the results")},
            load_state);
}

} // namespace cdem::script
