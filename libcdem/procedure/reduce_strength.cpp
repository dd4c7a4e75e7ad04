#include "libcdem/procedure/reduce_strength.hpp"

#include "libcdem/joint/strength_reduction.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

bool any_joint_has_strength(const Model& model) {
  const auto has = [](const Joint& joint) { return has_strength(joint); };
  const auto acts = [&](const Interface& interface) { return has(model.joints[interface.joint]); };
  const auto meets = [&](const auto& law) { return has(model.joints[law.second]); };
  const auto bonded = [&](const Body& body) {
    return !body.bonding.none() && (has(body.joint) || std::any_of(body.region_laws.joints.begin(),
                                                                   body.region_laws.joints.end(), has));
  };
  return std::any_of(model.interfaces.begin(), model.interfaces.end(), acts) ||
         std::any_of(model.surface.joint.begin(), model.surface.joint.end(), meets) ||
         std::any_of(model.bodies.begin(), model.bodies.end(), bonded);
}

bool any_block_has_strength(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) {
    return std::any_of(body.plasticity.laws.begin(), body.plasticity.laws.end(),
                       [](const Plasticity& law) { return has_strength(law); });
  });
}

// What the other kind of strength would serve for.
std::string advice(bool other_has_strength, const char* other) {
  return other_has_strength ? std::string("; or write reduce = {\"") + other + "\"}, which has some here"
                            : "";
}

void reduce_joints(Model& model, double factor) {
  if (!any_joint_has_strength(model))
    throw geom::InputError("reduce: the joints of the model have no strength to reduce: no cohesion, no "
                           "friction, no tensile strength, or all are glued; give a body a joint with some" +
                           advice(any_block_has_strength(model), "blocks"));
  for (Joint& joint : model.joints)
    joint = reduced(joint, factor);
  for (Body& body : model.bodies) {
    body.joint = reduced(body.joint, factor);
    for (Joint& joint : body.region_laws.joints)
      joint = reduced(joint, factor);
  }
  for (FaceStrengthBatch& strength : model.mesh.strength)
    for (int lane = 0; lane < lanes; ++lane) {
      strength.cohesion[lane] /= factor;
      strength.tensile_strength[lane] /= factor;
      strength.tan_friction[lane] /= factor;
    }
}

void reduce_blocks(Model& model, double factor) {
  if (!any_block_has_strength(model))
    throw geom::InputError(
        "reduce: no body of the model has a plasticity whose strength could be reduced; give "
        "bodies plasticity = cdem.plastic{...}" +
        advice(any_joint_has_strength(model), "joints"));
  for (Body& body : model.bodies)
    for (Plasticity& law : body.plasticity.laws)
      law = reduced(law, factor);
}

} // namespace

void reduce_strength(Model& model, double factor, const StrengthKinds& kinds) {
  geom::require_above("factor", factor, 0);
  if (kinds.joints)
    reduce_joints(model, factor);
  if (kinds.blocks)
    reduce_blocks(model, factor);
}

} // namespace cdem
