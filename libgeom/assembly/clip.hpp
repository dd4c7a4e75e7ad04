// Clipping an assembly by a surface of triangles: each block is cut along the facets that it meets, by planes, into convex
// pieces that lie wholly on one side.
//
//   pieces(cell, facets):   no facet in the cell's inside: the cell is a piece; its side is that of its centroid
//                           all facets within `tolerance` of one plane: cut by that plane, two pieces
//                           else cut by the plane of the largest facet, and go on with both parts
//   two parts that are wholly on one side are merged again
//
// A point is inside if an upward ray from it crosses the surface an odd number of times (the edge of two triangles
// counts once: Simulation of Simplicity, Edelsbrunner and Muecke 1990). One rule serves both cases: the inside of a
// closed surface, and the ground below a terrain.
#pragma once

#include "libgeom/assembly/assembly.hpp"
#include "libgeom/mesh/surface.hpp"

namespace geom {

enum class ClipSide { inside, outside, both }; // a terrain: inside is below

struct ClipOptions {
  ClipSide keep = ClipSide::inside;
  // m, >= 0: the surface that is cut may deviate from the given one by as much, and no piece is made thinner. 0: exact.
  double tolerance = 0;
  std::string name = {}; // of the faces that are cut
  bool glued = true;     // they are no joints
};

struct Clipped {
  Assembly assembly;
  std::int64_t cut_blocks = 0; // that the surface crosses
  std::int64_t thin = 0; // pieces whose 6 V / A (the side of a cube) is below a twentieth of their block's
  double thinnest = 0;   // m, 6 V / A of the thinnest of these
  Vec3 thinnest_place = Vec3::Zero();
};

// Pieces stand in the place of their block. Faces that a cut makes are glued as long as within the rock they are
// no joints. Throws
// InputError when an open surface ends over a block, when nothing is left, and when a block falls into more than 20000
// pieces.
Clipped clip(const Assembly&, const Surface&, const ClipOptions&);

} // namespace geom
