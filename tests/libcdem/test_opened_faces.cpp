// Water on faces inside bodies: between blocks whose joint has opened, and in cracks of a mesh.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "tests/libcdem/in_water.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

constexpr int slices = 3;
const Vec3 unit_size(0.9, 0.8, 1); // m, of three slices across x

int slice_of(const Vec3& place) {
  return std::min(slices - 1, static_cast<int>(slices * place.x() / unit_size.x()));
}

// Bonded between the slices, or all over.
System sliced_unit(bool everywhere = false) {
  geom::TetMesh mesh = geom::box_mesh(unit_size, {slices, 2, 2});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const int node : mesh.tets[t])
      middle += mesh.nodes[node] / 4;
    mesh.region[t] = slice_of(middle);
  }
  cdem::Bonding bonding;
  bonding.everywhere = everywhere;
  bonding.between_regions = !everywhere;
  return System(build({meshed("unit", mesh, bonding)}));
}

// Breaks the faces that `which` names by their number.
template <class Which>
void break_faces(System& s, const Which& which) {
  int face = 0;
  each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    if (which(face++))
      for (auto& point : s.state.faces[batch].mode)
        point[lane] = static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
  });
}

// The slice of each node (n_nodes).
std::vector<int> slices_of_nodes(const System& s) {
  std::vector<int> slice(s.model.node_position.size());
  for (std::size_t t = 0; t < s.model.tets.size(); ++t)
    for (const int node : s.model.tets[t])
      slice[node] = s.model.mesh.region[t];
  return slice;
}

std::vector<Vec3> forces_on_slices(System& s) {
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, s.state.time, &s.state.velocity);
  std::vector<Vec3> forces(slices, Vec3::Zero());
  const std::vector<int> slice = slices_of_nodes(s);
  for (std::size_t node = 0; node < slice.size(); ++node)
    forces[slice[node]] += vec(r.external[node]);
  return forces;
}

void place_slices(System& s, const std::function<Vec3(int slice, const Vec3&)>& place) {
  const std::vector<int> slice = slices_of_nodes(s);
  for (std::size_t i = 0; i < slice.size(); ++i) {
    const Vec3& x = s.model.node_position[i];
    s.state.displacement[i] = node(place(slice[i], x) - x);
  }
}

} // namespace

TEST_CASE("water reaches the faces between blocks that no bond holds together", "[water][flow]") {
  // Three blocks in a row, the middle one inside: each alone is carried by its own buoyancy.
  const bool rigid = GENERATE(false, true), two_bodies = GENERATE(false, true);
  CAPTURE(rigid, two_bodies);
  const Vec3 size(0.4, 0.5, 0.6);
  const cdem::Element element = rigid ? cdem::Element::rigid : cdem::Element::finite_volume;
  cdem::BodySpec one = body("one", geom::grid({1.2, 0.5, 0.6}, {3, 1, 1}));
  one.element = element;
  std::vector<cdem::BodySpec> bodies{one};
  std::vector<cdem::PairSpec> pairs;
  if (two_bodies) { // never bonded
    bodies[0].shape = geom::grid({0.8, 0.5, 0.6}, {2, 1, 1});
    cdem::BodySpec other = body("other", geom::grid(size, {1, 1, 1}, {0.8, 0, 0}));
    other.element = element;
    bodies.push_back(other);
    cdem::Joint dry;
    dry.bonded = false;
    pairs.push_back({"one", "other", dry});
  }
  System s(build(bodies, pairs));
  s.conditions.flows = {in_water(cdem::uniform_water(still(5)), 0)};
  const auto force_on = [&](int block) {
    cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
    cdem::update_external(r, s.state.time, &s.state.velocity);
    Vec3 sum = Vec3::Zero();
    for (int node = s.model.blocks[block].node_begin; node < s.model.blocks[block].node_end; ++node)
      sum += vec(r.external[node]);
    return sum;
  };
  const double one_side = sea_weight * 0.5 * 0.6 * (5 - 0.3); // N, on a face across the row
  const auto end = static_cast<int>(std::max_element(s.model.blocks.begin(), s.model.blocks.end(),
                                                     [](const cdem::Block& a, const cdem::Block& b) {
                                                       return a.mass.centroid.x() < b.mass.centroid.x();
                                                     }) -
                                    s.model.blocks.begin());
  CHECK(force_on(end).x() == Approx(two_bodies ? 0 : -one_side).margin(1e-9 * one_side));
  for (std::uint8_t& mode : s.state.bond_mode)
    mode = static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
  for (int b = 0; b < 3; ++b)
    CHECK((force_on(b) - sea_weight * 0.12 * Vec3::UnitZ()).norm() < 1e-9 * one_side);
  // Water in front of a row pushes it, whatever joints lie behind.
  s.conditions.flows[0].on = {cdem::Selection::side("x-")};
  CHECK((force_on(0) + force_on(1) + force_on(2)).x() == Approx(one_side));
  // A stream takes faces that have parted, when asked.
  cdem::Flow flow;
  flow.on = {cdem::Selection::of_body("one")};
  flow.direction = Vec3(-1, 0, 0);
  flow.velocity = [](double) { return 2.0; };
  flow.relative = false;
  const double push = cdem::flow_pressure(2, flow.water_density) * 0.3;
  for (const bool apart : {false, true}) {
    for (const cdem::Block& block : s.model.blocks)
      for (int node = block.node_begin; apart && node < block.node_end; ++node)
        s.state.displacement[node].x = 0.1 * block.mass.centroid.x();
    for (const bool new_faces : {false, true}) {
      flow.new_faces = new_faces;
      s.conditions.flows = {flow};
      const double sum = (force_on(0) + force_on(1) + force_on(2)).x();
      const int faces = apart && new_faces ? (two_bodies ? 2 : 3) : (two_bodies ? 0 : 1);
      CHECK(-sum == Approx(faces * push).margin(1e-9 * push));
    }
  }
}

