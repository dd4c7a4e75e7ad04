#include "libcdem/element/rigid_motion.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>

namespace cdem {
namespace {

// Each pass takes the error down by the angle of half a step, at most half a radian.
constexpr int most_passes = 60;
constexpr double largest_angle = 0.5; // rad

geom::Mat3 cross_matrix(const geom::Vec3& w) {
  geom::Mat3 m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

// sin(x) / x
double sinc(double x) {
  return x < 1e-4 ? 1 - x * x / 6 : geom::portable::sin(x) / x;
}

} // namespace

geom::Vec3 vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

std::array<double, 3> three_of(const geom::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

geom::Mat3 rotation(const RigidState& state) {
  const auto& q = state.rotation;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

geom::Mat3 turn_less_one(const geom::Vec3& angle) {
  const double a = angle.norm(), half = sinc(0.5 * a);
  const geom::Mat3 w = cross_matrix(angle);
  return sinc(a) * w + 0.5 * half * half * w * w;
}

geom::Mat3 turn(const geom::Vec3& angle) {
  return geom::Mat3::Identity() + turn_less_one(angle);
}

void turn_by(RigidState& state, const geom::Vec3& angle) {
  const double half = 0.5 * angle.norm();
  const geom::Vec3 v = 0.5 * sinc(half) * angle;
  const auto& q = state.rotation;
  const Eigen::Quaterniond now = (Eigen::Quaterniond(geom::portable::cos(half), v.x(), v.y(), v.z()) *
                                  Eigen::Quaterniond(q[0], q[1], q[2], q[3]))
                                     .normalized();
  state.rotation = {now.w(), now.x(), now.y(), now.z()};
}

geom::Vec3 spin(const RigidBody& body, const RigidState& state, double ahead) {
  const geom::Vec3 momentum = vec(state.angular_momentum);
  const geom::Mat3 r = rotation(state);
  // In the directions of R: w = exp(a) I^-1 exp(-a) L, with everything turned by R^T.
  const geom::Vec3 l = r.transpose() * momentum;
  geom::Vec3 w = body.inverse_inertia * l;
  for (int pass = 0; pass < most_passes; ++pass) {
    if (!((ahead * w).norm() < largest_angle))
      return geom::Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    const geom::Mat3 half = turn(ahead * w);
    const geom::Vec3 next = half * (body.inverse_inertia * (half.transpose() * l));
    const double change = (next - w).norm();
    w = next;
    if (change <= 1e-15 * w.norm())
      break;
  }
  return r * w;
}

double kinetic_energy(const RigidBody& body, const RigidState& state, double lag) {
  return 0.5 * body.mass * vec(state.velocity).squaredNorm() +
         0.5 * vec(state.angular_momentum).dot(spin(body, state, -lag));
}

} // namespace cdem
