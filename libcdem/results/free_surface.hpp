// The free surface of a field of water at a time, for pictures and files. The field is asked on a grid; between a wet and a
// dry point the water line is found by bisection.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/results/snapshot.hpp"

namespace cdem {

// Over the rectangle of the box; places and times that the field does not know are dry. No points where all is dry; of size 0 where water is everywhere, without a surface.
WaterSheet free_surface(const WaterField&, double time, const geom::Box&, const WaterWish& = {});

// Gives the snapshot the sheets of the water that loads the model, each once, over the box of its surface: fields of flows,
// and the levels and tables of water in joints. Water without a free surface is left out.
void add_water(const Conditions&, const WaterWish&, Snapshot&);

} // namespace cdem
