// Solids: primitives, boolean operations, import, and what a script can ask of one.
#include "lua/binding/angles.hpp"
#include "lua/binding/module.hpp"
#include "lua/binding/nearest.hpp"
#include "lua/binding/picture_fields.hpp"
#include "lua/binding/session.hpp"
#include "lua/binding/solid_objects.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/mesh/solid_mesh.hpp"
#include "libgeom/solid/read_stl.hpp"

#include <Eigen/Eigenvalues>

namespace cdem::script {

namespace {

using geom::InputError;

Value made(geom::Solid solid, std::string kind = "solid") {
  auto object = std::make_shared<SolidObject>(std::move(solid));
  object->kind = std::move(kind);
  return object;
}

std::vector<geom::Solid> solids_of(const Arguments& a, const std::string& key) {
  std::vector<geom::Solid> solids;
  for (const Value& item : a.list(key))
    solids.push_back(static_cast<const SolidObject&>(*item.object()).solid);
  return solids;
}

const geom::Solid& solid_of(const Arguments& a, const std::string& key) {
  return a.object<SolidObject>(key)->solid;
}

Value read_solid(Session& session, Object*, const Arguments& a) {
  const std::filesystem::path path = session.files.to_read(a.text("file"));
  std::string ending = path.extension().string();
  for (char& c : ending)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const double scale = a.number("scale");
  if (ending == ".stl")
    return made(geom::make_solid(geom::read_stl(path.string(), scale)), path.stem().string());
  if (ending != ".step" && ending != ".stp")
    throw InputError("file", '"' + a.text("file") + '"', "a name that ends in .step, .stp or .stl");
  geom::Solid solid = geom::read_step(path.string());
  if (scale != 1)
    solid = geom::scaled(solid, scale, geom::Vec3::Zero());
  return made(solid, path.stem().string());
}

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

Value rows(const geom::Mat3& m) {
  Values out;
  for (int i = 0; i < 3; ++i)
    out.emplace_back(geom::Vec3(m.row(i)));
  return Table::list(std::move(out));
}

Value inertia(Session&, SolidObject& self, const Arguments& a) {
  const double density = a.optional_number("density").value_or(self.density.value_or(1));
  const geom::MassProperties mass = geom::mass_properties(self.solid);
  const geom::Mat3 tensor = density * mass.inertia;
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(tensor, Eigen::EigenvaluesOnly);
  return Table{{"mass", density * mass.volume},
               {"centroid", mass.centroid},
               {"tensor", rows(tensor)},
               {"principal", geom::Vec3(solver.eigenvalues())}};
}

geom::Box box_of(const Arguments& given, const std::string& path) {
  geom::Box box;
  box.min = given.vec3("min");
  box.max = given.vec3("max");
  if (!(box.min.array() < box.max.array()).all())
    throw InputError(path + ".min", describe(given.value("min")), "below " + path + ".max in every axis");
  return box;
}

Value mesh(Session&, SolidObject& self, const Arguments& a) {
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
    if (const auto box = given.record("box"))
      refinement.box = box_of(*box, path + ".box");
    sizes.refinements.push_back(refinement);
  }
  auto object = std::make_shared<TetMeshObject>(geom::mesh_solid(self.solid, sizes));
  object->title = self.kind;
  return object;
}

Value save(Session& session, SolidObject& self, const Arguments& a) {
  require_ending(a.text("file"), ".step");
  if (!session.settings.check_only)
    geom::write_step(self.solid, session.files.to_write(a.text("file")).string());
  return {};
}

void bind_builders(Module& m) {
  const auto add = [&](std::string name, std::string doc, std::vector<Field> fields, auto body) {
    m.functions.push_back(
        {std::move(name), std::move(doc), std::move(fields), false, "cdem.Solid", "", body});
  };
  const auto place = [](std::string name) {
    return vec3(std::move(name)).unit("m").standard(Value(geom::Vec3(0, 0, 0)));
  };
  const Field radius = number("radius").above(0).unit("m").required();
  const Field axis = vec3("axis").unit("m").required().doc("from the middle of the base to that of the top");
  add("solid.box", "A box.",
      {vec3("size").above(0).unit("m").required(), place("origin").doc("lower corner")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::box(a.vec3("size"), a.vec3("origin")), "box");
      });
  add("solid.cylinder", "A cylinder.", {radius, axis, place("base").doc("middle of the base")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::cylinder(a.vec3("base"), a.vec3("axis"), a.number("radius")), "cylinder");
      });
  add("solid.cone", "A cone, cut off at the top unless top_radius is 0.",
      {number("radius").at_least(0).unit("m").required().doc("of the base"),
       number("top_radius").at_least(0).unit("m").standard(0.0), axis,
       place("base").doc("middle of the base")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::cone(a.vec3("base"), a.vec3("axis"), a.number("radius"), a.number("top_radius")),
                    "cone");
      });
  add("solid.sphere", "A ball.", {radius, place("centre")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::sphere(a.vec3("centre"), a.number("radius")), "sphere");
      });
  add("solid.read",
      "A solid from a STEP file (in the file's units) or from a closed STL surface, whose triangles become "
      "its "
      "faces and bound the mesh size from above.",
      {text("file").required().doc("ends in .step, .stp or .stl"),
       number("scale").above(0).standard(1.0).doc("0.001 for an STL in millimetres")},
      read_solid);
}

