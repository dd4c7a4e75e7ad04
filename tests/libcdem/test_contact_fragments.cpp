// Contact of the pieces of a body that broke.
#include "libcdem/results/energy.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;

namespace {

// Two halves glued weakly hit the floor on the lower one's edge; the glue breaks and they fall over each other.
System glued_halves() {
  geom::TetMesh mesh = geom::box_mesh({0.4, 0.4, 0.8}, {2, 2, 4});
  mesh.region.clear();
  for (const geom::Tet& tet : mesh.tets) {
    double z = 0;
    for (const int node : tet)
      z += mesh.nodes[node].z() / 4;
    mesh.region.push_back(z > 0.4 ? 1 : 0);
  }
  cdem::Bonding between;
  between.between_regions = true;
  cdem::Joint glue = rock_joint();
  glue.cohesion = glue.tensile_strength = 1e5;
  cdem::Elastic soft = rock();
  soft.youngs_modulus = 5e8;
  System s(build({meshed("floor", box_at({4, 4, 0.4}, {4, 4, 1}, Mat3::Identity(), {0, 0, -0.2}), {}, soft),
                  meshed("unit", placed(mesh, rotation({1, 1, 0}, 0.5), {0, 0, 0.35}), between, soft, glue)},
                 {{"floor", "unit", friction(30)}, {"unit", "unit", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 1)
      s.state.velocity[i] = node({0, 0, -3});
  return s;
}

} // namespace

TEST_CASE("contact: who looks at the pieces of a broken body changes no bit of them", "[contact][fracture]") {
  const auto hash_with = [](std::int64_t callback_every) {
    System s = glued_halves();
    cdem::RunOptions options;
    options.duration = 0.25;
    options.callback_every = callback_every;
    if (callback_every > 0)
      options.callback = [] {};
    s.run(options);
    int handed = 0;
    for (const cdem::FaceStateBatch& faces : s.state.faces)
      handed += static_cast<int>(std::count(std::begin(faces.handed_over), std::end(faces.handed_over), 1));
    CHECK(handed > 0);
    return cdem::hash(s.state);
  };
  const auto unseen = hash_with(0);
  CHECK(hash_with(1) == unseen);
  CHECK(hash_with(7) == unseen);
}

TEST_CASE("contact: the pieces of a broken body meet, and nothing blows up", "[contact][fracture]") {
  System s = glued_halves();
  const double kinetic = 0.5 * 0.4 * 0.4 * 0.8 * rock().density * 9;
  bool pieces_met = false;
  cdem::RunOptions options;
  options.duration = 0.5;
  options.callback_every = 50;
  options.callback = [&] {
    for (const cdem::Contact& c : s.state.contacts) {
      const auto [a, b] = cdem::blocks_of(s.model, c);
      pieces_met = pieces_met || (a == 1 && b == 1 && c.effective_penetration() > 0);
    }
  };
  s.run(options);
  CHECK(pieces_met);
  int handed = 0;
  for (const cdem::FaceStateBatch& faces : s.state.faces)
    for (const std::uint8_t flag : faces.handed_over)
      handed += flag;
  CHECK(handed == 8); // all triangles of the glue
  const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
  INFO("friction " << ledger.friction << " breaking " << ledger.breaking << " kinetic " << ledger.kinetic);
  CHECK(std::abs(ledger.total() - kinetic - ledger.external) < 0.02 * kinetic);
}
