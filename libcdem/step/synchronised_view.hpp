// A stage between two steps as somebody sees it who only looks: contacts and the stress of meshes stand where the nodes
// are while this lives; then bonds are as they were. Brought up twice, in this step and in the next, they would break
// with other energies, and slide to other places in the last digit.
#pragma once

#include "libcdem/step/stage.hpp"

namespace cdem {

class SynchronisedView {
public:
  explicit SynchronisedView(Stage&);
  ~SynchronisedView();
  SynchronisedView(const SynchronisedView&) = delete;
  SynchronisedView& operator=(const SynchronisedView&) = delete;

private:
  Stage& stage_;
  double strain_step_ = 0; // s; 0: nothing to put back
  bool contact_due_ = false, pieces_due_ = false;
  std::vector<StressBatch> stress_, viscous_stress_;
  std::vector<PlasticStrainBatch> plastic_strain_;
  std::vector<FaceStateBatch> faces_;
  std::vector<FaceSlip> face_slip_;
  std::vector<CohesiveFace> cohesive_;
  std::vector<CrackEnergy> crack_energy_;
  EnergyLedger spent_;
};

} // namespace cdem
