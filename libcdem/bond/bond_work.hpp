// Data of the springs of interfaces that live for one stage, beside Model and State: their forces and the numbers of
// their laws.
#pragma once

#include "libcdem/bond/idle_springs.hpp"
#include "libcdem/bond/spring_batches.hpp"
#include "libcdem/joint/softening.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct BreakEvent {
  int point = 0;
  BondMode mode = BondMode::intact;
  double normal_traction = 0, shear_traction = 0; // Pa, at breaking
};

// Energy that breaking or damage has taken from a spring of an interface.
struct CrackLoss {
  int interface = 0;
  CrackEnergy energy;
};

// Sums of one chunk of springs.
struct SpringSums {
  double friction = 0;            // J, this step
  double breaking = 0;            // J, this step
  double damping = 0;             // J, this step
  std::vector<BreakEvent> broken; // this step
  std::vector<CrackLoss> losses;  // this step: the parts of `breaking`
};

// The law of an interface that has one (joint/joint_law.hpp), in its spring.
struct InterfaceLaw {
  const JointLaw* law = nullptr; // of Model::joints; null: none
  JointSpring spring;
};

InterfaceLaw law_of_interface(const Model&, const Interface&);

struct BondWork {
  BondWork(const Model&, const State&);

  // N, on side a: what the springs themselves bear, without water (n_points); written by spring_forces
  std::vector<geom::Vec3> spring_force;
  // N, the same less what water pushes the faces apart with and with what dashpots bear, where interfaces have turned to
  // (n_points); empty where none can turn, no joint holds water and there are no dashpots.
  std::vector<geom::Vec3> acting_force;
  const std::vector<geom::Vec3>& force() const { return acting_force.empty() ? spring_force : acting_force; }
  std::vector<SpringStrength> strength; // per interface
  std::vector<double> damping; // s, Joint::stiffness_damping per interface; empty where no joint has any
  double contact_damping = 0;  // s, the least of contacts (bond/contact_damping.hpp)
  // 1/s, of the means that the friction of contacts follows, per interface; 0 where neither block deforms
  std::vector<double> rest_rate;
  double damping_step = 0; // s, of the step in time; 0: stiffness damping does not act
  // N, of damping in the step before, in undeformed directions (n_points; empty: no dashpots, as no interface turns and
  // no spring has become a contact)
  std::vector<geom::Vec3> viscous;
  void add_dashpots();
  // Both empty in a model without softening joints.
  std::vector<SofteningLaw> softening; // per interface
  std::vector<InterfaceLaw> laws;      // per interface; empty in a model without laws
  // m, of each spring in the step before (n_points; empty without softening joints and laws); written by spring_forces
  std::vector<geom::Vec3> stretch;
  std::vector<SpringSums> sums; // per chunk of springs
  SpringBatches batches;        // of the same springs, with their strengths
  IdleSprings idle;             // written by find_idle_springs
  // Springs whose side b is in the chunk, of each Model::chunks: no earlier chunk reads them in a step, which goes through
  // them from the last to the first.
  std::vector<Range> new_springs;
};

} // namespace cdem
