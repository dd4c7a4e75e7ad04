#include "libcdem/first_model.hpp"

#include "libcdem/contact/initial/separate.hpp"
#include "libcdem/model/build/build_model.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/hilbert.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/mesh/parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace cdem {
namespace {

int body_index(const Model& model, const std::string& name) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (model.bodies[b].name == name)
      return b;
  std::string names;
  for (const Body& body : model.bodies)
    names += (names.empty() ? "\"" : ", \"") + body.name + "\"";
  throw geom::InputError("contacts", "\"" + name + "\"", "the name of a body (" + names + ")");
}

// Springs between blocks of small strain have no damping of their own.
void require_no_damping(const Joint& joint, const std::string& field, const std::string& of) {
  if (joint.stiffness_damping > 0)
    throw geom::InputError(field + ".stiffness_damping", number(joint.stiffness_damping),
                           "0 " + of + ", where it would do nothing",
                           "give the material viscosity, or leave element = \"small_strain\" out");
}

// Contacts of meshes have no interface: no blocks whose size a thickness is a part of, and no springs that are damped.
void require_law_of_meshes(const Joint& joint, const std::string& field, const std::string& value) {
  if (joint.stiffness_damping > 0)
    throw geom::InputError(field + " " + value + ": stiffness_damping", number(joint.stiffness_damping),
                           "0 for meshes, whose contacts it would not damp",
                           "give the contact restitution, or the materials stiffness_damping");
  if (joint.thickness_ratio != Joint().thickness_ratio)
    throw geom::InputError(field + " " + value + ": thickness_ratio", number(joint.thickness_ratio),
                           "left out for meshes, which have no block size", "give thickness (m)");
}

// The laws between the bodies of a spec. Faces of blocks that touch get the pair's joint. Bodies that move far get a
// contact as well: between blocks the friction of their joint, else the law itself.
class PairLaws {
public:
  // parts: of each body, how many it has: blocks, or connected parts of its meshes.
  PairLaws(Model& frame, const ModelSpec& spec, const std::vector<std::size_t>& parts)
      : frame_(frame), spec_(spec), parts_(parts) {}

  // field, value: what the user gave, for messages.
  void add(int a, int b, const Joint& joint, const std::string& field, const std::string& value) {
    if (is_small(a) != is_small(b))
      throw geom::InputError(
          field, value, "two bodies that move far, or two of small strain",
          "leave element = \"small_strain\" out: a body of small strain meets nothing new");
    if (are_blocks(a, b)) {
      if (a == b && is_small(a))
        throw geom::InputError(field, value, "two different bodies",
                               "what holds a body's own blocks together is the body's joint");
      if (a != b && !add_to(frame_.pair_joint, a, b, joint))
        throw geom::InputError(field, value, "given once", "two bodies have one joint between them");
      if (is_small(a)) {
        require_no_damping(joint, field + " " + value, "between bodies of small strain");
        return;
      }
    }
    if (has_law(joint.law) && !are_blocks(a, b))
      throw geom::InputError(
          field, value, "a law of meshes, cdem.coulomb{ friction_angle = ... }",
          "dilation, residual strength, Barton-Bandis and tables are laws of interfaces between blocks");
    if (joint.bonded && !(are_blocks(a, b) && a != b))
      throw geom::InputError(
          field, value, "cdem.coulomb{ friction_angle = ... } between meshes",
          "only bodies of convex blocks are bonded to each other: unite meshes of one material to one solid "
          "before "
          "meshing (regions of it may have joints), build bodies of different materials from blocks");
    if (!are_blocks(a, b))
      require_law_of_meshes(joint, field, value);
    if (!add_to(frame_.surface.joint, a, b, contact_of(a, b, joint)))
      throw geom::InputError(field, value, "given once", "two bodies have one law between them");
  }

  // What bonds held together meets with the friction of the joint that held it, where contacts names no law of the body with itself:
  // blocks that come loose, and what a mesh breaks into. A mesh without bonds has no joint: its parts need a law in contacts.
  void add_within_bodies() {
    for (int b = 0; b < count(); ++b) {
      if (!has_law_of_its_own(b) || frame_.surface.joint.count({b, b}) > 0)
        continue;
      const Joint law = contact_of(b, b, spec_.bodies[b].joint);
      if (are_blocks(b, b)) {
        add_to(frame_.surface.joint, b, b, law);
      } else {
        frame_.surface.within[b] = static_cast<int>(frame_.joints.size());
        frame_.joints.push_back(law);
      }
    }
  }

  // Parts of a mesh that nothing has ever held together, as the units of a layer, have that law where there is no default.
  void add_between_parts() {
    for (const auto& [b, law] : frame_.surface.within)
      frame_.surface.joint.emplace(std::pair(b, b), law);
  }

