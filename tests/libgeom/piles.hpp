// Units, grounds and the distances between them, for tests of placement.
#pragma once

#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/triangle_distance.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/placement/ground.hpp"
#include "libgeom/placement/pile.hpp"
#include "libgeom/placement/rest.hpp"
#include "libgeom/solid/armour_units.hpp"

namespace testing {

using namespace geom;

inline TetMesh moved(TetMesh mesh, const Vec3& by) {
  for (Vec3& x : mesh.nodes)
    x += by;
  return mesh;
}

inline RestOptions resting(double friction, double gap) {
  RestOptions options;
  options.friction = friction;
  options.clear = gap;
  options.step = 0.01;
  options.last_step = 0.001;
  options.probe = 0.005;
  options.gyration = 0.3;
  return options;
}

// 40 m by 20 m, its upper side z = gradient x (0 at x = 0).
inline Ground slope_ground(double gradient) {
  TetMesh mesh = box_mesh({40, 20, 1}, {2, 2, 1});
  for (Vec3& x : mesh.nodes) {
    x.y() -= 10;
    x.z() += gradient * x.x() - 1;
  }
  return Ground(surface_of(mesh));
}

inline const TetMesh& accropode_mesh() {
  static const TetMesh mesh = mesh_solid(accropode(1), {0.4});
  return mesh;
}

inline std::vector<Surface> surfaces(const Pile& pile) {
  std::vector<Surface> all;
  for (const TetMesh& mesh : meshes(pile))
    all.push_back(surface_of(mesh));
  return all;
}

inline double least_distance(const Pile& pile, double limit) {
  const std::vector<Surface> all = surfaces(pile);
  double least = limit;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, distance(all[i], all[j], limit));
  return least;
}

} // namespace testing
