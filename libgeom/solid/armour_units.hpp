// Concrete armour units of breakwaters, and the slope they lie on. Every unit is made to a height; its volume
// is exactly that of a unit of height 1 m times height cubed. All are centred on the origin and stand along
// z.
//
// Proportions are fractions of the height. Dolos and tetrapod: Shore Protection Manual (1984), chapter 7. No
// dimensioned drawing of the accropode is public: its topology is certain, the proportions are ours, set so
// that V = 0.34 H^3; call the shape accropode-like. Antifer cube: sides as commonly given, the grooves ours,
// set so that V = 1.0247 H^3.
#pragma once

#include "libgeom/solid/solid.hpp"

#include <functional>

namespace geom {

// Two octagonal end bars along z at y = +-(1 - bar)/2, a middle bar along x whose noses stand out on both
// sides, and the core box that ties them.
struct AccropodeShape {
  double width = 0.42;  // of the end bars and the core along x
  double bar = 0.33;    // of an end bar along y
  double core = 0.42;   // of the core and the middle bar along z
  double length = 1;    // of the middle bar along x
  double taper = 0.70;  // size of a bar's end over that at the core
  double corner = 0.20; // cut off a bar's edges, over the shorter side of its section; 0: square bars

  static AccropodeShape slender() { return {}; }
  static AccropodeShape stocky() { return {0.386, 0.30, 0.42, 0.80, 0.95, 0.20}; }
};
Solid accropode(double height, const AccropodeShape& = AccropodeShape::slender());

// Two octagonal flukes, one along z and one along y, at the ends of an octagonal shank along x; the fillets
// between them are left out.
struct DolosShape {
  double tip = 0.20;   // A: width of a fluke at its ends
  double waist = 0.32; // B: width of the shank
  double root = 0.364; // E: width of a fluke at its middle
};
Solid dolos(double height, const DolosShape& = {});

// Four conical legs, one of them up.
struct TetrapodShape {
  double tip = 0.302;  // A: diameter of a leg at its end
  double root = 0.470; // D: diameter of a leg where it meets the others
};
Solid tetrapod(double height, const TetrapodShape& = {});

Solid cube(double height);

// A cube with a truncated pyramid of square section on each side, V = 0.544 H^3, H from tip to tip. The topology is that of
// the Cubipod (Gomez-Martin and Medina 2008); no dimensioned drawing is public: the proportions are ours.
struct CubipodShape {
  double cube = 0.74; // side of the cube
  double root = 0.48; // width of a pyramid where it stands on the cube
  double tip = 0.36;  // width of its end
};
Solid cubipod(double height, const CubipodShape& = {});

// A cube whose sides lean in towards the top, with a round groove down the middle of each.
struct AntiferShape {
  double bottom = 1.086;  // width of the lower face
  double top = 1.005;     // width of the upper face
  double groove = 0.1047; // radius; 0: none
};
Solid antifer(double height, const AntiferShape& = {});

// A wedge that rises along +x from the y axis: z <= gradient x, 0 <= x <= length, |y| <= width / 2, z >= 0.
Solid slope(double gradient, double length, double width);

// Height at which build(height) has this volume, m3.
double height_of_volume(double volume, const std::function<Solid(double)>& build);

} // namespace geom
