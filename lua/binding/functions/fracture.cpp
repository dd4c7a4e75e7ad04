// Cutting blocks near failure, and cracks that grow in stages.
#include "lua/binding/functions/angles.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/selections.hpp"

#include "libcdem/memory_needed.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

Value cut_row(const BlockCut& cut) {
  return Table{{"block", cut.block},
               {"mode", cut.mode == CutMode::shear ? "shear" : "tension"},
               {"centroid", cut.centroid},
               {"normal", cut.normal},
               // The criteria keep the paper's compression-positive values; scripts see tension as positive.
               {"principal_stress", geom::Vec3(-cut.principal.reverse())},
               {"angle_to_largest_pressure", degrees(cut.angle_to_sigma1)},
               {"generation", cut.generation},
               {"pieces", cut.pieces},
               {"tie", cut.tie}};
}

Value cut_rows(const std::vector<BlockCut>& cuts) {
  Values rows;
  for (const BlockCut& cut : cuts)
    rows.push_back(cut_row(cut));
  return Table::list(std::move(rows));
}

MayBreak may_break_of(const std::string& text) {
  return text == "all" ? MayBreak::all : text == "cut_faces" ? MayBreak::cut_faces : MayBreak::near_cuts;
}

RefineOptions refine_options(const ModelObject& model, const Arguments& a) {
  if (!model.unjointed.empty())
    throw InputError(
        "body \"" + model.unjointed.front() +
        "\" has no joint: give it one in cdem.model, which holds the faces of the cuts together");
  RefineOptions options;
  options.tension_threshold = a.number("tension_threshold");
  options.shear_threshold = a.number("shear_threshold");
  options.planes = a.count("planes");
  options.max_depth = a.count("max_depth");
  options.criterion = a.text("criterion") == "griffith" ? Criterion::griffith : Criterion::mohr_coulomb;
  if (a.has("region"))
    options.region = one_selection(model, a.value("region"), "region");
  options.cohesion = a.optional_number("cohesion");
  if (const auto angle = a.optional_number("friction_angle"))
    options.friction_angle = radians(*angle);
  options.tensile_strength = a.optional_number("tensile_strength");
  return options;
}

Value refine(Session& session, ModelObject& model, const Arguments& a) {
  RefineOptions options = refine_options(model, a);
  options.may_break = may_break_of(a.text("may_break"));
  return stage(session, model, "refine", a, Table(), [&](Simulation& simulation) {
    warn_of_memory(session, "cutting this model", memory_to_cut(simulation.counts().tets));
    const std::vector<BlockCut> cuts = simulation.refine(options);
    const auto shear = std::count_if(cuts.begin(), cuts.end(),
                                     [](const BlockCut& cut) { return cut.mode == CutMode::shear; });
    session.message("stage " + std::to_string(session.stages.size()) + " refine: " +
                    std::to_string(cuts.size()) + (cuts.size() == 1 ? " block cut (" : " blocks cut (") +
                    std::to_string(static_cast<std::int64_t>(cuts.size()) - shear) + " tension, " +
                    std::to_string(shear) + " shear), " + std::to_string(simulation.counts().blocks) +
                    " blocks now" + (cuts.empty() ? "; what may break stays as it was" : ""));
    return cut_rows(cuts);
  });
}

Value pass_row(const GrowPass& pass) {
  Values faces;
  for (const CrackFace& f : pass.faces)
    faces.emplace_back(Table{{"interface", f.interface},
                             {"pass", f.pass},
                             {"round", f.round},
                             {"mode", f.mode == BondMode::broken_shear ? "shear" : "tension"},
                             {"centroid", f.centroid},
                             {"normal", f.normal},
                             {"area", f.area},
                             {"ratio", f.ratio}});
  return Table{{"pass", pass.pass},
               {"state", name(pass.state)},
               {"cuts", cut_rows(pass.cuts)},
               {"faces", Table::list(std::move(faces))},
               {"rounds", pass.rounds},
               {"first_ratio", pass.first_ratio},
               {"last_ratio", pass.last_ratio},
               {"tip", pass.tip},
               {"path", Table::list(Values(pass.path.begin(), pass.path.end()))},
               {"steps", pass.steps}};
}

