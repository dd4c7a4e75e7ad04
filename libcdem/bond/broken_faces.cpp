#include "libcdem/bond/broken_faces.hpp"

#include "libcdem/bond/leaving_faces.hpp"
#include "libcdem/joint/coulomb_friction.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cdem {
namespace {

using simd::Vec;

using Frame = FaceFrame;
using Plane2 = std::array<double, 2>;

double length(const Plane2& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1]);
}

struct Response {
  double opening = 0;        // m
  Plane2 shear{};            // N, along and across
  geom::Vec3 force{0, 0, 0}; // N, on side a
  double energy = 0;         // J
};

Plane2 tangential(const Frame& f, int point) {
  return {f.gap[point].dot(f.along), f.gap[point].dot(f.across)};
}

// slip: m, as in FaceSlip.
Response stretched(double kn, double ks, const Frame& f, int point, const Plane2& slip = {}) {
  const Plane2 gap = tangential(f, point);
  Response r;
  r.opening = f.gap[point].dot(f.normal);
  r.shear = {ks * (gap[0] - slip[0]), ks * (gap[1] - slip[1])};
  r.force = kn * r.opening * f.normal + r.shear[0] * f.along + r.shear[1] * f.across;
  r.energy = 0.5 * (kn * r.opening * r.opening + (r.shear[0] * r.shear[0] + r.shear[1] * r.shear[1]) / ks);
  return r;
}

// The contact a broken spring is; slip moves on where it slides.
Response contact(double kn, double ks, double tan_friction, const Frame& f, int point, Plane2& slip) {
  Response trial = stretched(kn, ks, f, point, slip);
  if (trial.opening > 0) {
    slip = tangential(f, point);
    return {trial.opening};
  }
  const double shear = length(trial.shear), limit = friction_limit(-kn * trial.opening, tan_friction);
  if (shear <= limit)
    return trial;
  const double too_much = (1 - held_by_friction(shear, limit)) / ks;
  for (int axis = 0; axis < 2; ++axis)
    slip[axis] += too_much * trial.shear[axis];
  return stretched(kn, ks, f, point, slip);
}

void set_lane(Vec& v, int lane, const geom::Vec3& value) {
  v.x[lane] = value.x();
  v.y[lane] = value.y();
  v.z[lane] = value.z();
}

BondMode due(const FaceLaw& law, double area, double normal_force, double shear_force) {
  return breaks({law.cohesion * area, law.tan_friction, law.tensile_strength * area}, normal_force,
                shear_force);
}

// One face some of whose springs are broken or may break now: replaces their force on side a.
class OneFace {
public:
  OneFace(const FaceBatch& batch, int lane, const FaceMotion& motion, const FaceLaw& law)
      : batch_(batch), lane_(lane), motion_(motion), law_(law), now_(face_frame(batch, lane, motion, 0)) {}

  // spring: the place of the face's first one. slips: of the model.
  void advance(bool breaking, std::int64_t spring, FaceStateBatch& state, FaceSlipBatch* slips,
               Vec (&force)[3], FaceSums& sums) {
    part_ = 1 - state.let_go[lane_];
    FaceSlip slip = state.slip < 0 ? FaceSlip{} : slips[state.slip].at(lane_);
    bool whole_face = true;
    for (int point = 0; point < 3; ++point) {
      Plane2 s = {slip.value[point][0], slip.value[point][1]};
      if (!is_intact(state.mode[point][lane_]))
        slide(point, {slip.shear[point][0], slip.shear[point][1]}, s, sums);
      else if (!breaking || !snap(point, spring + point * lanes, state.mode[point][lane_], s, sums)) {
        whole_face = false;
        continue;
      }
      for (int axis = 0; axis < 2; ++axis) {
        slip.value[point][axis] = s[axis];
        slip.shear[point][axis] = response_[point].shear[axis];
      }
      set_lane(force[point], lane_, response_[point].force);
    }
    if (state.slip >= 0)
      slips[state.slip].set(lane_, slip);
    if (whole_face)
      leave(spring / (3 * lanes) * lanes + lane_, state, sums);
  }

private:
  double kn() const { return part_ * batch_.kn[lane_]; }
  double ks() const { return law_.shear_ratio * kn(); }
  geom::Vec3 moved(int point) {
    return now_.gap[point] - face_frame(batch_, lane_, motion_, motion_.step).gap[point];
  }

