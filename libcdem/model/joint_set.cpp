#include "libcdem/model/joint_set.hpp"

#include "libgeom/core/error.hpp"

#include <set>

namespace cdem {

std::string joint_set_of(const Model& model, const Interface& interface) {
  const Block &a = model.blocks[interface.block_a], &b = model.blocks[interface.block_b];
  const geom::PolyhedronFace *const one = &a.shape.faces[interface.face_a], *const other =
                                                                                &b.shape
                                                                                     .faces[interface.face_b];
  if (one->glued && other->glued)
    return "";
  if (a.body == b.body)
    for (const auto* face : {one, other})
      if (!face->glued && model.bodies[a.body].set_joint.count(face->cut) > 0)
        return face->cut;
  return one->cut.empty() ? other->cut : one->cut;
}

std::vector<std::string> joint_sets(const Model& model) {
  std::set<std::string> names;
  for (const Interface& interface : model.interfaces)
    names.insert(joint_set_of(model, interface));
  names.erase("");
  return {names.begin(), names.end()};
}

void require_joint_set(const Model& model, const std::string& field, const std::string& name) {
  std::string known;
  for (const std::string& set : joint_sets(model)) {
    if (set == name)
      return;
    known += (known.empty() ? "\"" : ", \"") + set + "\"";
  }
  throw geom::InputError(field, "\"" + name + "\"",
                         known.empty() ? "the name of a joint set or cut; no interface of the model has one"
                                       : "the name of a joint set or cut between blocks (" + known + ")",
                         known.empty() ? "give the set or cut a name = \"" + name + "\"" : "");
}

} // namespace cdem
