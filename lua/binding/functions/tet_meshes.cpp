// Meshes of tetrahedra: how good they are, which outer faces they have, files and pictures.
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/files.hpp"
#include "libcdem/vtk/read_vtk_mesh.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/mesh/shell_mesh.hpp"
#include "libgeom/mesh/tet_quality.hpp"

#include <algorithm>
#include <set>

namespace cdem::script {

namespace {

using geom::InputError;

Value read_tet_mesh(Session& session, Object*, const Arguments& a) {
  const std::filesystem::path path = session.files.to_read(a.text("file"));
  static const std::set<std::string> endings = {".msh", ".mesh", ".bdf", ".unv", ".inp", ".vtk", ".vtu"};
  if (endings.count(path.extension().string()) == 0)
    throw InputError("file", describe(a.value("file")),
                     "a name that ends in .msh, .mesh, .bdf, .unv, .inp, .vtk or .vtu");
  const std::string regions = a.text_or("regions", "");
  geom::MeshFile file;
  if (path.extension() == ".vtu" && is_vtu_of_ours(path.string()))
    file.mesh = read_vtu_mesh(path.string());
  else if (path.extension() == ".vtu" || path.extension() == ".vtk")
    file = read_vtk_mesh(path.string(), regions);
  else
    file = geom::read_mesh_file(path.string(), regions);
  if (!file.told.empty())
    session.message("read_mesh: " + path.filename().string() + ": " + file.told);
  if (!file.doubtful.empty())
    session.warn("read_mesh: " + path.filename().string() + ": " + file.doubtful);
  geom::TetMesh mesh = std::move(file.mesh);
  for (geom::Vec3& x : mesh.nodes)
    x = a.number("scale") * x + a.vec3("shift");
  auto object = std::make_shared<TetMeshObject>(std::move(mesh));
  object->title = path.stem().string();
  return object;
}

Value box_mesh(Session&, Object*, const Arguments& a) {
  auto object =
      std::make_shared<TetMeshObject>(geom::box_mesh(a.vec3("size"), a.ivec3("divisions"), a.number("jitter"),
                                                     static_cast<std::uint64_t>(a.integer("seed"))));
  for (geom::Vec3& x : object->mesh.nodes)
    x += a.vec3("origin");
  object->title = "box";
  return object;
}

Value shell_mesh(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<TetMeshObject>(geom::shell_mesh(
      a.object<SurfaceObject>("surface")->surface, a.number("thickness"), a.optional_vec3("front")));
  object->title = "shell";
  return object;
}

const Record<geom::MeshQuality> mesh_quality{
    "MeshQuality",
    "How good the tetrahedra of a mesh are.",
    {{integer("nodes"), &geom::MeshQuality::nodes},
     {integer("tets"), &geom::MeshQuality::tets},
     {integer("outer_faces"), &geom::MeshQuality::outer_faces},
     {number("volume", "m3"), &geom::MeshQuality::volume},
     {number("min_volume", "m3"), &geom::MeshQuality::min_volume},
     {number("max_volume", "m3"), &geom::MeshQuality::max_volume},
     {number("min_radius_ratio").doc("3 r_inscribed / r_circumscribed: 1 regular, 0 flat"),
      &geom::MeshQuality::min_radius_ratio},
     {number("mean_radius_ratio"), &geom::MeshQuality::mean_radius_ratio},
     {number("min_dihedral").in_degrees().doc("70.5 in a regular tetrahedron"),
      &geom::MeshQuality::min_dihedral},
     {number("max_dihedral").in_degrees(), &geom::MeshQuality::max_dihedral},
     {number("min_height", "m").doc("corner to opposite face: limits the time step"),
      &geom::MeshQuality::min_height},
     {number("min_edge", "m"), &geom::MeshQuality::min_edge},
     {number("mean_edge", "m"), &geom::MeshQuality::mean_edge},
     {number("max_edge", "m"), &geom::MeshQuality::max_edge}}};

const Record<geom::FaceGroup> face_group{
    "FaceGroup",
    "Outer faces of a mesh that were picked.",
    {{integer("count").required()},
     {number("area", "m2"), &geom::FaceGroup::area},
     {vec3("centroid", "m"), &geom::FaceGroup::centroid},
     {vec3("area_vector", "m2").doc("sum of outward normals times area"), &geom::FaceGroup::area_vector}}};

Table quality(TetMeshObject& self) {
  return mesh_quality(geom::quality(self.mesh));
}

std::vector<int> picked(const TetMeshObject& self, const Arguments& a) {
  if (a.has("side") + a.has("plane") + a.has("direction") != 1)
    throw InputError("must have one of side, plane and direction");
  if (a.has("side"))
    return geom::faces_on_side(self.mesh, self.faces, a.text("side"));
  if (a.has("direction"))
    return geom::faces_towards(self.mesh, self.faces, a.vec3("direction"), radians(a.number("angle")));
  const Arguments plane = *a.record("plane");
  if (!(plane.vec3("normal").norm() > 0))
    throw InputError("plane.normal", describe(plane.value("normal")), "longer than zero");
  const double tolerance =
      a.optional_number("tolerance").value_or(1e-6 * geom::bounding_box(self.mesh).size().norm());
  return geom::faces_on_plane(self.mesh, self.faces,
                              geom::Plane::through(plane.vec3("point"), plane.vec3("normal")), tolerance);
}

Value mesh_faces(Session&, TetMeshObject& self, const Arguments& a) {
  const std::vector<int> chosen = picked(self, a);
  if (chosen.empty())
    throw InputError("no outer face of the mesh lies there" +
                     std::string(a.has("side")
                                     ? "; where the solid is not flat on that side pick a plane with a "
                                       "tolerance, or a direction"
                                     : "; its box is from " + describe(geom::bounding_box(self.mesh).min) +
                                           " to " + describe(geom::bounding_box(self.mesh).max)));
  if (a.has("name"))
    self.mesh.named[a.text("name")] = chosen;
  Table group = face_group(geom::measure(self.mesh, self.faces, chosen));
  group.named["count"] = as_value(chosen.size());
  return group;
}

Value save_mesh(Session& session, TetMeshObject& self, const Arguments& a) {
  require_ending(a.text("file"), ".vtu");
  if (session.settings.check_only)
    return {};
  Snapshot snapshot = mesh_snapshot(self.mesh, self.mesh.named, -1);
  snapshot.title = self.title;
  write_vtu(snapshot, session.files.to_write(a.text("file")).string());
  return {};
}

Value mesh_picture(Session& session, TetMeshObject& self, const Arguments& a) {
  require_drawing(a.text("file"));
  PictureOptions options = view_options(a);
  options.edges = a.text("edges") != "none";
  Snapshot snapshot =
      mesh_snapshot(self.mesh, self.mesh.named, a.text("edges") == "mesh" ? -1 : radians(a.number("crease")));
  set_apart(snapshot, self.faces, self.mesh.named);
  if (!session.settings.check_only) {
    render(snapshot, options, session.files.to_write(a.text("file")).string());
    return {};
  }
  if (!options.field.empty())
    field_values(snapshot, options.field);
  return {};
}

std::vector<Field> mesh_picture_declaration() {
  std::vector<Field> fields = view_fields("\"region\", \"radius_ratio\", \"min_dihedral\", \"volume\" of the "
                                          "tetrahedra, \"on_<name>\" of named faces; plain when left out",
                                          "y");
  fields.push_back(
      choice("edges", {"creases", "mesh", "none"}).standard("creases").doc("lines on the surface"));
  fields.push_back(number("crease", "deg")
                       .within(0, 180)
                       .standard(25.0)
                       .doc("the surface is outlined where it turns by more than this"));
  return fields;
}

} // namespace

void bind_tet_meshes(Module& m) {
  m.add("read_mesh",
        "Linear tetrahedra from a file: gmsh .msh, Medit .mesh, Nastran .bdf, I-deas .unv, Abaqus .inp, .vtk "
        "or .vtu. What is wrong with them is said.",
        {text("file").required(),
         text("regions").doc(
             "what parts the mesh into regions: \"physical\" groups or \"volumes\" of gmsh, \"sections\" or "
             "element \"sets\" of Abaqus, the name of a cell array of VTK; chosen and told when left out"),
         number("scale").within(1e-6, 1e6).standard(1.0).doc("0.001 for a mesh in millimetres"),
         vec3("shift", "m")
             .standard(Value(geom::Vec3(0, 0, 0)))
             .doc("is added to the coordinates: a survey far from the origin loses its digits")},
        read_tet_mesh, "cdem.TetMesh");
  m.add("box_mesh", "A box of nx ny nz cells with six tetrahedra each.",
        {vec3("size", "m").above(0).required(),
         ivec3("divisions").at_least(1).required().doc("cells along x, y and z"),
         vec3("origin", "m").standard(Value(geom::Vec3(0, 0, 0))).doc("lower corner"),
         number("jitter")
             .within(0, geom::max_box_jitter)
             .standard(0.0)
             .doc("inner nodes move along each axis by up to this share of a cell"),
         integer("seed").at_least(0).standard(1).doc("of the jitter")},
        box_mesh, "cdem.TetMesh");
  m.add("shell_mesh",
        "An open surface as a wall, such as a drum, a funnel, a chute or a terrain: the mesh of a rigid body "
        "that is held. The surface is one side of the wall; the other side lies behind it.",
        {object("surface", "Surface").required().doc("cdem.read_surface or cdem.surface"),
         number("thickness", "m")
             .above(0)
             .required()
             .doc("more than bodies reach into it and move in a step; less than the surface is bent"),
         vec3("front", "m")
             .doc("a place on the side that bodies touch, such as the middle of a drum; "
                  "where the triangles' normals point when left out")},
        shell_mesh, "cdem.TetMesh");
  m.records.insert(m.records.end(), {mesh_quality, face_group});
  Class mesh{"TetMesh", "Tetrahedra, made by solid:mesh{} or cdem.read_mesh."};
  const auto of = [](const Object& self) -> const TetMeshObject& {
    return static_cast<const TetMeshObject&>(self);
  };
  mesh.property("nodes", "integer", "", "how many",
                [](const TetMeshObject& self) { return self.mesh.nodes.size(); });
  mesh.property("tets", "integer", "", "how many",
                [](const TetMeshObject& self) { return self.mesh.tets.size(); });
  mesh.property("regions", "integer", "", "how many; they are numbered from 1",
                [](const TetMeshObject& self) {
                  const std::vector<int>& region = self.mesh.region;
                  return region.empty() ? 1 : *std::max_element(region.begin(), region.end()) + 1;
                });
  mesh.property("parts", "integer", "",
                "how many sets of tetrahedra share no node; in a model each moves by itself",
                [](const TetMeshObject& self) { return self.parts; });
  mesh.text = [of](const Object& self) {
    return "cdem.TetMesh (" + of(self).title + ", " + geom::counted(of(self).mesh.tets.size(), "tet") +
           (of(self).parts > 1 ? ", in " + std::to_string(of(self).parts) + " parts)" : ")");
  };
  mesh.add(
      "volume", "", {}, [](TetMeshObject& self) { return geom::volume(self.mesh); }, "number", "m3");
  mesh.add(
      "box", "Smallest axis-aligned box that holds all nodes.", {},
      [](TetMeshObject& self) { return geom::bounding_box(self.mesh); }, "cdem.Box");
  mesh.add(
      "inertia", "Mass, centroid and inertia about the centroid of the tetrahedra.",
      {number("density", "kg/m3").above(0).standard(1.0)},
      [](Session&, TetMeshObject& self, const Arguments& a) -> Value {
        return inertia_table(geom::mass_properties(self.mesh), a.number("density"));
      },
      "cdem.Inertia");
  mesh.add("quality", "How good the tetrahedra are.", {}, quality, "cdem.MeshQuality");
  mesh.add(
      "faces",
      "Picks outer faces. With a name, files and pictures show them as point field on_<name>. In a "
      "model that is made of the mesh afterwards they are a place: cdem.select.faces.",
      {choice("side", {"x-", "x+", "y-", "y+", "z-", "z+"}).doc("faces in that face of the mesh's box"),
       record("plane", {vec3("point", "m").required(), vec3("normal").required()}).doc("faces in a plane"),
       number("tolerance", "m").at_least(0).doc("of plane; 1e-6 of the mesh's size when left out"),
       vec3("direction").doc("faces whose outward normal points this way"),
       number("angle", "deg").within(0, 90).standard(10.0).doc("of direction: how far off a normal may be"),
       text("name")},
      mesh_faces, "cdem.FaceGroup");
  mesh.add("save", "Writes the mesh for ParaView.", {text("file").required().doc("ends in .vtu").output()},
           save_mesh)
      .by_rank_0();
  mesh.add("picture", "Draws the mesh, without a display.", mesh_picture_declaration(), mesh_picture)
      .by_rank_0();
  m.classes.push_back(mesh);
}

} // namespace cdem::script
