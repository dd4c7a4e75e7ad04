// What a script can ask of a solid, and do with one.
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/meshing/solid_mesh.hpp"

#include <Eigen/Eigenvalues>
#include <cstdio>

namespace cdem::script {

namespace {

using geom::InputError;

// Relative difference of a mesh's volume from its solid's, above which the user is warned.
constexpr double volume_told_of = 0.03;

// The same unit in another place: it keeps its name, density and, unless scaled, its sizes.
Value moved(const SolidObject& self, geom::Solid solid, double factor = 1) {
  auto object = std::make_shared<SolidObject>(self);
  object->solid = std::move(solid);
  if (object->height)
    *object->height *= factor;
  if (object->mesh_size)
    *object->mesh_size *= factor;
  return object;
}

Value inertia(Session&, SolidObject& self, const Arguments& a) {
  return inertia_table(geom::mass_properties(self.solid),
                       a.optional_number("density").value_or(self.density.value_or(1)));
}

geom::Box box_of(const Arguments& given, const std::string& path) {
  geom::Box box = given.box("box");
  if (!(box.min.array() < box.max.array()).all())
    throw InputError(path + ".min", describe(box.min), "below " + path + ".max in every axis");
  return box;
}

std::string four_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

Value mesh(Session& session, SolidObject& self, const Arguments& a) {
  geom::MeshSize sizes;
  const auto size = a.has("size") ? a.optional_number("size") : self.mesh_size;
  if (!size)
    throw InputError("size: missing; give the edge length of the tetrahedra in metres");
  sizes.size = *size;
  sizes.growth = a.number("growth");
  std::size_t index = 0;
  for (const Arguments& given : a.records("refine")) {
    const std::string path = "refine[" + std::to_string(++index) + "]";
    if (given.has("at") + given.has("line") + given.has("box") != 1)
      throw InputError(path + ": must have one of at, line and box");
    geom::Refinement refinement;
    refinement.size = given.number("size");
    refinement.radius = given.number("radius");
    if (const auto at = given.optional_vec3("at"))
      refinement.line = {*at};
    for (const Value& point : given.list("line"))
      refinement.line.push_back(to_vec3(point));
    if (given.has("box"))
      refinement.box = box_of(given, path + ".box");
    sizes.refinements.push_back(refinement);
  }
  auto object = std::make_shared<TetMeshObject>(geom::mesh_solid(self.solid, sizes));
  object->title = self.kind;
  geom::Box box;
  for (const geom::Vec3& x : object->mesh.nodes)
    box.extend(x);
  if (const double least = box.size().minCoeff(); sizes.size > least * (1 + 1e-6))
    object->coarse = "mesh: size = " + four_digits(sizes.size) +
                     " m is more than the solid's smallest extent, " + four_digits(least) +
                     " m; a body that bends wants several tetrahedra across";
  const double part = geom::volume(object->mesh) / geom::mass_properties(self.solid).volume;
  if (std::abs(part - 1) > volume_told_of)
    session.warn("mesh: with size = " + four_digits(sizes.size) + " m its volume, and mass, is " +
                 four_digits(part) +
                 " of the solid's, as flat faces stand for curved ones; give a smaller size");
  return object;
}

Value save_solid(Session& session, SolidObject& self, const Arguments& a) {
  require_ending(a.text("file"), ".step");
  if (!session.settings.check_only)
    geom::write_step(self.solid, session.files.to_write(a.text("file")).string());
  return {};
}

void add_methods(Class& solid) {
  const std::vector<Field> refinement{
      vec3("at", "m").doc("near a point"),
      list("line", vec3_type(), 2).unit("m").doc("along a line, an edge"), box("box").doc("in a box"),
      number("size", "m").above(0).required(),
      number("radius", "m").at_least(0).standard(0.0).doc("how far the size holds")};
  solid.add(
      "volume", "", {}, [](SolidObject& self) { return geom::mass_properties(self.solid).volume; }, "number",
      "m3");
  solid.add(
      "regions", "Volume of each region, m3.", {},
      [](SolidObject& self) { return geom::region_volumes(self.solid); }, "number[]");
  solid.add(
      "box",
      "Axis-aligned box around the solid; where curved faces are cut by others it may be up to 1 % too "
      "large.",
      {}, [](SolidObject& self) { return geom::bounding_box(self.solid); }, "cdem.Box");
  solid.add("inertia", "Mass, centroid and inertia about the centroid.",
            {number("density", "kg/m3").above(0).doc("the solid's own when left out; 1 when it has none")},
            inertia, "cdem.Inertia");
  solid.add("mesh", "Tetrahedra that fill the solid; the same call gives the same mesh.",
            {number("size", "m").above(0).doc("edge length; the solid's mesh_size when left out"),
             list("refine", record_type(refinement), 0).doc("smaller tetrahedra in some places"),
             number("growth").within(0.05, 2).standard(0.3).doc(
                 "m of size per m of distance from a refined place")},
            mesh, "cdem.TetMesh");
  solid.add(
      "translate", "A moved copy.", {vec3("shift", "m").required()},
      [](Session&, SolidObject& self, const Arguments& a) -> Value {
        return moved(self, geom::translated(self.solid, a.vec3("shift")));
      },
      "cdem.Solid");
  solid.add(
      "rotate", "A copy turned, right-handed, about an axis through `centre`.",
      {vec3("axis").required().doc("of any length"), number("angle", "deg").required(),
       vec3("centre", "m").standard(Value(geom::Vec3(0, 0, 0)))},
      [](Session&, SolidObject& self, const Arguments& a) -> Value {
        return moved(self,
                     geom::rotated(self.solid, a.vec3("axis"), radians(a.number("angle")), a.vec3("centre")));
      },
      "cdem.Solid");
  solid.add(
      "scale", "A copy of another size.",
      {number("factor").above(0).required(), vec3("centre", "m").standard(Value(geom::Vec3(0, 0, 0)))},
      [](Session&, SolidObject& self, const Arguments& a) -> Value {
        return moved(self, geom::scaled(self.solid, a.number("factor"), a.vec3("centre")),
                     a.number("factor"));
      },
      "cdem.Solid");
  solid
      .add("save", "Writes a STEP file.", {text("file").required().doc("ends in .step").output()}, save_solid)
      .by_rank_0();
}

} // namespace

namespace {

struct Inertia {
  double mass;
  geom::Vec3 centroid;
  geom::Mat3 tensor;
  double ratio;
};

const Record<Inertia> inertia_record{
    "Inertia",
    "About the centroid.",
    {{number("mass", "kg"), &Inertia::mass},
     {vec3("centroid", "m"), &Inertia::centroid},
     {list("tensor", vec3_type()).unit("kg m2").doc("three rows"), &Inertia::tensor},
     {vec3("principal", "kg m2").doc("ascending"),
      [](const Inertia& inertia) {
        const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(inertia.tensor, Eigen::EigenvaluesOnly);
        return geom::Vec3(solver.eigenvalues());
      }},
     {number("principal_ratio").doc("largest over smallest of them"), &Inertia::ratio}}};

} // namespace

Value inertia_table(const geom::MassProperties& mass, double density) {
  return inertia_record(
      {density * mass.volume, mass.centroid, density * mass.inertia, geom::principal_inertia_ratio(mass)});
}

void bind_solid_class(Module& m) {
  m.records.push_back(inertia_record);
  Class solid{"Solid", "A free-form solid, made by cdem.solid.* and the armour units; it never changes."};
  solid.property("height", "number?", "m", "of an armour unit as it was made",
                 [](const SolidObject& self) { return self.height; });
  solid.property("density", "number?", "kg/m3", "", [](const SolidObject& self) { return self.density; });
  solid.length = [](const Object& self) {
    return static_cast<std::int64_t>(static_cast<const SolidObject&>(self).solid.regions());
  };
  solid.text = [](const Object& self) {
    const auto& object = static_cast<const SolidObject&>(self);
    return "cdem.Solid (" + object.kind +
           (object.height ? ", height " + number_text(*object.height) + " m)" : ")");
  };
  add_methods(solid);
  m.classes.push_back(solid);
}

} // namespace cdem::script
