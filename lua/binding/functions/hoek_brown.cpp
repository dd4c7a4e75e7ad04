// The generalised Hoek-Brown strength, of plasticity and of the faces of cohesive bodies.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/schema/angles.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

const Record<RockMass> rock_mass{
    {{rock_strength_field("sigma_ci").required().doc("uniaxial compressive strength of the intact rock"),
      &RockMass::sigma_ci},
     {number("gsi").within(5, 100).required().doc("geological strength index; 100 is intact rock"),
      &RockMass::geological_strength},
     {number("m_i").above(0).required().doc("constant of the intact rock, 4 for claystone to 33 for granite"),
      &RockMass::intact_constant},
     {number("disturbance").within(0, 1).standard().doc("D: 0 is undisturbed rock, 1 poor blasting"),
      &RockMass::disturbance},
     {strength_field("tensile_strength")
          .doc("at most that of the curve in uniaxial tension, which is the default")}}},
    residual_mass{{{number("gsi").within(5, 100), &RockMass::geological_strength},
                   {number("m_i").above(0), &RockMass::intact_constant},
                   {number("disturbance").within(0, 1), &RockMass::disturbance},
                   {strength_field("tensile_strength")}}};

RockMass read_rock_mass(const Arguments& a) {
  const RockMass rock = rock_mass.read(a);
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
    residual_mass.read(*residual, mass);
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
  const std::vector<Field> plastic{number("dilation_angle", "deg")
                                       .from(0, 90)
                                       .standard(0.0)
                                       .doc("at most the friction angle of the tangent"),
                                   record("residual", residual_mass.fields())
                                       .doc("of the rock at softening_strain; what is left out stays"),
                                   softening_strain_field()};
  m.add("hoek_brown",
        "Plasticity by the generalised Hoek-Brown strength of a rock mass (Hoek, Carranza-Torres and Corkum "
        "2002), with tension cut-off, dilation and softening (docs/theory.md, section 25).",
        rock_mass.fields() + plastic, plastic_hoek_brown, "cdem.Plasticity");
  const std::vector<Field> bond{
      friction_field("friction_angle").required().doc("of a crack, once it has begun")};
  m.add("hoek_brown_bond",
        "Brittle strength of a cohesive body (bonds = \"cohesive\") by the generalised Hoek-Brown curve: a "
        "face cracks where the stress meets the curve, on the plane of its tangent (docs/theory.md, section "
        "22).",
        rock_mass.fields() + bond, hoek_brown_bond, "cdem.Joint");
}

} // namespace cdem::script
