// Faces that were named on a mesh as a place of conditions and measurements.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

const Vec3 box_size(1.0, 0.8, 1.2);

// A crooked box: "root" is its side z-, "nose" half of its side x+.
geom::TetMesh unit_at(const Vec3& place) {
  geom::TetMesh mesh = geom::box_mesh(box_size, {3, 2, 4}, 0.15);
  const auto faces = geom::outer_faces(mesh);
  mesh.named["root"] = geom::faces_on_side(mesh, faces, "z-");
  for (const int face : geom::faces_on_side(mesh, faces, "x+"))
    if (mesh.nodes[faces[face].nodes[0]].z() + mesh.nodes[faces[face].nodes[1]].z() +
            mesh.nodes[faces[face].nodes[2]].z() <
        1.5 * box_size.z())
      mesh.named["nose"].push_back(face);
  for (Vec3& x : mesh.nodes)
    x += place;
  return mesh;
}

cdem::BodySpec two_units(bool bonded) {
  cdem::Bonding bonding;
  bonding.everywhere = bonded;
  cdem::BodySpec body = meshed("units", unit_at({0, 0, 0}), bonding);
  body.meshes.push_back(unit_at({3, 0, 0.5}));
  return body;
}

Vec3 resultant(const System& s) {
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, 0);
  Vec3 sum = Vec3::Zero();
  for (const cdem::Node& f : r.external)
    sum += vec(f);
  return sum;
}

std::string refused(const cdem::Selection& on) {
  geom::TetMesh cube = geom::box_mesh({1, 1, 1}, {1, 1, 1});
  for (Vec3& x : cube.nodes)
    x += Vec3(-9, 0, 0);
  const cdem::Model model = build({two_units(false), meshed("stone", cube)});
  return refusal([&] { cdem::selected_nodes(model, on); });
}

} // namespace

TEST_CASE("named faces: a traction pulls with area times stress, on every unit of a pile", "[faces]") {
  System s(build({two_units(GENERATE(false, true))}));
  const Vec3 stress(3e4, -1e4, 2e5);
  s.conditions.tractions = {{cdem::Selection::of_faces("root"), stress, {}}};
  CHECK((resultant(s) - 2 * box_size.x() * box_size.y() * stress).norm() < 1e-12 * stress.norm());
  s.conditions.tractions = {{cdem::Selection::of_faces("nose", "units"), stress, {}}};
  CHECK((resultant(s) - 2 * box_size.y() * 0.5 * box_size.z() * stress).norm() < 1e-12 * stress.norm());
}

TEST_CASE("named faces: a flow pushes on them alone, with its pressure times the cosine", "[faces]") {
  System s(build({two_units(true)}));
  cdem::Flow flow;
  flow.on = {cdem::Selection::of_faces("root", "units")};
  flow.direction = {3, 0, 4}; // 0.8 of it against the root
  flow.velocity = [](double) { return 10; };
  s.conditions.flows = {flow};
  const Vec3 expected =
      cdem::flow_pressure(10, 1025) * 0.8 * 2 * box_size.x() * box_size.y() * Vec3(0.6, 0, 0.8);
  CHECK((resultant(s) - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("named faces: as nodes they are all that lie there, as those of the side", "[faces]") {
  cdem::Bonding bonding;
  bonding.everywhere = GENERATE(false, true); // every tet has nodes of its own, or shares them
  const cdem::Model model = build({meshed("unit", unit_at({0, 0, 0}), bonding)});
  CHECK(cdem::selected_nodes(model, cdem::Selection::of_faces("root")) ==
        cdem::selected_nodes(model, cdem::Selection::side("z-")));
  CHECK(cdem::selected_outer_faces(model, cdem::Selection::of_faces("root")) ==
        cdem::selected_outer_faces(model, cdem::Selection::side("z-")));
}

TEST_CASE("named faces: what is held there stays, carries the weight, and survives a saved state",
          "[faces]") {
  const auto weighed = [] {
    cdem::ModelSpec spec;
    spec.bodies = {two_units(true), meshed("stone", unit_at({6, 0, 0}))};
    cdem::Simulation s(spec, 1, nullptr);
    s.gravity(gravity({1, 0, -9.81}));
    return s;
  };
  const cdem::Selection root = cdem::Selection::of_faces("root");
  cdem::Fix fix;
  fix.on = root;
  cdem::Simulation s = weighed();
  s.fix(fix);
  s.relax({});
  CHECK(s.max("displacement.magnitude", root).value == 0);
  CHECK(s.max("displacement.magnitude").value > 1e-7);
  const double weight = 3 * rock().density * box_size.prod();
  CHECK((s.reaction(root) - weight * Vec3(-1, 0, 9.81)).norm() < 1e-4 * weight);
  // Pressed by the weight over the area of the root: rho g h, but for bending.
  CHECK(s.mean("stress.zz", root) == Approx(-rock().density * 9.81 * box_size.z()).epsilon(0.15));

  // A model that is no longer as it was built is saved with the state; its faces keep their names.
  s.make_rigid(cdem::Selection::of_faces("root", "stone"));
  cdem::Simulation next = weighed();
  next.restore(s.save());
  next.fix(fix);
  CHECK((next.reaction(root) - s.reaction(root)).norm() < 1e-9 * weight);
}

TEST_CASE("named faces: a name that there is not is refused with those there are", "[faces][input]") {
  CHECK_THAT(refused(cdem::Selection::of_faces("rot")), Contains("name = \"rot\"") &&
                                                            Contains("did you mean root?") &&
                                                            Contains("There are: nose, root"));
  CHECK_THAT(refused(cdem::Selection::of_faces("top", "units")),
             Contains("body \"units\"") && Contains("There are: nose, root"));
  CHECK_THAT(refused(cdem::Selection::of_faces("root", "stone")),
             Contains("no faces of body \"stone\" have a name") && Contains("before the model is made"));
  CHECK_THAT(refused(cdem::Selection::of_faces("root", "unit")),
             Contains("body = \"unit\"") && Contains("the name of a body"));
}
