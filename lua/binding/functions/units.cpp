// The units of a model's body: the pile they are now, its measures, and which of them lie lowest.
#include "libcdem/results/units.hpp"
#include "libcdem/model/unit_order.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/pile_object.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/placement/pile_measures.hpp"

#include <algorithm>
#include <numeric>

namespace cdem::script {

namespace {

using geom::InputError;

void require_body(const ModelObject& model, const std::string& key, const std::string& name) {
  if (std::find(model.body_names.begin(), model.body_names.end(), name) == model.body_names.end())
    throw InputError(key + " = \"" + name + "\": no such body" + which_there_are(name, model.body_names));
}

const Record<ContactSummary> contacts_record{
    "Contacts",
    "Contacts of meshed bodies.",
    {{integer("acting").doc("semi-springs and semi-edges now"), &ContactSummary::acting},
     {number("deepest", "m").doc("largest depth so far"), &ContactSummary::deepest},
     {number("deepest_over_tet_height").doc("the same over the height of the lower tet"),
      &ContactSummary::deepest_over_height}}};

const geom::Pile& first_pile(const ModelObject& model, const std::string& body) {
  require_body(model, "body", body);
  const auto pile = model.piles.find(body);
  if (pile == model.piles.end())
    throw InputError("body", "\"" + body + "\"", "a meshed body of units that are alike",
                     "this one is of convex blocks, or of a mesh in several parts");
  return pile->second;
}

Value pile(Session&, ModelObject& model, const Arguments& a) {
  geom::Pile now = first_pile(model, a.text("body"));
  const std::vector<Unit> units =
      cdem::units_of(model.simulation.model(), model.simulation.state(), a.text("body"));
  const std::vector<Block>& blocks = model.simulation.model().blocks;
  std::vector<geom::Pose> poses; // of the units that are left
  std::vector<UnitNow> units_now;
  for (const Unit& unit : units) {
    const int number = blocks[unit.block].unit;
    if (static_cast<std::size_t>(number) > now.poses.size()) // of a saved state of another script
      throw InputError("body", "\"" + a.text("body") + "\"", "the body that this script made of a pile");
    poses.push_back(geom::after(unit.motion, now.poses[static_cast<std::size_t>(number - 1)]));
    units_now.push_back({number, unit.pieces, unit.largest_piece});
  }
  now.poses = std::move(poses);
  return std::make_shared<PileObject>(std::move(now), std::move(units_now));
}

const Record<geom::PileMeasures> layer_record{
    {{number("porosity")
          .doc("between the slope and the mean top of the pile; nil, as the next five, with a warning where "
               "the pile is too small to measure or reaches beside its ground"),
      &geom::PileMeasures::porosity},
     {number("porosity_error").doc("change when every second column is left out"),
      &geom::PileMeasures::porosity_error},
     {number("units_per_area", "1/m2").doc("volume of solid over area and unit volume"),
      &geom::PileMeasures::units_per_area},
     {number("units_per_area_times_dn2").doc("packing density phi = N Dn^2 / A"),
      &geom::PileMeasures::packing_density},
     {number("thickness", "m").doc("mean height of the top above the slope"), &geom::PileMeasures::thickness},
     {number("area", "m2").doc("of slope that was measured"), &geom::PileMeasures::area}}};

struct UnitContacts {
  int unit = 0, contacts = 0;
};

const Record<UnitContacts> unit_contacts_record{
    "UnitContacts",
    "How many neighbours press on a unit.",
    {{integer("unit").doc("its number in the body, from 1"), &UnitContacts::unit},
     {integer("contacts").doc("other meshed blocks that press on it"), &UnitContacts::contacts}}};

struct Touching {
  std::vector<UnitContacts> units; // those that are left
};

const Record<Touching> touching_record{
    {{number("contacts_per_unit").required().doc("mean number of other meshed blocks that press on a unit"),
      [](const Touching& t) {
        const auto add = [](int sum, const UnitContacts& unit) { return sum + unit.contacts; };
        return std::accumulate(t.units.begin(), t.units.end(), 0, add) / static_cast<double>(t.units.size());
      }},
     {integer("fewest_contacts").required().doc("of any unit"),
      [](const Touching& t) {
        return std::min_element(
                   t.units.begin(), t.units.end(),
                   [](const UnitContacts& a, const UnitContacts& b) { return a.contacts < b.contacts; })
            ->contacts;
      }},
     {list("contacts", object_type("UnitContacts")).doc("of each unit that is left"), &Touching::units,
      unit_contacts_record}}};

Touching touching_now(const ModelObject& model, const std::string& body) {
  const Model& now = model.simulation.model();
  const std::vector<int> contacts = cdem::touching(now, model.simulation.state(), body);
  Touching touching;
  for (const int block : units_of_body(now, body))
    touching.units.push_back({now.blocks[block].unit, contacts[touching.units.size()]});
  return touching;
}

Value measures(Session& session, ModelObject& model, const Arguments& a) {
  const geom::Pile& first = first_pile(model, a.text("body"));
  require_body(model, "onto", a.text("onto"));
  if (session.settings.check_only) {
    Table table = touching_record({{{1, 0}}});
    table.named.merge(layer_record({}).named);
    return table;
  }
  geom::Surface ground;
  for (const geom::Surface& part :
       surfaces_of(model.simulation.model(), model.simulation.state(), a.text("onto"))) {
    const int before = static_cast<int>(ground.points.size());
    ground.points.insert(ground.points.end(), part.points.begin(), part.points.end());
    for (geom::Triangle t : part.triangles) {
      for (int& point : t)
        point += before;
      ground.triangles.push_back(t);
    }
  }
  Table table = touching_record(touching_now(model, a.text("body")));
  try {
    table.named.merge(layer_record(geom::measure_pile(surfaces_of(model.simulation.model(),
                                                                  model.simulation.state(), a.text("body")),
                                                      ground, first.height, geom::volume(first.unit)))
                          .named);
  } catch (const InputError& unmeasurable) {
    session.warn(std::string("pile_measures: ") + unmeasurable.what() +
                 "; porosity, density and thickness are nil, the contacts are told");
  }
  return table;
}

// Numbers of the units furthest along a direction, the furthest first.
Value furthest(ModelObject& model, const Arguments& a, double sign) {
  require_body(model, "body", a.text("body"));
  const geom::Vec3 up = a.vec3("up");
  if (!(up.norm() > 0))
    throw InputError("up", describe(a.value("up")), "longer than zero");
  const std::vector<Unit> units =
      cdem::units_of(model.simulation.model(), model.simulation.state(), a.text("body"));
  const auto count = a.integer("count");
  if (count > static_cast<std::int64_t>(units.size()))
    throw InputError("count", std::to_string(count),
                     "at most " + std::to_string(units.size()) + ", the units of \"" + a.text("body") + "\"");
  const std::vector<Block>& blocks = model.simulation.model().blocks;
  std::vector<std::int64_t> order(units.size());
  std::iota(order.begin(), order.end(), 0);
  const auto level = [&](std::int64_t i) {
    return sign * up.dot(units[static_cast<std::size_t>(i)].centroid);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int64_t i, std::int64_t j) { return level(i) > level(j); });
  Values numbers;
  for (std::int64_t i = 0; i < count; ++i)
    numbers.emplace_back(static_cast<std::int64_t>(
        blocks[units[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])].block].unit));
  return Table::list(std::move(numbers));
}

} // namespace