  // Blocks held by a joint set leave the contact that this set's law has.
  void add_left_by_sets() {
    for (int b = 0; b < count(); ++b)
      if (!is_small(b))
        for (const auto& [name, joint] : frame_.bodies[b].set_joint) {
          const Joint left = contact_of(b, b, frame_.joints[joint]);
          frame_.surface.left_by[joint] = static_cast<int>(frame_.joints.size());
          frame_.joints.push_back(left);
        }
  }

  // The law of all pairs that have none. A body of small strain meets none that moves far; require_separate says so.
  void add_default(const Joint& joint) {
    validate(joint);
    require_spring_strength(joint, "bodies (contacts.default)");
    for (int a = 0; a < count(); ++a)
      for (int b = a; b < count(); ++b) {
        const auto& given = is_small(a) || are_blocks(a, b) ? frame_.pair_joint : frame_.surface.joint;
        if (is_small(a) == is_small(b) && given.count({a, b}) == 0)
          add(a, b, joint, "contacts.default", joint.bonded ? "a joint that bonds" : "a contact");
      }
  }

private:
  int count() const { return static_cast<int>(frame_.bodies.size()); }
  bool has_law_of_its_own(int b) const {
    const Bonding& bonding = frame_.bodies[b].bonding;
    return !is_small(b) && (parts_[b] > 1 || bonding.is_cohesive()) && (are_blocks(b, b) || !bonding.none());
  }
  bool is_small(int body) const { return frame_.bodies[body].element == Element::small_strain; }
  bool are_blocks(int a, int b) const {
    return spec_.bodies[a].meshes.empty() && spec_.bodies[b].meshes.empty();
  }
  double block_size(int body) const { // m, in the mean
    double volume = 0;
    const auto& blocks = spec_.bodies[body].shape.blocks;
    for (const geom::Polyhedron& block : blocks)
      volume += geom::mass_properties(block).volume;
    return std::cbrt(volume / static_cast<double>(blocks.size()));
  }
  bool add_to(std::map<std::pair<int, int>, int>& laws, int a, int b, const Joint& law) {
    const bool fresh = laws.emplace(std::minmax(a, b), static_cast<int>(frame_.joints.size())).second;
    if (fresh)
      frame_.joints.push_back(law);
    return fresh;
  }
  // Between blocks as stiff as the joint that held them, so that nothing sinks when an interface is handed over; between
  // meshes as stiff as a layer of the joint's thickness where it gives one.
  Joint contact_of(int a, int b, const Joint& joint) const {
    if (!are_blocks(a, b) && !joint.bonded) {
      Joint contact = joint;
      if (joint.thickness)
        give_stiffness(contact, joint, a, b, *joint.thickness);
      return contact;
    }
    Joint contact;
    contact.bonded = false;
    contact.restitution = joint.restitution;
    contact.friction_angle =
        has_law(joint.law) ? geom::portable::atan2(friction_left(joint), 1) : joint.friction_angle;
    if (!are_blocks(a, b))
      return contact;
    give_stiffness(contact, joint, a, b,
                   joint.thickness.value_or(joint.thickness_ratio * 0.5 * (block_size(a) + block_size(b))));
    return contact;
  }
  // E/L and G/L, L the thickness (m), with the moduli of both bodies in series, unless the joint gives them.
  void give_stiffness(Joint& contact, const Joint& joint, int a, int b, double thickness) const {
    const Elastic &one = spec_.bodies[a].material, &other = spec_.bodies[b].material;
    const auto series = [&](double p, double q) { return 2 / (thickness * (1 / p + 1 / q)); };
    contact.normal_stiffness =
        joint.normal_stiffness.value_or(series(one.youngs_modulus, other.youngs_modulus));
    contact.shear_stiffness =
        joint.shear_stiffness.value_or(series(one.shear_modulus(), other.shear_modulus()));
  }

  Model& frame_;
  const ModelSpec& spec_;
  const std::vector<std::size_t>& parts_;
};

void require_zones(const BodySpec& body) {
  if (body.zone_size == 0)
    return;
  geom::require_above("zone_size", body.zone_size, 0, "m");
  if (!body.meshes.empty())
    throw geom::InputError("zone_size", "of a mesh", "of an assembly of convex blocks",
                           "a mesh has the size that it was made with");
  if (body.element == Element::small_strain)
    throw geom::InputError("zone_size", "of a body of small strain", "of a body that moves far",
                           "leave element = \"small_strain\" out");
}

