#include "lua/binding/functions/mesh_body.hpp"

#include "lua/binding/session/model_object.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

using geom::InputError;

namespace {

// Which faces of a mesh its joint stands on.
void read_bonded_faces(const Arguments& given, const std::string& path, const std::string& which,
                       Bonding& bonding) {
  if (given.has("bonded_regions") && which == "regions")
    throw InputError(path + ".bonded_regions: these regions or bonded_faces = \"regions\", not both");
  for (const double region : given.numbers("bonded_regions"))
    bonding.regions.push_back(static_cast<int>(region) - 1);
  bonding.between_regions = which == "regions";
  bonding.everywhere = which == "all" && bonding.regions.empty();
}

int count_regions(const std::vector<geom::TetMesh>& meshes) {
  int last = 0;
  for (const geom::TetMesh& mesh : meshes)
    for (const int region : mesh.region)
      last = std::max(last, region);
  return last + 1;
}

// Faces between regions where there is one only: their joint would hold nothing.
void warn_of_one_region(Session& session, const std::string& path, const BodySpec& body) {
  if (body.bonding.between_regions && count_regions(body.meshes) == 1)
    session.warn(
        path + ".bonded_faces = \"regions\": the mesh has one region, so the joint holds no face; a file has "
               "regions by its physical groups, volumes, cell data or element sets: see `regions` of "
               "cdem.read_mesh");
}

} // namespace

void read_mesh(Session& session, const Arguments& given, const std::string& path,
               std::vector<geom::TetMesh> meshes, BodySpec& body) {
  const std::string element = given.text_or("element", "finite_volume");
  if (element == "small_strain")
    throw InputError(path + ".element", "\"small_strain\"", "finite_volume or rigid for a mesh",
                     "small_strain is for assemblies of convex blocks");
  body.element = element == "rigid" ? Element::rigid : Element::finite_volume;
  body.meshes = std::move(meshes);
  std::string bonds = given.text_or("bonds", given.has("joint") ? "cohesive" : "none"),
              faces = given.text_or("bonded_faces", "all");
  if (bonds == "all" || bonds == "regions" || bonds == "listed") { // as older scripts wrote it
    if (bonds == "listed" && !given.has("bonded_regions"))
      throw InputError(path + ".bonded_regions: missing; bonds = \"listed\" needs to know which");
    faces = bonds == "regions" ? bonds : "all";
    session.warn(path + ".bonds = \"" + bonds +
                 "\" says which faces are bonded, as of old; write bonds = \"springs\"" +
                 (faces == "regions" ? ", bonded_faces = \"regions\"" : "") +
                 ". The next version refuses it");
    bonds = "springs";
  }
  if (bonds != "none" && !given.has("joint"))
    throw InputError(path + ".joint: missing; bonds = \"" + bonds +
                     "\" needs to know what holds the faces, cdem.mohr_coulomb{...}");
  if (bonds == "none" && given.has("joint"))
    throw InputError(path + ".bonds", "\"none\"", "cohesive or springs with a joint", "leave the joint out");
  if (bonds == "none")
    for (const char* const only : {"bonded_faces", "bonded_regions"})
      if (given.has(only))
        throw InputError(path + "." + only + ": goes with a joint, which says what the faces bear");
  if (bonds != "none")
    read_bonded_faces(given, path, faces, body.bonding);
  std::size_t row = 0;
  for (const Value& law : given.list("region_joints")) {
    ++row;
    if (bonds == "none")
      throw InputError(path + ".region_joints: goes with a joint, which the other faces have");
    const Values& items = law.table()->items;
    const auto region = [&](int i) { return static_cast<int>(items[i].number()) - 1; };
    body.region_laws.regions.emplace_back(std::minmax({region(0), region(1)}));
    body.region_laws.joints.push_back(static_cast<const JointObject&>(*items[2].object()).joint);
  }
  warn_of_one_region(session, path, body);
  if (bonds == "springs" && body.joint.bonded && body.joint.tensile_strength > 0 && body.joint.cohesion > 0 &&
      body.joint.softening == Softening::none)
    session.warn(
        path + ".bonds = \"springs\" softens the body to about E / (1 + 1/stiffness_ratio) and breaks at 0.6 "
               "to 0.9 of its strength; bonds = \"cohesive\" keeps both");
  if (bonds == "cohesive") {
    body.bonding.kind = BondKind::cohesive;
    body.bonding.stiffness_ratio = 1;
  }
  body.bonding.stiffness_ratio =
      given.optional_number("stiffness_ratio").value_or(body.bonding.stiffness_ratio);
  body.bonding.shear_ratio = given.optional_number("shear_ratio").value_or(body.bonding.shear_ratio);
}

} // namespace cdem::script
