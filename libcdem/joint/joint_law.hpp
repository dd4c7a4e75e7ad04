// Laws of joints between blocks beyond linear springs, Mohr-Coulomb and its softening: the list of them, and the response of
// a spring that is broken or never was bonded. joint/joint_spring.hpp says what a law is; to add one, write it in a header
// of its own, put it into the list, and declare its fields in lua/binding/functions/joint_laws.cpp.
//
// With the elastic relative displacement e = j - o the closure is -e_n and the elastic shear e_s. If the trial shear
// exceeds the strength, the spring slips by x in the direction of the trial,
//
//   k_s (|e_s| - x) = strength(p(x), path + x),    p(x) the pressure after the rise of the slip x
//
// A pressure P beside which friction feels only N (joint/spring_law.hpp) bears strength(N) + (P - N) tan(psi), with the dilation
// angle psi under N: what lifts the faces acts at once. So slip takes strength(N) - N tan(psi), which is never below 0.
//
// The slip is added to o_s, the rise to o_n. Faces that are apart carry no traction. There o_s follows their relative
// displacement, and o_n the rise without pressure until they touch: their asperities have moved past each other all the
// same.
#pragma once

#include "libcdem/joint/barton_bandis.hpp"
#include "libcdem/joint/joint_table.hpp"
#include "libcdem/joint/residual_strength.hpp"

#include <variant>

