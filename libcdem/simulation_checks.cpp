#include "libcdem/simulation_checks.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <cmath>
#include <fmt/format.h>
#include <set>

namespace cdem {

using geom::require;
using geom::require_above;
using geom::require_at_least;
using geom::require_in;

std::string number(double x) {
  return fmt::format("{:g}", x);
}

void require_finite(const char* field, const geom::Vec3& v) {
  if (!v.allFinite())
    throw geom::InputError(field, geom::shown(v), "finite");
}

void require_spring_strength(const Joint& joint, const std::string& between) {
  if (joint.rate.on())
    throw geom::InputError("rate_effect", "of a joint between " + between,
                           "that of a mesh with bonds = \"cohesive\"",
                           "the springs of other bonds know no strain rate of the rock");
  if (joint.curve.on())
    throw geom::InputError("joint", "a Hoek-Brown strength, between " + between,
                           "that of a mesh with bonds = \"cohesive\"",
                           "the springs of other bonds know no principal stresses of the rock");
}

namespace {

void validate_mesh_joint(const BodySpec& body, const Joint& joint, const std::string& field) {
  const Bonding& b = body.bonding;
  if (b.none())
    return;
  if (!b.is_cohesive() && joint.softening != Softening::none)
    throw geom::InputError("softening", "on the faces of a mesh with springs", "none there",
                           "bonds = \"cohesive\" softens");
  if (has_law(joint.law))
    throw geom::InputError(field, "a joint with dilation, residual strength or another law of interfaces",
                           "cdem.mohr_coulomb or cdem.coulomb without them on the faces of a mesh",
                           "cdem.blocks{ mesh = ... } makes blocks of the tetrahedra");
  if (!b.is_cohesive())
    require_spring_strength(joint, "springs of the mesh of body \"" + body.name + "\"");
  if (b.is_cohesive() && !(joint.bonded && joint.tensile_strength > 0 && joint.cohesion > 0))
    throw geom::InputError(field +
                           ": a cohesive body needs a tensile_strength and a cohesion > 0 Pa, below which it "
                           "is continuous; bonds = \"springs\" takes any joint (body \"" +
                           body.name + "\")");
  const Joint standard;
  if (joint.thickness || joint.normal_stiffness || joint.shear_stiffness ||
      joint.thickness_ratio != standard.thickness_ratio)
    throw geom::InputError(field +
                           ": its thickness and stiffnesses are for convex blocks; the bonds of a mesh take "
                           "stiffness_ratio and shear_ratio of body \"" +
                           body.name + "\"");
}

// Regions that share a face; twice the same: two tets of it do.
std::set<std::pair<int, int>> regions_that_meet(const BodySpec& body) {
  std::set<std::pair<int, int>> meet;
  for (const geom::TetMesh& mesh : body.meshes)
    for (const geom::InnerFace& face : geom::inner_faces(mesh))
      meet.insert(std::minmax(mesh.region[face.tets[0]], mesh.region[face.tets[1]]));
  return meet;
}

void validate_region_laws(const BodySpec& body) {
  if (body.region_laws.empty())
    return;
  int count = 0;
  for (const geom::TetMesh& mesh : body.meshes)
    count = std::max(count, *std::max_element(mesh.region.begin(), mesh.region.end()) + 1);
  const std::set<std::pair<int, int>> meet = regions_that_meet(body);
  std::set<std::pair<int, int>> given;
  for (std::size_t row = 0; row < body.region_laws.regions.size(); ++row) {
    const auto [a, b] = body.region_laws.regions[row];
    const std::string field = "region_joints[" + std::to_string(row + 1) + "]";
    for (const int region : {a, b})
      if (region < 0 || region >= count)
        throw geom::InputError(field, std::to_string(region + 1),
                               "regions of the mesh of body \"" + body.name + "\" (1 to " +
                                   std::to_string(count) + ")");
    const std::string value = "{" + std::to_string(a + 1) + ", " + std::to_string(b + 1) + "}";
    if (!given.insert({a, b}).second)
      throw geom::InputError(field, value, "given once", "another row has the same regions");
    if (!body.bonding.bonds(a, b))
      throw geom::InputError(field, value, "regions whose faces are bonded",
                             "bonded_faces = \"all\" bonds every face of the mesh");
    if (meet.count({a, b}) == 0)
      throw geom::InputError(field, value, "regions that share faces", "these two do not touch");
    const Joint& joint = body.region_laws.joints[row];
    validate(joint);
    if (!joint.bonded)
      throw geom::InputError(field, "a contact", "cdem.mohr_coulomb{...}", "the faces of a mesh are bonded");
    validate_mesh_joint(body, joint, field);
  }
}

} // namespace

void validate_meshed(const BodySpec& body) {
  const Bonding& b = body.bonding;
  if (body.element == Element::small_strain)
    throw geom::InputError("element", "small_strain", "finite_volume or rigid for a mesh",
                           "small_strain is for assemblies of convex blocks");
  if (!(b.stiffness_ratio > 0 && b.stiffness_ratio <= 1e4))
    throw geom::InputError("stiffness_ratio", number(b.stiffness_ratio), "in (0, 1e4]",
                           "10 keeps about 0.91 of Young's modulus");
  if (!(b.shear_ratio > 0 && b.shear_ratio <= 100))
    throw geom::InputError("shear_ratio", number(b.shear_ratio), "in (0, 100]", "1 is usual");
  validate_mesh_joint(body, body.joint, "joint");
  validate_region_laws(body);
  if (!body.shape.blocks.empty())
    throw geom::InputError("shape", "blocks and meshes in one body", "one of them", "make two bodies");
  for (std::size_t i = 0; i < body.meshes.size(); ++i) {
    const geom::TetMesh& mesh = body.meshes[i];
    geom::validate(mesh, "the mesh of body \"" + body.name + "\"");
    const int regions = *std::max_element(mesh.region.begin(), mesh.region.end()) + 1;
    for (const int region : b.regions)
      if (region < 0 || region >= regions)
        throw geom::InputError("bonded_regions", std::to_string(region + 1),
                               "a region of the mesh (1 to " + std::to_string(regions) + ")");
  }
}

void check(const RelaxOptions& o) {
  require_in("residual", o.residual, "(0, 1)", "1e-6 is usual");
  require(o.max_steps > 0, "max_steps", static_cast<double>(o.max_steps), "an integer > 0");
}

void check(const MassScaling& s) {
  require(s.step >= 0 && std::isfinite(s.step), "mass_scaling.step", s.step, "a finite number > 0 s");
  if (s.factor != 0)
    require_at_least("mass_scaling.factor", s.factor, 1, "",
                     "it is the time step over the one that the true masses allow");
  if (s.step > 0 && s.factor > 0)
    throw geom::InputError("mass_scaling: give step (s) or factor, not both");
}

namespace {

// 0: the stable one.
void check_time_step(double time_step) {
  require(time_step >= 0 && std::isfinite(time_step), "time_step", time_step, "a finite number > 0 s");
}

} // namespace

void check(const RunOptions& o) {
  check(o.mass_scaling);
  if (o.mass_scaling.on() && o.time_step > 0)
    throw geom::InputError("mass_scaling: names the time step itself; leave time_step out");
  require(o.duration >= 0 && std::isfinite(o.duration), "duration", o.duration, "a finite number > 0 s");
  if ((o.duration != 0) == (o.steps != 0) || o.steps < 0)
    throw geom::InputError("run: give either duration (s) or steps (an integer > 0)");
  require_in("safety", o.safety, "(0, 1]");
  check_time_step(o.time_step);
  require_in("local_damping", o.local_damping, "[0, 1)");
}

void check(const SettleOptions& o) {
  if (o.friction_angle)
    require(*o.friction_angle >= 0 && *o.friction_angle < M_PI / 2, "friction_angle", *o.friction_angle,
            "in [0, pi/2) rad");
  require_in("kinetic_energy_ratio", o.kinetic_energy_ratio, "(0, 1)", "1e-6 is usual");
  require_in("local_damping", o.local_damping, "[0, 1)");
  require_above("max_time", o.max_time, 0, "s");
  require_in("safety", o.safety, "(0, 1]");
  check_time_step(o.time_step);
}

void check(const Flow& flow) {
  if (flow.water) {
    for (const auto& [name, value] : {std::pair("drag", flow.drag), std::pair("added_mass", flow.added_mass)})
      require(value >= 0 && value <= 100, name, value, "from 0 to 100");
    return;
  }
  require_finite("direction", flow.direction);
  if (!(flow.direction.norm() > 0))
    throw geom::InputError("direction", "(0, 0, 0)", "longer than zero");
  require_above("water_density", flow.water_density, 0, "kg/m3");
}

void check(const CriticalFlowOptions& o) {
  check(o.flow);
  check(o.mass_scaling);
  require_above("pressure_rate", o.pressure_rate, 0, "Pa/s");
  require_above("hold_periods", o.hold_periods, 0);
  require_in("fragment_fraction", o.fragment_fraction, "(0, 1)");
  require_above("compliance_ratio", o.compliance_ratio, 1);
  require_above("max_velocity", o.max_velocity, 1, "m/s");
  require_in("safety", o.safety, "(0, 1]");
  require_in("local_damping", o.local_damping, "[0, 1)");
}

} // namespace cdem
