#include "libcdem/first_model.hpp"

#include "libcdem/model/build.hpp"
#include "libcdem/model/separate.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libgeom/core/error.hpp"

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

// Between meshes nothing is glued.
void require_contact(const Joint& joint, const std::string& field, const std::string& value) {
  if (joint.bonded)
    throw geom::InputError(
        field, value, "cdem.coulomb{ friction_angle = ... } between meshes",
        "meshed bodies are not bonded to each other; unite them to one solid before meshing");
}

// The law of all pairs that have none. A mesh and an assembly of blocks have no contact; require_separate says so.
void add_default(Model& frame, const Joint& joint) {
  validate(joint);
  const int number = static_cast<int>(frame.joints.size()), count = static_cast<int>(frame.bodies.size());
  frame.joints.push_back(joint);
  for (int a = 0; a < count; ++a)
    for (int b = a; b < count; ++b) {
      const bool meshed = frame.bodies[a].element != Element::small_strain;
      if (meshed != (frame.bodies[b].element != Element::small_strain))
        continue;
      if (meshed)
        require_contact(joint, "contacts.default", "a joint that bonds");
      (meshed ? frame.surface.joint : frame.pair_joint).emplace(std::pair(a, b), number);
    }
}

} // namespace

Model first_model(const ModelSpec& spec) {
  if (spec.bodies.empty())
    throw geom::InputError("bodies", "{}", "a list of at least one body",
                           "add { shape = ..., material = ... }");
  Model frame;
  std::set<std::string> names;
  std::vector<BlockSeed> seeds;
  std::vector<MeshSeed> meshes;
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
    const int index = static_cast<int>(frame.bodies.size());
    frame.bodies.push_back(
        {body.name, body.material, body.joint, body.bonding, meshed ? body.element : Element::small_strain});
    for (const geom::TetMesh& mesh : body.meshes)
      meshes.push_back({0, index, mesh});
    frame.pair_joint[{index, index}] = static_cast<int>(frame.joints.size());
    frame.joints.push_back(body.joint);
    for (const geom::Polyhedron& block : body.shape.blocks) {
      BlockSeed seed;
      seed.body = index;
      seed.shape = block;
      seeds.push_back(std::move(seed));
    }
  }
  for (const PairSpec& pair : spec.pairs) {
    validate(pair.joint);
    const int a = body_index(frame, pair.body_a), b = body_index(frame, pair.body_b);
    const std::string both = "{\"" + pair.body_a + "\", \"" + pair.body_b + "\"}";
    const auto is_meshed = [&](int body) { return frame.bodies[body].element != Element::small_strain; };
    if (is_meshed(a) != is_meshed(b))
      throw geom::InputError("contacts", both, "two meshed bodies, or two of blocks",
                             "there is no contact between a mesh and an assembly of blocks; mesh both");
    if (is_meshed(a)) {
      require_contact(pair.joint, "contacts", both);
      if (!frame.surface.joint.emplace(std::minmax(a, b), static_cast<int>(frame.joints.size())).second)
        throw geom::InputError("contacts", both, "given once", "two bodies have one law between them");
      frame.joints.push_back(pair.joint);
      continue;
    }
    if (a == b)
      throw geom::InputError("contacts", both, "two different bodies",
                             "what holds a body's own blocks together is the body's joint");
    if (!frame.pair_joint.emplace(std::minmax(a, b), static_cast<int>(frame.joints.size())).second)
      throw geom::InputError("contacts", both, "given once", "two bodies have one joint between them");
    frame.joints.push_back(pair.joint);
  }
  if (spec.default_contact)
    add_default(frame, *spec.default_contact);
  Model model = build_model(frame, std::move(seeds), default_traits, std::move(meshes));
  require_separate(model);
  return model;
}

} // namespace cdem
