// What grow (a crack that advances in stages) takes and gives back.
#pragma once

#include "libcdem/fracture/crack_faces.hpp"
#include "libcdem/fracture/options.hpp"

#include <functional>

namespace cdem {

struct GrowPass;

struct GrowOptions {
  int passes = 3;           // at most this many (the paper's three), >= 1
  double break_ratio = 0.9; // break the faces that carry this part of the worst ratio, in (0, 1]
  std::optional<double>
      tip_radius; // m: blocks with their centroid this near to the tip are cut; default 1 block size
  bool anchor_at_tip = true;       // one cut plane of the blocks at the tip passes through it
  double residual = 1e-5;          // of every relaxation, in (0, 1)
  std::int64_t max_steps = 500000; // of every relaxation, > 0
  int max_rounds = 200;            // of breaking, per pass, >= 1
  // How blocks near the tip are judged and cut. region (if any) holds in addition to tip_radius; anchor is
  // set by the driver.
  RefineOptions refine;
  std::function<void(const GrowPass&)> callback; // after every pass, with the model in balance
};

enum class GrowState {
  growing,  // the last pass broke faces or cut blocks
  arrested, // no face reaches its strength and no block near the tip is to be cut
  through,  // the crack parts the body, or has no front left
  stuck     // a relaxation did not reach its residual, or the rounds of a pass were used up
};

struct GrowPass {
  int pass = 0; // from 1
  std::vector<BlockCut> cuts;
  std::vector<CrackFace> faces; // broken in this pass, in order
  int rounds = 0;               // times the worst faces were broken and the model was relaxed again
  double first_ratio = 0;       // traction over strength of the worst face after the cuts, before any broke
  double last_ratio = 0;        // of the worst face that is left
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