void bind_booleans(Module& m) {
  const auto add = [&](std::string name, std::string doc, std::vector<Field> fields, auto body) {
    m.functions.push_back(
        {std::move(name), std::move(doc), std::move(fields), false, "cdem.Solid", "", body});
  };
  const Field solids = list("solids", object_type("Solid"), 2).required();
  const Field solid = object("solid", "Solid").required().doc("left as it is; the result is a new one");
  add("solid.union", "All of several solids as one.", {solids},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::united(solids_of(a, "solids")));
      });
  add("solid.cut", "A solid without the parts that others cover.",
      {solid, list("tools", object_type("Solid")).required().doc("what is taken away")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::cut(solid_of(a, "solid"), solids_of(a, "tools")));
      });
  add("solid.common", "What two solids have in common.", {solid, object("other", "Solid").required()},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::common(solid_of(a, "solid"), solid_of(a, "other")));
      });
  add("solid.fragments",
      "The pieces that solids cut each other into, as regions of one solid; neighbours share faces, and "
      "their "
      "meshes share nodes.",
      {solids}, [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::fragments(solids_of(a, "solids")));
      });
}

std::vector<Function> solid_methods() {
  const std::vector<Field> refinement{
      vec3("at").unit("m").doc("near a point"),
      list("line", vec3_type(), 2).unit("m").doc("along a line, an edge"),
      record("box", {vec3("min").unit("m").required(), vec3("max").unit("m").required()}).doc("in a box"),
      number("size").above(0).unit("m").required(),
      number("radius").at_least(0).unit("m").standard(0.0).doc("how far the size holds")};
  return {
      {"volume",
       "",
       {},
       true,
       "number",
       "m3",
       method<SolidObject>([](Session&, SolidObject& self, const Arguments&) -> Value {
         return geom::mass_properties(self.solid).volume;
       })},
      {"regions",
       "Volume of each region, m3.",
       {},
       true,
       "number[]",
       "",
       method<SolidObject>([](Session&, SolidObject& self, const Arguments&) -> Value {
         const auto volumes = geom::region_volumes(self.solid);
         return Table::list({volumes.begin(), volumes.end()});
       })},
      {"box",
       "Axis-aligned box around the solid; where curved faces are cut by others it may be up to 1 % too "
       "large.",
       {},
       true,
       "cdem.Box",
       "",
       method<SolidObject>([](Session&, SolidObject& self, const Arguments&) -> Value {
         const geom::Box box = geom::bounding_box(self.solid);
         return Table{{"min", box.min}, {"max", box.max}};
       })},
      {"inertia",
       "Mass, centroid and inertia about the centroid.",
       {number("density").above(0).unit("kg/m3").doc("the solid's own when left out; 1 when it has none")},
       false,
       "cdem.Inertia",
       "",
       method<SolidObject>(inertia)},
      {"mesh",
       "Tetrahedra that fill the solid; the same call gives the same mesh.",
       {number("size").above(0).unit("m").doc("edge length; the solid's mesh_size when left out"),
        list("refine", record_type(refinement), 0).doc("smaller tetrahedra in some places"),
        number("growth").within(0.05, 2).standard(0.3).doc(
            "m of size per m of distance from a refined place")},
       false,
       "cdem.TetMesh",
       "",
       method<SolidObject>(mesh)},
      {"translate",
       "A moved copy.",
       {vec3("shift").unit("m").required()},
       false,
       "cdem.Solid",
       "",
       method<SolidObject>([](Session&, SolidObject& self, const Arguments& a) -> Value {
         return moved(self, geom::translated(self.solid, a.vec3("shift")));
       })},
      {"rotate",
       "A copy turned, right-handed, about an axis through `centre`.",
       {vec3("axis").required().doc("of any length"), number("angle").unit("deg").required(),
        vec3("centre").unit("m").standard(Value(geom::Vec3(0, 0, 0)))},
       false,
       "cdem.Solid",
       "",
       method<SolidObject>([](Session&, SolidObject& self, const Arguments& a) -> Value {
         return moved(
             self, geom::rotated(self.solid, a.vec3("axis"), radians(a.number("angle")), a.vec3("centre")));
       })},
      {"scale",
       "A copy of another size.",
       {number("factor").above(0).required(), vec3("centre").unit("m").standard(Value(geom::Vec3(0, 0, 0)))},
       false,
       "cdem.Solid",
       "",
       method<SolidObject>([](Session&, SolidObject& self, const Arguments& a) -> Value {
         return moved(self, geom::scaled(self.solid, a.number("factor"), a.vec3("centre")),
                      a.number("factor"));
       })},
      {"save",
       "Writes a STEP file.",
       {text("file").required().doc("ends in .step; in the output folder")},
       false,
       "",
       "",
       method<SolidObject>(save)}};
}

} // namespace

