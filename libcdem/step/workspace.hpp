// What a solving call needs beside Model and State and throws away afterwards: forces, resolved conditions, partial
// sums. Allocated once per stage; the step itself allocates nothing.
#pragma once

#include "libcdem/bond/bond_work.hpp"
#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/fracture/strength_watch.hpp"
#include "libcdem/integrate/move_nodes.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/ranks/shared_state.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct Workspace {
  // contacts: of the places where the nodes are; null: nobody knows them, and they are to be searched for.
  Workspace(const Model&, const State&, const Conditions&, const ContactLoads* contacts = nullptr);
  Workspace(const Model&, const State&, const Conditions&, BondWork, ContactWork);

  ResolvedConditions resolved;
  BondWork bond;
  // For meshed bodies; empty without them.
  std::vector<geom::Vec3>
      partial; // N, at the places of mesh chunks that others touch too; written by mesh_forces
  std::vector<FaceSums> face_sums;      // per mesh chunk
  double strain_step = 0;               // s, by which their stress stands behind the nodes
  bool damped = false;                  // stiffness damping acts
  const StrengthWatch* watch = nullptr; // of cohesive bodies, where they may break; null: none
  NearStrength near;                    // written by mesh_forces
  bool has_shared_nodes = false;        // some node is touched by several chunks
  bool hand_over_due =
      true; // broken faces that are gone go to contact in this step; a stage does so at times
  ContactWork contact;
  std::vector<NodeSums> node_sums;  // per chunk of blocks
  std::vector<NodeSums> rigid_sums; // per rigid body; of those that this rank moves
  std::vector<geom::Vec3>
      rigid_angle; // rad, per rigid body, by which it turns in the step; written by move_rigid

  // The part of the model that this rank computes and tells the others.
  std::shared_ptr<SharedState> shared;
  void share(std::shared_ptr<SharedState> part) {
    shared = std::move(part);
    contact.shared = shared.get();
  }
  const Partition& part() const { return shared->part(); }

  ActingForces acting() const {
    return {resolved, contact.loads.force, contact.loads.on_rigid, bond.force(), bond.idle.block};
  }
};

} // namespace cdem
