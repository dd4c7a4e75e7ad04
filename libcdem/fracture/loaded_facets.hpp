// The traction on the facets between joined blocks without zones (star_blocks.hpp), in a chunk of a cohesive mesh. The stress of
// the two tets at a face does not see bending. A facet that is freed has the force and the moment that its faces carry: the
// traction that its faces are judged by is the linear one with the same force and moment (linear_traction.hpp).
#pragma once

#include "libcdem/fracture/faces_of_chunk.hpp"

namespace cdem {

class LoadedFacets {
public:
  LoadedFacets(const FacesOfChunk&, double moved_for); // as in CrackingStep

  // The faces of facets that are hardly damaged, so far as they carry something.
  const std::vector<int>& faces() const { return faces_; }
  bool contain(int face) const { return !of_face_.empty() && of_face_[face].is; }
  // The plane of the corner that uses most of the strength, if that is all of it.
  std::optional<CriticalPlane> worst_plane(int face, const RockStrength&) const;

private:
  struct OfFace {
    bool is = false;
    geom::Vec3 normal = geom::Vec3::Zero(); // unit
    std::array<geom::Vec3, 3> at_corners;   // Pa, in space, on side a
  };
  void fit(const FacetFaces&);
  FaceFrame frame_of_whole(int face, const std::array<geom::Vec3, 3>& corners) const;

  const FacesOfChunk& of_;
  double moved_for_;            // s
  std::vector<OfFace> of_face_; // empty: there are no facets
  std::vector<int> faces_;
};

geom::Mat3 stress_with(const geom::Vec3& t, const geom::Vec3& n); // some stress s with s n = t

} // namespace cdem
