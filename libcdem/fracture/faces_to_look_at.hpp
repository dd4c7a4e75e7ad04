// Which faces of a chunk of a cohesive body are looked at one by one in a step: those that crack and may end, and of those
// that hold the ones that may be at what is left of their strength. The part of its strength that a joint uses is no more
// than what the stress of its tets and what its springs use together.
#pragma once

#include "libcdem/fracture/loaded_facets.hpp"

namespace cdem {

std::vector<int> faces_to_look_at(const FacesOfChunk&, const LoadedFacets&, const NearStrength&); // ascending

} // namespace cdem
