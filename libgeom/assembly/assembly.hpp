// Many blocks and the faces they share.
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

namespace geom {

struct Assembly {
  std::vector<Polyhedron> blocks;
};

Box bounding_box(const Assembly&);

std::vector<std::string>
cut_names(const Assembly&); // of joint sets and cuts that made faces; sorted, each once

struct SharedFace {
  int block_a, face_a; // block_a < block_b
  int block_b, face_b;
};

// All pairs of faces of different blocks that lie in one plane, look at each other and overlap in an area
// larger than tolerance^2; one face may be shared with many. tolerance (m); sorted by (block_a, face_a,
// block_b, face_b).
std::vector<SharedFace> shared_faces(const std::vector<Polyhedron>& blocks, double tolerance);

// The same, only pairs with at least one block marked in `changed` (used after cuts).
std::vector<SharedFace> shared_faces(const std::vector<Polyhedron>& blocks, const std::vector<char>& changed,
                                     double tolerance);

} // namespace geom
