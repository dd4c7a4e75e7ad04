// One layer of armour units in the staggered pattern of breakwaters: rows along the contour of a slope, each unit above
// the gap between two of the row below, laid row by row from the toe.
//
// phi = N Dn^2 / A is the packing density: N units on an area A of the slope, Dn the side of a cube of their volume.
// The pattern is a diamond, twice as wide along the contour as its rows are apart, so that rows are Dn / sqrt(2 phi)
// apart. Units come to rest under gravity with friction, slide down against the two units below, and keep `gap` from
// all others. Then all units but the lowest row, which is held, come to rest together. Units that lean on fewer than
// three bodies are repositioned (placement/laying.hpp). The distance of the rows then depends on how the units fit. So
// the pattern is widened along the contour until the density in the middle of the pile is phi within 1 % (of rows and
// columns, if the pile has no middle). At most six trials are made (two of a thousand units), and the nearest is taken.
// Between walls another layer with other attitudes is laid if units slid off, still have too few supports or do not
// come to rest, up to four layers in all (three from 61 units on, two from 81, one from 121). The layer with the fewest
// such units is taken, unless its density is off by more than 1 % and by more than that of the layers before.
#pragma once

#include "libgeom/placement/ground.hpp"
#include "libgeom/placement/pile.hpp"

#include <functional>

namespace geom {

struct LayerProgress {
  int layer = 1, layers = 1;     // with other attitudes: this one, and how many there are at most
  int spacing = 1, spacings = 1; // of the layer's: the same
  int laid = 0;                  // units, with this spacing
  const char* doing = "";        // "laid", and with all of them "come to rest together", "repositioned"
  int unsupported = 0;           // units that lack a support, of those that are repositioned
};

struct LayerOptions {
  double density = 0.645;        // phi
  std::optional<int> columns;    // units in a row; as many as the region allows
  std::optional<double> gap;     // m, clear distance; 2e-5 of the unit's height
  std::optional<PlanBox> region; // over the ground; all of it
  std::uint64_t seed = 1;        // of the attitudes
  int attitudes = 1500;          // tried for the family
  int nudges = 200; // steps of a unit on its way to rest; 0: only lowered on to what is there, each by itself
  double play = 0.1;       // of the height: how far along the contour from its place a unit may be laid
  double friction = 0.268; // coefficient, tan 15 degrees: with so much laid units are at rest
  bool walls = false;      // upright along the slope, where rows end
  std::function<void(const LayerProgress&)> tell; // called often; may throw to end it
};

// Numbers of units begin at 0.
struct Layer {
  Pile pile;
  bool at_rest = false;          // all together, clear of each other; false where they were but lowered
  std::vector<int> leaning;      // units on which fewer than three things press, of those at rest
  std::vector<int> put_back;     // units that would have gone further than half a height: they stay as laid
  std::optional<double> density; // phi in the middle of the pile; none where it is too small to have one
  int trials = 0;                // of spacings, in all
  int layers = 1;                // that were laid, each with other attitudes
};

// Throws InputError for a count below 1, a density or gap out of range, a unit of loose parts, a ground
// that is too small.
Layer place_layer(const TetMesh& unit, int count, const Ground&, const LayerOptions& = {});

} // namespace geom
