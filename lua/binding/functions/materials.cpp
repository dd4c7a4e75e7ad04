// Materials and joints.
#include "lua/binding/functions/angles.hpp"
#include "lua/binding/functions/joint_laws.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

// Rayleigh's alpha and beta for a fraction of critical damping at one frequency, where the sum of the two, alpha / 2w +
// beta w / 2, is least.
void read_damping(const Arguments& a, Elastic& elastic) {
  const auto damping = a.record("damping");
  if (!damping)
    return;
  for (const char* const own : {"viscosity", "stiffness_damping"})
    if (a.number(own) != 0)
      throw geom::InputError(std::string(own) +
                             ": damping = { fraction, frequency } sets it; give one of the two");
  const double fraction = damping->number("fraction"),
               w = 2 * 3.14159265358979323846 * damping->number("frequency");
  const std::string& of = damping->text("of");
  const double share = of == "both" ? 1 : 2;
  if (of != "stiffness")
    elastic.viscosity = share * fraction * w * elastic.density;
  if (of != "mass")
    elastic.stiffness_damping = share * fraction / w;
}

Value elastic(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<MaterialObject>();
  object->elastic.youngs_modulus = a.number("youngs_modulus");
  object->elastic.poissons_ratio = a.number("poissons_ratio");
  object->elastic.density = a.number("density");
  object->elastic.viscosity = a.number("viscosity");
  object->elastic.stiffness_damping = a.number("stiffness_damping");
  read_damping(a, object->elastic);
  validate(object->elastic);
  return object;
}

std::vector<Field> softening_fields() {
  return {
      choice("softening", {"none", "linear", "exponential"})
          .standard("none")
          .doc("how the strength falls once it is reached; none: brittle. It needs both fracture energies, "
               "and tensile_strength at most cohesion / tan(friction angle)"),
      fracture_energy_field("fracture_energy_1")
          .doc("G_I, work per crack area that opening to separation takes, elastic part included"),
      fracture_energy_field("fracture_energy_2").doc("G_II, the same for slip, beyond the work of friction")};
}

void read_softening(const Arguments& a, Joint& joint) {
  const std::string& curve = a.text("softening");
  joint.softening = curve == "linear"        ? Softening::linear
                    : curve == "exponential" ? Softening::exponential
                                             : Softening::none;
  joint.fracture_energy_1 = a.optional_number("fracture_energy_1").value_or(0);
  joint.fracture_energy_2 = a.optional_number("fracture_energy_2").value_or(0);
}

std::vector<Field> strength_fields() {
  return {
      record("weibull", {number("modulus").within(2, 1000).required().doc("m"),
                         number("reference_volume")
                             .above(0)
                             .unit("m3")
                             .required()
                             .doc("the volume whose mean strength the joint gives"),
                         integer("seed").at_least(0).required()})
          .doc("strength that scatters from face to face after Weibull: tensile strength and cohesion of a "
               "face are multiplied by one draw, in the mean (reference_volume / volume of the face)^(1/m); "
               "fracture energies and friction stay. A draw depends on the seed and on where the face lies"),
      record("rate_effect",
             {number("reference_rate").above(0).unit("1/s").required().doc("of the strengths given"),
              number("exponent").within(0, 1).required(),
              number("change_rate").above(0).unit("1/s").doc("beyond it exponent_above holds"),
              number("exponent_above").within(0, 1),
              flag("fracture_energy").standard(false).doc("fracture energies are raised too")})
          .doc("strength raised by the rate of strain at which a face of a cohesive body begins to crack, "
               "(rate / reference_rate)^exponent; fib Model Code 2010 for concrete in tension: 1e-6, 0.018, "
               "10, 1/3")};
}

