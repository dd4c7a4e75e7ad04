// Tetrahedra for large motion, by finite volumes (Feng 2014 eqs 2-14). Over a step of length dt in which the corners
// came with velocity v to where they are now, with the geometry of the middle of the step and c_k the area vectors
//   c_1 = e_2 x e_3, ...,  6 V = e_1 . c_1,   grad v = sum_k (v_k - v_0) (x) c_k / 6V                     (eqs 2-6)
//   sigma <- Q (sigma + d/2) Q^T + d/2,  d = dt (lambda tr(D) I + 2 G D)                                (eqs 7-11)
//   Q = I + (W + W^2 / 2) / (1 + |w|^2 / 4),  w the axial vector of dt W (Hughes and Winget 1980)
// with D, W the symmetric and skew part of grad v. Half of the increment d turns with the body and half does not: in
// the mean it has turned by half of Q, from the middle of the step, where D stands, to its end. A step back from the
// end then leads to where it came from; with all of d unturned each turn of a body that rings adds to its energy.
// and with the geometry of its end the force on a corner over its three faces, normals outward
//   f_k = -sigma c_k / 6,  f_0 = -sum f_k                                                                 (eq 12)
// With stiffness damping the stress of the force, not the one that is kept, has beta (lambda tr(D) I + 2 G D) more; it
// does not add up from step to step and stays unturned.
// The paper prints no rotation of the stress and the geometry of the start: one slow turn then leaves 9 MPa of stress
// in concrete. c_k / 6V is the gradient of the shape function, the same as the sum over face areas with one division.
//
// In a tet beside freed faces of a cohesive body, the strain (but not the spin) has an additional part
// (element/face_jumps.hpp)
//   D += sum over these faces of sym(J) / 2V,  J = (mean relative velocity) (x) A n in the middle of the step
#pragma once

#include "libcdem/material/elastic.hpp"
#include "libcdem/material/plasticity.hpp"
#include "libcdem/model/mesh.hpp"
#include "libcdem/parallel/read_ahead.hpp"
#include "libcdem/state/stress_batch.hpp"

namespace cdem {

struct TetStiffness {
  double lambda = 0, two_g = 0; // Pa
};
TetStiffness tet_stiffness(const Elastic&);

// Stiffness damping of a run of batches.
struct TetDamping {
  double beta = 0;                // s
  StressBatch* viscous = nullptr; // Pa, of the last step; none: no damping
};

// Plasticity of a run of batches (material/plasticity.hpp): the stress that Hooke's law leads to is returned to the limit
// before the forces are made of it. Where no tet of a batch comes near its limit this costs a comparison.
struct PlasticTets {
  const PlasticLaws* laws = nullptr;    // null: elastic
  const std::int8_t* law = nullptr;     // into laws, batch * lanes + lane; -1: elastic
  PlasticStrainBatch* strain = nullptr; // advanced
  double* work = nullptr;               // J, plastic work of this step is added
};

// Symmetric part of dt J above, summed over the freed faces of eight tets, m3: xx yy zz xy yz xz.
struct alignas(64) JumpBatch {
  double component[6][lanes];
};

// Forces of a run of batches, the last with `last_lanes` tets. Advances `stress` by the last step of dt (s; with 0
// nothing changes) and adds to `force`. position (m), velocity, force: one entry for each place of the chunk. Returns
// the energy that damping took in that step, J: the mean of the viscous stress before and after it times the strain.
// Asks for some of what is to be read ahead with each batch. jumps: null where no face is freed.
double finite_volume_forces(const MeshBatch* batches, std::int64_t count, int last_lanes,
                            const Node* position, const Node* velocity, const JumpBatch* jumps, double dt,
                            const TetStiffness&, const TetDamping&, const PlasticTets&, StressBatch* stress,
                            Node* force, ReadAhead&);

} // namespace cdem
