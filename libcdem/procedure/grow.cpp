#include "libcdem/procedure/grow.hpp"

#include "libcdem/fracture/crack_path.hpp"
#include "libcdem/procedure/refine.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace cdem {
namespace {

// A piece with this part of the volume that no intact bond holds to the rest: the body is parted.
constexpr double parted = 0.05;

void check(const GrowOptions& o) {
  geom::require(o.passes >= 1, "passes", o.passes, "an integer >= 1");
  geom::require_in("break_ratio", o.break_ratio, "(0, 1]",
                   "0.9 breaks the worst face and those within a tenth of it");
  if (o.tip_radius)
    geom::require_above("tip_radius", *o.tip_radius, 0, "m", "one block size is usual");
  geom::require_in("residual", o.residual, "(0, 1)", "1e-5 is usual");
  geom::require(o.max_steps >= 1, "max_steps", static_cast<double>(o.max_steps), "an integer >= 1");
  geom::require(o.max_rounds >= 1, "max_rounds", o.max_rounds, "an integer >= 1");
}

// Whole faces break at the mean of their tractions: the energy that a softening bond has yet to take is no part of it.
void refuse_softening(const Model& model) {
  for (const auto& [bodies, joint] : model.pair_joint) {
    const Softening softening = model.joints[joint].softening;
    if (softening == Softening::none)
      continue;
    const std::string &a = model.bodies[bodies.first].name, &b = model.bodies[bodies.second].name;
    throw geom::InputError(fmt::format(
        "the joint {} softens (softening = \"{}\"), and grow breaks whole faces at their strength; "
        "leave softening out, or load in small increments with relax, which follows the curve",
        a == b ? "inside \"" + a + "\"" : "between \"" + a + "\" and \"" + b + "\"",
        softening == Softening::linear ? "linear" : "exponential"));
  }
}

// The same for the laws of joint sets.
void refuse_softening_sets(const Model& model) {
  for (const Body& body : model.bodies)
    for (const auto& [name, joint] : body.set_joint)
      if (model.joints[joint].softening != Softening::none)
        throw geom::InputError(
            fmt::format("joints of body \"{}\": \"{}\" softens, and grow breaks whole faces at their "
                        "strength; leave softening out, or load in small increments with relax",
                        body.name, name));
}

double worst_ratio(const std::vector<FaceLoad>& loads) {
  double worst = 0;
  for (const FaceLoad& load : loads)
    worst = std::max(worst, load.ratio.value);
  return worst;
}

std::string place(const geom::Vec3& x) {
  return fmt::format("({:.4f}, {:.4f}, {:.4f})", x.x(), x.y(), x.z());
}

class Driver {
public:
  Driver(const GrowContext& context, const GrowOptions& options) : context_(context), options_(options) {}

  GrowResult operator()() {
    GrowResult result;
    // A crack that has already come through has nowhere to go; its pieces need not be able to stand.
    while (result.state == GrowState::growing && static_cast<int>(result.passes.size()) < options_.passes) {
      pass_ = {};
      pass_.pass = static_cast<int>(result.passes.size()) + 1;
      one_pass(result.passes.empty());
      tell_end();
      result.state = pass_.state;
      result.passes.push_back(pass_);
      if (options_.callback)
        options_.callback(result.passes.back());
    }
    return result;
  }

private:
  void one_pass(bool first) {
    if (first && !balance())
      return;
    cut_near_tip();
    if (!pass_.cuts.empty() && !balance())
      return;
    const auto loads = candidates();
    pass_.first_ratio = pass_.last_ratio = worst_ratio(loads);
    for (auto worst = worst_faces(loads, options_.break_ratio); !worst.empty();) {
      if (pass_.rounds == options_.max_rounds) {
        pass_.state = GrowState::stuck;
        break;
      }
      ++pass_.rounds;
      for (const FaceLoad& load : worst)
        take(break_face(context_.model, context_.state, context_.log, context_.stage, load));
      if (is_parted()) {
        pass_.state = GrowState::through;
        break;
      }
      if (!balance())
        break;
      const auto left = candidates();
      pass_.last_ratio = worst_ratio(left);
      worst = worst_faces(left, options_.break_ratio);
    }
    const CrackPath path = present_path();
    pass_.tip = path.tip;
    pass_.path = path.line;
    if (pass_.state != GrowState::growing)
      return;
    if (!path.line.empty() && !path.has_front)
      pass_.state = GrowState::through;
    else if (pass_.faces.empty() && pass_.cuts.empty())
      pass_.state = GrowState::arrested;
  }

  bool balance() {
    RelaxOptions relax;
    relax.residual = options_.residual;
    relax.max_steps = options_.max_steps;
    relax.breaking = false;
    const RelaxResult result = context_.relax(relax, fmt::format("grow, pass {}", pass_.pass));
    pass_.steps += result.steps;
    if (!result.converged) {
      pass_.state = GrowState::stuck;
      context_.observer.message(
          fmt::format("  grow: no balance after {} steps (residual {:.2g}, goal {:.2g})", result.steps,
                      result.residual, options_.residual));
    }
    return result.converged;
  }