Value grow_result(const GrowResult& result) {
  Values passes;
  for (const GrowPass& pass : result.passes)
    passes.push_back(pass_row(pass));
  return Table{{"state", name(result.state)}, {"passes", Table::list(std::move(passes))}};
}

Value grow(Session& session, ModelObject& model, const Arguments& a) {
  GrowOptions options;
  options.passes = a.count("passes");
  options.break_ratio = a.number("break_ratio");
  options.tip_radius = a.optional_number("tip_radius");
  options.anchor_at_tip = a.flag("anchor_at_tip");
  options.judged_by = a.text("judged_by") == "block" ? JudgedBy::block : JudgedBy::tip;
  options.where = a.text("breaking") == "anywhere" ? BreakWhere::anywhere : BreakWhere::front;
  if (a.has("may_break"))
    options.may_break = may_break_of(a.text("may_break"));
  options.residual = a.number("residual");
  options.max_steps = a.integer("max_steps");
  options.max_rounds = a.count("max_rounds");
  options.refine = refine_options(model, a);
  if (const auto callback = a.function("callback"))
    options.callback = [&session, callback](const GrowPass& pass) {
      session.checkpoints.call_back("callback", *callback, {pass_row(pass)});
    };
  return stage(session, model, "grow", a, grow_result({}),
               [&](Simulation& simulation) {
                 warn_of_memory(session, "cutting this model", memory_to_cut(simulation.counts().tets));
                 const GrowResult result = simulation.grow(options);
                 if (result.state == GrowState::stuck)
                   session.warn("grow: stuck in pass " + std::to_string(result.passes.size()) +
                                "; a relaxation did not reach its residual or max_rounds was used up");
                 return grow_result(result);
               },
               {{"callback", a.function("callback")}}, {pass_row({})});
}

std::vector<Field> refine_fields() {
  return {number("tension_threshold")
              .at_least(0)
              .unit("Pa")
              .standard(0.0)
              .doc("a block is cut when its stress is this close to the tensile strength"),
          number("shear_threshold")
              .at_least(0)
              .unit("Pa")
              .standard(0.0)
              .doc("the same for the Mohr-Coulomb line"),
          integer("planes").within(1, 15).standard(3).doc("equally spaced parallel cuts"),
          integer("max_depth").within(1, 6).standard(1).doc("a block that was cut this often is left alone"),
          choice("criterion", {"mohr_coulomb", "griffith"}).standard("mohr_coulomb"),
          place("region").doc("only blocks whose centroid lies in this one place"),
          number("cohesion").at_least(0).unit("Pa").doc("for the criterion, instead of the joint's"),
          number("friction_angle").from(0, 90).unit("deg").doc("for the criterion, instead of the joint's"),
          number("tensile_strength").at_least(0).unit("Pa").doc("for the criterion, instead of the joint's")};
}

Field may_break_field() {
  return choice("may_break", {"all", "cut_faces", "near_cuts"})
      .doc("interfaces that may break from now on: all, the cut planes, or these and the original faces "
           "between two cut blocks");
}

