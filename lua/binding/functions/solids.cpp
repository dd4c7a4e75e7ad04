// Solids: primitives, boolean operations, import.
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/solid/read_stl.hpp"

#include <set>

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

// Endings of the files that solid.read takes.
const std::string solid_endings = ".step, .stp, .stl, .obj, .off, .ply, .dxf or .ts";

Value read_solid(Session& session, Object*, const Arguments& a) {
  std::string ending = std::filesystem::path(a.text("file")).extension().string();
  for (char& c : ending)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool step = ending == ".step" || ending == ".stp";
  static const std::set<std::string> surfaces = {".stl", ".obj", ".off", ".ply", ".dxf", ".ts"};
  if (!step && surfaces.count(ending) == 0)
    throw InputError("file", "\"" + a.text("file") + "\"", "a name that ends in " + solid_endings);
  const std::filesystem::path path = session.files.to_read(a.text("file"));
  const double scale = a.number("scale");
  if (!step) {
    std::string mended;
    const geom::FacetedSurface surface = geom::read_stl(path.string(), scale, a.vec3("shift"), &mended);
    if (!mended.empty())
      session.message("solid.read: " + path.filename().string() + ": mended " + mended);
    return made(geom::make_solid(surface), path.stem().string());
  }
  geom::Solid solid = geom::read_step(path.string());
  if (scale != 1)
    solid = geom::scaled(solid, scale, geom::Vec3::Zero());
  if (!a.vec3("shift").isZero(0))
    solid = geom::translated(solid, a.vec3("shift"));
  return made(solid, path.stem().string());
}

void bind_solid_builders(Module& m) {
  const auto place = [](std::string name) {
    return vec3(std::move(name), "m").standard(Value(geom::Vec3(0, 0, 0)));
  };
  const Field radius = number("radius", "m").above(0).required();
  const Field axis = vec3("axis", "m").required().doc("from the middle of the base to that of the top");
  m.add(
      "solid.box", "A box.", {vec3("size", "m").above(0).required(), place("origin").doc("lower corner")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::box(a.vec3("size"), a.vec3("origin")), "box");
      },
      "cdem.Solid");
  m.add(
      "solid.cylinder", "A cylinder.", {radius, axis, place("base").doc("middle of the base")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::cylinder(a.vec3("base"), a.vec3("axis"), a.number("radius")), "cylinder");
      },
      "cdem.Solid");
  m.add(
      "solid.cone", "A cone, cut off at the top unless top_radius is 0.",
      {number("radius", "m").at_least(0).required().doc("of the base"),
       number("top_radius", "m").at_least(0).standard(0.0), axis, place("base").doc("middle of the base")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::cone(a.vec3("base"), a.vec3("axis"), a.number("radius"), a.number("top_radius")),
                    "cone");
      },
      "cdem.Solid");
  m.add(
      "solid.sphere", "A ball.", {radius, place("centre")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::sphere(a.vec3("centre"), a.number("radius")), "sphere");
      },
      "cdem.Solid");
  m.add("solid.read",
        "A solid from a STEP file (in the file's units), or from a closed surface of triangles (STL, OBJ, "
        "OFF, PLY, DXF, GOCAD). Each triangle becomes a face of the solid, so no element of its mesh is "
        "larger than the triangles. Triangles without area and T-junctions are mended, which is told.",
        {text("file").required().doc("ends in " + solid_endings),
         number("scale").within(1e-6, 1e6).standard(1.0).doc("0.001 for a file in millimetres"),
         place("shift").doc("is added to the coordinates: a survey far from the origin loses its digits")},
        read_solid, "cdem.Solid");
}

void bind_booleans(Module& m) {
  const Field solids = list("solids", object_type("Solid"), 2).required();
  const Field solid = object("solid", "Solid").required().doc("left as it is; the result is a new one");
  m.add(
      "solid.union", "All of several solids as one.", {solids},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::united(solids_of(a, "solids")));
      },
      "cdem.Solid");
  m.add(
      "solid.cut", "A solid without the parts that others cover.",
      {solid, list("tools", object_type("Solid")).required().doc("what is taken away")},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::cut(solid_of(a, "solid"), solids_of(a, "tools")));
      },
      "cdem.Solid");
  m.add(
      "solid.common", "What two solids have in common.", {solid, object("other", "Solid").required()},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::common(solid_of(a, "solid"), solid_of(a, "other")));
      },
      "cdem.Solid");
  m.add(
      "solid.fragments",
      "The pieces that solids cut each other into, as regions of one solid; neighbours share faces, and "
      "their meshes share nodes.",
      {solids},
      [](Session&, Object*, const Arguments& a) -> Value {
        return made(geom::fragments(solids_of(a, "solids")));
      },
      "cdem.Solid");
}

} // namespace

void bind_solids(Module& m) {
  bind_solid_builders(m);
  bind_booleans(m);
  bind_solid_class(m);
}

} // namespace cdem::script
