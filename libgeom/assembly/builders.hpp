// Builders of block assemblies. All lengths in m, angles in radians here (degrees in scripts).
#pragma once

#include "libgeom/assembly/assembly.hpp"

#include <cstdint>
#include <optional>

namespace geom {

// Builders refuse what they cannot build by InputError, with the field's name as a script writes it; none
// makes more than 10 million blocks.

// Boxes in rows: divisions = {nx, ny, nz}, each >= 1; origin is the lower corner.
Assembly grid(const Vec3& size, const std::array<int, 3>& divisions, const Vec3& origin = Vec3::Zero());

struct VoronoiOptions {
  Vec3 size = Vec3::Ones();
  Vec3 origin = Vec3::Zero();
  int count = 100;
  std::uint64_t seed = 1; // counter-based generator keyed by (seed, cell)
  int relaxations = 3;    // Lloyd steps: each moves the seeds to their cells' centroids
  bool extruded = false;  // one block through the z thickness (2-D cells)
};
Assembly voronoi(const VoronoiOptions&);

struct BrickOptions {
  Vec3 size = Vec3::Ones();  // the wall
  Vec3 brick = Vec3::Ones(); // one brick; courses are laid along z, running along x
  double shift = 0.5;        // each course against the one below, as a fraction of the brick's length
  Vec3 origin = Vec3::Zero();
};
Assembly bricks(const BrickOptions&); // running bond; end bricks are cut to the wall

struct JointSet {
  double dip = 0;               // rad, 0..pi/2, below the horizontal plane (z up)
  double dip_direction = 0;     // rad, 0..2 pi, clockwise from +y (north) seen from above
  double spacing = 1;           // m, mean normal distance
  double spacing_scatter = 0;   // standard deviation over the mean, < 0.5
  double dip_scatter = 0;       // rad, standard deviation
  double direction_scatter = 0; // rad, standard deviation
  std::string name = {};        // of the faces that the set makes (PolyhedronFace::cut)
  // m; a plane runs through it. Without it the planes are counted from the lowest corner of the blocks along the normal.
  std::optional<Vec3> origin = {};
  // Planes next to the origin, on both sides of it; of the centre of the blocks where no origin is given. Without it as
  // many as cross the blocks.
  std::optional<int> count = {};
  // Probability that a face belongs to the set, above 0. A face that does not has no name: it is a bridge of rock.
  double persistence = 1;
};
// Cuts every block by the planes of every set in turn, those with bridges last; seeded scatter. Every face between two
// blocks is drawn by itself, so bridges are as fine as the blocks that the other sets leave.
Assembly cut_by_joints(const Assembly&, const std::vector<JointSet>&, std::uint64_t seed = 1);

// Convex hull of at least four points that are not in one plane (CGAL).
Polyhedron convex_hull(const std::vector<Vec3>& points);

} // namespace geom
