// The state of rock before work begins: initial stress, gravity, how far from balance, displacement set to zero.
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/selections.hpp"

#include "libgeom/core/error.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

// Pa; the weight of 4 cm of rock: a unit is wrong.
constexpr double least = 1e3;

double ratio_of(const Value& given, const Value& one) {
  if (!one.is_number() || !(one.number() >= 0) || !std::isfinite(one.number()))
    throw InputError("k0", describe(given), "a finite number >= 0, or two of them {kx, ky}");
  return one.number();
}

std::array<double, 2> k0_of(const Value& given) {
  const Table* const two = given.table();
  if (!two)
    return {ratio_of(given, given), ratio_of(given, given)};
  if (two->items.size() != 2 || !two->named.empty())
    throw InputError("k0", describe(given), "a finite number >= 0, or two of them {kx, ky}");
  return {ratio_of(given, two->items[0]), ratio_of(given, two->items[1])};
}

InitialStress field_of(Session& session, ModelObject& model, const Arguments& a) {
  if (!a.has("stress") && !a.has("gradient"))
    throw InputError("give stress = {xx, yy, zz, xy, yz, xz} (Pa), gradient (Pa/m) with k0, or both");
  for (const char* const only : {"k0", "surface"})
    if (a.has(only) && !a.has("gradient"))
      throw InputError(std::string(only) + ": goes with gradient, the weight of the rock per volume (Pa/m)");
  if (a.has("gradient") && !a.has("k0"))
    throw InputError(
        "k0: missing; with gradient it says how much of the vertical stress acts horizontally, one number or "
        "{kx, ky}; nu / (1 - nu) is that of rock under its weight alone");
  InitialStress field;
  field.on = one_selection(model, a.value("on"), "on");
  if (a.has("stress")) {
    const std::vector<double> given = a.numbers("stress");
    if (given.size() != 6)
      throw InputError("stress", describe(a.value("stress")), "six numbers {xx, yy, zz, xy, yz, xz}");
    std::copy(given.begin(), given.end(), field.stress.begin());
    double largest = 0; // Pa
    for (const double component : given)
      largest = std::fmax(largest, std::abs(component));
    const bool alone = !a.has("gradient");
    if (alone && largest > 0 && largest < least)
      session.warn("initial_stress: stress = " + describe(a.value("stress")) +
                   ": no ground has as little; it is in Pa, 1 MPa is 1e6");
    if (alone && given[0] + given[1] + given[2] > 0)
      session.warn("initial_stress: stress = " + describe(a.value("stress")) +
                   ": tension in the mean; the ground is under pressure, which is negative");
  }
  if (a.has("gradient")) {
    field.gradient = a.number("gradient");
    field.k0 = k0_of(a.value("k0"));
    field.surface = a.optional_number("surface");
  }
  return field;
}

Value initial_stress(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("initial_stress");
  const InitialStress field = field_of(session, model, a);
  const BeyondStrength beyond = model.simulation.initial_stress(field);
  std::string line = "initial stress";
  if (a.has("stress"))
    line += " " + describe(a.value("stress")) + " Pa";
  if (a.has("gradient"))
    line += (a.has("stress") ? " and " : " ") + describe(a.value("gradient")) + " Pa per metre below z = " +
            number_text(field.surface.value_or(model.simulation.model().box.max.z())) + " m, K0 " +
            describe(a.value("k0"));
  model.notes->conditions.push_back(line + " in " + field.on.text);
  if (beyond.points > 0)
    session.warn("initial_stress: " + geom::counted(beyond.points, "joint point is", "joint points are") +
                 " loaded beyond what the joint bears, " +
                 (std::isfinite(beyond.largest_utilisation)
                      ? "at most " + three_digits(beyond.largest_utilisation) + " times its strength"
                      : std::string("some of them without any strength")) +
                 ", worst at " + place_text(beyond.place) +
                 " m: they break or slide at once; change k0 or stress, or raise the joint's strength");
  return beyond.points;
}

