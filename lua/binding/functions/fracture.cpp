// Cutting blocks near failure, and cracks that grow in stages.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/selections.hpp"

#include "libcdem/memory_needed.hpp"
#include "libcdem/procedure/refine.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

using geom::InputError;

const Record<BlockCut> cut_record{
    "Cut",
    "A block that was cut.",
    {{integer("block").doc("id"), &BlockCut::block},
     {choice("mode", {"tension", "shear"}), &BlockCut::mode},
     {vec3("centroid", "m"), &BlockCut::centroid},
     {vec3("normal").doc("of the cut planes"), &BlockCut::normal},
     {vec3("principal_stress", "Pa")
          .doc(
              "tension positive, the largest first"), // The criteria keep the paper's compression-positive values; scripts see tension as positive.
      [](const BlockCut& cut) { return geom::Vec3(-cut.principal.reverse()); }},
     {number("angle_to_largest_pressure")
          .in_degrees()
          .doc("between the cut planes and the axis of the largest pressure, principal_stress[3]"),
      &BlockCut::angle_to_sigma1},
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
     {vec3("centroid", "m"), &CrackFace::centroid},
     {vec3("normal"), &CrackFace::normal},
     {number("area", "m2"), &CrackFace::area},
     {number("ratio").doc("traction over strength when it broke"), &CrackFace::ratio}}};

const Record<GrowPass> grow_pass{
    "GrowPass",
    "One pass of a growing crack.",
    {{integer("pass").doc("from 1"), &GrowPass::pass},
     {choice("state", {"growing", "arrested", "through", "stuck"}), &GrowPass::state},
     {list("cuts", object_type("Cut"), 0), &GrowPass::cuts, cut_record},
     {list("faces", object_type("CrackFace"), 0).doc("broken in this pass, in order"), &GrowPass::faces,
      crack_face},
     {integer("rounds").doc("times the worst faces broke and the model was relaxed again"),
      &GrowPass::rounds},
     {number("first_ratio").doc("traction over strength of the worst face before any broke"),
      &GrowPass::first_ratio},
     {number("last_ratio").doc("of the worst face that is left"), &GrowPass::last_ratio},
     {vec3("tip", "m"), &GrowPass::tip},
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
      &GrowResult::state},
     {list("passes", object_type("GrowPass"), 0), &GrowResult::passes, grow_pass}}};

const Record<RefineOptions> refine_record{
    {{number("tension_threshold", "Pa")
          .at_least(0)
          .standard()
          .doc("a block is cut when its stress is this close to the tensile strength"),
      &RefineOptions::tension_threshold},
     {number("shear_threshold", "Pa").at_least(0).standard().doc("the same for the Mohr-Coulomb line"),
      &RefineOptions::shear_threshold},
     {integer("planes").within(1, 15).standard().doc("equally spaced parallel cuts"), &RefineOptions::planes},
     {integer("max_depth").within(1, 6).standard().doc("a block that was cut this often is left alone"),
      &RefineOptions::max_depth},
     {choice("criterion", {"mohr_coulomb", "griffith"}).standard(), &RefineOptions::criterion},
     {place("region").doc("only blocks whose centroid lies in this one place")},
     {strength_field("cohesion").doc("for the criterion, instead of the joint's"), &RefineOptions::cohesion},
     {number("friction_angle").from(0, 90).in_degrees().doc("for the criterion, instead of the joint's"),
      &RefineOptions::friction_angle},
     {strength_field("tensile_strength").doc("for the criterion, instead of the joint's"),
      &RefineOptions::tensile_strength}}};

Field may_break_field() {
  return choice("may_break", {"all", "cut_faces", "near_cuts"})
      .doc("interfaces that may break from now on: all, the cut planes, or these and the original faces "
           "between two cut blocks");
}

const Record<RefineOptions> break_record{{{may_break_field().standard(), &RefineOptions::may_break}}};

