// The units of a body, its blocks in their order: their present positions, displacements and contacts.
#pragma once

#include "libcdem/results/unit.hpp"
#include "libcdem/state/state.hpp"
#include "libgeom/mesh/surface.hpp"

namespace cdem {

// Each throws geom::InputError for a body that there is not.
std::vector<Unit> units_of(const Model&, const State&, const std::string& body);
// Where they are; of a broken unit, each piece is closed.
std::vector<geom::Surface> surfaces_of(const Model&, const State&, const std::string& body);
// How many other blocks of meshed bodies press on each unit.
std::vector<int> touching(const Model&, const State&, const std::string& body);

geom::Vec3 centroid_displacement(const Model&, const State&, int block); // m
geom::Vec3 shown_centroid_displacement(const Model&, const State&,
                                       int block);                   // m, since it was last set to zero
geom::Vec3 mean_displacement(const Model&, const State&, int block); // m, of all its nodes, weighted by mass

} // namespace cdem
