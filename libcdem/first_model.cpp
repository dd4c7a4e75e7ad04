#include "libcdem/first_model.hpp"

#include "libcdem/model/build/build_model.hpp"
#include "libcdem/model/separate.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libgeom/core/error.hpp"

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

// Between meshes nothing is glued.
void require_contact(const Joint& joint, const std::string& both) {
  if (joint.bonded)
    throw geom::InputError(
        "contacts", both, "cdem.coulomb{ friction_angle = ... } between meshes",
        "meshed bodies are not bonded to each other; unite them to one solid before meshing");
}

void add_contact(Model& frame, int a, int b, const Joint& law, const std::string& both) {
  if (!frame.surface.joint.emplace(std::minmax(a, b), static_cast<int>(frame.joints.size())).second)
    throw geom::InputError("contacts", both, "given once", "two bodies have one law between them");
  frame.joints.push_back(law);
}

double mean_block_size(const BodySpec& body) {
  double volume = 0;
  for (const geom::Polyhedron& block : body.shape.blocks)
    volume += geom::mass_properties(block).volume;
  return std::cbrt(volume / static_cast<double>(body.shape.blocks.size()));
}

// The contact of what such a joint held together: its friction, and as stiff as it was, so that nothing sinks when an
// interface is handed over.
Joint contact_after(const Joint& joint, const BodySpec& a, const BodySpec& b) {
  Joint contact;
  contact.bonded = false;
  contact.friction_angle = joint.friction_angle;
  const double thickness =
      joint.thickness.value_or(joint.thickness_ratio * 0.5 * (mean_block_size(a) + mean_block_size(b)));
  const auto series = [&](double p, double q) { return 2 / (thickness * (1 / p + 1 / q)); };
  contact.normal_stiffness =
      joint.normal_stiffness.value_or(series(a.material.youngs_modulus, b.material.youngs_modulus));
  contact.shear_stiffness =
      joint.shear_stiffness.value_or(series(a.material.shear_modulus(), b.material.shear_modulus()));
  return contact;
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
    frame.bodies.push_back({body.name, body.material, body.joint, body.bonding,
                            body.element.value_or(meshed ? Element::finite_volume : Element::small_strain)});
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
    const auto is_small = [&](int body) { return frame.bodies[body].element == Element::small_strain; };
    const auto is_mesh = [&](int body) { return !spec.bodies[body].meshes.empty(); };
    if (is_small(a) != is_small(b))
      throw geom::InputError(
          "contacts", both, "two bodies that move far, or two of small strain",
          "leave element = \"small_strain\" out: a body of small strain meets nothing new");
    if (is_mesh(a) || is_mesh(b)) {
      require_contact(pair.joint, both);
      add_contact(frame, a, b, pair.joint, both);
      continue;
    }
    if (a == b && !is_small(a)) {
      require_contact(pair.joint, both);
      add_contact(frame, a, b, pair.joint, both);
      continue;
    }
    if (a == b)
      throw geom::InputError("contacts", both, "two different bodies",
                             "what holds a body's own blocks together is the body's joint");
    if (!frame.pair_joint.emplace(std::minmax(a, b), static_cast<int>(frame.joints.size())).second)
      throw geom::InputError("contacts", both, "given once", "two bodies have one joint between them");
    frame.joints.push_back(pair.joint);
    if (!is_small(a))
      add_contact(frame, a, b, contact_after(pair.joint, spec.bodies[a], spec.bodies[b]), both);
  }
  // The blocks of a body that come loose meet with the friction of their joint.
  for (int b = 0; b < static_cast<int>(frame.bodies.size()); ++b)
    if (const BodySpec& body = spec.bodies[b]; frame.bodies[b].element != Element::small_strain &&
                                               body.shape.blocks.size() > 1 &&
                                               frame.surface.joint.count({b, b}) == 0)
      add_contact(frame, b, b, contact_after(body.joint, body, body), body.name);
  Model model = build_model(frame, std::move(seeds), default_traits, std::move(meshes));
  require_separate(model);
  return model;
}

} // namespace cdem
