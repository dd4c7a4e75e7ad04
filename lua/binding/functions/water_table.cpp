// Water tables that are not level.
#include "lua/binding/functions/angles.hpp"
#include "lua/binding/functions/radians_given.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/runtime/module.hpp"
#include "lua/binding/runtime/session.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/text_table.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

// Beyond it the pressure is more than half too large, cos^2 of the slope.
constexpr double steep = 35; // deg

std::vector<std::array<double, 2>> rows_of_file(Session& session, const std::string& name) {
  const geom::TextTable table(read_file(session.files.to_read(name)), name);
  const auto column = [&](const char* wanted) {
    const std::optional<std::size_t> found = table.find(wanted);
    if (!found)
      table.refuse(std::string("no column is named ") + wanted + "; a profile has distance (m) and z (m)");
    return *found;
  };
  const std::size_t distance = column("distance"), z = column("z");
  std::vector<std::array<double, 2>> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    rows.push_back({table.number(row, distance), table.number(row, z)});
    for (const auto& [value, of] : {std::pair(rows.back()[0], distance), std::pair(rows.back()[1], z)})
      if (std::isnan(value))
        table.refuse(row, of, "a number (m)");
    if (row > 0 && !(rows[row][0] > rows[row - 1][0]))
      table.refuse(row, distance, "more than in the row before: distances rise");
  }
  return rows;
}

void require_its_fields(const Arguments& a, const char* kind) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> kinds = {
      {"dip", {"point", "dip_direction"}},
      {"profile", {"origin", "direction"}},
      {"file", {"origin", "direction"}},
      {"surface", {}}};
  for (const auto& [other, fields] : kinds)
    for (const char* const field : fields) {
      const bool own = std::string(other) == kind ||
                       (std::string(other) == "profile" && std::string(kind) == "file") ||
                       (std::string(other) == "file" && std::string(kind) == "profile");
      if (!own && a.has(field))
        throw InputError(std::string(field) + ": goes with " +
                         (std::string(other) == "dip" ? "dip" : "profile or file") + ", not with " + kind);
    }
}

std::shared_ptr<const WaterTable> plane_of(Session& session, const Arguments& a) {
  for (const char* const field : {"point", "dip_direction"})
    if (!a.has(field))
      throw InputError(std::string(field) + ": missing; a plane has point, dip and dip_direction");
  const double dip = a.number("dip");
  warn_of_radians(session, "water_table: dip and dip_direction", {dip}, {a.number("dip_direction")});
  if (dip > steep)
    session.warn("water_table: dip = " + describe(a.value("dip")) +
                 ": the pressure is that of still water below each point of the table; under flow parallel "
                 "to so steep "
                 "a table it is less, cos(dip)^2 times that (docs/theory.md, \"Water\")");
  return water_plane(a.vec3("point"), radians(dip), radians(a.number("dip_direction")));
}

Value water_table(Session& session, Object*, const Arguments& a) {
  std::vector<const char*> given;
  for (const char* const kind : {"dip", "profile", "file", "surface"})
    if (a.has(kind))
      given.push_back(kind);
  if (given.size() != 1)
    throw InputError(
        "give one of dip with point and dip_direction (a plane), profile = rows {distance, z}, file = a "
        "table of them, and surface = cdem.read_surface{...} or cdem.surface{...}");
  const std::string kind = given[0];
  require_its_fields(a, given[0]);
  auto object = std::make_shared<WaterTableObject>();
  if (kind == "dip") {
    object->table = plane_of(session, a);
    object->words = "a plane that dips by " + describe(a.value("dip")) + " degrees towards " +
                    describe(a.value("dip_direction"));
  } else if (kind == "surface") {
    object->table = water_surface(a.object<SurfaceObject>("surface")->surface);
    object->words = "a surface of triangles";
  } else {
    std::vector<std::array<double, 2>> rows;
    for (const Value& row : a.list("profile"))
      rows.push_back({row.table()->items[0].number(), row.table()->items[1].number()});
    if (kind == "file")
      rows = rows_of_file(session, a.text("file"));
    object->words = "a profile of " + std::to_string(rows.size()) + " points";
    object->table = water_profile(std::move(rows), a.optional_vec3("origin").value_or(geom::Vec3::Zero()),
                                  a.optional_vec3("direction").value_or(geom::Vec3::UnitX()));
  }
  return object;
}

Value height(Session&, WaterTableObject& self, const Arguments& a) {
  const std::optional<double> z = self.table->height({a.number("x"), a.number("y"), 0});
  return z ? Value(*z) : Value();
}

} // namespace

void bind_water_table(Module& m) {
  m.functions.push_back(
      {"water_table",
       "A water table that is not level, for model:water and model:traction: a plane, a profile along a "
       "direction, "
       "or a surface. Pressure is weight times the vertical depth below it (docs/theory.md, \"Water\").",
       {vec3("point").unit("m").doc("of a plane"),
        number("dip").from(0, 90).unit("deg").doc("of a plane, below the horizontal"),
        number("dip_direction").within(0, 360).unit("deg").doc("clockwise from +y (north)"),
        list("profile", tuple_type({number_type(), number_type()}), 2)
            .doc("instead: rows {distance, z} (m); straight between them, level beyond, the same across"),
        text("file").doc("instead: a table (docs/output-files.md) with columns distance and z (m)"),
        vec3("origin").unit("m").doc("where the distance of a profile is 0; {0, 0, 0} when left out"),
        vec3("direction").doc("of a profile, horizontal; {1, 0, 0} when left out"),
        object("surface", "Surface")
            .doc("instead: open, once over each place; larger than the model in plan")},
       false,
       "cdem.WaterTable",
       "",
       water_table});
  Class object{"WaterTable", "A water table, made by cdem.water_table."};
  object.methods.push_back({"height",
                            "Its z over a place.",
                            {number("x").unit("m").required(), number("y").unit("m").required()},
                            true,
                            "number?",
                            "m; nil beyond the end of a surface",
                            method<WaterTableObject>(height)});
  object.text = [](const Object& self) {
    return "cdem.WaterTable: " + static_cast<const WaterTableObject&>(self).words;
  };
  m.classes.push_back(object);
}

} // namespace cdem::script
