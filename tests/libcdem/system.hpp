// A model with its state and conditions, open to the tests: what Simulation holds behind its door.
#pragma once

#include "libcdem/procedure/relax.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/simulation.hpp"
#include "libcdem/state/places.hpp"

namespace testing {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double degree = pi / 180;

// Granite-like, as in Han 2010 example 4.1.
cdem::Elastic rock();
cdem::Joint rock_joint();

cdem::BodySpec body(std::string name, geom::Assembly shape, const cdem::Elastic& = rock(),
                    const cdem::Joint& = rock_joint());
cdem::BodySpec meshed(std::string name, geom::TetMesh, const cdem::Bonding& = {},
                      const cdem::Elastic& = rock(), const cdem::Joint& = rock_joint());
cdem::Simulation simulation(geom::Assembly, const cdem::Elastic& = rock(), const cdem::Joint& = rock_joint(),
                            std::shared_ptr<cdem::Observer> = nullptr);
// A meshed column of 0.3 x 0.3 x 0.8 m on its foot, bonded everywhere, weak.
cdem::Simulation bonded_column(const std::array<int, 3>& divisions, int threads,
                               std::shared_ptr<cdem::Observer>);
// Units that gravity draws to a rigid floor, with friction of 35 degrees on it and on each other.
cdem::Simulation units_over_floor(geom::TetMesh floor, std::vector<geom::TetMesh> units, const cdem::Elastic&,
                                  int threads, std::shared_ptr<cdem::Observer>);
cdem::Model build(const std::vector<cdem::BodySpec>&, const std::vector<cdem::PairSpec>& = {});

geom::Vec3 centre(const cdem::Model&, const cdem::OuterFace&); // undeformed, m

// The place x to rounding, for conditions on single nodes and faces.
cdem::Selection at_place(const geom::Vec3& x);
std::array<bool, 3> axes(const std::string& names); // "xz" -> {true, false, true}

// Conditions.
cdem::Fix fixed(const cdem::Selection& on, const std::string& names = "xyz"); // where it is now
cdem::Traction traction(const cdem::Selection& on, const geom::Vec3& stress); // Pa
std::vector<cdem::Traction> on_six_sides(const geom::Mat3& stress);           // of a box
cdem::Gravity gravity(const geom::Vec3& acceleration = {0, 0, -9.81});        // m/s2

struct System {
  explicit System(cdem::Model);

  cdem::StageContext next_stage();
  cdem::RelaxResult relax(double residual, bool breaking = false);
  cdem::RunResult run(const cdem::RunOptions&);
  void hold(const cdem::Selection&, const std::string& names); // fixes where it is now
  void load_all_faces(const geom::Mat3& stress);               // traction stress . n on every outer face
  void adopt(cdem::Model&&, cdem::State&&);

  // Net force on each node with the conditions of now, N.
  std::vector<geom::Vec3> net_forces() const;
  // The same with the springs of meshes advanced in `state`, bonds breaking; what broke is added to `broken`.
  std::vector<geom::Vec3> advance_springs(std::vector<cdem::FaceBreak>& broken);
  // Norm of the net force on the free components over that of the loads (of the reactions when there are
  // none).
  double out_of_balance() const;

  cdem::Model model;
  cdem::State state, last_good;
  cdem::Conditions conditions;
  cdem::RunLog log;
  cdem::Observer observer;
  int threads = 1, stage = 0;
};

// Of all nodes, about the origin.
struct Momentum {
  geom::Vec3 linear = geom::Vec3::Zero(), angular = geom::Vec3::Zero(); // N s, N m s
};
enum class Places { undeformed, present }; // small strain refers to the first, finite volumes to the second
Momentum momentum(const System&, Places);

using cdem::node;
using cdem::vec;

// sigma = lambda tr(eps) I + 2 G eps, Pa.
geom::Mat3 hooke(const cdem::Elastic&, const geom::Mat3& gradient);
geom::Mat3 tet_stress(const System&, int tet); // initial stress included

// Largest deviation of any tet's stress from `expected`, and of any spring's traction from expected . n (its
// sign that of tension), over the norm of `expected`.
double stress_error(const System&, const geom::Mat3& expected);
double traction_error(const System&, const geom::Mat3& expected);

geom::Mat3 symmetric(double xx, double yy, double zz, double xy, double yz, double xz);
geom::Mat3 rotation(const geom::Vec3& axis, double angle);

} // namespace testing
