#include "libcdem/simulation_checks.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <cmath>
#include <fmt/format.h>
#include <set>

namespace cdem {

std::string number(double x) {
  return fmt::format("{:g}", x);
}

void require_finite(const char* field, const geom::Vec3& v) {
  if (!v.allFinite())
    throw geom::InputError(field, fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z()), "finite");
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
  if (!(o.residual > 0 && o.residual < 1))
    throw geom::InputError("residual", number(o.residual), "in (0, 1)", "1e-6 is usual");
  if (o.max_steps <= 0)
    throw geom::InputError("max_steps", std::to_string(o.max_steps), "an integer > 0");
}

void check(const MassScaling& s) {
  if (!(s.step >= 0) || !std::isfinite(s.step))
    throw geom::InputError("mass_scaling.step", number(s.step), "a finite number > 0 s");
  if (s.factor != 0 && (!(s.factor >= 1) || !std::isfinite(s.factor)))
    throw geom::InputError("mass_scaling.factor", number(s.factor), "a finite number >= 1",
                           "it is the time step over the one that the true masses allow");
  if (s.step > 0 && s.factor > 0)
    throw geom::InputError("mass_scaling: give step (s) or factor, not both");
}

void check(const RunOptions& o) {
  check(o.mass_scaling);
  if (o.mass_scaling.on() && o.time_step > 0)
    throw geom::InputError("mass_scaling: names the time step itself; leave time_step out");
  const bool by_time = o.duration != 0;
  if (!std::isfinite(o.duration) || o.duration < 0)
    throw geom::InputError("duration", number(o.duration), "a finite number > 0 s");
  if (by_time == (o.steps != 0) || o.steps < 0)
    throw geom::InputError("run: give either duration (s) or steps (an integer > 0)");
  if (!(o.safety > 0 && o.safety <= 1))
    throw geom::InputError("safety", number(o.safety), "in (0, 1]");
  if (!(o.time_step >= 0) || !std::isfinite(o.time_step))
    throw geom::InputError("time_step", number(o.time_step), "a finite number > 0 s");
  if (!(o.local_damping >= 0 && o.local_damping < 1))
    throw geom::InputError("local_damping", number(o.local_damping), "in [0, 1)");
}

void check(const SettleOptions& o) {
  if (o.friction_angle && !(*o.friction_angle >= 0 && *o.friction_angle < M_PI / 2))
    throw geom::InputError("friction_angle", number(*o.friction_angle), "in [0, pi/2) rad");
  if (!(o.kinetic_energy_ratio > 0 && o.kinetic_energy_ratio < 1))
    throw geom::InputError("kinetic_energy_ratio", number(o.kinetic_energy_ratio), "in (0, 1)",
                           "1e-6 is usual");
  if (!(o.local_damping >= 0 && o.local_damping < 1))
    throw geom::InputError("local_damping", number(o.local_damping), "in [0, 1)");
  if (!(o.max_time > 0) || !std::isfinite(o.max_time))
    throw geom::InputError("max_time", number(o.max_time), "a finite number > 0 s");
  if (!(o.safety > 0 && o.safety <= 1))
    throw geom::InputError("safety", number(o.safety), "in (0, 1]");
  if (!(o.time_step >= 0) || !std::isfinite(o.time_step))
    throw geom::InputError("time_step", number(o.time_step), "a finite number > 0 s");
}

void check(const Flow& flow) {
  if (flow.water) {
    for (const auto& [name, value] : {std::pair("drag", flow.drag), std::pair("added_mass", flow.added_mass)})
      if (!(value >= 0 && value <= 100))
        throw geom::InputError(name, number(value), "from 0 to 100");
    return;
  }
  require_finite("direction", flow.direction);
  if (!(flow.direction.norm() > 0))
    throw geom::InputError("direction", "(0, 0, 0)", "longer than zero");
  if (!(flow.water_density > 0) || !std::isfinite(flow.water_density))
    throw geom::InputError("water_density", number(flow.water_density), "a finite number > 0 kg/m3");
}

void check(const CriticalFlowOptions& o) {
  check(o.flow);
  check(o.mass_scaling);
  const auto require = [](const char* field, double value, double low, double high, const char* allowed) {
    if (!(value > low && value < high))
      throw geom::InputError(field, number(value), allowed);
  };
  const double infinity = std::numeric_limits<double>::infinity();
  require("pressure_rate", o.pressure_rate, 0, infinity, "a finite number > 0 Pa/s");
  require("hold_periods", o.hold_periods, 0, infinity, "a finite number > 0");
  require("fragment_fraction", o.fragment_fraction, 0, 1, "in (0, 1)");
  require("compliance_ratio", o.compliance_ratio, 1, infinity, "a finite number > 1");
  require("max_velocity", o.max_velocity, 1, infinity, "a finite number > 1 m/s");
  if (!(o.safety > 0 && o.safety <= 1))
    throw geom::InputError("safety", number(o.safety), "in (0, 1]");
  if (!(o.local_damping >= 0 && o.local_damping < 1))
    throw geom::InputError("local_damping", number(o.local_damping), "in [0, 1)");
}

} // namespace cdem
