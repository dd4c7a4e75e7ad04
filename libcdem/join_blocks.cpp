#include "libcdem/join_blocks.hpp"

#include "libcdem/first_model.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/meshing/joined_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdem {
namespace {

constexpr double relative_tolerance = 1e-7; // of the smallest block

const char* const springs_instead = "bonds = \"springs\" takes it";

void require_bond(const Joint& joint, const std::string& field) {
  validate(joint);
  if (!joint.bonded)
    throw geom::InputError(field, "a contact", "cdem.mohr_coulomb{...} with bonds = \"cohesive\"",
                           springs_instead);
}

void require_joinable(const BodySpec& body) {
  const std::string of = "of body \"" + body.name + "\" with bonds = \"cohesive\"";
  if (body.element != Element::finite_volume)
    throw geom::InputError("element " + of, body.element == Element::rigid ? "rigid" : "small_strain",
                           "finite_volume", "leave it out, or give bonds = \"springs\"");
  if (body.joint_at || !body.set_joints_at.empty())
    throw geom::InputError("joint " + of, "a function", "a Joint", springs_instead);
  require_bond(body.joint, "joint " + of);
  for (const auto& [name, joint] : body.set_joints)
    require_bond(joint, "joints." + name + " " + of);
}

// Of glued faces: no stress of rock reaches it.
Joint unbreakable() {
  Joint joint;
  joint.glued = true;
  joint.tensile_strength = joint.cohesion = 1e15;
  return joint;
}

geom::DividedFaces divided_faces_of(const std::vector<geom::Polyhedron>& blocks) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const geom::Polyhedron& block : blocks)
    smallest = std::min(smallest, std::cbrt(geom::mass_properties(block).volume));
  return geom::divided_faces(blocks, relative_tolerance * smallest);
}

} // namespace

void join_blocks(BodySpec& body) {
  require_joinable(body);
  require_set_names(body);
  const std::vector<geom::Polyhedron>& blocks = body.shape.blocks;
  const geom::DividedFaces all = divided_faces_of(blocks);
  std::map<std::pair<int, int>, const Joint*> own; // by regions
  const Joint held = unbreakable();
  if (body.joint.glued)
    body.joint = held;
  for (const geom::FacePart& part : all.parts) {
    if (part.block_b < 0)
      continue;
    const std::pair<int, int> regions = std::minmax(part.block_a, part.block_b);
    const geom::PolyhedronFace &a = blocks[part.block_a].faces[part.face_a],
                               &b = blocks[part.block_b].faces[part.face_b];
    if (a.glued && b.glued)
      own[regions] = &held;
    else
      for (const geom::PolyhedronFace* face : {&b, &a}) // that of the first block counts
        if (const auto found = body.set_joints.find(face->cut);
            !face->glued && found != body.set_joints.end())
          own[regions] = found->second.glued ? &held : &found->second;
  }
  for (const auto& [regions, joint] : own) {
    body.region_laws.regions.push_back(regions);
    body.region_laws.joints.push_back(*joint);
  }
  body.meshes = {body.zone_size > 0 ? geom::joined_mesh(blocks, all, body.zone_size)
                                    : geom::joined_mesh(blocks, all)};
  body.bonding.between_regions = true;
  body.shape = {};
  body.zone_size = 0;
  body.set_joints.clear();
}

} // namespace cdem
