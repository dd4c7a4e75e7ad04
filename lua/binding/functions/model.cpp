// cdem.model, and what a model is apart from its conditions, stages and results.
#include "lua/binding/functions/mesh_body.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/pile_object.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/schema/answers.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libcdem/join_blocks.hpp"
#include "libcdem/memory_needed.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem::script {

namespace {

using geom::InputError;

// The shape of a meshed body as a pile, of one unit when it is a mesh; none for an assembly.
std::optional<geom::Pile> pile_shape(const Arguments& given) {
  if (const auto pile = given.object<PileObject>("shape"))
    return pile->pile;
  const auto mesh = given.object<TetMeshObject>("shape");
  if (!mesh)
    return std::nullopt;
  geom::Pile pile = geom::pile_of(mesh->mesh);
  pile.poses = {{geom::Mat3::Identity(), geom::mass_properties(mesh->mesh).centroid}};
  return pile;
}

void warn_of_pieces(Session& session, const std::string& path, const PileObject& pile) {
  if (const auto broken = std::count_if(pile.units.begin(), pile.units.end(),
                                        [](const UnitNow& unit) { return unit.pieces > 1; });
      broken > 0)
    session.warn(path + ": " + geom::counted(broken, "unit") +
                 " of the pile had broken when it was taken; the body gets whole ones, where the largest "
                 "pieces lay");
}

void require_blocks(const Arguments& given, const std::string& path) {
  const std::string bonds = given.text_or("bonds", "springs");
  if (bonds != "springs" && bonds != "cohesive")
    throw InputError(path + ".bonds", "\"" + bonds + "\"", "cohesive or springs for an assembly");
  if (given.has("bonds") && !given.has("joint"))
    throw InputError(path + ".joint: missing; bonds = \"" + bonds + "\" needs to know what holds the faces");
  for (const char* const only :
       {"bonded_faces", "bonded_regions", "region_joints", "stiffness_ratio", "shear_ratio"})
    if (given.has(only) && (bonds == "springs" || std::string(only) != "stiffness_ratio"))
      throw InputError(path + "." + only + ": only for a meshed body; an assembly's faces are all bonded");
  if (const auto material = given.object<MaterialObject>("material");
      given.text_or("element", "finite_volume") == "small_strain" && material &&
      material->elastic.stiffness_damping > 0)
    throw InputError(
        path +
        ".material: stiffness_damping is for bodies that move far; one of small strain takes viscosity");
}

void read_plasticity(const Arguments& given, const std::string& path, BodySpec& body) {
  const auto add = [&](const Value& law) {
    body.plasticity.laws.push_back(static_cast<const PlasticityObject&>(*law.object()).plasticity);
    if (body.plasticity.laws.size() > 100)
      throw InputError(path + ".region_plasticity", std::to_string(body.plasticity.laws.size()) + " laws",
                       "at most 99");
    return static_cast<int>(body.plasticity.laws.size()) - 1;
  };
  if (given.has("plasticity"))
    body.plasticity.others = add(given.value("plasticity"));
  if (given.has("region_plasticity") && body.meshes.empty())
    throw InputError(path + ".region_plasticity: only for a meshed body; an assembly has no regions, give it "
                            "plasticity = cdem.plastic{...}");
  for (const Value& row : given.list("region_plasticity")) {
    const Values& items = row.table()->items;
    body.plasticity.regions.emplace_back(static_cast<int>(items[0].number()) - 1, add(items[1]));
  }
}

// A law, or a function of the place that gives one: for each interface that at its centroid. Faces that are cut later, and
// blocks that meet anew, have the law at the middle of the body.
void read_joint(const Value& given, const std::string& path, const BodySpec& body, Joint& joint,
                JointAt& at) {
  if (const auto object = std::dynamic_pointer_cast<JointObject>(given.object())) {
    joint = object->joint;
    return;
  }
  at = [function = given.reference(), path](const geom::Vec3& x) {
    const Values place{x.x(), x.y(), x.z()};
    const Value answer = answer_of(*function, path, place);
    if (const auto law = std::dynamic_pointer_cast<JointObject>(answer.object()))
      return law->joint;
    refuse_answer(*function, path, place, answer,
                  "a Joint: cdem.mohr_coulomb{...}, cdem.coulomb{...} or another law of joints");
  };
  joint = at(geom::bounding_box(body.shape).centre());
}

// The meshes of bodies that do not hang together: the body, and how many parts it is in.
using PartCounts = std::vector<std::pair<std::string, int>>;

// Adds the piles of meshed bodies to `piles`; returns the bodies without a joint.
std::vector<std::string> read_bodies(Session& session, const Arguments& a, ModelSpec& spec,
                                     std::map<std::string, geom::Pile>& piles, PartCounts& in_parts) {
  std::vector<std::string> unjointed;
  for (const Arguments& given : a.records("bodies")) {
    const std::string path = "bodies[" + std::to_string(spec.bodies.size() + 1) + "]";
    BodySpec body;
    body.name = given.text_or("name", "body_" + std::to_string(spec.bodies.size() + 1));
    const auto same = [&](const BodySpec& other) { return other.name == body.name; };
    if (std::any_of(spec.bodies.begin(), spec.bodies.end(), same))
      throw InputError(path + ".name", "\"" + body.name + "\"", "unique", "another body has it");
    if (body.name.empty() || body.name == "all" ||
        (body.name.size() == 2 && (body.name[1] == '-' || body.name[1] == '+')))
      throw InputError(path + ".name", "\"" + body.name + "\"", "a word that is no side of the model");
    body.material = given.object<MaterialObject>("material")->elastic;
    if (const auto joint = given.object<JointObject>("joint"))
      body.joint = joint->joint;
    else if (given.has("joint") && !given.object<AssemblyObject>("shape"))
      throw InputError(
          path + ".joint", "a function", "a Joint for a mesh",
          "a law that varies from place to place is for assemblies of blocks; region_joints gives "
          "regions of a mesh their own");
    if (const auto pile = pile_shape(given)) {
      std::vector<geom::TetMesh> units;
      const auto mesh = given.object<TetMeshObject>("shape");
      if (mesh)
        units = {mesh->mesh};
      else
        units = geom::meshes(*pile);
      if (given.has("joints"))
        throw InputError(path + ".joints: only for an assembly of blocks; a mesh has no joint sets");
      if (given.has("zone_size"))
        throw InputError(
            path + ".zone_size: only for an assembly of blocks; a mesh has the size that it was made with");
      read_mesh(session, given, path, std::move(units), body);
      read_plasticity(given, path, body);
      if (mesh && !mesh->coarse.empty() && body.element != Element::rigid)
        session.warn(path + ": " + mesh->coarse);
      if (const auto shape = given.object<PileObject>("shape"))
        warn_of_pieces(session, path, *shape);
      if (const int parts = geom::count_parts(pile->unit); parts == 1)
        piles.emplace(body.name, *pile);
      else
        in_parts.emplace_back(body.name, parts);
      spec.bodies.push_back(std::move(body));
      continue;
    }
    require_blocks(given, path);
    if (given.has("element"))
      body.element = given.text("element") == "rigid"           ? Element::rigid
                     : given.text("element") == "finite_volume" ? Element::finite_volume
                                                                : Element::small_strain;
    body.shape = given.object<AssemblyObject>("shape")->assembly;
    body.zone_size = given.optional_number("zone_size").value_or(0);
    read_plasticity(given, path, body);
    if (const Table* joints = given.value("joints").table())
      for (const auto& [name, joint] : joints->named)
        read_joint(joint, path + ".joints." + name, body, body.set_joints[name], body.set_joints_at[name]);
    if (given.has("joint"))
      read_joint(given.value("joint"), path + ".joint", body, body.joint, body.joint_at);
    if (given.text_or("bonds", "springs") == "cohesive") {
      body.bonding.kind = BondKind::cohesive;
      body.bonding.stiffness_ratio = given.optional_number("stiffness_ratio").value_or(1);
    }
    for (auto at = body.set_joints_at.begin(); at != body.set_joints_at.end();)
      at = at->second ? std::next(at) : body.set_joints_at.erase(at);
    if (!given.has("joint") && body.shape.blocks.size() > 1)
      throw InputError(path + ".joint: missing; the body has " + std::to_string(body.shape.blocks.size()) +
                       " blocks: say what holds them together, cdem.mohr_coulomb{...} or cdem.coulomb{...}");
    if (!given.has("joint"))
      unjointed.push_back(body.name);
    if (body.bonding.kind == BondKind::cohesive)
      join_blocks(body);
    spec.bodies.push_back(std::move(body));
  }
  return unjointed;
}

void read_pairs(const Arguments& a, ModelSpec& spec) {
  std::vector<std::string> names;
  for (const BodySpec& body : spec.bodies)
    names.push_back(body.name);
  if (const auto contacts = a.record("contacts"))
    if (const auto law = contacts->object<JointObject>("default"))
      spec.default_contact = law->joint;
  std::size_t index = 0;
  for (const Value& row : a.list("contacts")) {
    const Values& items = row.table()->items;
    PairSpec pair;
    pair.body_a = *items[0].get<std::string>();
    pair.body_b = *items[1].get<std::string>();
    pair.joint = static_cast<const JointObject&>(*items[2].object()).joint;
    ++index;
    for (const std::string& name : {pair.body_a, pair.body_b})
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw InputError("contacts[" + std::to_string(index) + "]: no body \"" + name + "\"" +
                         which_there_are(name, names));
    spec.pairs.push_back(pair);
  }
}

// Six digits: places to be found again, not to be computed with.
std::string shown_vec(const geom::Vec3& x) {
  char text[64];
  std::snprintf(text, sizeof text, "{%.6g, %.6g, %.6g}", x.x(), x.y(), x.z());
  return text;
}

std::string shown_parts(const PartCounts& in_parts) {
  std::string shown;
  for (const auto& [body, parts] : in_parts)
    shown += "; mesh of \"" + body + "\" in " + std::to_string(parts) + " parts, each moves by itself";
  return shown;
}

std::string shown_build(const ModelObject& model) {
  const ModelCounts c = model.simulation.counts();
  const geom::Box box = model.simulation.model().box;
  return geom::counted(c.bodies, "body", "bodies") + " (" + joined(model.body_names) + "), " +
         geom::counted(c.blocks, "block") + ", " + geom::counted(c.tets, "tet") + ", " +
         geom::counted(c.interfaces, "interface") + ", " + geom::counted(c.bonds, "bond") + "; box from " +
         shown_vec(box.min) + " to " + shown_vec(box.max) + " m, size " + shown_vec(box.size()) + " m";
}

// Laws that hold nothing as the model stands now.
void note_pairs_apart(Session& session, ModelObject& model, const ModelSpec& spec) {
  const auto is_small = [&](const std::string& name) {
    return std::any_of(spec.bodies.begin(), spec.bodies.end(), [&](const BodySpec& body) {
      return body.name == name && body.meshes.empty() && body.element == Element::small_strain;
    });
  };
  for (const auto& [a, b] : model.simulation.unmet()) {
    const std::string what = shown_pair(a, b);
    if (is_small(a))
      session.warn(what +
                   ": they share no face, and blocks of small strain meet nothing new: the law acts on "
                   "nothing; move them together, or leave element = \"small_strain\" out");
    else
      model.notes->apart.push_back(what + ": no interface now; they meet only if they move");
  }
}

// Units that cannot break, and whose stress perhaps nobody asks for.
void note_deforming_units(ModelObject& model, const ModelSpec& spec) {
  constexpr std::size_t many = 20;
  for (const BodySpec& body : spec.bodies) {
    if (body.meshes.size() < many || body.element == Element::rigid || !body.bonding.none() ||
        !body.plasticity.laws.empty())
      continue;
    std::size_t tets = 0;
    for (const geom::TetMesh& mesh : body.meshes)
      tets += mesh.tets.size();
    const Simulation& simulation = model.simulation;
    const double longer = 0.5 * simulation.rigid_time_step(body.name) / (0.9 * simulation.stable_time_step());
    model.notes->advice.push_back(
        "\"" + body.name + "\": " + std::to_string(body.meshes.size()) + " units deform, with " +
        std::to_string(tets) +
        " tets, and cannot break; where only their motion is wanted, element = \"rigid\" " +
        (longer > 1.5 && std::isfinite(longer)
             ? "takes steps some " + three_digits(std::round(longer)) + " times as long and "
             : "") +
        "computes no tets");
  }
}

Value make_model(Session& session, Object*, const Arguments& a) {
  ModelSpec spec;
  std::map<std::string, geom::Pile> piles;
  PartCounts in_parts;
  const auto unjointed = read_bodies(session, a, spec, piles, in_parts);
  read_pairs(a, spec);
  // Lua sees only the few bytes it holds of a model, and would keep finished ones for long.
  session.collect_garbage();
  warn_of_memory(session, "building this model", memory_to_build(spec));
  auto model =
      std::make_shared<ModelObject>(Simulation(spec, session.settings.threads, session.observer_of_models()));
  for (const BodySpec& body : spec.bodies)
    model->body_names.push_back(body.name);
  model->piles = std::move(piles);
  model->unjointed = unjointed;
  model->number = static_cast<int>(session.models.size()) + 1;
  if (session.checkpoints.keeps())
    model->simulation.set_checkpoint_writer(&session.checkpoints);
  model->simulation.set_replaying(session.checkpoints.replaying());
  model->memory = session.new_memory(Table());
  model->notes->built = shown_build(*model) + shown_parts(in_parts);
  for (const auto& [body, parts] :
       session.settings.check_only ? PartCounts() : in_parts) // told with the rest
    session.message("mesh of \"" + body + "\" in " + std::to_string(parts) + " parts: each moves by itself");
  session.models.push_back(model);
  session.notes.push_back(model->notes);
  note_pairs_apart(session, *model, spec);
  note_deforming_units(*model, spec);
  note_process_zones(session, *model);
  return model;
}

} // namespace

