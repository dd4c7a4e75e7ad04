// Discs of fracture networks at random, and statistics of networks.
#include "lua/binding/functions/discs.hpp"

#include "lua/binding/functions/radians_given.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/objects.hpp"
#include "lua/binding/schema/angles.hpp"

#include "libgeom/assembly/random_discs.hpp"
#include "libgeom/core/error.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

const Record<geom::RadiusOptions> radius_record{
    {{choice("law", {"constant", "exponential", "lognormal", "power"}).standard(), &geom::RadiusOptions::law},
     {number("mean", "m").above(0).doc("of constant, exponential and lognormal"), &geom::RadiusOptions::mean},
     {number("deviation", "m").above(0).doc("standard deviation, of lognormal"),
      &geom::RadiusOptions::deviation},
     {number("exponent").within(0.01, 20).doc("a of power: the density falls as radius^-(a + 1)"),
      &geom::RadiusOptions::exponent},
     {number("smallest", "m").above(0).doc("of power"), &geom::RadiusOptions::smallest},
     {number("largest", "m").above(0).doc("of power"), &geom::RadiusOptions::largest}}};

const Record<geom::RandomDiscs> disc_set{
    {{text("set").required().doc("its name"), &geom::RandomDiscs::set},
     {number("dip").within(0, 90).in_degrees().required().doc("of the mean plane"), &geom::RandomDiscs::dip},
     {number("dip_direction").within(0, 360).in_degrees().required(), &geom::RandomDiscs::dip_direction},
     {number("kappa").above(0).doc(
          "concentration of Fisher's distribution, some 10 to 100; all discs are parallel when left out"),
      &geom::RandomDiscs::kappa},
     {record("radius", radius_record.fields()).required(), &geom::RandomDiscs::radius, radius_record},
     {number("p30", "1/m3").above(0).doc("discs per volume"), &geom::RandomDiscs::p30},
     {number("p32", "1/m").above(0).doc("instead: area of discs per volume")}}};

// Names what a law takes where something else is given.
void require_radius(const Arguments& given, const std::string& path) {
  const std::string& law = given.text("law");
  const bool power = law == "power", lognormal = law == "lognormal";
  for (const auto& [name, wanted] : {std::pair("mean", !power),
                                     {"deviation", lognormal},
                                     {"exponent", power},
                                     {"smallest", power},
                                     {"largest", power}})
    if (given.has(name) != wanted)
      throw InputError(path + "." + name + (wanted ? ": missing; the law \"" : ": not of the law \"") + law +
                       "\", which takes " +
                       (power       ? "exponent, smallest and largest"
                        : lognormal ? "mean and deviation"
                                    : "mean"));
}

Value random_discs(Session& session, Object*, const Arguments& a) {
  std::vector<double> dips, directions; // deg
  std::vector<geom::RandomDiscs> sets;
  for (const Arguments& given : a.records("sets")) {
    const std::string path = "sets[" + std::to_string(sets.size() + 1) + "]";
    require_radius(*given.record("radius"), path + ".radius");
    geom::RandomDiscs set = disc_set.read(given);
    if (given.has("p30") == given.has("p32"))
      throw InputError(path + ": give one of p30 (discs per m3) and p32 (m2 of joint per m3)");
    if (given.has("p32"))
      set.p30 = given.number("p32") / (pi * geom::mean_square(set.radius));
    sets.push_back(std::move(set));
    dips.push_back(given.number("dip"));
    directions.push_back(given.number("dip_direction"));
  }
  warn_of_radians(session, "random_discs: dip and dip_direction of sets", dips, directions);
  return disc_record().list(
      geom::random_discs(sets, a.box("box"), static_cast<std::uint64_t>(a.integer("seed"))));
}

