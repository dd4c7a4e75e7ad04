// Materials and joints.
#include "lua/binding/functions/joint_laws.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

const Record<Elastic> elastic_record{
    {{modulus_field("youngs_modulus").required().doc("Young's modulus E"), &Elastic::youngs_modulus},
     {number("poissons_ratio").between(-1, 0.5).required().doc("Poisson's ratio nu"),
      &Elastic::poissons_ratio},
     {density_field("density").required(), &Elastic::density},
     {number("viscosity", "N s/m4")
          .at_least(0)
          .standard()
          .doc("damping force per volume and velocity, mu of Han 2010 eq 1; used by real-time stepping"),
      &Elastic::viscosity},
     {number("stiffness_damping", "s")
          .at_least(0)
          .standard()
          .doc("beta of Rayleigh damping, of meshes in real-time stepping: a vibration of angular "
               "frequency w has beta w / 2 of critical damping, motion as a rigid body none"),
      &Elastic::stiffness_damping},
     {record("damping",
             {number("fraction").between(0, 1).required().doc("of critical damping at the frequency"),
              number("frequency", "Hz").above(0).required(),
              choice("of", {"both", "mass", "stiffness"})
                  .standard("both")
                  .doc("half of it each, and more at other frequencies; or all by viscosity (falls with "
                       "the frequency, holds back motion as a rigid body); or all by stiffness_damping "
                       "(grows with the frequency, shortens the stable step)")})
          .doc("Rayleigh damping by the fraction of critical damping, in place of viscosity and "
               "stiffness_damping")},
     {number("shear_modulus", "Pa").doc("G = E / 2(1 + nu)"), &Elastic::shear_modulus},
     {number("p_wave_modulus", "Pa").doc("lambda + 2 G"), &Elastic::p_wave_modulus}}};

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
  elastic_record.read(a, object->elastic);
  read_damping(a, object->elastic);
  validate(object->elastic);
  return object;
}

const Record<Joint> any_joint{{{flag("bonded"), &Joint::bonded}, {flag("glued"), &Joint::glued}}},
    bond_strength{{{strength_field("cohesion").required(), &Joint::cohesion},
                   {friction_field("friction_angle").required(), &Joint::friction_angle},
                   {strength_field("tensile_strength").required(), &Joint::tensile_strength}}},
    joint_friction{{{friction_field("friction_angle").required(), &Joint::friction_angle}}},
    joint_softening{
        {{choice("softening", {"none", "linear", "exponential"})
              .standard()
              .doc("how the strength falls once it is reached; none: brittle. It needs both fracture "
                   "energies, and tensile_strength at most cohesion / tan(friction angle)"),
          &Joint::softening},
         {fracture_energy_field("fracture_energy_1")
              .doc("G_I, work per crack area that opening to separation takes, elastic part included"),
          &Joint::fracture_energy_1},
         {fracture_energy_field("fracture_energy_2")
              .doc("G_II, the same for slip, beyond the work of friction"),
          &Joint::fracture_energy_2}}};

const Record<StrengthScatter> weibull{
    {{number("modulus").within(2, 1000).required().doc("m"), &StrengthScatter::modulus},
     {number("reference_volume", "m3")
          .above(0)
          .required()
          .doc("the volume whose mean strength the joint gives"),
      &StrengthScatter::reference_volume},
     {integer("seed").at_least(0).required(), &StrengthScatter::seed}}};

const Record<RateEffect> rate_effect{
    {{number("reference_rate", "1/s").above(0).required().doc("of the strengths given"),
      &RateEffect::reference_rate},
     {number("exponent").within(0, 1).required(), &RateEffect::exponent},
     {number("change_rate", "1/s").above(0).doc("beyond it exponent_above holds"), &RateEffect::change_rate},
     {number("exponent_above").within(0, 1), &RateEffect::exponent_above},
     {flag("fracture_energy").standard().doc("fracture energies are raised too"),
      &RateEffect::fracture_energy}}};

const Record<Joint> face_strength{
    {{record("weibull", weibull.fields())
          .doc("strength that scatters from face to face after Weibull: tensile strength and cohesion of a "
               "face are multiplied by one draw, in the mean (reference_volume / volume of the face)^(1/m); "
               "fracture energies and friction stay. A draw depends on the seed and on where the face lies"),
      &Joint::scatter, weibull},
     {record("rate_effect", rate_effect.fields())
          .doc("strength raised by the rate of strain at which a face of a cohesive body begins to crack, "
               "(rate / reference_rate)^exponent; fib Model Code 2010 for concrete in tension: 1e-6, 0.018, "
               "10, 1/3"),
      &Joint::rate, rate_effect}}};

void require_rates(const Arguments& a) {
  const auto rate = a.record("rate_effect");
  if (rate && rate->has("change_rate") != rate->has("exponent_above"))
    throw geom::InputError("rate_effect: change_rate and exponent_above go together: from that rate on the "
                           "strength grows with that exponent");
}

Value made(Joint&& joint) {
  validate(joint);
  auto object = std::make_shared<JointObject>();
  object->joint = std::move(joint);
  return object;
}

