// Bolts and cables in scripts.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/radians_given.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;
using geom::Vec3;

constexpr double degree = 3.14159265358979323846 / 180;

const Record<Bolt> bolt_record{
    {{vec3("from", "m").doc("of one bolt: the collar")},
     {vec3("to", "m").doc("its far end")},
     {record("pattern", {vec3("centre", "m").required().doc("a point of the axis they fan out from"),
                         choice("axis", {"x", "y", "z"}).standard("y"),
                         number("radius", "m").above(0).required().doc("from the axis to the collars"),
                         number("length", "m").above(0).required(),
                         list("angles", number_type())
                             .required()
                             .doc("degrees from the horizontal (x; y where the axis is x), 90 is up (z)"),
                         list("at", number_type()).required().doc("places along the axis, m")})
          .doc("fans of bolts, instead of from and to")},
     {number("area", "m2")
          .above(0)
          .required()
          .doc("of the steel")
          .doubted(0.1, largest_quantity, "A bar of 25 mm has 4.9e-4"),
      &Bolt::area},
     {modulus_field("youngs_modulus").standard(200e9).doc("of the steel"), &Bolt::youngs_modulus},
     {number("yield_stress", "Pa")
          .above(0)
          .doc("of the steel; it does not yield when left out")
          .doubted(0, 1e7, "Steel has 2e8 to 2e9")},
     {number("grout_stiffness", "N/m2")
          .above(0)
          .standard(1e9)
          .doc("force per length of bolt and displacement past the rock")
          .doubted(0, 1e5, "Grout has 1e8 to 1e10"),
      &Bolt::grout_stiffness},
     {number("grout_strength", "N/m")
          .above(0)
          .doc("force per length; it does not slip when left out")
          .doubted(0, 1e3, "Grout has 1e5 to 1e6"),
      &Bolt::grout_strength},
     {number("pretension", "N")
          .at_least(0)
          .standard()
          .doc("of the plate once the bolt is tight")
          .doubted(0, 1e3, "A bolt has 1e4 to 1e6; 100 kN is 1e5"),
      &Bolt::pretension},
     {flag("plate").standard().doc("the collar is fast to the rock"), &Bolt::plate},
     {number("free_length", "m").at_least(0).standard().doc("without grout, from the collar on"),
      &Bolt::free_length},
     {integer("segments").within(1, 1000).standard(), &Bolt::segments}}};

// Fans of bolts from a line: each at `angles` in the plane across the axis, at each of the places along it.
std::vector<std::pair<Vec3, Vec3>> ends_of(const Arguments& pattern) {
  const std::string& axis = pattern.text("axis");
  const int along = axis[0] - 'x', across = (along + 1) % 3, up = (along + 2) % 3;
  // Angles from the horizontal, counter-clockwise seen against the axis; of an axis along y, x is the horizontal.
  const int horizontal = along == 1 ? 0 : across, vertical = along == 1 ? 2 : up;
  const double radius = pattern.number("radius"), length = pattern.number("length");
  std::vector<std::pair<Vec3, Vec3>> ends;
  for (const double place : pattern.numbers("at"))
    for (const double angle : pattern.numbers("angles")) {
      Vec3 direction = Vec3::Zero();
      direction[horizontal] = std::cos(angle * degree);
      direction[vertical] = std::sin(angle * degree);
      Vec3 centre = pattern.vec3("centre");
      centre[along] = place;
      ends.emplace_back(centre + radius * direction, centre + (radius + length) * direction);
    }
  return ends;
}

Value bolts(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("bolts");
  if (a.has("pattern") == a.has("from") || a.has("from") != a.has("to"))
    throw InputError("give from and to, or pattern");
  std::vector<std::pair<Vec3, Vec3>> ends;
  if (const auto pattern = a.record("pattern")) {
    warn_of_radians(session, "bolts: pattern.angles", pattern->numbers("angles"));
    ends = ends_of(*pattern);
  } else
    ends.emplace_back(a.vec3("from"), a.vec3("to"));
  Bolt bolt = bolt_record.read(a);
  if (const auto yield = a.optional_number("yield_stress"))
    bolt.yield_force = *yield * bolt.area;
  all_or_none(session, model, ends.size(), [&](Simulation& simulation, std::size_t i) {
    std::tie(bolt.from, bolt.to) = ends[i];
    try {
      simulation.bolt(bolt);
    } catch (const InputError& e) {
      throw InputError("bolt " + std::to_string(i + 1) + " of " + std::to_string(ends.size()) + ": " +
                       e.what());
    }
  });
  model.notes->conditions.push_back(geom::counted(ends.size(), "bolt") + " set");
  return static_cast<std::int64_t>(ends.size());
}

const Record<Simulation::BoltRow> bolt_state{
    "BoltState",
    "A node of a bolt.",
    {{integer("bolt").doc("from 1, in the order they were set"), &Simulation::BoltRow::bolt},
     {integer("node").doc("from 1, from the collar on"), &Simulation::BoltRow::node},
     {vec3("place", "m").doc("undeformed"), &Simulation::BoltRow::place},
     {number("tension", "N").doc("at a collar with a plate that of the plate"),
      &Simulation::BoltRow::tension},
     {number("grout", "N").doc("on the rock, towards the far end; a plate pushes that way"),
      &Simulation::BoltRow::grout},
     {number("slip", "m").doc("of the bolt past the grout"), &Simulation::BoltRow::slip},
     {number("yielded").doc("strain of the next segment that stays"), &Simulation::BoltRow::yielded}}};

Table bolt_forces(ModelObject& model) {
  return bolt_state.list(model.simulation.bolts());
}

Value save_bolts(Session& session, ModelObject& model, const Arguments& a) {
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  for (const char* const name : {"bolt", "node", "x", "y", "z", "tension", "grout", "slip", "yielded"})
    columns.emplace_back(name, std::vector<double>());
  for (const auto& row : model.simulation.bolts()) {
    const double values[] = {static_cast<double>(row.bolt),
                             static_cast<double>(row.node),
                             row.place.x(),
                             row.place.y(),
                             row.place.z(),
                             row.tension,
                             row.grout,
                             row.slip,
                             row.yielded};
    for (std::size_t c = 0; c < columns.size(); ++c)
      columns[c].second.push_back(values[c]);
  }
  if (columns.front().second.empty())
    throw InputError("save_bolts: the model has no bolts; model:bolts sets some");
  if (!session.settings.check_only)
    write_file(session.files.to_write(a.text("file")), csv(columns));
  return {};
}

} // namespace

void bind_bolts(Module& m) {
  m.records.push_back(bolt_state);
  Class& model = m.the_class("Model");
  model
      .add(
          "bolts",
          "Sets grouted bolts or cables into the rock as it stands now: steel that yields, grout that slips, "
          "along the axis only. Both ends of each must lie in the rock.",
          bolt_record.fields(), bolts, "integer", "how many")
      .replayed(Replay::again);
  model.add("bolt_forces", "Forces along the bolts, one table per node.", {}, bolt_forces,
            "cdem.BoltState[]");
  model.add("save_bolts", "Writes them as .csv: bolt, node, x, y, z, tension, grout, slip, yielded.",
            {text("file").standard("bolts.csv").output()}, save_bolts);
}

} // namespace cdem::script
