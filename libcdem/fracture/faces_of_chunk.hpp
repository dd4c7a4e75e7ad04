// The faces of one chunk of a cohesive body: where they stand, which stress their tets have, and how strong they are.
#pragma once

#include "libcdem/bond/freed_face.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/fracture/strength_watch.hpp"

namespace cdem {

inline void raise(RockStrength& rock, double factor) {
  rock.tensile_strength *= factor;
  rock.cohesion *= factor;
}

// Faces count from the chunk's first one on.
class FacesOfChunk {
public:
  FacesOfChunk(const Model& m, State& s, const StrengthWatch& w, std::int64_t chunk_index)
      : model(m), state(s), watch(w), index(chunk_index), chunk(m.mesh.chunks[chunk_index]),
        body(m.bodies[m.blocks[chunk.block].body]), joints(m, s, chunk), rocks_(body) {}

  std::int64_t batch(int face) const { return chunk.face_batches.begin + face / lanes; }
  std::int64_t number(int face) const { return chunk.face_batches.begin * lanes + face; }
  FaceStage stage(int face) const { return state.faces[batch(face)].stage[face % lanes]; }
  const FaceTets& tets(int face) const { return model.mesh.face_tets[number(face)]; }
  FaceNodes nodes(int face) const { return face_nodes(model.mesh, chunk, batch(face), face % lanes); }
  // joint: of the face; without meaning for one that holds.
  FreedFace freed(int face, const Joint& joint) const {
    return {model.mesh.faces[batch(face)], face % lanes, joint, state.faces[batch(face)],
            state.cohesive[number(face)]};
  }

  RockStrength rock(int face) const {
    return rocks_.of(joints.law(face), joints.tensile_strength(face), joints.cohesion(face));
  }
  // What a face that holds has left: a crack that did not continue took the rest, at most the part that may_end allows.
  RockStrength rock_left(int face) const {
    RockStrength left = rock(face);
    if (stage(face) == FaceStage::resumed)
      raise(left, 1 - damage_of(state.cohesive[number(face)]));
    return left;
  }
  FacePlane plane(int face) const { return watch.plane_between(model, tets(face).tet_a, tets(face).tet_b); }

  geom::Mat3 stress(int face) const;              // Pa, mean of both tets
  FaceFrame frame(int face, double behind) const; // behind: s, before now
  double
  strain_rate(int face) const; // 1/s, sqrt(d : d) of the rate of deformation d, in the mean of both tets
  // Pa, by which the mean stress of both tets rises in this time, s, at the present rate.
  geom::Mat3 rise(int face, double time) const;

  const Model& model;
  State& state;
  const StrengthWatch& watch;
  std::int64_t index; // of the chunk
  const MeshChunk& chunk;
  const Body& body;
  FaceJoints joints;

private:
  OwnRocks rocks_;
};

geom::Mat3 rate_of_strain(const Model&, const State&, int tet); // 1/s, symmetric, of a tet

} // namespace cdem
