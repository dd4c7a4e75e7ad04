#include "libgeom/placement/pile.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/core/rotation.hpp"
#include "libgeom/mesh/parts.hpp"

#include <Eigen/SVD>

#include <cassert>
#include <cmath>

namespace geom {

Pile pile_of(TetMesh unit) {
  Pile pile;
  pile.height = bounding_box(unit).size().z();
  const Vec3 centroid = mass_properties(unit).centroid;
  pile.unit = std::move(unit);
  for (Vec3& x : pile.unit.nodes)
    x -= centroid;
  return pile;
}

void require_one_part(const TetMesh& unit) {
  if (const int parts = count_parts(unit); parts > 1)
    throw InputError("unit", "a mesh of " + std::to_string(parts) + " parts", "one that hangs together",
                     "a unit is laid as one rigid body: join its solids, or lay one of them");
}

TetMesh posed(const TetMesh& mesh, const Pose& pose) {
  TetMesh moved = mesh;
  for (Vec3& x : moved.nodes)
    x = pose(x);
  return moved;
}

std::vector<TetMesh> meshes(const Pile& pile) {
  std::vector<TetMesh> all;
  all.reserve(pile.poses.size());
  for (const Pose& pose : pile.poses)
    all.push_back(posed(pile.unit, pose));
  return all;
}

Pile scaled(const Pile& pile, double factor) {
  require_positive("factor", factor, "");
  Pile result = pile;
  result.height *= factor;
  for (Vec3& x : result.unit.nodes)
    x *= factor;
  for (Pose& pose : result.poses)
    pose.translation *= factor;
  return result;
}

Box bounding_box(const Pile& pile) {
  Box box;
  for (const Pose& pose : pile.poses)
    for (const Vec3& x : pile.unit.nodes)
      box.extend(pose(x));
  return box;
}

double nominal_diameter(const Pile& pile) {
  return std::cbrt(volume(pile.unit));
}

double bounding_radius(const TetMesh& centred) {
  double square = 0;
  for (const Vec3& x : centred.nodes)
    square = std::max(square, x.squaredNorm());
  return std::sqrt(square);
}

Mat3 random_rotation(std::uint64_t seed, std::uint64_t id, std::uint64_t first_draw) {
  const double u = uniform(seed, id, first_draw), v = 2 * M_PI * uniform(seed, id, first_draw + 1),
               w = 2 * M_PI * uniform(seed, id, first_draw + 2);
  const double a = std::sqrt(1 - u), b = std::sqrt(u);
  return Eigen::Quaterniond(b * portable::cos(w), a * portable::sin(v), a * portable::cos(v),
                            b * portable::sin(w))
      .normalized()
      .toRotationMatrix();
}

Mat3 turned(const Mat3& rotation, const Vec3& by) {
  return by.norm() > 0 ? Mat3(rotation_about(by.normalized(), by.norm()).toRotationMatrix() * rotation)
                       : rotation;
}

Pose best_fit(const std::vector<Vec3>& points, const std::vector<Vec3>& places,
              const std::vector<double>& weights) {
  assert(points.size() == places.size() && points.size() == weights.size());
  double weight = 0;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    weight += weights[i];
    from += weights[i] * points[i];
    to += weights[i] * places[i];
  }
  from /= weight;
  to /= weight;
  Mat3 products = Mat3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    products += weights[i] * (places[i] - to) * (points[i] - from).transpose();
  const Eigen::JacobiSVD<Mat3> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 turn = Mat3::Identity(); // of the last axis, where the best orthogonal matrix is a reflection
  turn(2, 2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  Pose pose;
  pose.rotation = svd.matrixU() * turn * svd.matrixV().transpose();
  pose.translation = to - pose.rotation * from;
  return pose;
}

Pose after(const Pose& second, const Pose& first) {
  return {second.rotation * first.rotation, second(first.translation)};
}

void validate(const Pile& pile, const std::string& source) {
  validate(pile.unit, source);
  require_positive(source + ": height", pile.height);
  for (std::size_t i = 0; i < pile.poses.size(); ++i) {
    const std::string which = source + ": pose " + std::to_string(i + 1);
    const Mat3& r = pile.poses[i].rotation;
    require_finite(which + ": centroid", pile.poses[i].translation);
    if (!((r * r.transpose() - Mat3::Identity()).norm() < 1e-9 && r.determinant() > 0))
      throw InputError(which + ": its matrix is no rotation; its rows must be three perpendicular unit "
                               "vectors, right-handed");
  }
}

} // namespace geom