TEST_CASE("a cracked unit takes a stream as a whole one does, until its pieces have parted",
          "[water][flow]") {
  const int kind = GENERATE(0, 1, 2); // a field of water, a flow relative to the surface, a flow
  CAPTURE(kind);
  const double speed = 2, push = cdem::flow_pressure(speed, sea_density) * unit_size.y() * unit_size.z();
  System s = sliced_unit();
  s.state.time = 1;
  if (kind == 0) {
    s.conditions.flows = {in_water(stream({speed, 0, 0}))};
  } else {
    cdem::Flow flow;
    flow.direction = Vec3::UnitX();
    flow.velocity = [=](double) { return speed; };
    flow.new_faces = true;
    flow.relative = kind == 1;
    s.conditions.flows = {flow};
  }
  const auto pushes = [&] {
    std::vector<double> x;
    for (const Vec3& force : forces_on_slices(s))
      x.push_back(force.x() / push);
    return x;
  };
  const double size = std::cbrt(unit_size.prod()), face = std::sqrt(unit_size.y() * unit_size.z() / 8);
  const auto move = [&](double apart, double along) {
    place_slices(s, [&](int slice, const Vec3& x) { return Vec3(x + slice * Vec3(apart, along, 0)); });
  };
  const auto check = [&](const std::vector<double>& expected) {
    const std::vector<double> found = pushes();
    for (int slice = 0; slice < slices; ++slice)
      CHECK(found[slice] == Approx(expected[slice]).margin(1e-12));
  };
  const std::vector<double> first_alone{1, 0, 0}, each{1, 1, 1};
  check(first_alone);
  break_faces(s, [](int) { return true; });
  check(first_alone);
  move(0.0099 * size, 0.9 * face); // narrow, also where it has slid
  check(first_alone);
  move(0.0101 * size, 0);
  check(each);
  move(0, 1.1 * face); // the sides no longer lie on each other
  check(each);
}

TEST_CASE("a cracked unit floats as Archimedes said, and so does each piece that has left", "[water]") {
  // Whatever faces are broken, with the cracks closed.
  const geom::Mat3 turn = rotation({1, -2, 0.5}, 33 * degree);
  const double level = 0.45;
  const auto wet = [&](geom::Polyhedron shape, const std::function<Vec3(const Vec3&)>& place) {
    for (Vec3& x : shape.vertices)
      x = place(x);
    const geom::Cut parts = geom::cut(shape, geom::Plane{Vec3::UnitZ(), level});
    if (!parts.below)
      return 0.0;
    return geom::mass_properties(parts.below->shape).volume;
  };
  const auto turned = [&](const Vec3& x) { return Vec3(turn * x); };
  for (const int every : {1, 2, 5}) {
    System s = sliced_unit(true);
    s.conditions.flows = {in_water(cdem::uniform_water(still(level)))};
    place_slices(s, [&](int, const Vec3& x) { return turned(x); });
    const Wrench whole = wrench(s);
    break_faces(s, [&](int face) { return face % every == 0; });
    const Wrench cracked = wrench(s);
    const double expected = sea_weight * wet(geom::grid(unit_size, {1, 1, 1}).blocks.at(0), turned);
    CHECK((cracked.force - expected * Vec3::UnitZ()).norm() < 1e-12 * sea_weight);
    CHECK((cracked.moment - whole.moment).norm() < 1e-12 * sea_weight);
  }
  // Slices that stand apart, each turned by itself.
  System s = sliced_unit();
  s.conditions.flows = {in_water(cdem::uniform_water(still(level)))};
  break_faces(s, [](int) { return true; });
  const auto place = [&](int slice, const Vec3& x) {
    return Vec3(rotation({1, 2, -1}, 40 * slice * degree) * x + slice * Vec3(1.5, 0.2, -0.1));
  };
  place_slices(s, place);
  const std::vector<Vec3> forces = forces_on_slices(s);
  const geom::Assembly shapes = geom::grid(unit_size, {slices, 1, 1});
  for (const geom::Polyhedron& shape : shapes.blocks) {
    const int slice = slice_of(geom::mass_properties(shape).centroid);
    const double expected = sea_weight * wet(shape, [&](const Vec3& x) { return place(slice, x); });
    CHECK(expected > 0);
    CHECK((forces[slice] - expected * Vec3::UnitZ()).norm() < 1e-12 * sea_weight);
  }
}