void bind_solids(Module& m) {
  bind_builders(m);
  bind_booleans(m);
  m.records.push_back({"Inertia",
                       "About the centroid.",
                       {number("mass").unit("kg").required(), vec3("centroid").unit("m").required(),
                        list("tensor", vec3_type()).unit("kg m2").required().doc("three rows"),
                        vec3("principal").unit("kg m2").required().doc("ascending")}});
  Class solid{"Solid", "A free-form solid, made by cdem.solid.* and the armour units; it never changes."};
  const auto optional = [](std::optional<double> SolidObject::*member) {
    return [member](Session&, Object& self) -> Value {
      const auto& value = static_cast<SolidObject&>(self).*member;
      return value ? Value(*value) : Value();
    };
  };
  solid.properties = {
      {"height", "number?", "m", "of an armour unit as it was made", optional(&SolidObject::height)},
      {"density", "number?", "kg/m3", "", optional(&SolidObject::density)}};
  solid.length = [](const Object& self) {
    return static_cast<std::int64_t>(static_cast<const SolidObject&>(self).solid.regions());
  };
  solid.text = [](const Object& self) {
    const auto& object = static_cast<const SolidObject&>(self);
    return "cdem.Solid (" + object.kind +
           (object.height ? ", height " + number_text(*object.height) + " m)" : ")");
  };
  solid.methods = solid_methods();
  m.classes.push_back(solid);
}

} // namespace cdem::script