void bind_units(Module& m) {
  RecordType measured{"PileMeasures",
                      "How densely units lie on a slope, away from the edge of the pile by about one unit.",
                      layer_record.fields() + RecordType(touching_record).fields};
  m.records.push_back(std::move(measured));
  m.records.push_back(unit_contacts_record);
  m.records.push_back(contacts_record);
  Class& model = m.the_class("Model");
  const Field body = text("body").required().doc("name of a meshed body");
  model.add("pile",
            "The units of a body that are left, as they lie now, without their deformation: a pile that can "
            "be scaled, saved and be the shape of a body of another model. A unit that has broken stands as "
            "its largest piece does; the pile's `broken` and the `pieces` of its poses tell of it.",
            {body}, pile, "cdem.Pile");
  model.add("pile_measures",
            "Porosity, density and thickness of a layer of units, and how many neighbours press on them.",
            {body, text("onto").formerly("ground").required().doc("name of the body they lie on")}, measures,
            "cdem.PileMeasures");
  const std::vector<Field> fields{text("body").required(), integer("count").at_least(1).required(),
                                  vec3("up").standard(Value(geom::Vec3(0, 0, 1)))};
  model.add(
      "contacts", "How many contacts of meshed bodies act, and how deep they have been.", {},
      [](ModelObject& self) { return contacts_record(self.simulation.contacts()); }, "cdem.Contacts");
  model.add(
      "lowest_units", "Numbers of the units whose centroids are lowest now, for cdem.select.units.", fields,
      [](Session&, ModelObject& self, const Arguments& a) { return furthest(self, a, -1); }, "integer[]",
      "the lowest first");
  model.add(
      "highest_units", "Numbers of the units whose centroids are highest now, for cdem.select.units.", fields,
      [](Session&, ModelObject& self, const Arguments& a) { return furthest(self, a, 1); }, "integer[]",
      "the highest first");
}

} // namespace cdem::script
