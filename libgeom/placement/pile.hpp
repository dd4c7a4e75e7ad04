// Many units of one shape, each with its place and attitude.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

#include <cstdint>

namespace geom {

struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero(); // m

  Vec3 operator()(const Vec3& x) const { return rotation * x + translation; }
};

struct Pile {
  TetMesh unit;            // centred on its centroid
  double height = 0;       // H, m, of the unit
  std::vector<Pose> poses; // one for each unit; the translation is where its centroid is
};

// Without poses yet: the unit's mesh moved to its centroid, its height that of its box along z.
Pile pile_of(TetMesh unit);

// Throws InputError about the field `unit` when its tets are parts that share no node.
void require_one_part(const TetMesh& unit);

TetMesh posed(const TetMesh&, const Pose&);
std::vector<TetMesh> meshes(const Pile&);       // of all units, where they are
Pile scaled(const Pile&, double factor);        // all lengths times the factor, about the origin
double nominal_diameter(const Pile&);           // Dn, m: side of the cube with the unit's volume
Box bounding_box(const Pile&);                  // m, of all units where they are
double bounding_radius(const TetMesh& centred); // m, of the sphere about the origin

// Uniform over all rotations (Shoemake 1992), from three random numbers keyed by (seed, id, draw).
Mat3 random_rotation(std::uint64_t seed, std::uint64_t id, std::uint64_t first_draw = 0);

Mat3 turned(const Mat3& rotation, const Vec3& by); // about the direction of `by`, by its length, radians

// The motion that takes points to places with the least sum of weighted squared distances (Kabsch 1976).
Pose best_fit(const std::vector<Vec3>& points, const std::vector<Vec3>& places,
              const std::vector<double>& weights);
Pose after(const Pose& second, const Pose& first); // first, then second

// Throws InputError, `source` first, unless the mesh is valid, the height positive and every rotation a
// proper one.
void validate(const Pile&, const std::string& source);

} // namespace geom