  // Friction by the trapezoidal rule; shear: N, before the step.
  void slide(int point, const Plane2& shear, Plane2& slip, FaceSums& sums) {
    const Plane2 from = slip;
    const Response& r = response_[point] = contact(kn(), ks(), law_.tan_friction, now_, point, slip);
    for (int axis = 0; axis < 2; ++axis)
      sums.friction += 0.5 * (shear[axis] + r.shear[axis]) * (slip[axis] - from[axis]);
  }

  // True when the spring breaks.
  bool snap(int point, std::int64_t spring, std::uint8_t& mode, Plane2& slip, FaceSums& sums) {
    const Response bonded = stretched(kn(), ks(), now_, point);
    const double area = batch_.area[lane_], shear = length(bonded.shear);
    const BondMode now = now_.torn ? BondMode::broken_tension : due(law_, area, kn() * bonded.opening, shear);
    if (now == BondMode::intact)
      return false;
    mode = static_cast<std::uint8_t>(now);
    const Response& r = response_[point] = contact(kn(), ks(), law_.tan_friction, now_, point, slip);
    // The work of the step with the force it ends with, less what is stored.
    const double taken = bonded.energy - r.energy + 0.5 * (r.force - bonded.force).dot(moved(point));
    sums.breaking += taken;
    sums.crack.add(taken, now == BondMode::broken_shear ? 1 : 0);
    sums.broken.push_back({spring,
                           now,
                           now_.normal,
                           kn() * bonded.opening / area,
                           shear / area,
                           {slip[0], slip[1]},
                           {r.shear[0], r.shear[1]}});
    return true;
  }

  // A face without any bond left: handed over, or looked at whether it still may be two planes without end.
  void leave(std::int64_t face, FaceStateBatch& state, FaceSums& sums) {
    const double size = std::sqrt(3 * batch_.area[lane_]);
    if (law_.hands_over) {
      double energy = 0;
      for (int point = 0; point < 3; ++point)
        energy += response_[point].energy + 0.5 * response_[point].force.dot(moved(point));
      if (law_.hand_over_due && (leaves(state, lane_) || is_gone(now_, size)))
        sums.friction += cdem::leave(now_, size, energy, lane_, state, sums);
      return;
    }
    for (int point = 0; point < 3; ++point)
      if (response_[point].opening < 0 && now_.gap[point].squaredNorm() > size * size)
        sums.astray = face;
  }

  const FaceBatch& batch_;
  int lane_;
  const FaceMotion& motion_;
  const FaceLaw& law_;
  Frame now_;
  Response response_[3];
  double part_ = 1; // of its springs
};

} // namespace

void one_by_one(const FaceBatch& batch, unsigned faces, const FaceMotion& motion, const FaceLaw& law,
                bool breaking, std::int64_t first_spring, FaceStateBatch& state, FaceSlipBatch* slips,
                Vec (&force)[3], FaceSums& sums) {
  for (; faces != 0; faces &= faces - 1) {
    const int lane = __builtin_ctz(faces);
    OneFace(batch, lane, motion, at_lane(law, lane))
        .advance(breaking, first_spring + lane, state, slips, force, sums);
  }
}

FaceSpring face_spring(const FaceBatch& batch, const FaceNodes& nodes, int point, int lane,
                       const Node* position, const Node* displacement, const FaceLaw& law,
                       const FaceStateBatch& state, const FaceSlip& slip) {
  const Frame f = face_frame(nodes, position, displacement);
  FaceSpring spring;
  spring.gap = f.gap[point];
  spring.normal = f.normal;
  if (handed_over(state, lane))
    return spring;
  const double kn = (1 - state.let_go[lane]) * batch.kn[lane], ks = law.shear_ratio * kn;
  Plane2 s{slip.value[point][0], slip.value[point][1]};
  const Response r = is_intact(state.mode[point][lane]) ? stretched(kn, ks, f, point)
                                                        : contact(kn, ks, law.tan_friction, f, point, s);
  spring.force = r.force;
  spring.energy = r.energy;
  return spring;
}

void settle(const FaceBatch& batch, const FaceNodes& nodes, int point, int lane, const Node* position,
            const Node* displacement, const FaceLaw& law, FaceSlip& slip) {
  Plane2 s = {slip.value[point][0], slip.value[point][1]};
  const double kn = batch.kn[lane];
  const Response r = contact(kn, law.shear_ratio * kn, law.tan_friction,
                             face_frame(nodes, position, displacement), point, s);
  for (int axis = 0; axis < 2; ++axis) {
    slip.value[point][axis] = s[axis];
    slip.shear[point][axis] = r.shear[axis];
  }
}

} // namespace cdem