void require_plasticity(const BodySpec& body) {
  if (body.plasticity.empty())
    return;
  for (const Plasticity& law : body.plasticity.laws)
    validate(law);
  if (body.element == Element::small_strain)
    throw geom::InputError("plasticity", "of a body of small strain", "of a body that moves far",
                           "leave element = \"small_strain\" out");
  if (body.bonding.is_cohesive())
    throw geom::InputError("plasticity", "of a body with cohesive faces",
                           "of a body without a joint, or with bonds = \"springs\"",
                           "leave the joint out, or the plasticity");
  for (const auto& [region, law] : body.plasticity.regions) {
    bool there = false;
    for (const geom::TetMesh& mesh : body.meshes)
      there = there || std::find(mesh.region.begin(), mesh.region.end(), region) != mesh.region.end();
    if (!there)
      throw geom::InputError("region_plasticity", std::to_string(region + 1),
                             "the number of a region of its mesh");
  }
}

// Laws of the body's joint sets and named cuts, and that of its glued faces.
void add_set_joints(Model& frame, int index, const BodySpec& body) {
  const auto add = [&](const Joint& joint) {
    validate(joint);
    frame.joints.push_back(joint);
    return static_cast<int>(frame.joints.size()) - 1;
  };
  require_set_names(body);
  Body& made = frame.bodies[index];
  for (const auto& [name, joint] : body.set_joints)
    made.set_joint[name] = add(joint);
  const auto& blocks = body.shape.blocks;
  if (std::any_of(blocks.begin(), blocks.end(), [](const geom::Polyhedron& block) {
        return std::any_of(block.faces.begin(), block.faces.end(),
                           [](const auto& face) { return face.glued; });
      }))
    made.glued_joint = add(glued_joint());
}

// The blocks of a body in the order of a Hilbert curve, which keeps neighbours near each other in memory; ids count them as
// they were built.
void add_seeds(Model& frame, int index, const geom::Assembly& shape, std::vector<BlockSeed>& seeds) {
  std::vector<geom::Vec3> places;
  places.reserve(shape.blocks.size());
  for (const geom::Polyhedron& block : shape.blocks)
    places.push_back(geom::bounding_box(block).centre());
  for (const int i : geom::along_hilbert_curve(places, geom::bounding_box(shape))) {
    BlockSeed seed;
    seed.id = frame.next_id + i;
    seed.body = index;
    seed.shape = shape.blocks[i];
    seeds.push_back(std::move(seed));
  }
  frame.next_id += static_cast<std::int64_t>(shape.blocks.size());
}

// The springs of interfaces are damped; contact, which is all that bodies have that touch later, is not.
void require_damps(const ModelSpec& spec, const Model& model) {
  std::set<std::pair<int, int>> touch;
  bool any_touch = false;
  for (const Interface& interface : model.interfaces) {
    const auto pair =
        std::minmax({model.blocks[interface.block_a].body, model.blocks[interface.block_b].body});
    touch.insert(pair);
    any_touch = any_touch || pair.first != pair.second;
  }
  const auto refuse = [](const std::string& field, const Joint& joint, const char* which) {
    throw geom::InputError(field + ": stiffness_damping", number(joint.stiffness_damping),
                           std::string("0 for bodies ") + which + ", whose contacts it would not damp",
                           "give the contact restitution, or the materials stiffness_damping");
  };
  for (const PairSpec& pair : spec.pairs)
    if (pair.joint.stiffness_damping > 0 &&
        touch.count(std::minmax(body_index(model, pair.body_a), body_index(model, pair.body_b))) == 0)
      refuse("contacts {\"" + pair.body_a + "\", \"" + pair.body_b + "\"}", pair.joint,
             "that do not touch when the model is built");
  if (spec.default_contact && spec.default_contact->stiffness_damping > 0 && !any_touch)
    refuse("contacts.default", *spec.default_contact, "of which none touch when the model is built");
}

} // namespace

void require_set_names(const BodySpec& body) {
  std::map<std::string, bool> glued; // by name, all faces
  for (const geom::Polyhedron& block : body.shape.blocks)
    for (const geom::PolyhedronFace& face : block.faces)
      if (!face.cut.empty())
        glued[face.cut] = glued.emplace(face.cut, true).first->second && face.glued;
  for (const auto& set : body.set_joints) {
    const std::string& name = set.first;
    const auto found = glued.find(name);
    if (found == glued.end()) {
      std::string names;
      for (const auto& known : glued)
        names += (names.empty() ? "\"" : ", \"") + known.first + (known.second ? "\", which is glued" : "\"");
      throw geom::InputError("joints of body \"" + body.name + "\"", "\"" + name + "\"",
                             names.empty() ? "the name of a joint set or cut; none of its cuts has a name"
                                           : "the name of a joint set or cut of its shape (" + names + ")",
                             names.empty() ? "give the set or cut a name = \"" + name + "\"" : "");
    }
    if (found->second)
      throw geom::InputError("joints of body \"" + body.name + "\"", "\"" + name + "\"",
                             "a cut that is not glued",
                             "leave glued = true out of the cut, or the law out here");
  }
}

