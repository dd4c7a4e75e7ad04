// Bodies in still water and in streams, and what acts on them.
#pragma once

#include "libcdem/load/resolve.hpp"
#include "libcdem/water/plain_water.hpp"
#include "tests/libcdem/system.hpp"

namespace testing {

inline constexpr double sea_density = 1025, sea_weight = 1025 * 9.81; // kg/m3, N/m3

inline cdem::UniformWater still(double level) {
  cdem::UniformWater water;
  water.velocity = [](double) { return geom::Vec3(0, 0, 0); };
  water.level = level;
  return water;
}

inline cdem::Flow in_water(std::shared_ptr<const cdem::WaterField> water, double drag = 1,
                           double added_mass = 0) {
  cdem::Flow flow;
  flow.water = std::move(water);
  flow.drag = drag;
  flow.added_mass = added_mass;
  flow.new_faces = true;
  return flow;
}

struct Wrench {
  geom::Vec3 force = geom::Vec3::Zero(), moment = geom::Vec3::Zero(); // N; N m about the origin
};

inline Wrench wrench(const System& s) {
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, s.state.time, &s.state.velocity);
  Wrench sum;
  for (std::size_t i = 0; i < r.external.size(); ++i) {
    sum.force += vec(r.external[i]);
    sum.moment += cdem::place_of(s.model, s.state, static_cast<int>(i)).cross(vec(r.external[i]));
  }
  return sum;
}

inline std::shared_ptr<const cdem::WaterField> stream(const geom::Vec3& velocity,
                                                      const geom::Vec3& acceleration = geom::Vec3::Zero()) {
  cdem::UniformWater water;
  water.velocity = [=](double t) { return geom::Vec3(velocity + (t - 1) * acceleration); };
  return cdem::uniform_water(water);
}

} // namespace testing
