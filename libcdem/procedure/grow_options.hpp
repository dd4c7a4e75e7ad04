// What grow (a crack that advances in stages) takes and gives back.
#pragma once

#include "libcdem/fracture/crack_faces.hpp"
#include "libcdem/fracture/options.hpp"

#include <functional>

namespace cdem {

struct GrowPass;

// Which faces may break in a pass: those that meet the crack's front (any, while there is no crack), or any.
enum class BreakWhere { front, anywhere };

// By what stress a block at the tip is judged and its planes are turned: that of all elements around
// the tip, weighted (fracture/tip_field.hpp; the tension threshold has no meaning then), or its own mean (Han 2010).
enum class JudgedBy { tip, block };

struct GrowOptions {
  int passes = 3;           // at most this many (the paper's three), >= 1
  double break_ratio = 0.9; // break the faces that carry this part of the worst ratio, in (0, 1]
  BreakWhere where = BreakWhere::front;
  JudgedBy judged_by = JudgedBy::tip;
  bool anchor_at_tip = true; // one cut plane of the blocks at the tip passes through it
  // m, default 1 block size: reach of the stress around the tip (JudgedBy::tip), and, when the planes are not
  // anchored, distance from the tip within which blocks are cut. Anchored planes are cut into the blocks that
  // touch the tip and nowhere else.
  std::optional<double> tip_radius;
  // Default: only cut planes when they are anchored, else also the original faces between two cut blocks.
  std::optional<MayBreak> may_break;
  // How blocks near the tip are judged and cut. region (if any) holds in addition; near, judged_by, anchor
  // and may_break are set by the driver.
  RefineOptions refine;
  double residual = 1e-5;                        // of every relaxation, in (0, 1)
  std::int64_t max_steps = 500000;               // of every relaxation, > 0
  int max_rounds = 200;                          // of breaking, per pass, >= 1
  std::function<void(const GrowPass&)> callback; // after every pass, with the model in balance
};

enum class GrowState {
  growing,  // the last pass broke faces or cut blocks
  arrested, // no face reaches its strength and no block at the tip is to be cut
  through,  // the crack parts the body, or has no front left
  stuck     // a relaxation did not reach its residual, or the rounds of a pass were used up
};

struct GrowPass {
  int pass = 0; // from 1
  std::vector<BlockCut> cuts;
  std::vector<CrackFace> faces; // broken in this pass, in order
  int rounds = 0;         // times the worst faces were broken and the model was brought into balance again
  double first_ratio = 0; // load over strength of the worst face that may break, after the cuts
  double last_ratio = 0;  // of the worst one that is left at the end
  geom::Vec3 tip = geom::Vec3::Zero(); // m
  std::vector<geom::Vec3> path;        // m, from the crack's mouth to its end; empty while there is no crack
  std::int64_t steps = 0;              // relaxation steps of this pass
  GrowState state = GrowState::growing;
};

struct GrowResult {
  std::vector<GrowPass> passes;
  GrowState state = GrowState::growing;
};

const char* name(GrowState); // "growing", "arrested", "through", "stuck"

} // namespace cdem
