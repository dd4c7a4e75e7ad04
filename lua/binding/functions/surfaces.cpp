// Surfaces of triangles, and blocks clipped by them or by solids.
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/assembly/clip.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/sound_surface.hpp"
#include "libgeom/solid/facets.hpp"
#include "libgeom/solid/read_surface.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

Value read_surface(Session& session, Object*, const Arguments& a) {
  const std::filesystem::path path = session.files.to_read(a.text("file"));
  auto object = std::make_shared<SurfaceObject>();
  geom::FileSurface read =
      geom::read_surface(path.string(), a.number("scale"), geom::max_surface_triangles, a.vec3("shift"));
  object->surface = std::move(read.surface);
  if (!read.mended.empty())
    session.message("read_surface: " + path.filename().string() + ": mended " + read.mended);
  if (!read.note.empty() && a.number("scale") == 1)
    session.warn("read_surface: " + path.filename().string() + ": " + read.note);
  return object;
}

Value surface(Session& session, Object*, const Arguments& a) {
  auto object = std::make_shared<SurfaceObject>();
  for (const Value& point : a.list("points"))
    object->surface.points.push_back(to_vec3(point));
  const auto count = static_cast<double>(object->surface.points.size());
  for (const Value& row : a.list("triangles")) {
    geom::Triangle triangle{};
    for (int i = 0; i < 3; ++i) {
      const double number = row.table()->items[i].number();
      if (!(number >= 1 && number <= count) || number != std::floor(number))
        throw InputError(
            "triangles[" + std::to_string(object->surface.triangles.size() + 1) + "]", describe(row),
            "three numbers of points, from 1 to " + std::to_string(object->surface.points.size()));
      triangle[i] = static_cast<int>(number) - 1;
    }
    object->surface.triangles.push_back(triangle);
  }
  const double same = geom::same_corner * geom::bounding_box(object->surface).size().norm();
  if (const auto mended = geom::mended_text(geom::mend(object->surface, same)); !mended.empty())
    session.message("surface: mended " + mended);
  if (object->surface.triangles.empty())
    throw InputError("triangles: none of them has an area");
  geom::require_single(object->surface, "triangles");
  geom::require_uncrossed(object->surface, "triangles", same);
  return object;
}

Value clip(Session& session, Object*, const Arguments& a) {
  const auto solid = a.object<SolidObject>("solid");
  const auto given = a.object<SurfaceObject>("surface");
  if ((solid != nullptr) == (given != nullptr))
    throw InputError("give one of solid and surface = cdem.read_surface{...}");
  const std::string& keep = a.text("keep");
  geom::ClipOptions options;
  options.keep = keep == "both"                        ? geom::ClipSide::both
                 : keep == "inside" || keep == "below" ? geom::ClipSide::inside
                                                       : geom::ClipSide::outside;
  options.name = a.text_or("name", "");
  options.glued = a.flag("glued");
  options.tolerance = a.number("tolerance");
  const bool curved = solid && geom::has_curved_faces(solid->solid);
  if (curved && !(options.tolerance > 0))
    throw InputError(
        "tolerance: missing; the solid has curved faces: give how far (m) the flat cuts may leave "
        "them, such as a hundredth of their radius");
  if (curved)
    options.tolerance *= 0.5; // the other half is that of its facets
  const geom::Surface surface = solid ? geom::facets(solid->solid, options.tolerance) : given->surface;
  const bool is_open = !geom::open_edges(surface).empty();
  if (keep != "both" && is_open != (keep == "below" || keep == "above"))
    throw InputError("keep", '"' + keep + '"',
                     is_open ? "below, above or both: the surface is open, a terrain"
                             : "inside, outside or both: the surface is closed");
  geom::Clipped clipped = geom::clip(a.object<AssemblyObject>("shape")->assembly, surface, options);
  if (clipped.thin > 0)
    session.warn("clip: " +
                 geom::counted(clipped.thin, "piece is thinner than a twentieth of its block,",
                               "pieces are thinner than a twentieth of their blocks, the thinnest") +
                 " " + three_digits(clipped.thinnest) + " m at " + place_text(clipped.thinnest_place) +
                 " m; thin blocks shorten the time step: give a tolerance (m) that is larger, within which "
                 "facets are cut as one plane");
  auto object = std::make_shared<AssemblyObject>();
  object->assembly = std::move(clipped.assembly);
  return object;
}