const Record<geom::DiscStatistics> statistics_record{
    "DiscStatistics",
    "What the discs of one set come to.",
    {{text("set"), &geom::DiscStatistics::set},
     {integer("count").doc("discs in all"), &geom::DiscStatistics::count},
     {number("mean_radius", "m"), &geom::DiscStatistics::mean_radius},
     {number("dip").in_degrees().doc("of the mean plane"), &geom::DiscStatistics::dip},
     {number("dip_direction").in_degrees(), &geom::DiscStatistics::dip_direction},
     {number("kappa").doc("of Fisher, (n - 1) / (n - R); nil for fewer than three discs or parallel ones"),
      &geom::DiscStatistics::kappa},
     {number("p30", "1/m3").doc("centres in the box over its volume"), &geom::DiscStatistics::p30},
     {number("p32", "1/m").doc("area in the box over its volume"), &geom::DiscStatistics::p32},
     {number("p21", "1/m").doc("length of traces in the plane, within the box, over its area"),
      &geom::DiscStatistics::p21},
     {number("p10", "1/m").doc("crossings with the line over its length"), &geom::DiscStatistics::p10}}};

Value disc_statistics(Session& session, Object*, const Arguments& a) {
  geom::DiscWindow window;
  window.box = a.box("box");
  if (const auto plane = a.record("plane")) {
    if (!(plane->vec3("normal").norm() > 0))
      throw InputError("plane.normal", describe(plane->value("normal")), "longer than zero");
    window.plane = geom::Plane::through(plane->vec3("point"), plane->vec3("normal"));
  }
  if (const auto line = a.record("line"))
    window.line = {line->vec3("from"), line->vec3("to")};
  return statistics_record.list(geom::disc_statistics(discs_of(session, a), window));
}

} // namespace

std::vector<geom::Disc> discs_of(Session& session, const Arguments& a) {
  std::vector<geom::Disc> discs;
  std::vector<double> dips, directions; // deg
  for (const Arguments& given : a.records("discs")) {
    geom::Disc disc;
    disc.id = static_cast<std::int64_t>(discs.size()) + 1;
    disc_record().read(given, disc);
    discs.push_back(disc);
    dips.push_back(given.number("dip"));
    directions.push_back(given.number("dip_direction"));
  }
  warn_of_radians(session, "dip and dip_direction of discs", dips, directions);
  return discs;
}

const Record<geom::Disc>& disc_record() {
  static const Record<geom::Disc> members{
      {{integer("id").at_least(0).doc(
            "discs cut in the order of their ids; its place in the list when left out"),
        &geom::Disc::id},
       {vec3("centre", "m").required(), &geom::Disc::centre},
       {number("dip").within(0, 90).in_degrees().required(), &geom::Disc::dip},
       {number("dip_direction").within(0, 360).in_degrees().required(), &geom::Disc::dip_direction},
       {number("radius", "m").above(0).required(), &geom::Disc::radius},
       {text("set").required().doc("name of its faces, for their law"), &geom::Disc::set}}};
  return members;
}

void bind_discs(Module& m) {
  m.add("random_discs",
        "A fracture network at random, for cut_by_discs: discs with centres even in a box, orientation after "
        "Fisher, and a law of radii. Take the box larger than the rock by the largest radius, or the discs "
        "thin out at its sides.",
        {list("sets", record_type(disc_set.fields())).required(), box("box").required().doc("of the centres"),
         integer("seed").at_least(0).standard(1).doc("the same seed gives the same discs on every machine")},
        random_discs, "table[]", "id, centre, dip, dip_direction, radius and set of each");
  m.records.push_back(statistics_record);
  m.add("disc_statistics",
        "Intensities and mean orientation of discs, a row for each set: of cdem.random_discs, or as "
        "surveyed, of cdem.read_discs.",
        {list("discs", record_type(disc_record().fields())).required(),
         box("box").required().doc("the volume"),
         record("plane", {vec3("point", "m").required(), vec3("normal").required()})
             .doc("for p21: a rock face or the floor of a drift"),
         record("line", {vec3("from", "m").required(), vec3("to", "m").required()})
             .doc("for p10: a scanline or a borehole")},
        disc_statistics, "cdem.DiscStatistics[]");
}

} // namespace cdem::script
