#include "libcdem/model/build/face_strength.hpp"

#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"

#include <cstring>

namespace cdem {
namespace {

// The same for points in any order.
template <std::size_t n>
std::uint64_t id_of(std::array<geom::Vec3, n> points) {
  std::sort(points.begin(), points.end(), [](const geom::Vec3& a, const geom::Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  std::uint64_t id = 14695981039346656037ull;
  for (const geom::Vec3& point : points)
    for (int axis = 0; axis < 3; ++axis) {
      const double x = point[axis] + 0.0; // -0 and 0 are one place
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      id = (id ^ (bits ^ (bits >> 32))) * 1099511628211ull;
    }
  return id;
}

} // namespace

bool has_own_strengths(const Body& body) {
  return !body.bonding.none() && (!body.region_laws.empty() || body.joint.scatter.on());
}

bool has_own_strengths(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return has_own_strengths(body); });
}

FaceStrength face_strength(const Body& body, int region_a, int region_b,
                           const std::array<geom::Vec3, 3>& corners, double volumes) {
  FaceStrength face;
  face.joint = body.region_laws.between(region_a, region_b);
  const Joint& joint = body.joint_of(face.joint);
  const double factor =
      joint.scatter.on()
          ? scatter_factor(joint.scatter, volumes / 4, geom::uniform(joint.scatter.seed, id_of(corners), 0))
          : 1;
  face.tensile_strength = factor * joint.tensile_strength;
  face.cohesion = factor * joint.cohesion;
  face.tan_friction = geom::portable::tan(joint.friction_angle);
  return face;
}

double interface_strength(const Joint& joint, const geom::Vec3& centroid_a, const geom::Vec3& centroid_b,
                          double volume) {
  if (!joint.scatter.on())
    return 1;
  const std::uint64_t id = id_of(std::array<geom::Vec3, 2>{centroid_a, centroid_b});
  return scatter_factor(joint.scatter, volume, geom::uniform(joint.scatter.seed, id, 0));
}

} // namespace cdem
