// Does it stand, and by how much: copies of a model, reduced strengths, the factor of safety (lua/cdem/safety.lua).
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <limits>

namespace cdem::script {

namespace {

using geom::InputError;

constexpr double small_share = 0.01; // of the volume of a model: a block whose fall is hardly that of a slope

StrengthKinds kinds_of(const Arguments& a) {
  StrengthKinds kinds;
  for (const std::string& kind : a.texts("reduce"))
    (kind == "joints" ? kinds.joints : kinds.blocks) = true;
  return kinds;
}

Value copy(Session& session, ModelObject& model, const Arguments&) {
  model.require_idle("copy");
  session.collect_garbage();
  auto other = std::make_shared<ModelObject>(model.simulation.copy());
  other->body_names = model.body_names;
  other->piles = model.piles;
  other->unjointed = model.unjointed;
  other->failing_since = model.failing_since;
  other->places = model.places;
  other->number = static_cast<int>(session.models.size()) + 1;
  if (session.checkpoints.keeps())
    other->simulation.set_checkpoint_writer(&session.checkpoints);
  other->simulation.set_replaying(session.checkpoints.replaying());
  other->memory = session.new_memory(model.memory->copy());
  other->notes->built = "copy of model " + std::to_string(model.number) + ": " + model.notes->built;
  other->notes->conditions = model.notes->conditions;
  session.models.push_back(other);
  session.notes.push_back(other->notes);
  return other;
}

Value reduce_strength(Session&, ModelObject& model, const Arguments& a) {
  model.require_idle("reduce_strength");
  model.simulation.reduce_strength(a.number("factor"), kinds_of(a));
  model.notes->conditions.push_back("strength of " + describe(a.value("reduce")) + " divided by " +
                                    describe(a.value("factor")));
  return {};
}

// Gives the checked arguments back; the search itself is lua/cdem/safety.lua.
Value factor_of_safety(Session& session, Object*, const Arguments& a) {
  if (a.has("model") == a.has("builder"))
    throw InputError(
        "model, builder: give one of them: a model, whose state as it is each trial starts from, "
        "or builder = function() ... return model end");
  const double lower = a.number("lower"), upper = a.number("upper"), tolerance = a.number("tolerance");
  if (!(upper > lower))
    throw InputError("upper", describe(a.value("upper")), "above lower = " + describe(a.value("lower")));
  if (!(tolerance < upper - lower))
    throw InputError("tolerance", describe(a.value("tolerance")),
                     "below upper - lower = " + number_text(upper - lower));
  if (const auto model = a.object<ModelObject>("model")) {
    model->require_idle("factor_of_safety");
    if (model->failing_since > 0)
      session.warn("cdem.factor_of_safety: model: it ran away in stage " +
                   std::to_string(model->failing_since) +
                   " and stands where it had slid to; a factor found from there belongs to another slope and "
                   "may be too large. Give a model in balance: model:copy() from before that stage, or one "
                   "that took up its loads with stronger joints (model:reduce_strength{ factor = 0.7 }, "
                   "model:relax, factor = 1 / 0.7)");
    double volume = 0, least = std::numeric_limits<double>::infinity(); // m3
    for (const auto& block : model->simulation.blocks()) {
      volume += block.volume;
      least = std::min(least, block.volume);
    }
    if (!a.has("smallest") && least < small_share * volume)
      model->notes->advice.push_back(
          "factor_of_safety without smallest (m3): the fall of one block decides it, the smallest of " +
          three_digits(least) + " m3 too, where the model has " + three_digits(volume) +
          " m3; smallest leaves falls below it out, 0 says that they are meant");
    if (a.optional_number("smallest").value_or(0) >= volume)
      throw InputError("smallest", describe(a.value("smallest")),
                       "below the volume of the model, " + number_text(volume) + " m3",
                       "mechanisms below it are left out");
    Simulation tried =
        model->simulation.copy(); // tells of strengths that there are not before anything is solved
    tried.reduce_strength(1, kinds_of(a));
  }
  Table given = a.table();
  given.named.emplace("smallest", 0.0);
  return given;
}

Field reduce() {
  Type kind;
  kind.kind = Kind::choice;
  kind.choices = {"joints", "blocks"};
  return list("reduce", kind)
      .required()
      .doc("strengths that are divided: joints (cohesion, tan(phi) and tensile strength of joints, bonds and "
           "contacts), blocks (those of plasticity)");
}

void bind_stability_records(Module& m) {
  m.records.push_back(
      {"SafetyTrial",
       "One trial of a search for the factor of safety.",
       {number("factor").required(), choice("verdict", {"stable", "failing", "undecided"}).required(),
        integer("steps").required(), number("residual").required()}});
  m.records.push_back(
      {"Mechanism",
       "What fails: the blocks that have moved by a fifth of the largest displacement or more.",
       {list("blocks", number("").type, 0).required().doc("their ids, the largest displacement first"),
        number("volume", "m3").required().doc("of all of them"),
        number("largest", "m3").required().doc("volume of the largest"),
        number("share").required().doc("of the volume of all blocks"),
        vec3("centroid", "m").required().doc("of all of them, where they were"),
        vec3("min", "m").required().doc("lower corner of the box of their centroids"),
        vec3("max", "m").required(),
        vec3("displacement", "m").required().doc("mean by volume, from the balance of the model")}});
  m.records.push_back(
      {"FactorOfSafety",
       "What the search for the factor of safety came to.",
       {number("factor").required().doc("middle of the bracket"),
        number("lower").required().doc("largest factor at which the model is stable"),
        number("upper").required().doc("smallest one at which it is not"),
        object("stable", "Model").required().doc("at lower, in its new balance"),
        object("failing", "Model")
            .required()
            .doc("at upper, as it was when it was found to run away; its displacement is the mechanism"),
        object("mechanism", "Mechanism")
            .doc("what fails at upper; empty in a check, none where nothing has moved"),
        integer("left_out").required().doc("blocks that failed at upper in mechanisms below smallest"),
        list("trials", object_type("SafetyTrial"), 0).required().doc("in the order they were made")}});
}

} // namespace

void bind_stability(Module& m) {
  bind_stability_records(m);
  Class& model = m.the_class("Model");
  model.add("copy",
            "Another model in the same state, with the same conditions and without histories, probes and "
            "the largest errors so far (`one_way_error`); what becomes of one does not touch the other.",
            {}, copy, "cdem.Model");
  model.add("reduce_strength",
            "Divides strengths by a factor: cohesion, tan(phi) and tensile strength. Stiffness, fracture "
            "energies and the state stay; glued faces never break. A second call acts on top of the first.",
            {number("factor").above(0).required(), reduce()}, reduce_strength);
  m.add(
      "factor_of_safety",
      "The factor of safety by strength reduction: the factor by which the strengths can be divided before "
      "the model fails, found by bisection. Each trial starts from the same state, with its displacement set "
      "to zero, and is relaxed; the verdict of model:relax says whether it stands. The log tells which "
      "blocks fail, where, and how large they are. Trials show in the progress, in the log and in "
      "report.json, which also gets the figures factor_of_safety, factor_of_safety_lower and "
      "factor_of_safety_upper. Closed forms of limit equilibrium let a joint that slips keep its cohesion: "
      "to "
      "compare with them, give it a residual_cohesion as large as its cohesion.",
      {object("model", "Model").doc("each trial starts from its state as it is; it stays as it is"),
       function("builder", "(): cdem.Model").doc("instead: makes the model of a trial, called anew for each"),
       reduce(), number("lower").above(0).standard(0.5).doc("a factor at which the model stands"),
       number("upper").above(0).standard(4.0).doc("a factor at which it fails"),
       number("tolerance").above(0).standard(0.02).doc("width of the bracket that is left"),
       number("residual")
           .between(0, 1)
           .standard(1e-5)
           .doc(
               "goal of each relaxation. 1e-4 takes far fewer steps, but passes slip within a body as stable "
               "where its unbalanced force is below 1e-4 of the loads; each loose piece has to be in balance "
               "for itself"),
       integer("max_steps")
           .at_least(1)
           .standard(200000)
           .doc("of each relaxation; a trial that is undecided then counts as failing, with a warning"),
       number("smallest", "m3")
           .at_least(0)
           .doc("volume of a mechanism that counts, 0 when left out: blocks that fail and are smaller "
                "together are removed "
                "from the trial, which goes on without them; their number is told"),
       text("picture").doc(
           "file (.png) of the mechanism: displacement of the failing side, seen from where it moves to"),
       text("figure").standard("factor_of_safety").doc("name of the figure in the report")},
      factor_of_safety, "cdem.FactorOfSafety");
}

} // namespace cdem::script