void read_strength(const Arguments& a, Joint& joint) {
  if (const auto weibull = a.record("weibull"))
    joint.scatter = {weibull->number("modulus"), weibull->number("reference_volume"),
                     static_cast<std::uint64_t>(weibull->integer("seed"))};
  const auto rate = a.record("rate_effect");
  if (!rate)
    return;
  joint.rate.reference_rate = rate->number("reference_rate");
  joint.rate.exponent = rate->number("exponent");
  joint.rate.fracture_energy = rate->flag("fracture_energy");
  if (rate->has("change_rate") != rate->has("exponent_above"))
    throw geom::InputError("rate_effect: change_rate and exponent_above go together: from that rate on the "
                           "strength grows with that exponent");
  if (rate->has("change_rate")) {
    joint.rate.change_rate = rate->number("change_rate");
    joint.rate.exponent_above = rate->number("exponent_above");
  }
}

std::string softening_name(const Joint& joint) {
  switch (joint.softening) {
  case Softening::none:
    break;
  case Softening::linear:
    return "linear";
  case Softening::exponential:
    return "exponential";
  }
  return "none";
}

Value mohr_coulomb(Session& session, Object*, const Arguments& a) {
  auto object = std::make_shared<JointObject>();
  object->joint.bonded = true;
  object->joint.cohesion = a.number("cohesion");
  object->joint.friction_angle = radians(a.number("friction_angle"));
  object->joint.tensile_strength = a.number("tensile_strength");
  read_softening(a, object->joint);
  read_strength(a, object->joint);
  read_residual_strength(session, a, object->joint);
  read_joint_stiffness(a, object->joint);
  validate(object->joint);
  return object;
}

Value coulomb(Session& session, Object*, const Arguments& a) {
  auto object = std::make_shared<JointObject>();
  object->joint.bonded = false;
  object->joint.friction_angle = radians(a.number("friction_angle"));
  object->joint.restitution = a.number("restitution");
  read_residual_strength(session, a, object->joint);
  read_joint_stiffness(a, object->joint);
  validate(object->joint);
  return object;
}

Value glued(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<JointObject>();
  object->joint = glued_joint();
  read_joint_stiffness(a, object->joint);
  validate(object->joint);
  return object;
}

Value plastic(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<PlasticityObject>();
  Plasticity& rock = object->plasticity;
  rock.cohesion = a.number("cohesion");
  rock.friction_angle = radians(a.number("friction_angle"));
  rock.dilation_angle = radians(a.number("dilation_angle"));
  rock.tensile_strength = a.number("tensile_strength");
  rock.softening_strain = a.optional_number("softening_strain").value_or(0);
  rock.residual_cohesion = a.optional_number("residual_cohesion").value_or(rock.cohesion);
  rock.residual_tensile_strength =
      a.optional_number("residual_tensile_strength").value_or(rock.tensile_strength);
  rock.residual_friction_angle =
      a.has("residual_friction_angle") ? radians(a.number("residual_friction_angle")) : rock.friction_angle;
  const bool softens =
      a.has("residual_cohesion") || a.has("residual_tensile_strength") || a.has("residual_friction_angle");
  if (softens != a.has("softening_strain"))
    throw geom::InputError(
        "softening_strain: goes together with residual_cohesion, residual_friction_angle or "
        "residual_tensile_strength: over that plastic strain the strength falls to them");
  validate(rock);
  return object;
}

} // namespace

