// Laws of joints between blocks: residual strength and dilation, Barton-Bandis, tables. A new law has its entry here.
#include "lua/binding/functions/joint_laws.hpp"

#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

double tangent(double degrees) {
  return geom::portable::tan(radians(degrees));
}

Value finished(Joint&& joint) {
  validate(joint);
  auto object = std::make_shared<JointObject>();
  object->joint = std::move(joint);
  return object;
}

const Record<BartonBandis> rough_joint{
    {{number("jrc").within(0, 20).required().doc("joint roughness coefficient"), &BartonBandis::jrc},
     {rock_strength_field("jcs").required().doc("strength of the joint walls"), &BartonBandis::jcs},
     {friction_field("residual_friction_angle").from(0, 70).required().doc("phi_r"),
      &BartonBandis::residual_angle},
     {joint_stiffness_field("initial_stiffness")
          .required()
          .doc(
              "slope of the hyperbola where it begins; normal_stiffness, or E/L, is the steepest it becomes"),
      &BartonBandis::initial_stiffness},
     {number("maximum_closure", "m").above(0).required(), &BartonBandis::maximum_closure},
     {number("length", "m")
          .above(0)
          .doc("of the joint: jrc and jcs are those of samples and are scaled to it, and it gives the slip "
               "at the "
               "peak, length / 500 (JRC / length)^0.33")},
     {number("sample_length", "m").above(0).standard(0.1).doc("of the samples")},
     {number("peak_slip", "m").above(0).doc("slip at the peak; wins over that of the length"),
      &BartonBandis::peak_slip}}};

Value barton_bandis(Session&, Object*, const Arguments& a) {
  BartonBandis law = rough_joint.read(a);
  if (const auto length = a.optional_number("length"))
    scale_to_length(law, *length, a.number("sample_length"));
  law.peak_slip = a.optional_number("peak_slip").value_or(law.peak_slip);
  Joint joint = contact_law(a);
  joint.friction_angle = law.residual_angle;
  joint.law = law;
  joint_stiffness().read(a, joint);
  return finished(std::move(joint));
}

const Record<JointTable> table_joint{
    {{list("normal", tuple_type({number_type(), number_type()}), 0)
          .doc("rows {closure (m), pressure (Pa)} that rise, one of them {0, 0}; rows below it are "
               "{-opening, -pull}, up to the opening at which the joint parts. Without rows it is linear"),
      &JointTable::closing},
     {list("shear", tuple_type({number_type(), number_type()}), 2)
          .required()
          .doc("rows {pressure (Pa), strength (Pa)}, the first {0, strength without pressure}"),
      &JointTable::shear}}};

Value joint_table(Session&, Object*, const Arguments& a) {
  const JointTable law = table_joint.read(a);
  Joint joint = contact_law(a);
  joint.law = law;
  joint_stiffness().read(a, joint);
  validate(joint);
  joint.friction_angle = geom::portable::atan2(law.friction_left({}), 1);
  return finished(std::move(joint));
}

struct InWords {
  std::string operator()(const ResidualStrength& law) const {
    std::string text = "residual c " + number_text(law.cohesion) + " Pa, tension " +
                       number_text(law.tension) + " Pa, friction angle " +
                       three_digits(degrees(geom::portable::atan2(law.friction, 1))) + " deg";
    if (law.dilation > 0)
      text += ", dilation " + three_digits(degrees(geom::portable::atan2(law.dilation, 1))) + " deg";
    return text;
  }
  std::string operator()(const BartonBandis& law) const {
    return "Barton-Bandis, JRC " + number_text(law.jrc) + ", JCS " + number_text(law.jcs) + " Pa, phi_r " +
           three_digits(degrees(law.residual_angle)) + " deg" +
           (law.peak_slip > 0 ? ", peak at " + number_text(law.peak_slip) + " m" : "");
  }
  std::string operator()(const JointTable& law) const {
    return "tables of " + std::to_string(law.closing.size()) + " and " + std::to_string(law.shear.size()) +
           " rows";
  }
};

} // namespace

std::string law_text(const Joint& joint) {
  return with_law(joint.law, InWords());
}

std::vector<Field> dilation_fields() {
  return {friction_field("residual_friction_angle")
              .doc("between blocks: friction once the joint has slipped; at most friction_angle, which it is "
                   "when left out"),
          number("dilation_angle", "deg")
              .from(0, 90)
              .doc("between blocks: slip opens the joint at this angle; at most the residual friction angle"),
          number("dilation_limit", "m")
              .at_least(0)
              .doc("slip at which dilation ends; without it it does not end")};
}