std::vector<Field> grow_fields() {
  std::vector<Field> fields{
      integer("passes").at_least(1).standard(3).doc("at most this many"),
      number("break_ratio")
          .within(0, 1)
          .standard(0.9)
          .doc("faces that carry this part of the worst ratio of traction to strength break together"),
      choice("breaking", {"front", "anywhere"})
          .standard("front")
          .doc(
              "faces that may break: those that meet the crack's front, or any; any while there is no crack"),
      flag("anchor_at_tip")
          .standard(true)
          .doc("blocks that the crack enters are cut, and one plane passes through its tip"),
      choice("judged_by", {"tip", "block"})
          .standard("tip")
          .doc("what turns the planes: the stress around the tip, or each block's own mean (Han 2010)"),
      number("tip_radius")
          .above(0)
          .unit("m")
          .doc("reach of the stress around the tip and, without anchor_at_tip, of the cutting; one block "
               "size when left out"),
      number("residual").between(0, 1).standard(1e-5).doc("goal of every relaxation"),
      integer("max_steps").at_least(1).standard(500000).doc("of every relaxation"),
      integer("max_rounds").at_least(1).standard(200).doc("of breaking, in each pass"),
      function("callback", "(pass: cdem.GrowPass)")
          .doc("called after every pass, with the model in balance; may read the model and write files")};
  fields[1].type.range.low_open = true;
  for (const Field& field : refine_fields())
    fields.push_back(field);
  fields.push_back(may_break_field());
  fields.back().doc_text += "; the cut planes when left out, near_cuts without anchor_at_tip";
  return fields;
}

void bind_fracture_records(Module& m) {
  m.records.push_back(
      {"Cut",
       "A block that was cut.",
       {integer("block").required().doc("id"), choice("mode", {"tension", "shear"}).required(),
        vec3("centroid").unit("m").required(), vec3("normal").required().doc("of the cut planes"),
        vec3("principal_stress").unit("Pa").required().doc("tension positive, the largest first"),
        number("angle_to_largest_pressure")
            .unit("deg")
            .required()
            .doc("between the cut planes and the axis of the largest pressure, principal_stress[3]"),
        integer("generation").required().doc("0 for an original block"), integer("pieces").required(),
        flag("tie").required().doc("both conjugate planes were equally good")}});
  m.records.push_back(
      {"CrackFace",
       "A face of the crack, as it lay in the undeformed body.",
       {integer("interface").required().doc("id"), integer("pass").required(),
        integer("round").required().doc("within the pass"), choice("mode", {"tension", "shear"}).required(),
        vec3("centroid").unit("m").required(), vec3("normal").required(),
        number("area").unit("m2").required(),
        number("ratio").required().doc("traction over strength when it broke")}});
  m.records.push_back(
      {"GrowPass",
       "One pass of a growing crack.",
       {integer("pass").required().doc("from 1"),
        choice("state", {"growing", "arrested", "through", "stuck"}).required(),
        list("cuts", object_type("Cut"), 0).required(),
        list("faces", object_type("CrackFace"), 0).required().doc("broken in this pass, in order"),
        integer("rounds").required().doc("times the worst faces broke and the model was relaxed again"),
        number("first_ratio").required().doc("traction over strength of the worst face before any broke"),
        number("last_ratio").required().doc("of the worst face that is left"),
        vec3("tip").unit("m").required(),
        list("path", vec3_type(), 0)
            .unit("m")
            .required()
            .doc("from the crack's mouth to its end; empty while there is no crack"),
        integer("steps").required().doc("of relaxation")}});
  m.records.push_back({"GrowResult",
                       "What growing a crack came to.",
                       {choice("state", {"growing", "arrested", "through", "stuck"})
                            .required()
                            .doc("arrested: nothing reaches its strength any more; through: the crack parts "
                                 "the body; stuck: no balance was reached"),
                        list("passes", object_type("GrowPass"), 0).required()}});
}

} // namespace

void bind_fracture(Module& m) {
  bind_fracture_records(m);
  Class& model = m.the_class("Model");
  std::vector<Field> of_refine = refine_fields();
  of_refine.push_back(may_break_field().standard("near_cuts"));
  model.add("refine",
            "Cuts blocks near failure along their failure plane into slices (Han 2010 eqs 13-20); the pieces "
            "are bonded and carry the state over.",
            of_refine, refine, "cdem.Cut[]", "one table per block that was cut");
  model.add(
      "grow",
      "Lets a crack advance in passes: blocks at its tip are cut along their failure plane, the worst faces "
      "break, the model finds its balance, until nothing breaks; then the next pass (Han 2010 example 4.2).",
      grow_fields(), grow, "cdem.GrowResult");
}

} // namespace cdem::script
