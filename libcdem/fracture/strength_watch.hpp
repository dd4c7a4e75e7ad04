// Which faces of cohesive bodies are near their strength. Every step, the stress that the elements have just got, still in
// the cache, is compared with a bound on the utilisation, eight tets side by side. Faces beside tets above that bound, and
// joints whose springs pull, are looked at one by one in every step: when a face is freed or cracks follows from what it bears
// alone, not from the number of the face or of the step. Facets of joined blocks without zones are looked at as wholes.
//
//   crack   the utilisation of a face is 1 (begin_cracks.hpp)
//   join    all tets around a node have been below `due_at` for a while, are below `freed_at` now, and no face there has ever
//           cracked: its copies become one node again
//   free    the utilisation of a face that is not freed yet is above `due_at`, now or in two steps at the present rate
//           of strain; then all faces of its body above `freed_at` are freed together, since freeing is dear. A joint that is
//           freed at some corners is judged with its springs, as one that may crack, or it would bear more than its strength
#pragma once

#include "libcdem/fracture/critical_plane.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/state.hpp"

#include <vector>

namespace cdem {

// Parts of its strength at which a face is freed: it is high time; it is freed with others.
inline constexpr double due_at = 0.9, freed_at = 0.5;
// Joined blocks without zones (star_blocks.hpp) are freed by the stress of any of their tets, before a corner of their joints
// may be at its strength: where a moment bends blocks of the length h and the depth d, tets use 0.7 to 1.6 d/h of what the
// corners use (h from a half to five times d). These are the parts for d = h; others have d/h of them, with the least extent of
// a block for d and the largest for h.
inline constexpr double stars_due_at = 0.25, stars_freed_at = 0.125;
// The springs of a face change the stress that it bears by no more than this times the traction that they add, as norms.
inline constexpr double most_of_traction = 1.4142136 * (1 + 1e-9);

// What is known of the tets, eight by eight. Kept between steps; it follows from the State and is found again where it is
// not known.
struct NearStrength {
  static constexpr std::uint8_t may_crack = 1, may_be_due = 2;
  std::vector<std::uint8_t> bits; // per batch of tets
  std::vector<double>
      pull2; // Pa2, per face, of the moment of its tets' stress, written by cohesive_face_forces; infinite: unknown
  bool crack_known = false, due_known = false;

  void forget() { crack_known = due_known = false; }
  void forget_pulls(const Model&);
};

// Where the stresses of the two tets at eight faces stand, batch * lanes + lane; 0 beside an empty lane.
struct alignas(64) SlotsOfTets {
  int a[lanes] = {}, b[lanes] = {};
};

// Faces between two joined blocks without zones, into those of a chunk; on which side of each the first block stands.
struct FacetFaces {
  std::vector<int> faces;
  std::vector<char> first_is_a;
};

class StrengthWatch {
public:
  StrengthWatch() = default; // sees nothing
  static StrengthWatch of(const Model&);
  bool empty() const { return neighbours_.empty(); } // no body is cohesive
  void freed(const Model&);                          // nodes have been freed, all else is as it was
  void keep(const Model&);                           // for the next stage of this model

  // Some face in the chunk may crack. before: the stress of its batches a step ago; null: unknown.
  bool looks_at(std::int64_t chunk) const { return !bounds_.empty() && !bounds_[chunk].at_strength.empty(); }
  // The freed faces of a chunk that are judged on their own plane, by pairs of joined blocks without zones (star_blocks.hpp).
  const std::vector<FacetFaces>& facets(std::int64_t chunk) const {
    return facets_[static_cast<std::size_t>(chunk)];
  }
  // On which plane the face between two tets of the model is judged. On its own where it belongs to a border between regions
  // that has a joint of its own, or beside which nothing else may crack, unless the border is ragged there.
  FacePlane plane_between(const Model&, int tet_a, int tet_b) const;
  // Whether a face with this normal stands nearer to the plane with the normal m than all others that may crack of one of its
  // tets.
  bool is_nearest_of_a_tet(const Model&, const State&, const FaceTets&, const geom::Vec3& face,
                           const geom::Vec3& m) const;
  // Bounds on the whole strength of the faces of a chunk: a stress for which some face is too weak is beyond one of them.
  const std::vector<UtilisationBound>& strength_bounds(std::int64_t chunk) const {
    return bounds_[static_cast<std::size_t>(chunk)].whole;
  }
  // Pa: no stress of a smaller norm is beyond them.
  double harmless_stress(std::int64_t chunk) const {
    return bounds_[static_cast<std::size_t>(chunk)].harmless;
  }
  const SlotsOfTets& slots_at(std::int64_t face_batch) const {
    return slots_[static_cast<std::size_t>(face_batch)];
  }
  bool has_held_faces(std::int64_t chunk) const { return held_[static_cast<std::size_t>(chunk)] != 0; }
  void look(const MeshChunk&, std::int64_t chunk, const StressBatch* stress, const StressBatch* before,
            NearStrength&) const;
  void look(const Model&, const State&, Range chunks, int threads, NearStrength&) const; // at all of them

  // Per body, whether a face of it is due to be freed. ahead: s, two steps. everywhere: at every face, not only beside the tets known to be
  // near. own: chunks of the mesh that this rank looks at.
  std::vector<char> due(const Model&, const State&, const NearStrength&, Range own, int threads, double ahead,
                        bool everywhere) const;
  // Per node of the model, 1 for those of faces of these bodies above `freed_at` that are not freed yet, now or ahead.
  std::vector<char> to_free(const Model&, const State&, const std::vector<char>& bodies, int threads,
                            double ahead) const;

  // Per node of the model, 1 for those to be joined again, in blocks where many may be.
  std::vector<char> to_join(const Model&, const State&, Range own, int threads) const;

private:
  explicit StrengthWatch(const Model&);
  struct Bounds {
    std::vector<UtilisationBound> whole, at_strength, at_half;
    double harmless = 0; // Pa, by `whole`
  };
  class ChunkFaces;
  int star_of(const Model& model, std::int64_t tet) const {
    return star_.empty() ? -1 : star_[static_cast<std::size_t>(tet - model.mesh.first_tet)];
  }
  void find_planes(const Model&);
  template <class Visit> // (batch, lane)
  void each_half_freed(const MeshChunk&, const Visit&) const;

  std::vector<int> neighbours_;   // per tet of the mesh and face of it: 4 tet + face on the other side, or -1
  std::vector<FacePlane> plane_;  // of the same; empty: all are of the material
  std::vector<RockStrength> own_; // of the same; empty: all are as their body's joint says
  std::vector<Bounds> bounds_;    // of the faces of each chunk; none: it is of no cohesive body
  std::vector<int> star_; // per tet of the mesh: its block without zones, or -1; empty: there are none
  std::vector<std::vector<FacetFaces>> facets_; // per chunk
  std::vector<char> open_star_;          // per such block, 1: some face of it may crack and is not freed
  std::vector<char> open_;               // per batch of tets, 1: some face may crack and is not freed
  std::vector<char> held_;               // per chunk, likewise
  std::vector<SlotsOfTets> slots_;       // per batch of faces
  std::vector<std::uint8_t> half_freed_; // likewise, a bit for each joint freed at some of its corners only
  bool kept_ = true;                     // `of` finds it
};

} // namespace cdem
