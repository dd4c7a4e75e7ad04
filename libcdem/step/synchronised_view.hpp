// A stage between two steps, for code that only reads it. While this object lives, contacts and the stress of meshes
// belong to the present positions of the nodes. Then stress and bonds are restored. If they were advanced twice, in
// this step and in the next, bonds would break with other energies, and slip would differ in the last digit.
#pragma once

#include "libcdem/step/stage.hpp"

namespace cdem {

class SynchronisedView {
public:
  // With several ranks the State is whole, or each has its share: who reads more makes it whole (make_whole).
  enum class Of { whole, shares };
  SynchronisedView(Stage&, Of);
  ~SynchronisedView();
  // After code of others has read the state: with several ranks it must have asked for the same on all (ranks/looks.hpp).
  void require_same_looks() const;
  SynchronisedView(const SynchronisedView&) = delete;
  SynchronisedView& operator=(const SynchronisedView&) = delete;

private:
  Stage& stage_;
  double strain_step_ = 0; // s; 0: nothing to put back
  bool contact_due_ = false, pieces_due_ = false, faces_changed_ = false;
  std::vector<StressBatch> stress_, viscous_stress_;
  std::vector<PlasticStrainBatch> plastic_strain_;
  std::vector<FaceStateBatch> faces_;
  std::vector<Contact> contacts_;
  std::vector<TetContact> tet_contacts_; // they may take over the force of faces
  std::vector<FaceSlip> face_slip_;
  std::vector<CohesiveFace> cohesive_;
  std::vector<CrackEnergy> crack_energy_;
  EnergyLedger spent_;
};

} // namespace cdem