  void cut_near_tip() {
    const CrackPath path = present_path();
    RefineOptions refine = options_.refine;
    if (!path.line.empty()) {
      const double radius = options_.tip_radius.value_or(size_at(path.tip));
      if (options_.judged_by == JudgedBy::tip) {
        refine.judged_by = Ball{path.tip, radius};
        // A mean around the tip is no measure of strength: a tip in tension is always given planes, and the
        // load of their faces decides whether they break.
        refine.tension_threshold = std::numeric_limits<double>::max();
      }
      refine.near = Ball{path.tip, options_.anchor_at_tip ? 0 : radius};
      if (options_.anchor_at_tip) {
        refine.anchor = path.tip;
        refine.ahead = path.ahead;
      }
    }
    // Cuts that line up carry the crack on by themselves; others need the faces between cut blocks to link
    // them.
    refine.may_break =
        options_.may_break.value_or(options_.anchor_at_tip ? MayBreak::cut_faces : MayBreak::near_cuts);
    Refined refined = cdem::refine(context_.model, context_.state, refine);
    pass_.cuts = std::move(refined.cuts);
    context_.adopt(std::move(refined.rebuilt));
    context_.observer.message(fmt::format("  grow, pass {}: {} cut{}", pass_.pass, blocks(pass_.cuts.size()),
                                          path.line.empty() ? "" : " near the tip at " + place(path.tip)));
  }

  void take(CrackFace face) {
    face.pass = pass_.pass;
    face.round = pass_.rounds;
    context_.observer.message(fmt::format(
        "  grow, pass {}, round {}: a face at {} broke in {}, {:.2f} x its strength", face.pass, face.round,
        place(face.centroid), face.mode == BondMode::broken_shear ? "shear" : "tension", face.ratio));
    pass_.faces.push_back(face);
  }

  void tell_end() {
    context_.observer.message(fmt::format(
        "  grow, pass {} {}: {} cut, {} {} broken in {} {}, {} {}{}", pass_.pass, name(pass_.state),
        blocks(pass_.cuts.size()), pass_.faces.size(), pass_.faces.size() == 1 ? "face" : "faces",
        pass_.rounds, pass_.rounds == 1 ? "round" : "rounds", pass_.steps,
        pass_.steps == 1 ? "step" : "steps", pass_.path.empty() ? "" : ", tip at " + place(pass_.tip)));
  }

  // Faces that may break now.
  std::vector<FaceLoad> candidates() const {
    std::vector<FaceLoad> loads = face_loads(context_.model, context_.state);
    if (options_.where == BreakWhere::anywhere)
      return loads;
    const CrackPath path = present_path();
    if (path.line.empty())
      return loads;
    const auto& front = path.front_interfaces;
    const auto off_front = [&](const FaceLoad& load) {
      return !std::binary_search(front.begin(), front.end(), load.interface);
    };
    loads.erase(std::remove_if(loads.begin(), loads.end(), off_front), loads.end());
    return loads;
  }

  static std::string blocks(std::size_t count) {
    return fmt::format("{} block{}", count, count == 1 ? "" : "s");
  }

  CrackPath present_path() const {
    std::optional<geom::Vec3> first;
    if (!context_.log.breaks.empty())
      first = context_.log.breaks.front().place;
    return crack_path(context_.model, context_.state, first);
  }

  // First size of the block whose centroid is nearest: parts keep that of the block they were cut from.
  double size_at(const geom::Vec3& place) const {
    const Block* nearest = &context_.model.blocks.front();
    for (const Block& block : context_.model.blocks)
      if ((block.mass.centroid - place).squaredNorm() < (nearest->mass.centroid - place).squaredNorm())
        nearest = &block;
    return nearest->first_size;
  }

  bool is_parted() const {
    const std::vector<double> pieces = piece_volumes(context_.model, context_.state);
    double whole = 0;
    for (const double volume : pieces)
      whole += volume;
    return pieces.size() > 1 && pieces[1] >= parted * whole;
  }

  const GrowContext& context_;
  const GrowOptions& options_;
  GrowPass pass_;
};

} // namespace

const char* name(GrowState state) {
  switch (state) {
  case GrowState::growing:
    return "growing";
  case GrowState::arrested:
    return "arrested";
  case GrowState::through:
    return "through";
  case GrowState::stuck:
    return "stuck";
  }
  return "";
}

GrowResult grow(const GrowContext& context, const GrowOptions& options) {
  check(options);
  refuse_softening(context.model);
  refuse_softening_sets(context.model);
  return Driver(context, options)();
}

} // namespace cdem