Value mohr_coulomb(Session& session, Object*, const Arguments& a) {
  Joint joint = bond_strength.read(a);
  joint_softening.read(a, joint);
  require_rates(a);
  face_strength.read(a, joint);
  read_residual_strength(session, a, joint);
  joint_stiffness().read(a, joint);
  return made(std::move(joint));
}

Value coulomb(Session& session, Object*, const Arguments& a) {
  Joint joint = contact_law(a);
  joint_friction.read(a, joint);
  read_residual_strength(session, a, joint);
  joint_stiffness().read(a, joint);
  return made(std::move(joint));
}

Value glued(Session&, Object*, const Arguments& a) {
  Joint joint = glued_joint();
  joint_stiffness().read(a, joint);
  return made(std::move(joint));
}

const Record<Plasticity> peak_strength{
    {{strength_field("cohesion").required(), &Plasticity::cohesion},
     {friction_field("friction_angle").required(), &Plasticity::friction_angle},
     {strength_field("tensile_strength")
          .required()
          .doc("what is beyond the tip of the cone, cohesion / tan(friction_angle), does not act"),
      &Plasticity::tensile_strength},
     {number("dilation_angle").from(0, 90).standard().in_degrees().doc("at most friction_angle"),
      &Plasticity::dilation_angle}}},
    residual_strength{
        {{strength_field("residual_cohesion").doc("at softening_strain; the peak's when left out"),
          &Plasticity::residual_cohesion},
         {friction_field("residual_friction_angle"), &Plasticity::residual_friction_angle},
         {strength_field("residual_tensile_strength"), &Plasticity::residual_tensile_strength},
         {softening_strain_field(), &Plasticity::softening_strain}}};

Value plastic(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<PlasticityObject>();
  Plasticity& rock = object->plasticity;
  peak_strength.read(a, rock);
  rock.residual_cohesion = rock.cohesion;
  rock.residual_tensile_strength = rock.tensile_strength;
  rock.residual_friction_angle = rock.friction_angle;
  residual_strength.read(a, rock);
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
  m.add("elastic", "Isotropic linear elasticity (Han 2010 eq 3).", elastic_record.fields(), elastic,
        "cdem.Material");

  m.add("plastic",
        "Mohr-Coulomb plasticity with tension cut-off, dilation and softening, of the tetrahedra of blocks "
        "and meshes (docs/theory.md, section 25).",
        peak_strength.fields() + residual_strength.fields(), plastic, "cdem.Plasticity");
  Class plasticity{"Plasticity", "Made by cdem.plastic or cdem.hoek_brown."};
  peak_strength.add_to(plasticity, &PlasticityObject::plasticity);
  m.classes.push_back(plasticity);

  m.add("mohr_coulomb",
        "Bond between block faces. It breaks in tension above the tensile strength, and in shear above "
        "cohesion + normal pressure x tan(friction angle). Then it is a contact with the same friction "
        "angle, or with the residual strength that is given (Han 2010 eqs 8-11). With softening it loses its "
        "strength along a curve whose area is the fracture energy.",
        bond_strength.fields() + residual_strength_fields() + dilation_fields() + joint_softening.fields() +
            face_strength.fields() + joint_stiffness().fields(),
        mohr_coulomb, "cdem.Joint");
  m.add("coulomb", "Contact that never was bonded: no tension, friction only (Han 2010 eq 9).",
        joint_friction.fields() + dilation_fields() + joint_stiffness().fields() + joint_impact().fields(),
        coulomb, "cdem.Joint");

  std::vector<Field> stiff = joint_stiffness().fields();
  stiff[0].standard(glued_thickness_ratio);
  m.add("glued",
        "Bond that never breaks, of faces that are no joint, such as those of an excavation outline. It is "
        "four times as stiff as a joint by default.",
        stiff, glued, "cdem.Joint");

  Class material{"Material", "Made by cdem.elastic."};
  elastic_record.add_to(material, &MaterialObject::elastic);
  material.text = [](const Object& self) {
    const Elastic& e = static_cast<const MaterialObject&>(self).elastic;
    return "cdem.Material (E " + number_text(e.youngs_modulus) + " Pa, nu " + number_text(e.poissons_ratio) +
           ", " + number_text(e.density) + " kg/m3)";
  };
  m.classes.push_back(material);

  Class joint{"Joint", "Made by cdem.mohr_coulomb, cdem.hoek_brown_bond, cdem.coulomb, cdem.barton_bandis, "
                       "cdem.joint_table or cdem.glued."};
  for (const Record<Joint>* const record :
       {&any_joint, &bond_strength, &joint_softening, &joint_stiffness(), &joint_impact()})
    record->add_to(joint, &JointObject::joint);
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
                : ", " + *joint_softening(j).named["softening"].get<std::string>() + " softening, G_I " +
                      number_text(j.fracture_energy_1) + " J/m2, G_II " + number_text(j.fracture_energy_2) +
                      " J/m2") +
           (j.scatter.on() ? ", Weibull modulus " + number_text(j.scatter.modulus) : std::string()) +
           (j.rate.on() ? ", rate effect" : "") + (has_law(j.law) ? ", " + law_text(j) : "") + ")";
  };
  m.classes.push_back(joint);
}

} // namespace cdem::script