namespace cdem {

// The first: none, the spring is that of joint/spring_law.hpp.
using JointLaw = std::variant<std::monostate, ResidualStrength, BartonBandis, JointTable>;

inline bool has_law(const JointLaw& law) {
  return law.index() != 0;
}

// visit(law) of the law there is; nothing where there is none.
template <class Visit>
auto with_law(const JointLaw& law, const Visit& visit) {
  using Result = decltype(visit(std::declval<const ResidualStrength&>()));
  return std::visit(
      [&](const auto& own) -> Result {
        if constexpr (std::is_same_v<std::decay_t<decltype(own)>, std::monostate>)
          return Result();
        else
          return visit(own);
      },
      law);
}

struct JointResponse {
  geom::Vec3 traction = geom::Vec3::Zero(); // Pa, pulls a towards b when along the normal
  geom::Vec3 offset = geom::Vec3::Zero();   // m, new o
  JointHistory history;
};

// Pa, beside the pressure of the spring itself. viscous: of a dashpot; unfelt: what friction does not feel of the two
// (joint/spring_law.hpp).
struct BesidePressure {
  double viscous = 0, unfelt = 0;
};

namespace joint_law {

// Traction at this opening of the faces, Pa, pressure positive.
template <class Law>
double pressure_at(const Law& law, const JointSpring& spring, double open, double parted) {
  return open > 0 ? -law.pull(spring, open, parted) : law.pressure(spring, -open);
}

// m, dilation after the slip has gone from `before` to `after`.
template <class Law>
double dilation_after(const Law& law, const JointSpring& spring, const JointHistory& h, double pressure,
                      double before, double after) {
  if (after >= before)
    return h.dilation + law.rise(spring, pressure, h.path, before, after);
  return h.dilation * after / before;
}

constexpr int most_trials = 60;
constexpr double close_enough = 1e-12; // of the trial

// The zero of f, which is above 0 at `low` and not above it at `high`, near to `first` (false position, Illinois).
template <class F>
double zero_of(const F& f, double low, double high, double f_low, double first, double tolerance) {
  double f_high = 0, x = first;
  bool high_known = false;
  int side = 0;
  for (int i = 0; i < most_trials; ++i) {
    const double y = f(x);
    if (std::abs(y) <= tolerance)
      return x;
    if (y > 0) {
      low = x;
      f_low = y;
      if (side == 1)
        f_high *= 0.5;
      side = 1;
    } else {
      high = x;
      f_high = y;
      high_known = true;
      if (side == -1)
        f_low *= 0.5;
      side = -1;
    }
    if (!high_known) {
      f_high = f(high);
      high_known = true;
    }
    const double next = f_high == f_low ? low : low + (high - low) * f_low / (f_low - f_high);
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

template <class Law>
JointResponse response(const Law& law, const JointSpring& spring, const geom::Vec3& normal,
                       const geom::Vec3& jump, const geom::Vec3& offset, const JointHistory& history,
                       const BesidePressure& beside) {
  JointResponse r{geom::Vec3::Zero(), offset, history};
  const geom::Vec3 stretch = jump - offset;
  const double open = stretch.dot(normal);
  const geom::Vec3 shear = stretch - open * normal;
  if (open > 0) {
    r.history.parted = std::max(history.parted, open);
    if (!(law.pull(spring, open, r.history.parted) > 0)) {
      const double before = history.slip.norm();
      r.history.slip += shear;
      const double rise = std::min(
          open, dilation_after(law, spring, history, 0, before, r.history.slip.norm()) - history.dilation);
      r.history.dilation += rise;
      r.offset += shear + rise * normal;
      return r;
    }
  }
  const double pressure = pressure_at(law, spring, open, r.history.parted), length = shear.norm(),
               trial = spring.ks * length;
  const double before = history.slip.norm();
  const auto felt = [&](double now) { return std::max(0.0, now + beside.viscous - beside.unfelt); };
  const auto rise_to = [&](const geom::Vec3& slip) {
    return dilation_after(law, spring, history, felt(pressure), before, slip.norm()) - history.dilation;
  };
  const double lifts =
      beside.unfelt == 0 || length == 0 ? 0 : beside.unfelt * rise_to(history.slip + shear) / length;
  const auto borne = [&](double now, double path) {
    return std::max(0.0, law.strength(spring, felt(now), path) + lifts);
  };
  const double beyond_now = trial - borne(pressure, history.path);
  if (!(beyond_now > 0)) {
    r.traction = -pressure * normal + spring.ks * shear;
    return r;
  }
  const geom::Vec3 along = shear / length;
  const auto rise_by = [&](double x) { return rise_to(history.slip + x * along); };
  const auto pressure_after = [&](double x) {
    return pressure_at(law, spring, open - rise_by(x), r.history.parted);
  };
  const auto beyond = [&](double x) {
    return spring.ks * (length - x) - borne(pressure_after(x), history.path + x);
  };
  const double slip = zero_of(beyond, 0, length, beyond_now, beyond_now / spring.ks, close_enough * trial);
  const double rise = rise_by(slip);
  r.history.slip += slip * along;
  r.history.path += slip;
  r.history.dilation += rise;
  r.offset += slip * along + rise * normal;
  r.traction = -pressure_after(slip) * normal + spring.ks * (length - slip) * along;
  return r;
}

template <class Law>
double stored(const Law& law, const JointSpring& spring, const geom::Vec3& normal, const geom::Vec3& stretch,
              double parted) {
  const double open = stretch.dot(normal);
  const geom::Vec3 shear = stretch - open * normal;
  if (open > 0 && !(law.pull(spring, open, parted) > 0))
    return 0;
  return 0.5 * spring.ks * shear.squaredNorm() +
         (open > 0 ? law.stored_pull(spring, open, parted) : law.stored(spring, -open));
}

} // namespace joint_law

// Response of a spring whose joint has a law, broken or never bonded.
inline JointResponse joint_response(const JointLaw& law, const JointSpring& spring, const geom::Vec3& normal,
                                    const geom::Vec3& jump, const geom::Vec3& offset,
                                    const JointHistory& history, const BesidePressure& beside = {}) {
  return with_law(law, [&](const auto& own) {
    return joint_law::response(own, spring, normal, jump, offset, history, beside);
  });
}

// J/m2, stretch: with the offset of the response.
inline double joint_stored(const JointLaw& law, const JointSpring& spring, const geom::Vec3& normal,
                           const geom::Vec3& stretch, double parted) {
  return with_law(law,
                  [&](const auto& own) { return joint_law::stored(own, spring, normal, stretch, parted); });
}

// Pa, of faces that are this far open, m; parted: JointHistory::parted.
inline double joint_pressure(const JointLaw& law, const JointSpring& spring, double open, double parted) {
  return with_law(law, [&](const auto& own) { return joint_law::pressure_at(own, spring, open, parted); });
}

inline double joint_strength(const JointLaw& law, const JointSpring& spring, double pressure, double path) {
  return with_law(law, [&](const auto& own) { return own.strength(spring, pressure, path); });
}

} // namespace cdem
