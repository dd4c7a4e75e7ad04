// Block assemblies: the builders of libgeom.
#include "lua/binding/functions/discs.hpp"
#include "lua/binding/functions/radians_given.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/discs.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/assembly/join_thin.hpp"
#include "libgeom/assembly/tet_blocks.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <limits>

namespace cdem::script {

namespace {

Value made(geom::Assembly assembly) {
  auto object = std::make_shared<AssemblyObject>();
  object->assembly = std::move(assembly);
  return object;
}

Value grid(Session&, Object*, const Arguments& a) {
  return made(geom::grid(a.vec3("size"), a.ivec3("divisions"), a.vec3("origin")));
}

Value one_box(Session&, Object*, const Arguments& a) {
  return made(geom::grid(a.vec3("size"), {1, 1, 1}, a.vec3("origin")));
}

Field block_size_field() {
  return vec3("size", "m").above(0).required();
}
Field origin_field() {
  return vec3("origin", "m").standard(Value(geom::Vec3(0, 0, 0))).doc("lower corner");
}
Field seed_field() {
  return integer("seed").at_least(0).standard(1).doc("the same seed gives the same blocks on every machine");
}

const Record<geom::VoronoiOptions> voronoi_options{
    {{block_size_field().doc("of the whole"), &geom::VoronoiOptions::size},
     {integer("count").at_least(1).required().doc("number of blocks"), &geom::VoronoiOptions::count},
     {seed_field(), &geom::VoronoiOptions::seed},
     {integer("relaxations")
          .within(0, 1000)
          .standard()
          .doc("Lloyd steps: each moves the points to their cells' centroids, which evens the cells out"),
      &geom::VoronoiOptions::relaxations},
     {flag("extruded").standard().doc("cells in x and y, one block through z"),
      &geom::VoronoiOptions::extruded},
     {origin_field(), &geom::VoronoiOptions::origin}}};

const Record<geom::BrickOptions> brick_options{
    {{block_size_field().doc("of the wall"), &geom::BrickOptions::size},
     {vec3("brick", "m").above(0).required().doc("one brick"), &geom::BrickOptions::brick},
     {number("shift").from(0, 1).standard().doc(
          "of each course against the one below, as a fraction of the brick's length"),
      &geom::BrickOptions::shift},
     {origin_field(), &geom::BrickOptions::origin}}};

const Record<geom::JointSet> joint_set{
    {{number("dip").within(0, 90).in_degrees().required().doc("below the horizontal plane, z up"),
      &geom::JointSet::dip},
     {number("dip_direction")
          .within(0, 360)
          .in_degrees()
          .required()
          .doc("clockwise from +y (north) seen from above"),
      &geom::JointSet::dip_direction},
     {number("spacing", "m").above(0).required().doc("mean, along the normal"), &geom::JointSet::spacing},
     {number("spacing_scatter").from(0, 0.5).standard().doc("standard deviation over the mean"),
      &geom::JointSet::spacing_scatter},
     {number("dip_scatter").within(0, 90).in_degrees().standard().doc("standard deviation"),
      &geom::JointSet::dip_scatter},
     {number("direction_scatter").within(0, 360).in_degrees().standard().doc("standard deviation"),
      &geom::JointSet::direction_scatter},
     {vec3("origin", "m")
          .doc("a plane runs through it; without it the planes are counted from the "
               "lowest corner of the blocks along the normal"),
      &geom::JointSet::origin},
     {integer("count").at_least(1).doc(
          "planes next to the origin, on both sides of it; next to the centre of the blocks where no origin "
          "is given. As many as cross the blocks when left out"),
      &geom::JointSet::count},
     {number("persistence")
          .within(0, 1)
          .standard()
          .doc("probability that a face belongs to the set, above 0. The other faces are bridges of rock, "
               "which the body's joint holds; each face between two blocks is drawn by itself. Needs a name"),
      &geom::JointSet::persistence},
     {text("name").doc("of the set, for its law: a body's joints = { name = joint }"),
      &geom::JointSet::name}}};

Value voronoi(Session&, Object*, const Arguments& a) {
  return made(geom::voronoi(voronoi_options.read(a)));
}

Value bricks(Session&, Object*, const Arguments& a) {
  return made(geom::bricks(brick_options.read(a)));
}

Value cut_by_joints(Session& session, Object*, const Arguments& a) {
  std::vector<geom::JointSet> sets;
  std::vector<double> dips, directions; // deg
  for (const Arguments& given : a.records("sets")) {
    sets.push_back(joint_set.read(given));
    dips.push_back(given.number("dip"));
    directions.push_back(given.number("dip_direction"));
  }
  warn_of_radians(session, "cut_by_joints: dip and dip_direction of sets", dips, directions);
  geom::JoinedThin joined =
      geom::join_thin(geom::cut_by_joints(a.object<AssemblyObject>("shape")->assembly, sets,
                                          static_cast<std::uint64_t>(a.integer("seed"))),
                      a.number("smallest"));
  if (joined.united + joined.glued > 0)
    session.message("cut_by_joints: " + std::to_string(joined.united) + " blocks thinner than " +
                    three_digits(a.number("smallest")) + " m united with a neighbour, " +
                    std::to_string(joined.glued) + " glued to one");
  const std::vector<std::string> cut = geom::cut_names(joined.assembly);
  for (const geom::JointSet& set : sets)
    if (!set.name.empty() && std::find(cut.begin(), cut.end(), set.name) == cut.end())
      session.warn("cut_by_joints: set \"" + set.name + "\" made no face: none of its planes, " +
                   three_digits(set.spacing) +
                   " m apart, meets the shape, or all that it cut off was united with a neighbour; give it "
                   "an origin on the "
                   "shape, a smaller spacing, or a smaller `smallest`");
  return made(std::move(joined.assembly));
}

Value read_discs(Session& session, Object*, const Arguments& a) {
  const std::string& name = a.text("file");
  return disc_record().list(geom::read_discs(read_file(session.files.to_read(name)), name));
}

Value cut_by_discs(Session& session, Object*, const Arguments& a) {
  geom::MovedCuts moved;
  geom::Assembly cut = geom::cut_by_discs(a.object<AssemblyObject>("shape")->assembly, discs_of(session, a),
                                          a.optional_number("clearance"), &moved);
  if (moved.count > 0)
    session.message(
        "cut_by_discs: " + geom::counted(moved.count, "cut was", "cuts were") + " moved, by up to " +
        three_digits(moved.farthest) +
        " m, to keep clear of corners of blocks; clearance says how near they may come, 0 cuts exactly");
  return made(std::move(cut));
}

Value blocks_of_mesh(Session&, Object*, const Arguments& a) {
  return made(geom::tet_blocks(a.object<TetMeshObject>("mesh")->mesh));
}

Value assembly_solid(Session&, AssemblyObject& self, const Arguments&) {
  auto object = std::make_shared<SolidObject>(geom::make_solid(self.assembly));
  object->kind = "blocks";
  return object;
}

Value convex_hull(Session&, Object*, const Arguments& a) {
  std::vector<geom::Vec3> points;
  for (const Value& point : a.list("points"))
    points.push_back(to_vec3(point));
  geom::Assembly assembly;
  assembly.blocks.push_back(geom::convex_hull(points));
  return made(std::move(assembly));
}

std::optional<geom::Box> optional_box(const Arguments& a, const std::string& name) {
  if (!a.has(name))
    return {};
  const geom::Box box = a.box(name);
  if ((box.min.array() > box.max.array()).any())
    throw geom::InputError(name + ".min", describe(box.min), "below " + name + ".max in every axis");
  return box;
}

Value keep_blocks(Session&, Object*, const Arguments& a) {
  return made(geom::kept(a.object<AssemblyObject>("shape")->assembly, *optional_box(a, "inside")));
}

// Blocks whose least height is below `thin` times their extent, m.
struct Splinters {
  std::int64_t count = 0;
  double thinnest = std::numeric_limits<double>::infinity();
  geom::Vec3 place = geom::Vec3::Zero();
};
Splinters splinters_of(const geom::Assembly& assembly) {
  constexpr double thin = 1e-4;
  Splinters found;
  for (const geom::Polyhedron& block : assembly.blocks)
    if (const double height = geom::thickness(block);
        height < thin * geom::bounding_box(block).size().norm()) {
      ++found.count;
      if (height < found.thinnest) {
        found.thinnest = height;
        found.place = geom::bounding_box(block).centre();
      }
    }
  return found;
}

const Record<geom::PlaneCutOptions> plane_cut{
    {{box("inside").doc("only blocks whose centroid lies in this box")},
     {box("crossing").doc("only blocks that reach into this box: the notch or the load line to be cut")},
     {number("clearance", "m")
          .at_least(0)
          .standard()
          .doc("where a vertex of a block is nearer than this, the plane is shifted for that block"),
      &geom::PlaneCutOptions::clearance},
     {text("name").doc("of the cut, for its law: a body's joints = { name = joint }"),
      &geom::PlaneCutOptions::name},
     {flag("glued").standard().doc(
          "a construction cut, such as an excavation outline: no joint; its faces hold the rock together, "
          "stiff and unbreakable, whatever the body's joint. Where it runs along a joint that is there "
          "already, the joint stays"),
      &geom::PlaneCutOptions::glued}}};

Value cut_by_plane(Session& session, Object*, const Arguments& a) {
  const geom::Vec3 normal = a.vec3("normal");
  if (!(normal.norm() > 0))
    throw geom::InputError("normal", describe(a.value("normal")), "longer than zero");
  geom::PlaneCutOptions options = plane_cut.read(a);
  options.inside = optional_box(a, "inside");
  options.crossing = optional_box(a, "crossing");
  const geom::Assembly& whole = a.object<AssemblyObject>("shape")->assembly;
  geom::Assembly parts = geom::cut_by_plane(whole, geom::Plane::through(a.vec3("point"), normal), options);
  const geom::Plane plane = geom::Plane::through(a.vec3("point"), normal);
  const geom::Box box = geom::bounding_box(whole);
  const double reach = 0.5 * plane.normal.cwiseAbs().dot(box.size());
  if (!whole.blocks.empty() && std::abs(plane.level(box.centre())) > (1 + 1e-9) * reach)
    session.warn(
        "cut_by_plane: the plane misses the shape, so nothing was cut; shape:box() tells where it is");
  const Splinters splinters = splinters_of(parts);
  if (const std::int64_t made_here = splinters.count - splinters_of(whole).count; made_here > 0)
    session.warn("cut_by_plane: " + geom::counted(made_here, "block") +
                 " thinner than a ten-thousandth of its size, down to " + three_digits(splinters.thinnest) +
                 " m at " + place_text(splinters.place) +
                 " m: the plane runs along a face; move it, or give clearance");
  return made(std::move(parts));
}

Value translate(Session&, Object*, const Arguments& a) {
  return made(geom::translated(a.object<AssemblyObject>("shape")->assembly, a.vec3("shift")));
}

Value rotate(Session&, Object*, const Arguments& a) {
  return made(geom::rotated(a.object<AssemblyObject>("shape")->assembly, a.vec3("axis"),
                            radians(a.number("angle")), a.vec3("centre")));
}

Value merge(Session&, Object*, const Arguments& a) {
  std::vector<geom::Assembly> parts;
  for (const Value& shape : a.list("shapes"))
    parts.push_back(static_cast<const AssemblyObject&>(*shape.object()).assembly);
  return made(geom::merged(parts));
}

double volume(const geom::Assembly& assembly) {
  double sum = 0;
  for (const geom::Polyhedron& block : assembly.blocks)
    sum += geom::mass_properties(block).volume;
  return sum;
}

const Record<geom::Polyhedron> block_record{
    "Block",
    "One block of an assembly.",
    {{vec3("centroid", "m"),
      [](const geom::Polyhedron& block) { return geom::mass_properties(block).centroid; }},
     {number("volume", "m3"),
      [](const geom::Polyhedron& block) { return geom::mass_properties(block).volume; }},
     {integer("faces").doc("number of faces"),
      [](const geom::Polyhedron& block) { return block.faces.size(); }},
     {list("vertices", vec3_type()).unit("m"), &geom::Polyhedron::vertices}}};

void bind_builders(Module& m) {
  m.add("grid", "A box of equal boxes in rows.",
        {block_size_field().doc("of the whole"),
         ivec3("divisions").at_least(1).required().doc("boxes along x, y and z"), origin_field()},
        grid, "cdem.Assembly");
  m.add("box", "One box.", {block_size_field(), origin_field()}, one_box, "cdem.Assembly");
  m.add("voronoi", "A box of Voronoi cells about seeded random points.", voronoi_options.fields(), voronoi,
        "cdem.Assembly");
  m.add("bricks", "A wall in running bond: courses laid along z, bricks running along x, the end bricks cut.",
        brick_options.fields(), bricks, "cdem.Assembly");
  m.add("cut_by_joints",
        "Cuts every block by the planes of joint sets, one set after the other, those with a persistence "
        "below 1 last.",
        {object("shape", "Assembly").required(), list("sets", record_type(joint_set.fields())).required(),
         seed_field(),
         number("smallest", "m")
             .at_least(0)
             .standard(0.0)
             .doc("blocks whose least height over a face is smaller are splinters, which fail before the "
                  "rock does and shorten the time step. A splinter is united with a neighbour if both "
                  "together are convex. Otherwise one of its faces is glued to a neighbour. Glued cuts are "
                  "left as they "
                  "are: a splinter joins no neighbour across one")},
        cut_by_joints, "cdem.Assembly");
  m.add("cut_by_discs",
        "Joints of finite size: every block that a disc reaches is cut by the disc's plane. Faces with their "
        "centroid in the disc belong to its set; beyond it they are bridges of rock, which the body's joint "
        "holds.",
        {object("shape", "Assembly").required(),
         list("discs", record_type(disc_record().fields())).required(),
         number("clearance", "m")
             .at_least(0)
             .doc("a cut that comes nearer to a corner of its block than this without running through it is "
                  "moved away, since thin blocks fail early and shorten the time step; 0 cuts exactly; 1e-3 "
                  "of each block's diagonal when left out. What is moved is told")},
        cut_by_discs, "cdem.Assembly");
  m.add("read_discs",
        "Discs of a fracture network from a .csv with the columns id, x, y, z, dip, dip_direction, radius "
        "and set, in any order, for cut_by_discs.",
        {text("file").required()}, read_discs, "table[]",
        "id, centre, dip, dip_direction, radius and set of each")
      .ordered()
      .replayed(Replay::recorded);
  m.add("convex_hull", "One block: the convex hull of points.",
        {list("points", vec3_type(), 4).unit("m").required().doc("four or more, not in one plane")},
        convex_hull, "cdem.Assembly");
  m.add("blocks",
        "Every tetrahedron of a mesh as a block: blocks whose tetrahedra share a face share it too, so that "
        "they can be bonded, cut and come loose.",
        {object("mesh", "TetMesh").required()}, blocks_of_mesh, "cdem.Assembly");
}

void bind_edits(Module& m) {
  const Field shape = object("shape", "Assembly").required().doc("left as it is; the result is a new one");
  m.add("cut_by_plane", "Splits every block that a plane crosses.",
        std::vector<Field>{shape, vec3("point", "m").required().doc("any point of the plane"),
                           vec3("normal").required().doc("of any length")} +
            plane_cut.fields(),
        cut_by_plane, "cdem.Assembly");
  m.add("keep", "The blocks whose centroid lies in a box.", {shape, box("inside").required()}, keep_blocks,
        "cdem.Assembly");
  m.add("translate", "Moves blocks.", {shape, vec3("shift", "m").required()}, translate, "cdem.Assembly");
  m.add("rotate", "Turns blocks, right-handed, about an axis through `centre`.",
        {shape, vec3("axis").required().doc("of any length"), number("angle", "deg").required(),
         vec3("centre", "m").standard(Value(geom::Vec3(0, 0, 0)))},
        rotate, "cdem.Assembly");
  m.add("merge", "One assembly of the blocks of several.",
        {list("shapes", object_type("Assembly")).required()}, merge, "cdem.Assembly");
}

} // namespace

void bind_shapes(Module& m) {
  bind_builders(m);
  bind_edits(m);

  m.records.insert(m.records.end(),
                   {RecordType{"Box", "An axis-aligned box.", box("").type.fields}, block_record});
  Class assembly{"Assembly", "Convex blocks, made by the builders; #assembly is the number of blocks."};
  assembly.length = [](const Object& self) {
    return static_cast<std::int64_t>(static_cast<const AssemblyObject&>(self).assembly.blocks.size());
  };
  assembly.text = [](const Object& self) {
    const auto count = static_cast<const AssemblyObject&>(self).assembly.blocks.size();
    return "cdem.Assembly (" + geom::counted(count, "block") + ")";
  };
  assembly.add(
      "volume", "Sum over the blocks, m3.", {}, [](AssemblyObject& self) { return volume(self.assembly); },
      "number", "m3");
  assembly.add(
      "box", "Smallest axis-aligned box that holds all blocks.", {},
      [](AssemblyObject& self) { return geom::bounding_box(self.assembly); }, "cdem.Box");
  assembly.add(
      "joint_sets",
      "Names of the joint sets and cuts that made faces of the blocks, in the order of the alphabet.", {},
      [](AssemblyObject& self) { return geom::cut_names(self.assembly); }, "string[]");
  assembly.add(
      "blocks", "One table per block.", {},
      [](AssemblyObject& self) { return block_record.list(self.assembly.blocks); }, "cdem.Block[]");
  assembly.add("solid",
               "The blocks as one solid with a region for each, in their order. Its mesh shares nodes on the "
               "faces between them. As the shape of a body, such a mesh breaks along the faces of the blocks "
               "with bonded_faces = \"regions\", and anywhere with bonded_faces = \"all\".",
               {}, assembly_solid, "cdem.Solid");
  m.classes.push_back(assembly);
}

} // namespace cdem::script
