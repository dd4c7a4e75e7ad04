// Whether a semi-spring that is behind the nearest triangle of a fragment stands in the fragment.
//
// Bonds hold the tets of a fragment together, and give: edges that two triangles of its surface share part, and where they
// have parted the normals of the triangles that are nearest tell of a surface that is not closed. So the way from the
// nearest place to the semi-spring is followed from tet to tet. It goes on through faces with whole bonds. Where it
// leaves through the surface, the semi-spring stands outside.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

void find_tets_beyond(const Model&, const ContactFragments&, TetsBeyond&);

// The tets of the block that have a node on its surface, as it is now, by their places in Block; others are deep.
std::vector<char> tets_at_surface(const Model&, const ContactFragments&, int block);

// x: m, behind the triangle, of which `place` is the place nearest to it.
bool stands_within(const Model&, const State&, const TetsBeyond&, int triangle, const geom::Vec3& place,
                   const geom::Vec3& x);

} // namespace cdem
