// Begins and ends cracks in cohesive bodies. Freed faces that reach their strength crack on the plane that fails
// (fracture/critical_plane.hpp, bond/cohesive_faces.hpp). A face bears the mean stress of both tets; a joint, which has a plane of its
// own, bears on it the traction of its penalty too (with_traction). Cracked faces that unload with little damage become whole
// again. This is done in every step, before its forces, from the stress of the step before (the mean of both tets) and
// the relative displacements of that step. With the present ones, stress and displacement would belong to two moments,
// and the change of energy would be wrong.
//
// A step may take the stress beyond the strength. The crack begins at the strength all the same: what is beyond it is taken
// from both tets too, as if the plane had opened and slipped by so much (`relief`). This takes energy, which is counted
// as taken by breaking. So the body bears its strength at any rate and with any step. Stress that was beyond the strength
// before the step, of faces that had no plane to crack on, is left to the tets.
//
// A face between joined blocks without zones (star_blocks.hpp) is judged by the traction that it carries: that of its tets'
// stress and of its springs, as a linear one over the facet that has the same force and moment.
//
// A brittle face is broken when it begins to crack, carries its strength for one step more, and then lets go.
#pragma once

#include "libcdem/fracture/strength_watch.hpp"
#include "libcdem/parallel/chunks.hpp"

namespace cdem {

struct BegunCracks {
  struct Break {
    std::int64_t chunk = 0;
    FaceSpringPlace place;
    BondMode mode = BondMode::intact;
    geom::Vec3 normal = geom::Vec3::Zero();         // of the plane, unit
    double normal_traction = 0, shear_traction = 0; // Pa, on the plane
  };
  struct Relief {
    int tet = 0;
    Stress change{}; // Pa
  };
  std::vector<Break> broken; // of brittle faces
  // J, by chunk, ascending: of what the faces stored, and of what relief took from tets.
  std::vector<std::pair<std::int64_t, double>> breaking, relieved;
  // J, by chunk, ascending: what of `breaking` brittle faces took.
  std::vector<std::pair<std::int64_t, CrackEnergy>> energies;
  std::vector<Relief> reliefs; // for relieve()

  bool empty() const { return broken.empty() && breaking.empty() && relieved.empty() && energies.empty(); }
};

struct CrackingStep {
  double moved_for = 0; // s, since the stress was computed, at the velocity of the nodes
  double length = 0;    // s, of a step, in which the stress has risen at the present rate of strain
  // Strengths follow the rate of strain where a joint says so; in a relaxation there is none.
  bool in_real_time = true;
  int threads = 1;
};

// chunks: of MeshData::chunks, those looked at.
BegunCracks begin_cracks(const Model&, State&, const StrengthWatch&, const NearStrength&, Range chunks,
                         const CrackingStep&);

// Takes from the tets what is beyond the strength, from each the largest of its reliefs. `begun.reliefs` is that of all
// ranks; energies are those of the tets in `chunks`.
void relieve(const Model&, State&, BegunCracks& begun, Range chunks, const CrackingStep&);

void append(const BegunCracks& more, BegunCracks& all); // of later chunks

} // namespace cdem
