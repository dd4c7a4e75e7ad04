// Supports and loads as the user states them. They refer to places, not to nodes, so they survive cutting.
#pragma once

#include "libcdem/bolt/bolt.hpp"
#include "libcdem/model/selection.hpp"
#include "libcdem/water/water_field.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <optional>

namespace cdem {

class WaterTable; // load/water_table.hpp

// Factor over time (s; pseudo-time in a relaxation, where it is evaluated once at the start); empty means 1.
using Amplitude = std::function<double(double time)>;

struct Fix {
  Selection on;
  std::array<bool, 3> axes{true, true, true};
  bool release = false; // sets the components free instead; later ones win over earlier ones
  // m, total value; a relaxation moves there in its first steps, a run at a steady velocity until its end
  std::optional<geom::Vec3> displacement = {};
  std::optional<geom::Vec3> velocity = {}; // m/s, in real-time stepping; zero when not given
  Amplitude amplitude = {};                // of the velocity
};

// Adds a fix. Earlier ones that it overrules altogether are dropped: a script may hold a place anew in every stage.
void add_fix(std::vector<Fix>& fixes, const Fix& fix);

// Pressure on outer faces, along their inward normals (load/face_pressure.hpp).
struct FacePressure {
  std::optional<double> level; // m, z of a free water surface: p = weight (level - z) below it
  double weight = 9810;        // N/m3
  std::function<double(const geom::Vec3&)> pressure; // Pa, at undeformed places; without level and table
  std::shared_ptr<const WaterTable> table{}; // in place of the level: p = weight times the depth below it
};

struct Traction {
  Selection on;
  geom::Vec3 stress = geom::Vec3::Zero(); // Pa, force over undeformed area, not following the surface
  Amplitude amplitude;
  std::optional<FacePressure> pressure{}; // in place of the stress
};

struct PointForce {
  Selection on;                          // nodes; shared in proportion to the volume around each
  geom::Vec3 force = geom::Vec3::Zero(); // N, total
  Amplitude amplitude;
};

struct Gravity {
  geom::Vec3 acceleration = geom::Vec3::Zero(); // m/s2
  double water_density = 0;                     // kg/m3; takes from the weight, never from the inertia
  Amplitude amplitude = {};
  // m/s2, in place of the acceleration; evaluated as an amplitude is. Empty: it keeps its direction.
  std::function<geom::Vec3(double time)> turning = {};
};

// Dashpots on outer faces that let waves out (load/quiet.hpp), and a plane wave that enters through them.
struct Quiet {
  Selection on;
  geom::Vec3 velocity = geom::Vec3::Zero(); // m/s, particle velocity of the entering wave alone
  geom::Vec3 stress = geom::Vec3::Zero();   // Pa, traction of the entering wave alone on these faces
  Amplitude amplitude;
};

// Dashpots on a vertical side of the model towards a column of rock that moves as if the model were not there
// (load/free_field.hpp).
struct FreeField {
  Selection on; // one of x-, x+, y-, y+
};

// Pressure of a steady stream on what faces it (Feng 2014 eqs 19-20): traction alpha F along the flow, alpha = d . n
// with n the inward normal of an outer face where it stands now, F = rho V^2 / 2; none where alpha <= 0. The paper's
// surface is at rest. One that moves at v meets the water at u = V d - v, and where the flow is `relative` this u takes
// the place of V d: traction rho/2 (u . n)+ u, which is the paper's at v = 0. Shielding by other bodies, or by other parts
// of the same one, is not modelled.
struct Flow {
  std::vector<Selection> on{Selection::everything()}; // outer faces of these places
  geom::Vec3 direction = geom::Vec3::Zero();          // d, made a unit vector
  double water_density = 1025;                        // kg/m3; the paper gives none, this is sea water
  std::function<double(double time)> velocity;        // V, m/s, >= 0
  bool new_faces = false; // faces opened inside bodies take it too (load/opened_faces.hpp)
  bool relative = true;   // to the velocity of the surface, in real-time stepping
  // A field of water in place of direction, density and velocity (load/water_forces.hpp); always relative.
  std::shared_ptr<const WaterField> water;
  double drag = 1; // C_D of a convex body: scales the traction, which integrates to 1 over its silhouette
  double added_mass = 0; // C_A = C_M - 1, of the volume under water

  std::string places() const; // for messages
};

// Pressure of a gas or a fluid on the faces of cracks (load/crack_pressure.hpp): given over time, or by a pumped volume.
struct CrackPressure {
  Selection on;            // faces of cohesive bodies, by their undeformed centroid
  Amplitude pressure;      // Pa, >= 0
  Amplitude volume;        // m3, pumped in until then; empty: the pressure is given
  double bulk_modulus = 0; // K, Pa, > 0; of the fluid
  double reservoir = 0;    // V_0, m3, > 0; what it fills beside the cracks
};

inline double flow_pressure(double velocity, double water_density) { // F, Pa
  return 0.5 * water_density * velocity * velocity;
}
inline double flow_velocity(double pressure, double water_density) { // V, m/s
  return std::sqrt(2 * pressure / water_density);
}

// The table of water that stands in joints (load/water.hpp), for pictures: its pressure is part of the State.
struct StillWater {
  Selection on;
  std::vector<std::string> sets;             // of joints; empty: all
  std::optional<double> level;               // m, z
  std::shared_ptr<const WaterTable> table{}; // in place of the level
};

struct Conditions {
  std::vector<Fix> fixes;
  std::vector<Traction> tractions;
  std::vector<PointForce> forces;
  std::optional<Gravity> gravity;
  std::vector<Flow> flows;
  std::vector<CrackPressure> crack_pressures;
  std::vector<Quiet> quiets;
  std::vector<FreeField> free_fields;
  std::vector<Bolt> bolts;
  std::vector<StillWater> still_waters;

  bool load() const { return !tractions.empty() || !forces.empty() || gravity || !flows.empty(); }
};

} // namespace cdem
