// A notch in a cohesive body, made by hand along faces of its mesh: their nodes are freed, and the faces are cracks that
// carry nothing but contact. Under pressure they carry that pressure, and the shear that friction holds, from the beginning.
#pragma once

#include "libcdem/state/state.hpp"

#include <functional>

namespace cdem {

// Breaks each face that may break and all of whose three points are selected: at(place, block), undeformed, m. Returns how many
// points. The stress of the state must belong to the present positions of the nodes.
std::int64_t notch(Model&, State&, const std::function<bool(const geom::Vec3& place, int block)>& at);

} // namespace cdem
