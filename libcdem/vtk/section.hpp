// What a snapshot shows instead of the faces of its blocks: a cut through them, or the joints between them.
#pragma once

#include "libcdem/results/snapshot.hpp"

namespace cdem {

struct CutPlane {
  geom::Vec3 point = geom::Vec3::Zero();  // m, undeformed
  geom::Vec3 normal = geom::Vec3::Zero(); // not zero
};

// The tets where the plane crosses their undeformed places, as triangles that both sides see; fields of points are linear
// in between. Throws geom::InputError where it crosses none.
Snapshot section_of(const Snapshot&, const CutPlane&);

// The triangles of Snapshot::bonds, seen from both sides, with their fields in place of those of tets; and the outline.
Snapshot joints_of(const Snapshot&);

} // namespace cdem
