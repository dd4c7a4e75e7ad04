// Snapshots made by hand for the tests of files and pictures: convex polygons extruded along z, star-meshed,
// with a displacement, a stress and a few broken interfaces.
#pragma once

#include "libcdem/results/snapshot.hpp"

namespace cdem::sample {

using Polygon = std::vector<std::array<double, 2>>; // convex, counter-clockwise

// Rectangles of a grid over width x height, m.
std::vector<Polygon> grid(double width, double height, int columns, int rows);

// The two parts of each polygon on either side of the line through `point` at `degrees` from the y axis.
std::vector<Polygon> cut(const std::vector<Polygon>&, std::array<double, 2> point, double degrees);

// Extruded to z in [0, thickness]: points, tets, surface, block_edges, and the cell field block_id (from 1).
Snapshot blocks(const std::vector<Polygon>&, double thickness);

// Adds the point field "displacement": side wedges of the box pushed out by `push`, m, top and bottom towards
// the middle; and the cell field "stress", Pa.
void add_wedge_fields(Snapshot&, double push);

// Adds an interface, a rectangle from (a.x, a.y) to (b.x, b.y) over the thickness, in `pieces` pieces.
void add_interface(Snapshot&, std::array<double, 2> a, std::array<double, 2> b, double thickness, BondMode,
                   int pieces);

// 10 x 10 plate of 0.3 m with the middle blocks cut at 30 degrees and broken interfaces of both modes.
Snapshot plate();

} // namespace cdem::sample
