// cdem.select.*: places that do not depend on a model.
#include "lua/binding/session/selections.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/objects.hpp"

#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

Value plane(Session&, Object*, const Arguments& a) {
  const geom::Vec3 normal = a.vec3("normal");
  if (!(normal.norm() > 0))
    throw geom::InputError("normal", describe(a.value("normal")), "longer than zero");
  auto object = std::make_shared<SelectionObject>();
  object->selection = Selection::on_plane(geom::Plane::through(a.vec3("point"), normal));
  object->selection.text =
      "plane through " + describe(a.value("point")) + " with normal " + describe(a.value("normal"));
  return object;
}

Value select_box(Session&, Object*, const Arguments& a) {
  geom::Box box;
  box.min = a.vec3("min");
  box.max = a.vec3("max");
  if ((box.min.array() > box.max.array()).any())
    throw geom::InputError("min", describe(a.value("min")), "below max in every axis",
                           "max is " + describe(a.value("max")));
  auto object = std::make_shared<SelectionObject>();
  object->selection = Selection::in_box(box);
  object->selection.text = "box from " + describe(a.value("min")) + " to " + describe(a.value("max"));
  return object;
}

Value units(Session&, Object*, const Arguments& a) {
  std::vector<int> numbers;
  for (const Value& number : a.list("numbers"))
    numbers.push_back(static_cast<int>(*number.get<std::int64_t>()));
  auto object = std::make_shared<SelectionObject>();
  object->selection = Selection::of_units(a.text("body"), std::move(numbers));
  return object;
}

Value faces(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<SelectionObject>();
  object->selection = Selection::of_faces(a.text("name"), a.text_or("body", ""));
  return object;
}

Value where(Session&, Object*, const Arguments& a) {
  auto object = std::make_shared<SelectionObject>();
  object->selection = predicate_selection(a.function("predicate"));
  return object;
}

} // namespace

void bind_selections(Module& m) {
  m.add("select.plane", "Everything that lies on a plane.",
        {vec3("point", "m").required().doc("any point of the plane"),
         vec3("normal").required().doc("of any length")},
        plane, "cdem.Selection");
  m.add("select.box", "Everything inside an axis-aligned box, its faces included.",
        {vec3("min", "m").required(), vec3("max", "m").required()}, select_box, "cdem.Selection");
  Type whole_number;
  whole_number.kind = Kind::integer;
  whole_number.range = {1, 1e7};
  m.add("select.units",
        "Some of a body's units: those of a pile, the parts of a mesh, or blocks, counted from 1 in their "
        "order. They keep their numbers where others are removed; pieces of a cut block keep its number.",
        {text("body").required().doc("by name"), list("numbers", whole_number).required()}, units,
        "cdem.Selection");
  m.add("select.faces",
        "Outer faces that mesh:faces{ name = ... } named before the model was made; in a pile, those of each "
        "unit. A fix of them holds all nodes on them.",
        {text("name").required(), text("body").doc("by name; all bodies that have such faces when left out")},
        faces, "cdem.Selection");
  m.add("select.where", "Everything for whose undeformed place a function returns true.",
        {function("predicate", "(x: number, y: number, z: number): boolean").required()}, where,
        "cdem.Selection")
      .ordered();
  Class selection{"Selection",
                  "A place, made by cdem.select.*; judged on undeformed places, so it survives cutting."};
  selection.text = [](const Object& self) {
    return "cdem.Selection (" + static_cast<const SelectionObject&>(self).selection.text + ")";
  };
  m.classes.push_back(selection);
}

} // namespace cdem::script
