// Water tables that are not level.
#include "lua/binding/functions/radians_given.hpp"
#include "lua/binding/module/module.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/text_table.hpp"
#include "libgeom/mesh/plan_triangles.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

// Beyond it the pressure is more than half too large, cos^2 of the slope.
constexpr double steep = 35; // deg

struct TableFile {
  std::vector<std::array<double, 2>> rows; // of a profile, or
  std::vector<geom::Vec3> points;
};

TableFile read_table(Session& session, const std::string& name) {
  const geom::TextTable table(read_file(session.files.to_read(name)), name);
  const auto distance = table.find("distance"), x = table.find("x"), y = table.find("y"), z = table.find("z");
  const bool profile = distance.has_value();
  if (!z || (!profile && !(x && y)))
    table.refuse("its columns must be distance and z (m), of a profile, or x, y and z (m), of points");
  const auto number = [&](std::size_t row, std::size_t column) {
    const double value = table.number(row, column);
    if (std::isnan(value))
      table.refuse(row, column, "a number (m)");
    return value;
  };
  TableFile file;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!profile) {
      file.points.emplace_back(number(row, *x), number(row, *y), number(row, *z));
      continue;
    }
    file.rows.push_back({number(row, *distance), number(row, *z)});
    if (row > 0 && !(file.rows[row][0] > file.rows[row - 1][0]))
      table.refuse(row, *distance, "more than in the row before: distances rise");
  }
  return file;
}

// point and dip_direction go with dip, origin and direction with a profile, given as rows or by a file.
void require_its_fields(const Arguments& a, const std::string& kind) {
  const auto require = [&](const char* field, bool fits, const char* partner) {
    if (a.has(field) && !fits)
      throw InputError(std::string(field) + ": goes with " + partner + ", not with " + kind);
  };
  for (const char* const field : {"point", "dip_direction"})
    require(field, kind == "dip", "dip");
  for (const char* const field : {"origin", "direction"})
    require(field, kind == "profile" || kind == "file", "profile or file");
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
  std::vector<std::string> given;
  for (const char* const kind : {"dip", "profile", "points", "file", "surface"})
    if (a.has(kind))
      given.emplace_back(kind);
  if (given.size() != 1)
    throw InputError(
        "give one of dip with point and dip_direction (a plane), profile = rows {distance, z}, points = "
        "{ {x, y, z}, ... }, file = a table of either, and surface = cdem.read_surface{...} or "
        "cdem.surface{...}");
  const std::string& kind = given[0];
  require_its_fields(a, kind);
  TableFile table;
  if (kind == "file")
    table = read_table(session, a.text("file"));
  for (const Value& row : a.list("profile"))
    table.rows.push_back({row.table()->items[0].number(), row.table()->items[1].number()});
  for (const Value& point : a.list("points"))
    table.points.push_back(to_vec3(point));
  auto object = std::make_shared<WaterTableObject>();
  if (kind == "dip") {
    object->table = plane_of(session, a);
    object->words = "a plane that dips by " + describe(a.value("dip")) + " degrees towards " +
                    describe(a.value("dip_direction"));
  } else if (kind == "surface") {
    object->table = water_surface(a.object<SurfaceObject>("surface")->surface);
    object->words = "a surface of triangles";
  } else if (table.rows.empty()) {
    for (const char* const field : {"origin", "direction"})
      if (a.has(field))
        throw InputError(std::string(field) + ": goes with a profile, not with points x, y, z");
    object->table = water_surface(geom::plan_triangles(table.points, kind == "file" ? "file" : "points"));
    object->words = std::to_string(table.points.size()) + " points";
  } else {
    object->words = "a profile of " + std::to_string(table.rows.size()) + " points";
    object->table =
        water_profile(std::move(table.rows), a.optional_vec3("origin").value_or(geom::Vec3::Zero()),
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
  m.add("water_table",
        "A water table that is not level, for model:water and model:traction: a plane, a profile along a "
        "direction, or a surface. Pressure is weight times the vertical depth below it (docs/theory.md, "
        "\"Water\").",
        {vec3("point", "m").doc("of a plane"),
         number("dip", "deg").from(0, 90).doc("of a plane, below the horizontal"),
         number("dip_direction", "deg").within(0, 360).doc("clockwise from +y (north)"),
         list("profile", tuple_type({number_type(), number_type()}), 2)
             .doc("instead: rows {distance, z} (m); straight between them, level beyond, the same across"),
         list("points", vec3_type(), 3)
             .unit("m")
             .doc("instead: {x, y, z}, such as levels in boreholes; straight in the triangles of Delaunay "
                  "between them"),
         text("file").doc(
             "instead: a table (docs/output-files.md) with columns distance and z, or x, y and z (m)"),
         vec3("origin", "m").doc("where the distance of a profile is 0; {0, 0, 0} when left out"),
         vec3("direction").doc("of a profile, horizontal; {1, 0, 0} when left out"),
         object("surface", "Surface")
             .doc("instead: open, once over each place; larger than the model in plan")},
        water_table, "cdem.WaterTable");
  Class object{"WaterTable", "A water table, made by cdem.water_table."};
  object
      .add("height", "Its z over a place.", {number("x", "m").required(), number("y", "m").required()},
           height, "number?", "m; nil beyond the end of a surface")
      .ordered();
  object.text = [](const Object& self) {
    return "cdem.WaterTable: " + static_cast<const WaterTableObject&>(self).words;
  };
  m.classes.push_back(object);
}

} // namespace cdem::script