const Record<RelaxOptions> balance_options{
    {{number("residual")
          .between(0, 1)
          .standard()
          .doc("goal: out-of-balance force norm over applied force norm"),
      &RelaxOptions::residual},
     {integer("max_steps").at_least(1).standard().doc("gives up with converged = false"),
      &RelaxOptions::max_steps}}};

Value gravity_stress(Session& session, ModelObject& model, const Arguments& a) {
  RelaxOptions options = balance_options.read(a);
  options.breaking = false;
  if (!model.simulation.conditions().gravity)
    throw InputError("gravity_stress: no gravity acts; call model:gravity{ vector = {0, 0, -9.81} } first");
  return stage(session, model, "gravity_stress", a, relax_record({}), [&](Simulation& simulation) {
    const RelaxResult result = simulation.relax(options);
    if (!result.converged)
      session.warn("gravity_stress: not converged after " + std::to_string(result.steps) +
                   " steps, residual " + three_digits(result.residual) + " above " +
                   number_text(options.residual) +
                   "; raise max_steps, give a larger residual, or look whether something moves freely");
    simulation.reset_displacement();
    return Value(relax_record(result));
  });
}

Value reset_displacement(Session&, ModelObject& model, const Arguments&) {
  model.require_idle("reset_displacement");
  model.simulation.reset_displacement();
  model.notes->conditions.push_back("displacement set to zero");
  return {};
}

const Record<Unbalance> unbalance_record{
    "Unbalance",
    "How far from balance a model is.",
    {{number("largest").doc("net force of a free node over the reference, the largest"), &Unbalance::largest},
     {number("mean").doc("the mean over all free nodes"), &Unbalance::mean},
     {number("force", "N").doc("net force where the ratio is largest"), &Unbalance::force},
     {integer("block").doc("its id, there"), &Unbalance::block},
     {vec3("place", "m"), &Unbalance::place}}};

Value unbalance(Session&, ModelObject& model, const Arguments& a) {
  return unbalance_record(model.simulation.unbalance(a.optional_number("reference")));
}

} // namespace

void bind_in_situ(Module& m) {
  m.records.push_back(unbalance_record);
  Class& model = m.the_class("Model");
  model.add("initial_stress",
            "Stress present before anything moves: the same everywhere, growing with depth, or the sum of "
            "both. The vertical stress at depth d below the surface is -gradient d, the horizontal one k0 "
            "times that. Interfaces between two blocks that are both selected start with its traction.",
            {place("on").standard("all").doc("where: one place"),
             list("stress", number_type(), 6).unit("Pa").doc("{xx, yy, zz, xy, yz, xz}, tension positive"),
             number("gradient", "Pa/m")
                 .at_least(0)
                 .doc("weight per volume, density times 9.81")
                 .doubted(0, 1e3, "Rock has 2e4 to 3e4, its weight per metre of depth"),
             plain("k0").doc("horizontal over vertical stress, one number or {kx, ky}; needed with gradient"),
             number("surface", "m")
                 .doc("z where depth begins, the top of the model when left out; above it there is none")},
            initial_stress, "integer",
            "joint points that this loads beyond their strength; a warning tells of them");
  model.add("gravity_stress",
            "Stress of the model's own weight: relaxes under gravity and what else acts, without breaking "
            "bonds, and then sets the displacement to zero.",
            balance_options.fields(), gravity_stress, "cdem.RelaxResult");
  model.add("reset_displacement",
            "Results show the displacement from here on: fields, measures, files and pictures, which draw "
            "the model where it stands now. Stress, joints and supports go on as before; opening and slip of "
            "joints, and the displacement of fix{}, still count from the beginning.",
            {}, reset_displacement);
  model.add("unbalance",
            "How far from balance the model is now: the net forces of its free nodes over the weight of "
            "their blocks. The ratio is 0 in balance, and 1 where a node feels a force like the weight of "
            "its whole block.",
            {number("reference", "N").above(0).doc("force to compare with instead of the weights")},
            unbalance, "cdem.Unbalance");
}

} // namespace cdem::script
