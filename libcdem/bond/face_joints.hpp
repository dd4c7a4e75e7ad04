// The joint that each face of a chunk has: that of its body, or its own (model/build/face_strength.hpp), raised by the
// rate of strain at which it began to crack (joint/rate_effect.hpp).
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

class FaceJoints {
public:
  explicit FaceJoints(const Joint& all) : joint_(&all) {} // every face has this one
  FaceJoints(const Model& model, const State& state, const MeshChunk& chunk) {
    const Body& body = model.bodies[model.blocks[chunk.block].body];
    joint_ = &body.joint;
    body_ = &body;
    if (!model.mesh.strength.empty())
      strength_ = model.mesh.strength.data() + chunk.face_batches.begin;
    if (!state.rate_factor.empty())
      rate_ = state.rate_factor.data() + chunk.face_batches.begin * lanes;
  }

  bool alike() const { return !strength_ && !rate_; } // all faces have the same
  // face: from the chunk's first on. The answer may stand in `room`.
  const Joint& of(std::int64_t face, Joint& room) const {
    if (alike())
      return *joint_;
    room = before_rate(face);
    if (rate_)
      raise(room, rate_[face]);
    return room;
  }
  Joint before_rate(std::int64_t face) const {
    if (!strength_)
      return *joint_;
    const FaceStrengthBatch& own = strength_[face / lanes];
    Joint joint = body_->joint_of(own.joint[face % lanes]);
    joint.tensile_strength = own.tensile_strength[face % lanes];
    joint.cohesion = own.cohesion[face % lanes];
    return joint;
  }
  // Into the body's region_laws; -1: the body's joint.
  int law(std::int64_t face) const { return strength_ ? strength_[face / lanes].joint[face % lanes] : -1; }
  bool own() const { return strength_ != nullptr; }
  double tensile_strength(std::int64_t face) const {
    return strength_ ? strength_[face / lanes].tensile_strength[face % lanes] : joint_->tensile_strength;
  }
  double cohesion(std::int64_t face) const {
    return strength_ ? strength_[face / lanes].cohesion[face % lanes] : joint_->cohesion;
  }

  double tan_friction(std::int64_t face, double otherwise) const {
    return strength_ ? strength_[face / lanes].tan_friction[face % lanes] : otherwise;
  }

  static void raise(Joint& joint, double factor) {
    joint.tensile_strength *= factor;
    joint.cohesion *= factor;
    if (joint.rate.fracture_energy) {
      joint.fracture_energy_1 *= factor;
      joint.fracture_energy_2 *= factor;
    }
  }

private:
  const Joint* joint_ = nullptr;
  const Body* body_ = nullptr;
  const FaceStrengthBatch* strength_ = nullptr; // of the chunk's first batch
  const double* rate_ = nullptr;                // of its first face
};

} // namespace cdem