void bind_model(Module& m) {
  const Type pair = tuple_type({text_type(), text_type(), object_type("Joint")});
  Type whole_number;
  whole_number.kind = Kind::integer;
  const std::vector<Field> body{
      object("shape", "Assembly|TetMesh|Pile")
          .required()
          .doc("blocks, a mesh of tetrahedra, or a pile of them"),
      object("material", "Material").required(),
      object_or_function("joint", "Joint", "(x: number, y: number, z: number): cdem.Joint")
          .doc("between the body's own blocks; needed when there are several, or when they are cut. A mesh "
               "has it on its inner faces, which can break then. An assembly may have a function of the "
               "place instead, which returns a law. It is called once for each face between two blocks, with "
               "the centroid of the face, so that the law may vary with depth, region or seed"),
      named("joints", object_or_function_type("Joint", "(x: number, y: number, z: number): cdem.Joint"))
          .doc("of an assembly: laws by the name of the joint set or cut that made the faces, { bedding = "
               "joint, fault = joint }; `joint` holds all others"),
      text("name").doc("for selections and contacts; body_1, body_2 ... by default"),
      choice("element", {"small_strain", "finite_volume", "rigid"})
          .doc("how its tetrahedra deform: finite_volume (Feng 2014) for any motion, the default; "
               "small_strain (Han 2010) of an assembly whose blocks hardly turn and keep the neighbours they "
               "begin with; rigid: keeps its shape until model:make_deformable"),
      number("zone_size", "m")
          .above(0)
          .doc("of an assembly: each block gets tetrahedra of about this edge length inside, so that it "
               "bends and shows where it is stressed; without it a few about its centroid. Joints between "
               "blocks stay as they are"),
      choice("bonds", {"cohesive", "springs", "none", "all", "regions", "listed"})
          .doc("what holds the parts of a body with a joint together. cohesive, the default of a mesh: the "
               "body is continuous, with shared nodes, until a face nears its strength. The face then "
               "follows the joint's softening or brittle law. It is recommended for bonded blocks too: they "
               "become one mesh in which each block is a region and the joints are the borders of regions. A "
               "uniform stress stays uniform, and the blocks part at the strength of the joint. springs, the "
               "default of an assembly: springs at the corners of faces (Han 2010), with a thickness. Where "
               "three or more blocks meet in an edge they carry 0.9 to 1.7 of a uniform traction, so that "
               "the first bond breaks at about half the strength. A mesh has three springs on every bonded "
               "face (Feng 2014), which soften the body and break at 0.6 to 0.9 of its strength. all, "
               "regions and listed are old words for springs"),
      choice("bonded_faces", {"all", "regions"})
          .doc("of a mesh with a joint, the inner faces that may break: all, the default, or those between "
               "different regions"),
      list("bonded_regions", whole_number, 1)
          .doc("of a mesh with a joint, instead of bonded_faces: numbers of regions, from 1, whose faces may "
               "break"),
      list("region_joints", tuple_type({whole_number, whole_number, object_type("Joint")}), 1)
          .doc(
              "of a mesh: {region, region, joint} gives the faces between two regions, or with the same "
              "number twice those inside one, a joint of their own; numbers from 1. All others have `joint`"),
      object("plasticity", "Plasticity")
          .doc("of a body that moves far: its tetrahedra yield by this law, cdem.plastic{...} or "
               "cdem.hoek_brown{...}"),
      list("region_plasticity", tuple_type({whole_number, object_type("Plasticity")}), 1)
          .doc("of a mesh: {region, law} gives a region a law of its own; numbers from 1. All others have "
               "`plasticity`, or are elastic without it"),
      number("stiffness_ratio")
          .above(0)
          .doc("of a mesh, beta in Kn = beta E A / (3 d). Springs have 10 by default; a body that is bonded "
               "everywhere keeps about E / (1 + 1/beta). A cohesive body has 1 by default, the penalty of "
               "freed faces, and keeps all of E"),
      number("shear_ratio").above(0).doc("of a mesh, Ks / Kn; 1 by default")};
  m.add(
      "model", "A model: bodies of blocks, and what holds touching bodies to each other.",
      {list("bodies", record_type(body)).required(),
       list("contacts", pair, 0)
           .beside(
               {object("default", "Joint")
                    .doc(
                        "of every two bodies that are not named, and of the units of a body that has no law "
                        "with "
                        "itself; of meshes it is cdem.coulomb. What a unit breaks into keeps the friction of "
                        "the joint that held it")})
           .doc("{\"body a\", \"body b\", joint} for every two bodies that touch; default = joint for all "
                "others")},
      make_model, "cdem.Model");
  bind_model_class(m);
}

} // namespace cdem::script
