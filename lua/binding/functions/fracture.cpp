// Cutting blocks near failure, and cracks that grow in stages.
#include "lua/binding/functions/angles.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/selections.hpp"

#include "libcdem/memory_needed.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

const Record<BlockCut> cut_record{
    "Cut",
    "A block that was cut.",
    {{integer("block").doc("id"), &BlockCut::block},
     {choice("mode", {"tension", "shear"}),
      [](const BlockCut& cut) { return cut.mode == CutMode::shear ? "shear" : "tension"; }},
     {vec3("centroid").unit("m"), &BlockCut::centroid},
     {vec3("normal").doc("of the cut planes"), &BlockCut::normal},
     {vec3("principal_stress")
          .unit("Pa")
          .doc(
              "tension positive, the largest first"), // The criteria keep the paper's compression-positive values; scripts see tension as positive.
      [](const BlockCut& cut) { return geom::Vec3(-cut.principal.reverse()); }},
     {number("angle_to_largest_pressure")
          .unit("deg")
          .doc("between the cut planes and the axis of the largest pressure, principal_stress[3]"),
      [](const BlockCut& cut) { return degrees(cut.angle_to_sigma1); }},
     {integer("generation").doc("0 for an original block"), &BlockCut::generation},
     {integer("pieces"), &BlockCut::pieces},
     {flag("tie").doc("both conjugate planes were equally good"), &BlockCut::tie}}};

const Record<CrackFace> crack_face{
    "CrackFace",
    "A face of the crack, as it lay in the undeformed body.",
    {{integer("interface").doc("id"), &CrackFace::interface},
     {integer("pass"), &CrackFace::pass},
     {integer("round").doc("within the pass"), &CrackFace::round},
     {choice("mode", {"tension", "shear"}),
      [](const CrackFace& f) { return f.mode == BondMode::broken_shear ? "shear" : "tension"; }},
     {vec3("centroid").unit("m"), &CrackFace::centroid},
     {vec3("normal"), &CrackFace::normal},
     {number("area").unit("m2"), &CrackFace::area},
     {number("ratio").doc("traction over strength when it broke"), &CrackFace::ratio}}};

const Record<GrowPass> grow_pass{
    "GrowPass",
    "One pass of a growing crack.",
    {{integer("pass").doc("from 1"), &GrowPass::pass},
     {choice("state", {"growing", "arrested", "through", "stuck"}),
      [](const GrowPass& pass) { return name(pass.state); }},
     {list("cuts", object_type("Cut"), 0), [](const GrowPass& pass) { return cut_record.list(pass.cuts); }},
     {list("faces", object_type("CrackFace"), 0).doc("broken in this pass, in order"),
      [](const GrowPass& pass) { return crack_face.list(pass.faces); }},
     {integer("rounds").doc("times the worst faces broke and the model was relaxed again"),
      &GrowPass::rounds},
     {number("first_ratio").doc("traction over strength of the worst face before any broke"),
      &GrowPass::first_ratio},
     {number("last_ratio").doc("of the worst face that is left"), &GrowPass::last_ratio},
     {vec3("tip").unit("m"), &GrowPass::tip},
     {list("path", vec3_type(), 0)
          .unit("m")
          .doc("from the crack's mouth to its end; empty while there is no crack"),
      &GrowPass::path},
     {integer("steps").doc("of relaxation"), &GrowPass::steps}}};

const Record<GrowResult> grow_record{
    "GrowResult",
    "What growing a crack came to.",
    {{choice("state", {"growing", "arrested", "through", "stuck"})
          .doc("arrested: nothing reaches its strength any more; through: the crack parts "
               "the body; stuck: no balance was reached"),
      [](const GrowResult& result) { return name(result.state); }},
     {list("passes", object_type("GrowPass"), 0),
      [](const GrowResult& result) { return grow_pass.list(result.passes); }}}};

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
    return cut_record.list(cuts);
  });
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
      session.checkpoints.call_back("callback", *callback, {grow_pass(pass)});
    };
  return stage(session, model, "grow", a, grow_record(GrowResult()),
               [&](Simulation& simulation) {
                 warn_of_memory(session, "cutting this model", memory_to_cut(simulation.counts().tets));
                 const GrowResult result = simulation.grow(options);
                 if (result.state == GrowState::stuck)
                   session.warn("grow: stuck in pass " + std::to_string(result.passes.size()) +
                                "; a relaxation did not reach its residual or max_rounds was used up");
                 return grow_record(result);
               },
               {{"callback", a.function("callback")}}, {grow_pass(GrowPass())});
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
          strength_field("cohesion").doc("for the criterion, instead of the joint's"),
          number("friction_angle").from(0, 90).unit("deg").doc("for the criterion, instead of the joint's"),
          strength_field("tensile_strength").doc("for the criterion, instead of the joint's")};
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

} // namespace

void bind_fracture(Module& m) {
  m.records.insert(m.records.end(), {cut_record, crack_face, grow_pass, grow_record});
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
