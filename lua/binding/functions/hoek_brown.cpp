// The generalised Hoek-Brown strength, of plasticity and of the faces of cohesive bodies.
#include "lua/binding/functions/angles.hpp"
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

std::vector<Field> rock_mass_fields() {
  return {
      rock_strength_field("sigma_ci").required().doc("uniaxial compressive strength of the intact rock"),
      number("gsi").within(5, 100).required().doc("geological strength index; 100 is intact rock"),
      number("m_i").above(0).required().doc("constant of the intact rock, 4 for claystone to 33 for granite"),
      number("disturbance").within(0, 1).standard(0.0).doc("D: 0 is undisturbed rock, 1 poor blasting"),
      strength_field("tensile_strength")
          .doc("at most that of the curve in uniaxial tension, which is the default")};
}

RockMass read_rock_mass(const Arguments& a) {
  const RockMass rock{a.number("sigma_ci"), a.number("gsi"), a.number("m_i"), a.number("disturbance")};
  validate(rock);
  return rock;
}

Value plastic_hoek_brown(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<PlasticityObject>();
  Plasticity& rock = object->plasticity;
  RockMass mass = read_rock_mass(a);
  rock.curve = rock.residual_curve = hoek_brown(mass);
  rock.tensile_strength =
      a.optional_number("tensile_strength").value_or(uniaxial_tensile_strength(rock.curve));
  rock.residual_tensile_strength = rock.tensile_strength;
  rock.dilation_angle = radians(a.number("dilation_angle"));
  const auto residual = a.record("residual");
  if (residual.has_value() != a.has("softening_strain"))
    throw geom::InputError(
        "softening_strain: goes together with residual: over that plastic strain the strength falls to it");
  if (residual) {
    rock.softening_strain = a.number("softening_strain");
    mass.geological_strength = residual->optional_number("gsi").value_or(mass.geological_strength);
    mass.intact_constant = residual->optional_number("m_i").value_or(mass.intact_constant);
    mass.disturbance = residual->optional_number("disturbance").value_or(mass.disturbance);
    rock.residual_curve = hoek_brown(mass);
    rock.residual_tensile_strength =
        residual->optional_number("tensile_strength")
            .value_or(std::min(rock.tensile_strength, uniaxial_tensile_strength(rock.residual_curve)));
  }
  validate(rock);
  return object;
}

Value hoek_brown_bond(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<JointObject>();
  Joint& joint = object->joint;
  joint.curve = hoek_brown(read_rock_mass(a));
  joint.tensile_strength =
      a.optional_number("tensile_strength").value_or(uniaxial_tensile_strength(joint.curve));
  joint.cohesion = tangent(joint.curve, 0).cohesion;
  joint.friction_angle = radians(a.number("friction_angle"));
  validate(joint);
  return object;
}

} // namespace

void bind_hoek_brown(Module& m) {
  std::vector<Field> plastic = rock_mass_fields();
  plastic.push_back(number("dilation_angle")
                        .from(0, 90)
                        .standard(0.0)
                        .unit("deg")
                        .doc("at most the friction angle of the tangent"));
  plastic.push_back(
      record("residual", {number("gsi").within(5, 100), number("m_i").above(0),
                          number("disturbance").within(0, 1), strength_field("tensile_strength")})
          .doc("of the rock at softening_strain; what is left out stays"));
  plastic.push_back(
      number("softening_strain")
          .above(0)
          .doc("equivalent plastic strain at which the residual strength is reached, linearly; without "
               "fracture energy, so that what it dissipates depends on the size of the elements"));
  m.add("hoek_brown",
        "Plasticity by the generalised Hoek-Brown strength of a rock mass (Hoek, Carranza-Torres and Corkum "
        "2002), with tension cut-off, dilation and softening (docs/theory.md, section 25).",
        plastic, plastic_hoek_brown, "cdem.Plasticity");
  std::vector<Field> bond = rock_mass_fields();
  bond.push_back(friction_field("friction_angle").required().doc("of a crack, once it has begun"));
  m.add("hoek_brown_bond",
        "Brittle strength of a cohesive body (bonds = \"cohesive\") by the generalised Hoek-Brown curve: a "
        "face cracks where the stress meets the curve, on the plane of its tangent (docs/theory.md, section "
        "22).",
        bond, hoek_brown_bond, "cdem.Joint");
}

} // namespace cdem::script