double area(const geom::Surface& surface) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto x = surface.corners(t);
    sum += 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  }
  return sum;
}

} // namespace

void bind_surfaces(Module& m) {
  m.add("read_surface",
        "A surface of triangles from a file: STL, ASCII DXF (3DFACE, polyface and polygon meshes), OBJ, OFF, "
        "PLY or GOCAD; a terrain, an excavation. Triangles without area and T-junctions are mended, which is "
        "told.",
        {text("file").required().doc("ends in .stl, .dxf, .obj, .off, .ply or .ts"),
         number("scale").within(1e-6, 1e6).standard(1.0).doc("0.001 for a file in millimetres"),
         vec3("shift", "m")
             .standard(Value(geom::Vec3(0, 0, 0)))
             .doc("is added to the coordinates: a survey far from the origin loses its digits")},
        read_surface, "cdem.Surface");
  m.add("surface", "A surface of triangles by its points: a terrain by a formula or from a table.",
        {list("points", vec3_type(), 3).unit("m").required(),
         list("triangles", tuple_type({number_type(), number_type(), number_type()}), 1)
             .required()
             .doc("numbers of three points each, from 1")},
        surface, "cdem.Surface");
  m.add("clip",
        "Cuts blocks along a surface or the faces of a solid, and keeps those on one side. Each block is cut "
        "by planes into convex pieces; the cuts within it are glued unless told otherwise.",
        {object("shape", "Assembly").required().doc("left as it is; the result is a new one"),
         object("solid", "Solid"),
         object("surface", "Surface").doc("instead: closed, or open and single in height, a terrain"),
         choice("keep", {"inside", "outside", "below", "above", "both"})
             .required()
             .doc("inside and outside of a closed surface or a solid, below and above an open one; both: "
                  "only cut, the outline of a later excavation (model:remove)"),
         number("tolerance", "m")
             .at_least(0)
             .standard(0.0)
             .doc("how far the cuts may leave the surface; makes fewer pieces and no thinner ones. 0: exact; "
                  "curved solids need one"),
         text("name").doc("of the faces that are cut, in pictures of joints, lists and `joints` of a body"),
         flag("glued").standard(true).doc(
             "true: the cuts are no joints, and their faces never break. false: they are joints, as the "
             "faces of cdem.cut_by_plane are. A cut that runs on through the rest of a block, where the "
             "surface bends inside it, is a joint there too; so a fault can follow a surface")},
        clip, "cdem.Assembly");
  Class object{"Surface", "Triangles, made by cdem.read_surface or cdem.surface; #surface is their number."};
  object.length = [](const Object& self) {
    return static_cast<std::int64_t>(static_cast<const SurfaceObject&>(self).surface.triangles.size());
  };
  object.text = [](const Object& self) {
    return "cdem.Surface (" +
           std::to_string(static_cast<const SurfaceObject&>(self).surface.triangles.size()) + " triangles)";
  };
  object.add(
      "area", "The area of all triangles, m2.", {}, [](SurfaceObject& self) { return area(self.surface); },
      "number", "m2");
  object.add(
      "closed", "Whether every edge belongs to two triangles.", {},
      [](SurfaceObject& self) { return geom::open_edges(self.surface).empty(); }, "boolean");
  object.add(
      "box", "Smallest axis-aligned box that holds it.", {},
      [](SurfaceObject& self) { return geom::bounding_box(self.surface); }, "cdem.Box");
  m.classes.push_back(object);
}

} // namespace cdem::script
