// Results of joints between blocks.
#include "lua/binding/functions/joint_choice.hpp"
#include "lua/binding/module/module.hpp"
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

Value joints(Session&, ModelObject& model, const Arguments& a) {
  Values rows;
  for (const JointSum& s : model.simulation.joints(joint_choice(model, a)))
    rows.emplace_back(Table{{"set", s.set},
                            {"interfaces", s.interfaces},
                            {"parted", s.parted},
                            {"area", s.area},
                            {"open_area", s.open_area},
                            {"broken_area", s.broken_area},
                            {"normal_traction", s.normal},
                            {"shear_traction", s.shear},
                            {"water_pressure", s.water},
                            {"utilisation", s.mean_use},
                            {"largest_utilisation", s.largest_use},
                            {"slip", s.mean_slip},
                            {"largest_slip", s.largest_slip},
                            {"opening", s.mean_opening},
                            {"largest_opening", s.largest_opening}});
  return Table::list(std::move(rows));
}

Value joint_points(Session&, ModelObject& model, const Arguments& a) {
  static const char* const modes[] = {"bonded", "broken_tension", "broken_shear", "contact"};
  static const char* const names[] = {
      "set",         "place",   "area", "mode", "normal_traction", "shear_traction", "water_pressure",
      "utilisation", "opening", "slip"};
  Values lists[10];
  for (const auto& [set, p] : model.simulation.joint_points(joint_choice(model, a))) {
    const Value row[] = {set,       p.place, p.area,  std::string(modes[static_cast<int>(p.mode)]),
                         p.normal,  p.shear, p.water, p.use,
                         p.opening, p.slip};
    for (int i = 0; i < 10; ++i)
      lists[i].push_back(row[i]);
  }
  Table result;
  for (int i = 0; i < 10; ++i)
    result.named[names[i]] = Table::list(std::move(lists[i]));
  return result;
}

std::vector<Field> sum_fields() {
  return {
      text("set").required().doc("its name; \"\": joints of no set"),
      integer("interfaces").required().doc("pairs of faces that springs hold"),
      integer("parted").required().doc("pairs that are left to contact; no other value counts them"),
      number("area").unit("m2").required(),
      number("open_area").unit("m2").required().doc("of faces that are apart"),
      number("broken_area").unit("m2").required(),
      number("normal_traction").unit("Pa").required().doc("mean over the area, tension positive; effective"),
      number("shear_traction").unit("Pa").required().doc("mean of its size"),
      number("water_pressure").unit("Pa").required().doc("mean"),
      number("utilisation")
          .required()
          .doc("traction over strength, 1 where it slides; mean over the area that is not apart"),
      number("largest_utilisation").required(),
      number("slip").unit("m").required().doc("size of the shear displacement since the beginning, mean"),
      number("largest_slip").unit("m").required(),
      number("opening").unit("m").required().doc("below 0: closed under pressure; mean"),
      number("largest_opening").unit("m").required()};
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
  m.records.push_back({"JointSum", "What the joints of one set bear and how they have moved.", sum_fields()});
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
