// The motion of a rigid body as initial velocities: v(x) = v + w x (x - about).
//
// Velocities stand State::velocity_lag behind the places. w x (x - about) is therefore taken where the points were then,
// exp(-[w] lag) (x - about) from the point that they turn about; a rigid body gets the angular momentum of that moment.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

#include <string>

namespace cdem {

struct RigidMotion {
  geom::Vec3 velocity = geom::Vec3::Zero();         // v, m/s
  geom::Vec3 angular_velocity = geom::Vec3::Zero(); // w, rad/s
  geom::Vec3 about = geom::Vec3::Zero();            // m, where it is now
};

geom::Vec3 centroid_of(const Model&, const State&, const std::vector<int>& nodes); // m, where it is now

// The fixes hold every node in each direction in which that motion would move it.
bool fixes_stop(const std::vector<Fix>&, const Model&, const State&, const std::vector<int>& nodes,
                const RigidMotion&);

// Gives the nodes that motion; rigid bodies take it as a whole. Returns the kinetic energy that they gain, J. Throws
// geom::InputError when a part of a rigid body is among them; on: what the user selected.
double give_motion(const Model&, State&, const std::vector<int>& nodes, const RigidMotion&,
                   const std::string& on);

} // namespace cdem
