// Results of joints between blocks.
#include "lua/binding/functions/joint_choice.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/selections.hpp"

namespace cdem::script {

JointChoice joint_choice(const ModelObject& model, const Arguments& a) {
  JointChoice choice;
  choice.sets = a.texts("sets");
  choice.on = one_selection(model, a.value("on"), "on");
  return choice;
}

std::vector<Field> joint_choice_fields() {
  return {list("sets", text_type(), 1).doc("names of joint sets and cuts; all joints when left out"),
          place("on").standard("all").doc("where: one place")};
}

namespace {

const Record<JointSum> joint_sum{
    "JointSum",
    "What the joints of one set bear and how they have moved.",
    {{text("set").doc("its name; \"\": joints of no set"), &JointSum::set},
     {integer("interfaces").doc("pairs of faces that springs hold"), &JointSum::interfaces},
     {integer("parted").doc("pairs that are left to contact; no other value counts them"), &JointSum::parted},
     {number("area", "m2"), &JointSum::area},
     {number("open_area", "m2").doc("of faces that are apart"), &JointSum::open_area},
     {number("broken_area", "m2"), &JointSum::broken_area},
     {number("normal_traction", "Pa").doc("mean over the area, tension positive; effective"),
      &JointSum::normal},
     {number("shear_traction", "Pa").doc("mean of its size"), &JointSum::shear},
     {number("water_pressure", "Pa").doc("mean"), &JointSum::water},
     {number("utilisation")
          .doc("traction over strength, 1 where it slides; mean over the area that is not apart"),
      &JointSum::mean_utilisation},
     {number("largest_utilisation"), &JointSum::largest_utilisation},
     {number("slip", "m").doc("size of the shear displacement since the beginning, mean"),
      &JointSum::mean_slip},
     {number("largest_slip", "m"), &JointSum::largest_slip},
     {number("opening", "m").doc("below 0: closed under pressure; mean"), &JointSum::mean_opening},
     {number("largest_opening", "m"), &JointSum::largest_opening}}};

Table joints(Session&, ModelObject& model, const Arguments& a) {
  return joint_sum.list(model.simulation.joints(joint_choice(model, a)));
}

using NamedPoint = std::pair<std::string, JointPoint>;

const Record<NamedPoint> joint_point{
    "JointPoints",
    "The points of joints: lists with an entry for each.",
    {{text("set"), &NamedPoint::first},
     {vec3("place", "m").doc("undeformed"), [](const NamedPoint& p) { return p.second.place; }},
     {number("area", "m2"), [](const NamedPoint& p) { return p.second.area; }},
     {text("mode").doc("\"bonded\", \"broken_tension\", \"broken_shear\" or \"contact\""),
      [](const NamedPoint& p) {
        static const char* const modes[] = {"bonded", "broken_tension", "broken_shear", "contact"};
        return modes[static_cast<int>(p.second.mode)];
      }},
     {number("normal_traction", "Pa").doc("tension positive; effective"),
      [](const NamedPoint& p) { return p.second.normal; }},
     {number("shear_traction", "Pa"), [](const NamedPoint& p) { return p.second.shear; }},
     {number("water_pressure", "Pa"), [](const NamedPoint& p) { return p.second.water; }},
     {number("utilisation"), [](const NamedPoint& p) { return p.second.utilisation; }},
     {number("opening", "m"), [](const NamedPoint& p) { return p.second.opening; }},
     {number("slip", "m"), [](const NamedPoint& p) { return p.second.slip; }}}};

Table joint_points(Session&, ModelObject& model, const Arguments& a) {
  return joint_point.columns(
      cdem::joint_points(model.simulation.model(), model.simulation.state(), joint_choice(model, a)));
}

} // namespace

void bind_joints(Module& m) {
  m.records.insert(m.records.end(), {joint_sum, joint_point.of_columns()});
  Class& model = m.the_class("Model");
  model.add("joints",
            "What joints between blocks bear and how they have moved: a row for each joint set and named "
            "cut, and one, at the end, for joints of no set.",
            joint_choice_fields(), joints, "cdem.JointSum[]");
  model.add("joint_points", "The same point by point, of joints that springs still hold.",
            joint_choice_fields(), joint_points, "cdem.JointPoints");
}

} // namespace cdem::script