Model first_model(const ModelSpec& spec) {
  if (spec.bodies.empty())
    throw geom::InputError("bodies", "{}", "a list of at least one body",
                           "add { shape = ..., material = ... }");
  Model frame;
  std::set<std::string> names;
  std::vector<BlockSeed> seeds;
  std::vector<MeshSeed> meshes;
  std::vector<std::size_t> parts;
  for (const BodySpec& body : spec.bodies) {
    if (!names.insert(body.name).second)
      throw geom::InputError("name", "\"" + body.name + "\"", "unique among the bodies");
    if (body.shape.blocks.empty() && body.meshes.empty())
      throw geom::InputError("shape", "an empty assembly", "at least one block");
    validate(body.material);
    validate(body.joint);
    const bool meshed = !body.meshes.empty();
    if (meshed)
      validate_meshed(body);
    else
      require_spring_strength(body.joint, "blocks of body \"" + body.name + "\"");
    require_zones(body);
    require_plasticity(body);
    if (body.element == Element::small_strain) {
      const std::string of = "between blocks of small strain";
      require_no_damping(body.joint, "joint of body \"" + body.name + "\"", of);
      for (const auto& [name, joint] : body.set_joints)
        require_no_damping(joint, "joints." + name + " of body \"" + body.name + "\"", of);
    }
    const int index = static_cast<int>(frame.bodies.size());
    frame.bodies.push_back(
        {body.name, body.material, body.joint, body.bonding, body.element, body.zone_size, body.region_laws});
    frame.bodies.back().region_laws.sort();
    frame.bodies.back().plasticity = body.plasticity;
    const std::size_t before = meshes.size();
    for (const geom::TetMesh& mesh : body.meshes)
      for (geom::TetMesh& part : geom::parts(mesh))
        meshes.push_back({0, index, 0, std::move(part)});
    parts.push_back(body.shape.blocks.size() + meshes.size() - before);
    frame.pair_joint[{index, index}] = static_cast<int>(frame.joints.size());
    frame.joints.push_back(body.joint);
    add_set_joints(frame, index, body);
    add_seeds(frame, index, body.shape, seeds);
  }
  PairLaws laws(frame, spec, parts);
  for (const PairSpec& pair : spec.pairs) {
    validate(pair.joint);
    require_spring_strength(pair.joint, "\"" + pair.body_a + "\" and \"" + pair.body_b + "\"");
    laws.add(body_index(frame, pair.body_a), body_index(frame, pair.body_b), pair.joint, "contacts",
             "{\"" + pair.body_a + "\", \"" + pair.body_b + "\"}");
  }
  laws.add_within_bodies();
  laws.add_left_by_sets();
  if (spec.default_contact)
    laws.add_default(*spec.default_contact);
  laws.add_between_parts();
  std::map<int, const JointAt*> varying; // by joint
  for (int b = 0; b < static_cast<int>(frame.bodies.size()); ++b) {
    if (spec.bodies[b].joint_at)
      varying[frame.pair_joint.at({b, b})] = &spec.bodies[b].joint_at;
    for (const auto& [name, joint_at] : spec.bodies[b].set_joints_at)
      varying[frame.bodies[b].set_joint.at(name)] = &joint_at;
  }
  const auto rule = [&](const Model& model, int block_a, int face_a, int block_b, int face_b) {
    InterfaceTraits traits = default_traits(model, block_a, face_a, block_b, face_b);
    if (const auto found = varying.find(traits.joint); found != varying.end())
      traits.joint_at = found->second;
    return traits;
  };
  Model model = build_model(frame, std::move(seeds), rule, std::move(meshes));
  require_separate(model);
  require_damps(spec, model);
  return model;
}

std::vector<std::array<int, 2>> pairs_without_interface(const ModelSpec& spec, const Model& model) {
  std::set<std::array<int, 2>> pairs;
  for (const PairSpec& pair : spec.pairs) {
    const int a = body_index(model, pair.body_a), b = body_index(model, pair.body_b);
    if (a == b && !model.bodies[a].bonding.none())
      continue; // the parts of a mesh meet once it breaks
    pairs.insert({std::min(a, b), std::max(a, b)});
  }
  for (int b = 0; b < static_cast<int>(spec.bodies.size()); ++b)
    if (spec.bodies[b].shape.blocks.size() > 1)
      pairs.insert({b, b});
  for (const Interface& interface : model.interfaces) {
    const int a = model.blocks[interface.block_a].body, b = model.blocks[interface.block_b].body;
    pairs.erase({std::min(a, b), std::max(a, b)});
  }
  return {pairs.begin(), pairs.end()};
}

} // namespace cdem