std::vector<Field> residual_strength_fields() {
  return {strength_field("residual_cohesion")
              .doc("between blocks: cohesion of a broken joint whose faces press; at most cohesion"),
          strength_field("residual_tensile_strength")
              .formerly("residual_tension")
              .doc("between blocks: pull of a broken joint, however far it opens; at most tensile_strength")};
}

void read_residual_strength(Session& session, const Arguments& a, Joint& joint) {
  static const char* const names[] = {"residual_friction_angle", "dilation_angle", "dilation_limit",
                                      "residual_cohesion", "residual_tensile_strength"};
  bool any = false;
  for (const char* name : names)
    any = any || (a.has(name) && a.value(name).is_number());
  if (!any)
    return;
  if (a.has("dilation_limit") && !a.has("dilation_angle"))
    throw InputError("dilation_limit: goes with dilation_angle, the angle up to it");
  ResidualStrength law;
  law.friction = geom::portable::tan(joint.friction_angle);
  if (const auto angle = a.optional_number("residual_friction_angle"))
    law.friction = tangent(*angle);
  if (const auto angle = a.optional_number("dilation_angle"))
    law.dilation = tangent(*angle);
  law.dilation_limit = a.optional_number("dilation_limit").value_or(law.dilation_limit);
  if (joint.bonded) {
    law.cohesion = a.optional_number("residual_cohesion").value_or(0);
    law.tension = a.optional_number("residual_tensile_strength").value_or(0);
    if (law.cohesion > 0 && !a.has("residual_tensile_strength") && joint.tensile_strength > 0)
      session.warn("residual_cohesion = " + describe(a.value("residual_cohesion")) +
                   " without residual_tensile_strength: a point that breaks loses all its tension, also "
                   "where the joint only peels at an edge, so slopes and blocks are less safe than by c and "
                   "phi; give residual_tensile_strength, 0 where that is meant");
  }
  joint.law = law;
}

const Record<Joint>& joint_impact() {
  static const Record<Joint> record{
      {{number("restitution")
            .within(0.01, 1)
            .standard()
            .doc("coefficient of restitution of the contact of bodies that move far: speed after over speed "
                 "before an impact, as far as the contact and not waves within the bodies decide it; 1: an "
                 "impact loses nothing but by friction. At rest contacts of deformable bodies damp what "
                 "vibrates, whatever it is"),
        &Joint::restitution}}};
  return record;
}

Joint contact_law(const Arguments& a) {
  Joint joint;
  joint.bonded = false;
  joint_impact().read(a, joint);
  return joint;
}

const Record<Joint>& joint_stiffness() {
  static const Record<Joint> members{
      {{number("thickness_ratio")
            .above(0)
            .standard()
            .doc("equivalent thickness of the joint over the block size (cube root of its volume), which "
                 "sets the stiffness E/L and G/L"),
        &Joint::thickness_ratio},
       {number("thickness", "m")
            .above(0)
            .doc("equivalent thickness itself; wins over the ratio. Contacts of meshes take it too"),
        &Joint::thickness},
       {joint_stiffness_field("normal_stiffness").doc("instead of E/L"), &Joint::normal_stiffness},
       {joint_stiffness_field("shear_stiffness").doc("instead of G/L"), &Joint::shear_stiffness},
       {number("stiffness_damping", "s")
            .at_least(0)
            .standard()
            .doc("beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, "
                 "as long as their faces have not parted; refused where it would do nothing"),
        &Joint::stiffness_damping}}};
  return members;
}

void bind_joint_laws(Module& m) {
  m.add("barton_bandis",
        "Rough joint between blocks that never was bonded (Barton and Choubey 1977, Bandis et al. 1983): it "
        "closes on a hyperbola and slips above pressure x tan(residual angle + JRC log10(JCS / pressure)). "
        "With a length, or peak_slip, the roughness is mobilised and worn with slip, and the joint dilates.",
        rough_joint.fields() + joint_stiffness().fields() + joint_impact().fields(), barton_bandis,
        "cdem.Joint");
  m.add("joint_table",
        "Joint between blocks that never was bonded, by tables: straight between rows, straight on beyond "
        "the last.",
        table_joint.fields() + joint_stiffness().fields() + joint_impact().fields(), joint_table,
        "cdem.Joint");
}

} // namespace cdem::script
