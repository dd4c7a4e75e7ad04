// Size and motion of fragments: those of rigid bodies in flight are known, and the sums over fragments are the model's.
#include "libcdem/bond/fragments.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/results/fragment_motions.hpp"
#include "libcdem/results/fragments.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

struct Warnings final : cdem::Observer {
  std::vector<std::string> lines;
  void warning(const std::string& line) override { lines.push_back(line); }
};

std::vector<cdem::FragmentMotion> motions(const System& s) {
  return cdem::fragment_motions(s.model, s.state, cdem::resolve(s.model, s.state, s.conditions));
}

} // namespace

TEST_CASE("fragments: a body that flies and spins has the momenta and energies of a rigid one",
          "[fragments]") {
  const Vec3 size(0.2, 0.3, 0.4), velocity(3, -2, 1), spin(20, -10, 5);
  System s(build({meshed("small", box_at({0.1, 0.1, 0.1}, {2, 2, 2}, geom::Mat3::Identity(), {2, 0, 0})),
                  meshed("box", box_at(size, {4, 6, 8}, rotation({1, 2, 3}, 0.5), {0, 1, 0}))}));
  for (int i = s.model.blocks[1].node_begin; i < s.model.blocks[1].node_end; ++i)
    s.state.velocity[i] = node(velocity + spin.cross(s.model.node_position[i] - Vec3(0, 1, 0)));
  const auto list = motions(s);
  REQUIRE(list.size() == 2);
  const cdem::FragmentMotion& f = list[0]; // the larger one
  const double volume = size.prod(), mass = rock().density * volume;
  CHECK(f.body == 1);
  CHECK(f.volume == Approx(volume));
  CHECK(f.diameter == Approx(std::cbrt(6 * volume / pi)));
  CHECK(f.mass == Approx(mass));
  // Each tetrahedron's mass stands at its corners: the same centroid.
  CHECK((f.centre - Vec3(0, 1, 0)).norm() < 1e-9);
  CHECK((f.momentum - mass * velocity).norm() < 1e-9 * f.momentum.norm());
  CHECK(f.translation == Approx(0.5 * mass * velocity.squaredNorm()));
  CHECK(f.rotation == Approx(0.5 * spin.dot(f.angular_momentum)));
  CHECK(std::abs(f.rest()) < 1e-9 * f.kinetic);
  // Of the solid: m (b^2 + c^2) / 12 about its axes; masses at corners reach out further.
  const geom::Mat3 turn = rotation({1, 2, 3}, 0.5);
  const Vec3 moments =
      mass / 12 *
      Vec3(size.y() * size.y() + size.z() * size.z(), size.x() * size.x() + size.z() * size.z(),
           size.x() * size.x() + size.y() * size.y());
  const Vec3 angular = turn * moments.asDiagonal() * turn.transpose() * spin;
  CHECK((f.angular_momentum - angular).norm() < 0.1 * angular.norm());
  CHECK(list[1].kinetic == 0);
  CHECK(list[1].body == 0);
}

TEST_CASE("fragments: a breathing body has a rest and neither translation nor rotation", "[fragments]") {
  System s(build({meshed("box", box_at({0.2, 0.3, 0.4}, {2, 3, 4}, geom::Mat3::Identity(), {1, 1, 1}))}));
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node(0.1 * (s.model.node_position[i] - Vec3(1, 1, 1)));
  const cdem::FragmentMotion f = motions(s)[0];
  CHECK(f.kinetic > 0);
  CHECK(f.rest() == Approx(f.kinetic).epsilon(1e-9));
}

TEST_CASE("fragments: those of a body that shatters share its mass, momenta and energy",
          "[fragments][bonds]") {
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  cdem::Joint weak = rock_joint();
  weak.cohesion = weak.tensile_strength = 1e5;
  weak.friction_angle = 0;
  System s(build({meshed("box", box_at({0.4, 0.4, 0.4}, {3, 3, 3}, geom::Mat3::Identity(), {3, 2, 1}),
                         everywhere, rock(), weak)}));
  const Vec3 middle(3, 2, 1), spin(5, 3, -2);
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) {
    const Vec3 from = s.model.node_position[i] - middle;
    s.state.velocity[i] = node(Vec3(1, 2, 3) + spin.cross(from) + Vec3(4 * from.x(), from.y(), 0));
  }
  const Momentum before = momentum(s, Places::present);
  cdem::RunOptions options;
  options.steps = 400;
  s.run(options);
  const auto list = motions(s);
  REQUIRE(list.size() > 3);
  double volume = 0, mass = 0, kinetic = 0;
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  std::int64_t tets = 0;
  for (const cdem::FragmentMotion& f : list) {
    volume += f.volume;
    mass += f.mass;
    kinetic += f.kinetic;
    linear += f.momentum;
    angular += f.angular_momentum + f.centre.cross(f.momentum);
    tets += f.tets;
    CHECK(f.translation + f.rotation <= f.kinetic * (1 + 1e-12));
  }
  CHECK(tets == static_cast<std::int64_t>(s.model.tets.size()));
  CHECK(volume == Approx(0.064));
  CHECK(mass == Approx(0.064 * rock().density));
  CHECK(kinetic == Approx(cdem::kinetic_energy(s.model, s.state)).epsilon(1e-12));
  CHECK((linear - before.linear).norm() < 1e-9 * before.linear.norm());
  CHECK((angular - before.angular).norm() < 1e-6 * before.angular.norm());
  CHECK(list.size() == [&] {
    const auto pieces = cdem::fragments_of_nodes(s.model, s.state);
    std::size_t n = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      n += pieces[i] == static_cast<int>(i);
    return n;
  }());
}

