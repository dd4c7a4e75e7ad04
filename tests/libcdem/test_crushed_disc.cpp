// A disc with springs that two plates crush: it cracks into pieces of many tetrahedra and into single ones. The work that is skipped
// in search and contacts changes no bit.
#include "tests/libcdem/boxes.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/step/workspace.hpp"
#include "libgeom/meshing/solid_mesh.hpp"

#include <algorithm>

using namespace testing;

namespace {

constexpr double radius = 0.05, thickness = 0.025; // m

cdem::ModelSpec between_plates(double size, double turn, cdem::BondKind kind = cdem::BondKind::springs) {
  cdem::Joint weak = rock_joint();
  weak.tensile_strength = 4e6;
  weak.cohesion = 8e6;
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  everywhere.kind = kind;
  geom::MeshSize of_mesh;
  of_mesh.size = size;
  const geom::Solid disc = geom::rotated(geom::cylinder({0, -0.5 * thickness, 0}, {0, thickness, 0}, radius),
                                         {0, 1, 0}, turn, {0, 0, 0});
  geom::TetMesh mesh = geom::mesh_solid(disc, of_mesh);
  double top = 0, bottom = 0;
  for (const geom::Vec3& x : mesh.nodes) {
    top = std::max(top, x.z());
    bottom = std::min(bottom, x.z());
  }
  const auto plate = [](double from) {
    geom::TetMesh box = geom::box_mesh({2 * radius, 2 * radius, 0.2 * radius}, {4, 4, 1});
    for (geom::Vec3& x : box.nodes)
      x += geom::Vec3(-radius, -radius, from);
    return box;
  };
  cdem::ModelSpec spec;
  spec.bodies = {meshed("disc", std::move(mesh), everywhere, rock(), weak),
                 meshed("lower", plate(bottom - 0.2 * radius), {}, rock()),
                 meshed("upper", plate(top), {}, rock())};
  spec.bodies[1].element = spec.bodies[2].element = cdem::Element::rigid;
  spec.pairs = {
      {"disc", "disc", friction(23)}, {"disc", "lower", friction(23)}, {"disc", "upper", friction(23)}};
  return spec;
}

struct Outcome {
  std::vector<std::uint64_t> hashes; // after each stage
  std::int64_t broken = 0;
  std::size_t contacts = 0;
};

System with_moving_plates(const cdem::ModelSpec& spec) {
  System s(cdem::first_model(spec));
  for (const bool lower : {true, false}) {
    cdem::Fix plate;
    plate.on = body_of(lower ? "lower" : "upper");
    plate.velocity = geom::Vec3(0, 0, lower ? 0.5 : -0.5);
    s.conditions.fixes.push_back(plate);
  }
  return s;
}

// looks_from: the first stage in which all contacts are looked at, if any.
Outcome crush(const cdem::ModelSpec& spec, int looks_from, int stages, int steps) {
  System s = with_moving_plates(spec);
  Outcome outcome;
  for (int stage = 0; stage < stages; ++stage) {
    cdem::RunOptions options;
    options.steps = steps;
    options.looks_at_all_contacts = stage >= looks_from;
    s.run(options);
    outcome.hashes.push_back(cdem::hash(s.state));
  }
  outcome.broken = static_cast<std::int64_t>(s.log.breaks.size());
  outcome.contacts = s.state.contacts.size();
  return outcome;
}

void check_same(const Outcome& all, const Outcome& skipped) {
  for (std::size_t stage = 0; stage < all.hashes.size(); ++stage) {
    INFO("stage " << stage);
    CHECK(skipped.hashes[stage] == all.hashes[stage]);
  }
}

} // namespace

TEST_CASE("crushed disc: what is skipped changes no bit", "[contact][fracture]") {
  const cdem::ModelSpec spec = between_plates(0.0117, 0.1);
  const Outcome all = crush(spec, 0, 6, 400), skipped = crush(spec, 6, 6, 400);
  INFO("tets " << cdem::first_model(spec).tets.size() << " broken " << all.broken << " contacts "
               << all.contacts << " and " << skipped.contacts);
  CHECK(all.broken > 500);
  check_same(all, skipped);
}

TEST_CASE("crushed disc: what is skipped changes no bit where cracks end in pieces", "[contact][fracture]") {
  const cdem::ModelSpec spec = between_plates(0.013, 0.4);
  const Outcome all = crush(spec, 8, 9, 400), skipped = crush(spec, 9, 9, 400);
  INFO("broken " << all.broken << " contacts " << all.contacts << " and " << skipped.contacts);
  CHECK(all.broken > 1000);
  check_same(all, skipped);
}

TEST_CASE("crushed disc: what is skipped changes no bit of a cohesive disc",
          "[contact][cohesive][fracture]") {
  const cdem::ModelSpec spec = between_plates(0.013, 0.1, cdem::BondKind::cohesive);
  const Outcome all = crush(spec, 0, 6, 400), skipped = crush(spec, 6, 6, 400);
  INFO("broken " << all.broken << " contacts " << all.contacts << " and " << skipped.contacts);
  CHECK(all.broken > 200);
  check_same(all, skipped);
}

TEST_CASE("crushed disc: pairs of tetrahedra are not found again where nodes are freed",
          "[contact][cohesive][fracture]") {
  System s = with_moving_plates(between_plates(0.013, 0.1, cdem::BondKind::cohesive));
  cdem::RunOptions options;
  options.steps = 2400;
  s.run(options);
  cdem::Workspace before(s.model, s.state, {});
  cdem::contact_forces(s.model, s.state, before.contact, 1);
  REQUIRE(before.contact.tet_contacts);
  std::vector<char> disc(s.model.node_position.size(), 0);
  std::fill(disc.begin() + s.model.blocks[0].node_begin, disc.begin() + s.model.blocks[0].node_end, 1);
  const cdem::Freed freed = cdem::split_nodes(s.model, s.state, disc);
  REQUIRE(freed.model.node_position.size() > s.model.node_position.size());

  cdem::Workspace known(freed.model, freed.state, {}), anew(freed.model, freed.state, {});
  cdem::State with_known = freed.state, with_anew = freed.state;
  cdem::take_tet_pairs(freed.model, freed.state, before.contact.tet_contacts, known.contact);
  cdem::contact_forces(freed.model, with_known, known.contact, 1);
  cdem::contact_forces(freed.model, with_anew, anew.contact, 1);
  CHECK(known.contact.tet_contacts == before.contact.tet_contacts);
  CHECK(cdem::hash(with_known) == cdem::hash(with_anew));
  const std::vector<cdem::Node>&of_known = known.contact.loads.force, &of_anew = anew.contact.loads.force;
  REQUIRE(of_known.size() == of_anew.size());
  double largest = 0;
  for (std::size_t i = 0; i < of_known.size(); ++i) {
    const cdem::Node &a = of_known[i], &b = of_anew[i];
    largest = std::max(largest, std::abs(a.x));
    REQUIRE((a.x == b.x && a.y == b.y && a.z == b.z));
  }
  CHECK(largest > 0);
}
