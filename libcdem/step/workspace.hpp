// What a solving call needs beside Model and State and throws away afterwards: forces, resolved conditions, partial
// sums. Allocated once per stage; the step itself allocates nothing.
#pragma once

#include "libcdem/contact/contact_work.hpp"
#include "libcdem/joint/softening.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct BreakEvent {
  int point = 0;
  BondMode mode = BondMode::intact;
  double normal_traction = 0, shear_traction = 0; // Pa, at breaking
};

// Sums of one chunk of springs.
struct SpringSums {
  double friction = 0;            // J, this step
  double breaking = 0;            // J, this step
  std::vector<BreakEvent> broken; // this step
};

// Sums of one chunk of blocks, over its free degrees of freedom.
struct NodeSums {
  double residual2 = 0; // N2, out-of-balance forces
  double applied2 = 0;  // N2, external forces
  double reaction2 = 0; // N2, out-of-balance forces where nodes are held
  double stiffness = 0; // J, -du . dF
  double inertia = 0;   // J, du . M du
  double kinetic = 0;   // J
  double external = 0;  // J, this step
  double damping = 0;   // J, this step
};

struct Workspace {
  Workspace(const Model&, const State&, const Conditions&);

  ResolvedConditions resolved;
  std::vector<Node> force; // N, at the nodes of star blocks, without loads; written by block_forces
  std::vector<geom::Vec3> spring_force; // N, on side a (n_points); written by spring_forces
  // N, the same where interfaces have turned to (n_points); empty where none can turn.
  std::vector<geom::Vec3> turned_force;
  const std::vector<geom::Vec3>& bond_force() const {
    return turned_force.empty() ? spring_force : turned_force;
  }
  std::vector<SpringStrength> strength; // per interface
  // Both empty in a model without softening joints.
  std::vector<SofteningLaw> softening; // per interface
  // m, of each spring in the step before (n_points); written by spring_forces
  std::vector<geom::Vec3> stretch;
  std::vector<SpringSums> spring_sums; // per chunk of springs
  // Of meshed bodies; empty without them.
  std::vector<geom::Vec3>
      partial; // N, at the places of mesh chunks that others touch too; written by mesh_forces
  std::vector<FaceSums> face_sums; // per mesh chunk
  double strain_step = 0;          // s, by which their stress stands behind the nodes
  bool damped = false;             // stiffness damping acts
  std::vector<Node> contact_force; // N, of contacts (n_nodes); empty without; written by contact_forces
  ContactWork contact;
  std::vector<NodeSums> node_sums;  // per chunk of blocks
  std::vector<NodeSums> rigid_sums; // per rigid body
};

} // namespace cdem