TEST_CASE("fragments: those of broken bodies are ranked by volume, a body in one piece is left out",
          "[fragments]") {
  const geom::Mat3 unturned = geom::Mat3::Identity();
  geom::TetMesh stones = box_at({0.1, 0.1, 0.1}, {1, 1, 1}, unturned, {0, 0, 0});
  const geom::TetMesh larger = box_at({0.2, 0.2, 0.2}, {1, 1, 1}, unturned, {1, 0, 0});
  const int first = static_cast<int>(stones.nodes.size());
  stones.nodes.insert(stones.nodes.end(), larger.nodes.begin(), larger.nodes.end());
  for (geom::Tet tet : larger.tets) {
    for (int& node : tet)
      node += first;
    stones.tets.push_back(tet);
  }
  stones.region.assign(stones.tets.size(), 0);
  System s(
      build({meshed("floor", box_at({2, 2, 1}, {2, 2, 1}, unturned, {0, 0, -5})), meshed("stones", stones)}));
  const std::vector<int> rank = cdem::fragment_ranks(s.model, s.state);
  REQUIRE(rank.size() == s.model.node_position.size());
  for (std::size_t node = 0; node < rank.size(); ++node) {
    const Vec3& x = s.model.node_position[node];
    CHECK(rank[node] == (x.z() < -1 ? 0 : x.x() > 0.5 ? 1 : 2));
  }
}

TEST_CASE("fragments: rigid bodies count with their own mass and inertia", "[fragments][rigid]") {
  const Vec3 size(0.2, 0.3, 0.4), velocity(1, 2, 3), spin(4, -3, 2);
  cdem::ModelSpec spec;
  spec.bodies = {meshed("box", box_at(size, {6, 9, 12}, geom::Mat3::Identity(), Vec3::Zero()))};
  cdem::Simulation s(spec, 1, nullptr);
  s.make_rigid(cdem::Selection::everything());
  s.initial_velocity(cdem::Selection::everything(), velocity, spin);
  const cdem::FragmentMotion f = s.fragment_motions()[0];
  const double mass = rock().density * size.prod();
  const Vec3 moments =
      mass / 12 *
      Vec3(size.y() * size.y() + size.z() * size.z(), size.x() * size.x() + size.z() * size.z(),
           size.x() * size.x() + size.y() * size.y());
  CHECK(f.mass == Approx(mass));
  CHECK(f.translation == Approx(0.5 * mass * velocity.squaredNorm()));
  CHECK(f.kinetic == Approx(s.energy().kinetic));
  CHECK(std::abs(f.rest()) < 1e-9 * f.kinetic);
  CHECK((f.angular_momentum - moments.cwiseProduct(spin)).norm() < 0.05 * f.angular_momentum.norm());
}

TEST_CASE("fragments: a broken body that turns rigid is one until it is deformable again",
          "[fragments][rigid][bonds]") {
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  everywhere.kind = GENERATE(cdem::BondKind::springs, cdem::BondKind::cohesive);
  cdem::ModelSpec spec;
  spec.bodies = {meshed("box", geom::box_mesh({0.6, 0.15, 0.15}, {4, 1, 1}), everywhere)};
  const auto listener = std::make_shared<Warnings>();
  cdem::Simulation s(spec, 1, listener);
  s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0.3, 0, 0}, {1, 0, 0})));
  s.initial_velocity(cdem::Selection::everything(), {1, 0, 0}, {0, 0, 10});
  REQUIRE(s.fragments().size() == 2);
  REQUIRE(s.fragment_motions().size() == 2);
  s.make_rigid(cdem::Selection::everything());
  REQUIRE(listener->lines.size() == 1);
  CHECK_THAT(listener->lines[0], Catch::Contains("broken into 2 pieces"));
  CHECK(s.fragments().size() == 1);
  const auto list = s.fragment_motions();
  REQUIRE(list.size() == 1);
  CHECK(list[0].mass == Approx(rock().density * 0.6 * 0.15 * 0.15));
  CHECK(list[0].momentum.x() == Approx(list[0].mass));
  CHECK(list[0].kinetic == Approx(s.energy().kinetic));
  s.make_deformable(cdem::Selection::everything());
  CHECK(s.fragment_motions().size() == 2);
}

TEST_CASE("fragments: the mass that passes grows with the size to all of it", "[fragments]") {
  System s(build({meshed("a", box_at({0.1, 0.1, 0.1}, {1, 1, 1}, geom::Mat3::Identity(), {0, 0, 0})),
                  meshed("b", box_at({0.2, 0.2, 0.2}, {1, 1, 1}, geom::Mat3::Identity(), {1, 0, 0})),
                  meshed("c", box_at({0.3, 0.3, 0.3}, {1, 1, 1}, geom::Mat3::Identity(), {2, 0, 0}))}));
  const auto rows = cdem::mass_passing(motions(s));
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].diameter == Approx(0.1 * std::cbrt(6 / pi)));
  CHECK(rows[0].passing == Approx(1.0 / 36));
  CHECK(rows[1].passing == Approx(9.0 / 36));
  CHECK(rows[2].passing == Approx(1));
}