RefineOptions refine_options(const ModelObject& of, const Arguments& a) {
  RefineOptions options = refine_record.read(a);
  if (a.has("region"))
    options.region = one_selection(of, a.value("region"), "region");
  const Model& model = of.simulation.model();
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const std::string& body = model.bodies[model.blocks[b].body].name;
    if (std::find(of.unjointed.begin(), of.unjointed.end(), body) != of.unjointed.end() &&
        may_be_cut(model, static_cast<int>(b), options))
      throw InputError("body \"" + body +
                       "\" has no joint: give it one in cdem.model, which holds the faces of the cuts "
                       "together, or leave the body out with region");
  }
  return options;
}

Value refine(Session& session, ModelObject& model, const Arguments& a) {
  RefineOptions options = refine_options(model, a);
  break_record.read(a, options);
  return stage(session, model, "refine", a, Table(), [&](Simulation& simulation) {
    warn_of_memory(session, "cutting this model", memory_to_cut(simulation.counts().tets));
    const std::vector<BlockCut> cuts = simulation.refine(options);
    const auto shear = std::count_if(cuts.begin(), cuts.end(),
                                     [](const BlockCut& cut) { return cut.mode == CutMode::shear; });
    session.message("stage " + std::to_string(session.stages.size()) +
                    " refine: " + geom::counted(cuts.size(), "block") + " cut (" +
                    std::to_string(static_cast<std::int64_t>(cuts.size()) - shear) + " tension, " +
                    std::to_string(shear) + " shear), " + std::to_string(simulation.counts().blocks) +
                    " blocks now" + (cuts.empty() ? "; what may break stays as it was" : ""));
    return cut_record.list(cuts);
  });
}

const Record<GrowOptions> grow_options{
    {{integer("passes").at_least(1).standard().doc("at most this many"), &GrowOptions::passes},
     {number("break_ratio")
          .above(0)
          .up_to(1)
          .standard()
          .doc("faces that carry this part of the worst ratio of traction to strength break together"),
      &GrowOptions::break_ratio},
     {choice("breaking", {"front", "anywhere"})
          .standard()
          .doc(
              "faces that may break: those that meet the crack's front, or any; any while there is no crack"),
      &GrowOptions::where},
     {flag("anchor_at_tip")
          .standard()
          .doc("blocks that the crack enters are cut, and one plane passes through its tip"),
      &GrowOptions::anchor_at_tip},
     {choice("judged_by", {"tip", "block"})
          .standard()
          .doc("what turns the planes: the stress around the tip, or each block's own mean (Han 2010)"),
      &GrowOptions::judged_by},
     {number("tip_radius", "m")
          .above(0)
          .doc("reach of the stress around the tip and, without anchor_at_tip, of the cutting; one block "
               "size when left out"),
      &GrowOptions::tip_radius},
     {number("residual").between(0, 1).standard().doc("goal of every relaxation"), &GrowOptions::residual},
     {integer("max_steps").at_least(1).standard().doc("of every relaxation"), &GrowOptions::max_steps},
     {integer("max_rounds").at_least(1).standard().doc("of breaking, in each pass"),
      &GrowOptions::max_rounds},
     {function("callback", "(pass: cdem.GrowPass)")
          .doc("called after every pass, with the model in balance; may read the model and write files")}}},
    grow_breaks{{{may_break_field().doc(may_break_field().doc_text +
                                        "; the cut planes when left out, near_cuts without anchor_at_tip"),
                  &GrowOptions::may_break}}};

Value grow(Session& session, ModelObject& model, const Arguments& a) {
  GrowOptions options = grow_options.read(a);
  grow_breaks.read(a, options);
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

} // namespace

void bind_fracture(Module& m) {
  m.records.insert(m.records.end(), {cut_record, crack_face, grow_pass, grow_record});
  Class& model = m.the_class("Model");
  model.add("refine",
            "Cuts blocks near failure along their failure plane into slices (Han 2010 eqs 13-20); the pieces "
            "are bonded and carry the state over.",
            refine_record.fields() + break_record.fields(), refine, "cdem.Cut[]",
            "one table per block that was cut");
  model.add(
      "grow",
      "Lets a crack advance in passes: blocks at its tip are cut along their failure plane, the worst faces "
      "break, the model finds its balance, until nothing breaks; then the next pass (Han 2010 example 4.2).",
      grow_options.fields() + refine_record.fields() + grow_breaks.fields(), grow, "cdem.GrowResult");
}

} // namespace cdem::script
