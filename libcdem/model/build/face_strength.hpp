// Which law a face of a mesh has, and how strong it is: that of its regions, and its draw of a strength that scatters
// (joint/strength_scatter.hpp).
//
// Each tet draws for its volume (of a joint with a plane of its own: for a quarter of the volume of both tets of each of its
// faces), by the seed and its place in the undeformed mesh. Neither the numbering nor the freeing of nodes changes that. So the
// weakest tet of a body has the strength of the body's volume, whatever the mesh. One weak face among strong ones would
// not fail the body: its neighbours would carry it. A flaw therefore weakens all faces within half the correlation length,
// which is five edges of the mesh, or the process zone E G_I / T^2 where that is longer: a crack as large as this goes on by
// itself.
#pragma once

#include "libcdem/model/model.hpp"
#include "libgeom/mesh/boundary.hpp"

namespace cdem {

// Some face of a mesh has another strength than its body's joint.
bool has_own_strengths(const Body&);
bool has_own_strengths(const Model&);

struct FaceStrength {
  int joint = -1;                            // into the body's region_laws; -1: the body's joint
  double tensile_strength = 0, cohesion = 0; // Pa
  double tan_friction = 0;
};

// The faces of one connected mesh.
class FaceStrengths {
public:
  FaceStrengths(const Body&, const geom::TetMesh&, const std::vector<geom::InnerFace>&);
  FaceStrengths(const Body&, const geom::TetMesh&); // finds the inner faces itself, where a strength scatters
  FaceStrength of(int tet_a, int tet_b) const;
  double correlation_length(int joint) const; // m, of the body's region_laws; -1: of the body's joint

private:
  static bool scatter(const Body&);
  std::vector<double> draws(int law, const std::vector<geom::InnerFace>&) const;
  void spread(std::vector<double>& factor, double length) const;

  const Body& body_;
  const geom::TetMesh& mesh_;
  std::vector<double> tan_friction_;        // of each law, the body's joint first
  std::vector<std::vector<double>> factor_; // likewise, per tet; empty: the law has no scatter
};

// Strength of an interface between blocks with these centroids. Its volume is that of the pyramids from it to both, m3.
double interface_strength(const Joint&, const geom::Vec3& centroid_a, const geom::Vec3& centroid_b,
                          double volume);

} // namespace cdem
