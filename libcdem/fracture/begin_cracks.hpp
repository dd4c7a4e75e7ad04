// Begins and ends cracks in cohesive bodies. Freed faces that reach their strength crack on the plane that fails
// (fracture/working_plane.hpp, bond/cohesive_faces.hpp). Cracked faces that unload with little damage become whole
// again. This is done once a step, before its forces, from the stress of the step before (the mean of both tets) and
// the relative displacements of that step. With the present ones, stress and displacement would belong to two moments,
// and the change of energy would be wrong.
#pragma once

#include "libcdem/parallel/chunks.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct BegunCracks {
  struct Break {
    std::int64_t chunk = 0;
    FaceSpringPlace place;
    BondMode mode = BondMode::intact;
    geom::Vec3 normal = geom::Vec3::Zero();         // of the plane, unit
    double normal_traction = 0, shear_traction = 0; // Pa, on the plane
  };
  std::vector<Break> broken; // of brittle faces, which break at once
  // J, by chunk, ascending: of what the faces stored.
  std::vector<std::pair<std::int64_t, double>> breaking;
  // J, by chunk, ascending: what of `breaking` brittle faces took.
  std::vector<std::pair<std::int64_t, CrackEnergy>> energies;
};

// moved_for: s, since the stress was computed, at the velocity of the nodes. in_real_time: strengths follow the rate of strain where a joint says so; in a relaxation there is none.
// chunks: of MeshData::chunks, those looked at.
BegunCracks begin_cracks(const Model&, State&, Range chunks, double moved_for, int threads,
                         bool in_real_time);

void append(const BegunCracks& more, BegunCracks& all); // of later chunks

} // namespace cdem