void bind_materials(Module& m) {
  m.add("elastic", "Isotropic linear elasticity (Han 2010 eq 3).",
        {modulus_field("youngs_modulus").required().doc("Young's modulus E"),
         number("poissons_ratio").between(-1, 0.5).required().doc("Poisson's ratio nu"),
         density_field("density").required(),
         number("viscosity")
             .at_least(0)
             .standard(0.0)
             .unit("N s/m4")
             .doc("damping force per volume and velocity, mu of Han 2010 eq 1; used by real-time stepping"),
         number("stiffness_damping")
             .at_least(0)
             .standard(0.0)
             .unit("s")
             .doc("beta of Rayleigh damping, of meshes in real-time stepping: a vibration of angular "
                  "frequency w has beta w / 2 of critical damping, motion as a rigid body none"),
         record("damping",
                {number("fraction").between(0, 1).required().doc("of critical damping at the frequency"),
                 number("frequency").above(0).unit("Hz").required(),
                 choice("of", {"both", "mass", "stiffness"})
                     .standard("both")
                     .doc("half of it each, and more at other frequencies; or all by viscosity (falls with "
                          "the frequency, holds back motion as a rigid body); or all by stiffness_damping "
                          "(grows with the frequency, shortens the stable step)")})
             .doc("Rayleigh damping by the fraction of critical damping, in place of viscosity and "
                  "stiffness_damping")},
        elastic, "cdem.Material");

  m.add("plastic",
        "Mohr-Coulomb plasticity with tension cut-off, dilation and softening, of the tetrahedra of blocks "
        "and meshes (docs/theory.md, section 25).",
        {strength_field("cohesion").required(), friction_field("friction_angle").required(),
         strength_field("tensile_strength")
             .required()
             .doc("what is beyond the tip of the cone, cohesion / tan(friction_angle), does not act"),
         number("dilation_angle").from(0, 90).standard(0.0).unit("deg").doc("at most friction_angle"),
         strength_field("residual_cohesion").doc("at softening_strain; the peak's when left out"),
         friction_field("residual_friction_angle"), strength_field("residual_tensile_strength"),
         number("softening_strain")
             .above(0)
             .doc("equivalent plastic strain at which the residual strength is reached, linearly; without "
                  "fracture energy, so that what it dissipates depends on the size of the elements")},
        plastic, "cdem.Plasticity");
  Class plasticity{"Plasticity", "Made by cdem.plastic or cdem.hoek_brown."};
  const auto of_plasticity = [&](std::string name, std::string unit, auto get) {
    plasticity.property(std::move(name), "number", std::move(unit), "",
                        [get](const PlasticityObject& p) { return std::invoke(get, p.plasticity); });
  };
  of_plasticity("cohesion", "Pa", &Plasticity::cohesion);
  of_plasticity("friction_angle", "deg", [](const Plasticity& p) { return degrees(p.friction_angle); });
  of_plasticity("dilation_angle", "deg", [](const Plasticity& p) { return degrees(p.dilation_angle); });
  of_plasticity("tensile_strength", "Pa", &Plasticity::tensile_strength);
  m.classes.push_back(plasticity);

  std::vector<Field> bonded{strength_field("cohesion").required(),
                            friction_field("friction_angle").required(),
                            strength_field("tensile_strength").required()};
  std::vector<Field> loose{friction_field("friction_angle").required()};
  for (const Field& f : residual_strength_fields())
    bonded.push_back(f);
  for (const Field& f : dilation_fields()) {
    bonded.push_back(f);
    loose.push_back(f);
  }
  for (const Field& f : softening_fields())
    bonded.push_back(f);
  for (const Field& f : strength_fields())
    bonded.push_back(f);
  for (const Field& f : joint_stiffness_fields()) {
    bonded.push_back(f);
    loose.push_back(f);
  }
  loose.push_back(number("restitution")
                      .within(0.01, 1)
                      .standard(1.0)
                      .doc("coefficient of restitution of the contact of bodies that move far: speed after "
                           "over speed before an impact, as far as the contact and not waves within the "
                           "bodies decide it; 1: the contact loses nothing but by friction"));
  m.add("mohr_coulomb",
        "Bond between block faces. It breaks in tension above the tensile strength, and in shear above "
        "cohesion + normal pressure x tan(friction angle). Then it is a contact with the same friction "
        "angle, or with the residual strength that is given (Han 2010 eqs 8-11). With softening it loses its "
        "strength along a curve whose area is the fracture energy.",
        bonded, mohr_coulomb, "cdem.Joint");
  m.add("coulomb", "Contact that never was bonded: no tension, friction only (Han 2010 eq 9).", loose,
        coulomb, "cdem.Joint");

  std::vector<Field> stiff = joint_stiffness_fields();
  stiff[0].standard(glued_thickness_ratio);
  m.add("glued",
        "Bond that never breaks, of faces that are no joint, such as those of an excavation outline. It is "
        "four times as stiff as a joint by default.",
        stiff, glued, "cdem.Joint");

  Class material{"Material", "Made by cdem.elastic."};
  const auto of_material = [&](std::string name, std::string unit, std::string doc, auto get) {
    material.property(std::move(name), "number", std::move(unit), std::move(doc),
                      [get](const MaterialObject& self) { return std::invoke(get, self.elastic); });
  };
  of_material("youngs_modulus", "Pa", "", &Elastic::youngs_modulus);
  of_material("poissons_ratio", "", "", &Elastic::poissons_ratio);
  of_material("density", "kg/m3", "", &Elastic::density);
  of_material("viscosity", "N s/m4", "", &Elastic::viscosity);
  of_material("stiffness_damping", "s", "beta of Rayleigh damping", &Elastic::stiffness_damping);
  of_material("shear_modulus", "Pa", "G = E / 2(1 + nu)", &Elastic::shear_modulus);
  of_material("p_wave_modulus", "Pa", "lambda + 2 G", &Elastic::p_wave_modulus);
  material.text = [](const Object& self) {
    const Elastic& e = static_cast<const MaterialObject&>(self).elastic;
    return "cdem.Material (E " + number_text(e.youngs_modulus) + " Pa, nu " + number_text(e.poissons_ratio) +
           ", " + number_text(e.density) + " kg/m3)";
  };
  m.classes.push_back(material);

  Class joint{"Joint", "Made by cdem.mohr_coulomb, cdem.hoek_brown_bond, cdem.coulomb, cdem.barton_bandis, "
                       "cdem.joint_table or cdem.glued."};
  const auto of_joint = [&](std::string name, std::string type, std::string unit, auto get) {
    joint.property(std::move(name), std::move(type), std::move(unit), "",
                   [get](const JointObject& j) { return std::invoke(get, j.joint); });
  };
  of_joint("bonded", "boolean", "", &Joint::bonded);
  of_joint("glued", "boolean", "", &Joint::glued);
  of_joint("cohesion", "number", "Pa", &Joint::cohesion);
  of_joint("friction_angle", "number", "deg", [](const Joint& j) { return degrees(j.friction_angle); });
  of_joint("tensile_strength", "number", "Pa", &Joint::tensile_strength);
  of_joint("softening", "string", "", [](const Joint& j) { return softening_name(j); });
  of_joint("fracture_energy_1", "number", "J/m2", &Joint::fracture_energy_1);
  of_joint("fracture_energy_2", "number", "J/m2", &Joint::fracture_energy_2);
  of_joint("thickness_ratio", "number", "", &Joint::thickness_ratio);
  of_joint("thickness", "number?", "m", &Joint::thickness);
  of_joint("normal_stiffness", "number?", "Pa/m", &Joint::normal_stiffness);
  of_joint("shear_stiffness", "number?", "Pa/m", &Joint::shear_stiffness);
  of_joint("stiffness_damping", "number", "s", &Joint::stiffness_damping);
  of_joint("restitution", "number", "", &Joint::restitution);
  joint.text = [](const Object& self) {
    const Joint& j = static_cast<const JointObject&>(self).joint;
    if (j.glued)
      return std::string("cdem.Joint (glued, never breaks)");
    if (j.curve.on())
      return "cdem.Joint (bonded, Hoek-Brown: sigma_ci " + number_text(j.curve.sigma_ci) + " Pa, m_b " +
             number_text(j.curve.m_b) + ", s " + number_text(j.curve.s) + ", a " + number_text(j.curve.a) +
             ", tensile strength " + number_text(j.tensile_strength) + " Pa)";
    return std::string(j.bonded ? "cdem.Joint (bonded, c " + number_text(j.cohesion) +
                                      " Pa, tensile strength " + number_text(j.tensile_strength) + " Pa, "
                                : std::string("cdem.Joint (contact, ")) +
           "friction angle " + number_text(degrees(j.friction_angle)) + " deg" +
           (j.softening == Softening::none
                ? std::string()
                : ", " + softening_name(j) + " softening, G_I " + number_text(j.fracture_energy_1) +
                      " J/m2, G_II " + number_text(j.fracture_energy_2) + " J/m2") +
           (j.scatter.on() ? ", Weibull modulus " + number_text(j.scatter.modulus) : std::string()) +
           (j.rate.on() ? ", rate effect" : "") + (has_law(j.law) ? ", " + law_text(j) : "") + ")";
  };
  m.classes.push_back(joint);
}

} // namespace cdem::script
