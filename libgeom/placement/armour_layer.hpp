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
// Between walls the layer is laid again with other attitudes if units slid off, still have too few supports or do not
// come to rest, up to four attempts in all (three from 61 units on, two from 81, one from 121). The attempt with the
// fewest such units is taken, unless its density is off by more than 1 % and by more than that of those before.
//
// Further layers lie on the first. Each has the same rows, shifted by half a place along the contour, so that its units
// come down above the gaps between the units below. Those do not move meanwhile. Its lowest row is held at the toe too:
// it comes down there, but does not slide below its place.
#pragma once

#include "libgeom/placement/ground.hpp"
#include "libgeom/placement/pile.hpp"
#include "libgeom/placement/pile_measures.hpp"

#include <functional>

namespace geom {

inline constexpr int max_layers = 20;

struct LayerProgress {
  int layer = 1, layers = 1;     // on top of each other: this one, and how many there are
  int attempt = 1, attempts = 1; // with other attitudes: this one, and how many there are at most
  int spacing = 1, spacings = 1; // of the attempt's: the same
  int laid = 0;                  // units, with this spacing, and those of the layers below
  const char* doing = "";        // "laid", and with all of them "come to rest together", "repositioned"
  int unsupported = 0;           // units that lack a support, of those that are repositioned
};

struct LayerOptions {
  int layers = 1;                // on top of each other; they share the units
  double density = 0.645;        // phi of each layer
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

// Numbers of units begin at 0; those of the lowest layer come first, and in a layer those of the lowest row.
struct Layer {
  Pile pile;
  bool at_rest = false;      // all together, clear of each other; false where they were but lowered
  std::vector<int> leaning;  // units on which fewer than three things press, of those at rest
  std::vector<int> put_back; // units that would have gone further than half a height: they stay as laid
  std::optional<PileMeasures> measures; // of the middle of the pile; none where it is too small to have one
  std::optional<double> density;        // phi of a layer there, the mean of all layers
  int trials = 0;                       // of spacings, in all
  int attempts = 1;                     // with other attitudes, of the layer that took the most
};

// Throws InputError for a count below the number of layers, a density or gap out of range, a unit of loose parts, a
// ground that is too small.
Layer place_layer(const TetMesh& unit, int count, const Ground&, const LayerOptions& = {});

} // namespace geom
