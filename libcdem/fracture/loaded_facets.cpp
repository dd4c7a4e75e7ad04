#include "libcdem/fracture/loaded_facets.hpp"

#include "libcdem/fracture/linear_traction.hpp"
#include "libcdem/state/places.hpp"

namespace cdem {

using geom::Mat3;
using geom::Vec3;

Mat3 stress_with(const Vec3& t, const Vec3& n) {
  return t * n.transpose() + n * t.transpose() - t.dot(n) * n * n.transpose();
}

LoadedFacets::LoadedFacets(const FacesOfChunk& of, double moved_for) : of_(of), moved_for_(moved_for) {
  const std::vector<FacetFaces>& facets = of.watch.facets(of.index);
  if (!facets.empty())
    of_face_.resize(static_cast<std::size_t>(of.chunk.faces));
  for (const FacetFaces& facet : facets)
    fit(facet);
}

void LoadedFacets::fit(const FacetFaces& facet) {
  LinearTraction linear;
  Joint room;
  std::optional<Vec3> near; // a place of the facet
  for (std::size_t i = 0; i < facet.faces.size(); ++i) {
    const int face = facet.faces[i];
    const FaceStage stage = of_.stage(face);
    if (!holds(stage) && !(stage == FaceStage::cracking && may_end(of_.state.cohesive[of_.number(face)]) &&
                           of_.joints.of(face, room).softening != Softening::none))
      continue;
    std::array<Vec3, 3> corners;
    for (int corner = 0; corner < 3; ++corner)
      corners[corner] = place_of(of_.model, of_.state, of_.nodes(face).a[corner]);
    if (!near)
      near = corners[0];
    const FaceFrame then =
        stage == FaceStage::holding ? frame_of_whole(face, corners) : of_.frame(face, moved_for_);
    const FreedFace freed = of_.freed(face, of_.joints.of(face, room));
    const auto tractions = carried_tractions(freed, then, of_.stress(face));
    const double side = facet.first_is_a[i] != 0 ? 1 : -1;
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 6 - *near;
    for (int point = 0; point < 3; ++point)
      linear.add(freed.batch.area[freed.lane], middle + 0.5 * corners[point], side * tractions[point],
                 side * then.normal);
    of_face_[face] = {true, then.normal, corners};
    faces_.push_back(face);
  }
  if (!near)
    return;
  linear.fit();
  for (std::size_t i = 0; i < facet.faces.size(); ++i)
    if (OfFace& face = of_face_[facet.faces[i]]; face.is)
      for (Vec3& at : face.at_corners) // a place so far
        at = (facet.first_is_a[i] != 0 ? 1 : -1) * linear.at(at - *near);
}

// The gaps at the moment of the stress and the normal of side a: sides that have never cracked lie on each other.
FaceFrame LoadedFacets::frame_of_whole(int face, const std::array<Vec3, 3>& corners) const {
  const FaceNodes nodes = of_.nodes(face);
  const auto moved = [&](int node) {
    return Vec3(vec(of_.state.displacement[node]) - moved_for_ * velocity_of(of_.state, node));
  };
  Vec3 apart[3];
  for (int corner = 0; corner < 3; ++corner)
    apart[corner] = moved(nodes.b[corner]) - moved(nodes.a[corner]);
  FaceFrame f;
  f.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  f.along = f.across = Vec3::Zero();
  for (int point = 0; point < 3; ++point)
    f.gap[point] = (apart[0] + apart[1] + apart[2]) / 6 + 0.5 * apart[point];
  return f;
}

std::optional<CriticalPlane> LoadedFacets::worst_plane(int face, const RockStrength& rock) const {
  const OfFace& at = of_face_[face];
  double most = 0;
  Mat3 worst = Mat3::Zero();
  for (const Vec3& t : at.at_corners) {
    const Mat3 stress = stress_with(t, at.normal);
    if (const double used = strength_utilisation(stress, rock, at.normal, FacePlane::own); used > most) {
      most = used;
      worst = stress;
    }
  }
  return most >= 1 ? critical_plane(worst, rock, at.normal, FacePlane::own) : std::nullopt;
}

} // namespace cdem
