// Results of joints between blocks.
#include "lua/binding/functions/joint_choice.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/selections.hpp"

namespace cdem::script {

JointChoice joint_choice(const ModelObject& model, const Arguments& a) {
  JointChoice choice;
  for (const Value& set : a.list("sets"))
    choice.sets.push_back(*set.get<std::string>());
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
     {number("area").unit("m2"), &JointSum::area},
     {number("open_area").unit("m2").doc("of faces that are apart"), &JointSum::open_area},
     {number("broken_area").unit("m2"), &JointSum::broken_area},
     {number("normal_traction").unit("Pa").doc("mean over the area, tension positive; effective"),
      &JointSum::normal},
     {number("shear_traction").unit("Pa").doc("mean of its size"), &JointSum::shear},
     {number("water_pressure").unit("Pa").doc("mean"), &JointSum::water},
     {number("utilisation")
          .doc("traction over strength, 1 where it slides; mean over the area that is not apart"),
      &JointSum::mean_utilisation},
     {number("largest_utilisation"), &JointSum::largest_utilisation},
     {number("slip").unit("m").doc("size of the shear displacement since the beginning, mean"),
      &JointSum::mean_slip},
     {number("largest_slip").unit("m"), &JointSum::largest_slip},
     {number("opening").unit("m").doc("below 0: closed under pressure; mean"), &JointSum::mean_opening},
     {number("largest_opening").unit("m"), &JointSum::largest_opening}}};

Table joints(Session&, ModelObject& model, const Arguments& a) {
  return joint_sum.list(model.simulation.joints(joint_choice(model, a)));
}

Value joint_points(Session&, ModelObject& model, const Arguments& a) {
  static const char* const modes[] = {"bonded", "broken_tension", "broken_shear", "contact"};
  static const char* const names[] = {
      "set",         "place",   "area", "mode", "normal_traction", "shear_traction", "water_pressure",
      "utilisation", "opening", "slip"};
  Values lists[10];
  for (const auto& [set, p] : model.simulation.joint_points(joint_choice(model, a))) {
    const Value row[] = {set,       p.place, p.area,  std::string(modes[static_cast<int>(p.mode)]),
                         p.normal,  p.shear, p.water, p.utilisation,
                         p.opening, p.slip};
    for (int i = 0; i < 10; ++i)
      lists[i].push_back(row[i]);
  }
  Table result;
  for (int i = 0; i < 10; ++i)
    result.named[names[i]] = Table::list(std::move(lists[i]));
  return result;
}

std::vector<Field> point_fields() {
  return {list("set", text_type(), 0).required(),
          list("place", vec3_type(), 0).unit("m").required().doc("undeformed"),
          list("area", number_type(), 0).unit("m2").required(),
          list("mode", text_type(), 0)
              .required()
              .doc("\"bonded\", \"broken_tension\", \"broken_shear\" or \"contact\""),
          list("normal_traction", number_type(), 0).unit("Pa").required().doc("tension positive; effective"),
          list("shear_traction", number_type(), 0).unit("Pa").required(),
          list("water_pressure", number_type(), 0).unit("Pa").required(),
          list("utilisation", number_type(), 0).required(),
          list("opening", number_type(), 0).unit("m").required(),
          list("slip", number_type(), 0).unit("m").required()};
}

} // namespace

void bind_joints(Module& m) {
  m.records.push_back(joint_sum);
  m.records.push_back({"JointPoints", "The points of joints: lists with an entry for each.", point_fields()});
  Class& model = m.the_class("Model");
  model.add("joints",
            "What joints between blocks bear and how they have moved: a row for each joint set and named "
            "cut, and one, at the end, for joints of no set.",
            joint_choice_fields(), joints, "cdem.JointSum[]");
  model.add("joint_points", "The same point by point, of joints that springs still hold.",
            joint_choice_fields(), joint_points, "cdem.JointPoints");
}

} // namespace cdem::script
