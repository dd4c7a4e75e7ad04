// cdem.water.*: fields of water that loads take.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/water_object.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/vtk/read_water.hpp"
#include "libcdem/water/irregular_sea.hpp"
#include "libcdem/water/plain_water.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem::script {

namespace {

using geom::InputError;
using geom::Vec3;

constexpr double half_turn = 3.141592653589793;
constexpr double same_direction = 0.02; // rad

std::shared_ptr<WaterObject> holding(std::shared_ptr<const WaterField> field, std::string words) {
  auto object = std::make_shared<WaterObject>();
  object->field = std::move(field);
  object->words = std::move(words);
  return object;
}

Field density_of_water() {
  return water_density_field("density").standard(1025.0).doc("sea water by default");
}
Field gravity_of_water() {
  return number("gravity", "m/s2").above(0).standard().doc("along -z, the weight of the water");
}
Field direction_field() {
  return vec3("direction").standard().doc("of travel, horizontal");
}
Field level_field() {
  return number("level", "m").standard().doc("z of still water");
}
Field depth_field() {
  return number("depth", "m").above(0).required().doc("of still water");
}

const Record<WaveGiven> wave_given{
    {{choice("theory", {"stream_function", "stokes", "airy"}).standard(), &WaveGiven::theory},
     {number("height", "m").above(0).required().doc("crest over trough"), &WaveGiven::height},
     {number("period", "s").above(0).doc("give it or length"), &WaveGiven::period},
     {number("length", "m").above(0), &WaveGiven::length},
     {depth_field(), &WaveGiven::depth},
     {level_field(), &WaveGiven::level},
     {direction_field(), &WaveGiven::direction},
     {vec3("crest_at", "m").standard().doc("where a crest stands at time 0"), &WaveGiven::crest_at},
     {number("current", "m/s").standard().doc("along the direction, mean under water"), &WaveGiven::current},
     {integer("order").within(3, 50).standard().doc("of the stream function"), &WaveGiven::order},
     {density_of_water(), &WaveGiven::density},
     {gravity_of_water(), &WaveGiven::gravity}}};

const Record<SeaGiven> sea_given{
    {{number("significant_height", "m").above(0).required(), &SeaGiven::significant_height},
     {number("peak_period", "s").above(0).required(), &SeaGiven::peak_period},
     {depth_field(), &SeaGiven::depth},
     {level_field(), &SeaGiven::level},
     {number("peak_enhancement").within(1, 20).standard().doc("gamma; 1: Pierson and Moskowitz"),
      &SeaGiven::peak_enhancement},
     {direction_field(), &SeaGiven::direction},
     {vec3("origin", "m").standard(), &SeaGiven::origin},
     {integer("components").within(10, 10000).standard(), &SeaGiven::components},
     {integer("seed").at_least(0).standard(), &SeaGiven::seed},
     {density_of_water(), &SeaGiven::density},
     {gravity_of_water(), &SeaGiven::gravity}}};

const Record<SlopeGiven> slope_given{
    {{list("bed", tuple_type({number_type(), number_type()}), 2)
          .required()
          .doc("points {x, z} (m) from the sea up the slope, x along the direction from the origin"),
      &SlopeGiven::bed},
     {object_or_function("waves", "Water", "(time: number): number")
          .required()
          .doc("that enter over the first point: waves of its level, depth and direction, much longer than "
               "deep, or the height over still water (m)")},
     {number("duration", "s").above(0).required().doc("a run may not go on beyond it"),
      &SlopeGiven::duration},
     {level_field(), &SlopeGiven::level},
     {number("cell", "m").above(0).doc("a 300th of the bed when left out")},
     {number("ramp", "s").at_least(0).standard(0.0).doc("over which the waves grow from nothing")},
     {number("friction")
          .within(0, 10)
          .standard()
          .doc("f of the bed's resistance rho f u |u|: smooth 0.005, armour 0.02 to 0.1"),
      &SlopeGiven::friction},
     {direction_field(), &SlopeGiven::direction},
     {vec3("origin", "m").standard(), &SlopeGiven::origin},
     {density_of_water(), &SlopeGiven::density},
     {gravity_of_water(), &SlopeGiven::gravity}}};

const Record<WaterArrays> water_arrays{
    {{text("velocity").standard("U").doc("name of the array (m/s, three components), at points or in cells"),
      &WaterArrays::velocity},
     {text("pressure")
          .doc("name of the array: pressure above that of the air with its hydrostatic part, such as "
               "OpenFOAM's \"p\" (\"p_rgh\" lacks that part). Left out: hydrostatic below the surface"),
      &WaterArrays::pressure},
     {number("pressure_factor")
          .above(0)
          .standard()
          .doc("Pa in a unit of it; the density where it is kinematic"),
      &WaterArrays::pressure_factor},
     {text("fraction").doc("name of the array of the water fraction, 0 to 1, such as \"alpha.water\""),
      &WaterArrays::fraction},
     {number("level", "m")
          .doc("z of the free surface where there is no fraction; left out: water everywhere")},
     {number("cell", "m")
          .above(0)
          .doc("of the grid; left out: that of a .vti, else the mean size of the cells"),
      &WaterArrays::cell},
     {choice("same_along", {"x", "y", "z"})
          .doc("the water is the same all along this axis, as in a flume of one cell")},
     {vec3("shift", "m").standard().doc("is added to the coordinates"), &WaterArrays::shift},
     {density_of_water(), &WaterArrays::density},
     {gravity_of_water(), &WaterArrays::gravity}}};

const Record<UniformWater> uniform_record{
    {{vec3_or_function("velocity", "(time: number): number[]").unit("m/s").required(),
      &UniformWater::velocity},
     {number("level", "m")
          .doc("z of the free surface, below which the pressure is hydrostatic; left out: water everywhere, "
               "no buoyancy"),
      &UniformWater::level},
     {density_of_water(), &UniformWater::density},
     {gravity_of_water(), &UniformWater::gravity}}};

const char* const in_water = "(x: number, y: number, z: number, time: number): number";

const Record<FunctionWater> function_record{
    {{function("velocity", std::string(in_water) + "[]").unit("m/s").required(), &FunctionWater::velocity},
     {function("acceleration", std::string(in_water) + "[]").unit("m/s2"), &FunctionWater::acceleration},
     {function("pressure", in_water).unit("Pa").doc("that of the motion included"), &FunctionWater::pressure},
     {function("surface", in_water).unit("m").doc("z of the free surface; water everywhere when left out"),
      &FunctionWater::surface},
     {density_of_water(), &FunctionWater::density},
     {gravity_of_water(), &FunctionWater::gravity}}};

// A slip in its functions is an error of the line that gave them; a field belongs to no model and no time yet.
Value tried(std::shared_ptr<WaterObject> object) {
  object->field->at(geom::Vec3::Zero(), 0);
  return object;
}

Value uniform(Session&, Object*, const Arguments& a) {
  return tried(holding(uniform_water(uniform_record.read(a)), "water of one velocity"));
}

Value field(Session&, Object*, const Arguments& a) {
  return tried(holding(function_water(function_record.read(a)), "water of functions"));
}

Vec3 level_direction(const Vec3& given) {
  return Vec3(given.x(), given.y(), 0).normalized();
}

Value wave(Session&, Object*, const Arguments& a) {
  const WaveGiven given = wave_given.read(a);
  const auto made = std::make_shared<WaveField>(given);
  auto object = holding(made, "waves of " + number_text(given.height) + " m and " +
                                  number_text(given.period.value_or(made->period())) + " s");
  object->travelling = TravellingWaves{made->along, made->wave.wave_number, given.current};
  return object;
}

Value sea(Session&, Object*, const Arguments& a) {
  const SeaGiven given = sea_given.read(a);
  auto object = holding(std::make_shared<IrregularSea>(given),
                        "an irregular sea of " + number_text(given.significant_height) + " m");
  object->travelling = TravellingWaves{level_direction(given.direction),
                                       linear_wave_number(given.peak_period, given.depth, given.gravity), 0};
  return object;
}

// Waves of another level or depth would enter with the flow and the celerity of other water.
void require_same_bed(const WaterField& waves, const SlopeGiven& slope) {
  const std::optional<FlatBed> bed = waves.flat_bed();
  if (!bed)
    return;
  const double depth = slope.level - slope.bed[0][1], rounding = 1e-6 * std::abs(depth);
  if (std::abs(bed->level - slope.level) > rounding || std::abs(bed->level - bed->z - depth) > rounding)
    throw InputError("waves",
                     number_text(bed->level - bed->z) +
                         " m deep with still water at z = " + number_text(bed->level) + " m",
                     "those of the first point of the bed, " + number_text(depth) +
                         " m and z = " + number_text(slope.level) + " m",
                     "give cdem.water.wave this depth and level, or the slope a bed as deep");
}

// One dimension has no waves that travel elsewhere, and a wall at its far end lets no current through.
void require_along(const TravellingWaves& waves, const SlopeGiven& slope) {
  const Vec3 along = level_direction(slope.direction);
  if (!((waves.direction - along).norm() <= same_direction))
    throw InputError("waves", "of direction " + geom::text(waves.direction),
                     "of the direction of the slope, " + geom::text(along),
                     "waves travel along its bed only");
  if (waves.current != 0)
    throw InputError("waves", "on a current of " + number_text(waves.current) + " m/s", "without a current",
                     "the far end of the slope is closed");
}

// Shallow water is for waves much longer than the depth d: k d well below 1.
void warn_of_short(const TravellingWaves& waves, const SlopeGiven& slope, Session& session) {
  const double kd = waves.wave_number * (slope.level - slope.bed[0][1]);
  if (kd > 1)
    session.warn(fmt::format(
        "cdem.water.slope: the waves have k d = {:.2g} (wave number times depth) at the first point of the "
        "bed, and shallow water holds up to about 1. It moves alike from the surface to the bed, where these "
        "waves have {:.2g} of their velocity at still water; let the bed begin in less water, or take longer "
        "waves",
        kd, 1 / std::cosh(kd)));
}

// The waves that enter over the foot of the slope, grown from nothing over the ramp.
std::function<double(double)> entering(Session& session, const Arguments& a, const SlopeGiven& slope) {
  std::function<double(double)> height;
  if (const auto waves = a.object<WaterObject>("waves")) {
    require_same_bed(*waves->field, slope);
    if (waves->travelling) {
      require_along(*waves->travelling, slope);
      warn_of_short(*waves->travelling, slope, session);
    }
    Vec3 foot = slope.origin + slope.bed[0][0] * level_direction(slope.direction);
    foot.z() = slope.level;
    height = [field = waves->field, foot, level = slope.level](double time) {
      return field->at(foot, time).surface - level;
    };
    if (!std::isfinite(height(0)))
      throw InputError("waves", "water without a free surface there", "waves of the same level");
  } else {
    read(a, number("waves", "m"), height);
  }
  const double ramp = a.number("ramp");
  return [height, ramp](double time) {
    if (time >= ramp)
      return height(time);
    return 0.5 * (1 - geom::portable::cos(half_turn * time / ramp)) * height(time);
  };
}

Value slope_water(Session& session, Object*, const Arguments& a) {
  SlopeGiven given = slope_given.read(a);
  given.cell = a.optional_number("cell").value_or((given.bed.back()[0] - given.bed[0][0]) / 300);
  if (geom::Vec3(given.direction.x(), given.direction.y(), 0).norm() > 0)
    given.entering = entering(session, a, given);
  auto made = std::make_shared<SlopeWater>(given);
  const double top = given.bed.back()[1];
  if (made->run_up() >= top)
    session.warn("cdem.water.slope: the water reaches the end of the bed at z = " + number_text(top) +
                 " m, which is a wall; let the bed go on");
  auto object = holding(
      made, "waves that run up a slope to z = " + number_text(std::round(1e3 * made->run_up()) / 1e3) + " m");
  object->slope = made;
  return object;
}

WaterFiles files_of(Session& session, const Arguments& a) {
  if (a.has("series") == a.has("files"))
    throw InputError("give one of series = a .pvd file and files = a list with their times");
  if (a.has("series")) {
    if (a.has("times"))
      throw InputError("times: goes with files; a .pvd file has its own");
    return water_files_of(session.files.to_read(a.text("series")).string());
  }
  WaterFiles files;
  for (const Value& file : a.list("files"))
    files.paths.push_back(session.files.to_read(*file.get<std::string>()).string());
  files.times = a.numbers("times");
  if (files.times.empty() && files.paths.size() == 1)
    files.times = {0};
  return files;
}

// "-3 to 12", "any"
std::string range_text(double low, double high) {
  return std::isfinite(low) ? number_text(low) + " to " + number_text(high) : "any";
}

Value file_water(Session& session, Object*, const Arguments& a) {
  WaterArrays wish = water_arrays.read(a);
  if (const std::string axis = a.text_or("same_along", ""); !axis.empty())
    wish.same_along = axis[0] - 'x';
  WaterFiles files = files_of(session, a);
  if (files.times.size() != files.paths.size())
    throw InputError("times", std::to_string(files.times.size()) + " numbers",
                     "as many as files, " + std::to_string(files.paths.size()));
  for (double& time : files.times)
    time += a.number("time_shift");
  const bool has_level = a.has("level");
  if (has_level && !wish.fraction.empty())
    throw InputError("level: goes without fraction, whose surface is its own");
  WaterRecord record = read_water(files, wish);
  record.level = a.optional_number("level");
  const auto made = std::make_shared<RecordedWater>(std::move(record));
  const geom::Box box = made->box();
  std::string line = "cdem.water.file: " + geom::counted(files.paths.size(), "file");
  if (files.times.size() > 1)
    line += " from " + number_text(files.times.front()) + " to " + number_text(files.times.back()) + " s";
  for (int axis = 0; axis < 3; ++axis)
    line += std::string(", ") + "xyz"[axis] + " " + range_text(box.min[axis], box.max[axis]);
  session.message(line + " m; a run that leaves these ends with an error");
  if (const auto cut = made->reaches_top())
    session.warn(fmt::format(
        "cdem.water.file: at {:g} s water reaches the top of the files at {}, and there is air above; "
        "write a higher box",
        cut->time, geom::place_text(cut->place)));
  return holding(made, "water of " + geom::counted(files.paths.size(), "file"));
}

const Record<WaterPoint> water_point{
    "WaterPoint",
    "Water at a place and time.",
    {{vec3("velocity", "m/s"), &WaterPoint::velocity},
     {vec3("acceleration", "m/s2").doc("of the particles"), &WaterPoint::acceleration},
     {number("pressure", "Pa").doc("above that of the air"), &WaterPoint::pressure},
     {number("surface", "m").doc("z of the free surface; nil where it is dry or water is everywhere"),
      [](const WaterPoint& point) { return if_finite(point.surface); }}}};

Table point_at(Session&, WaterObject& water, const Arguments& a) {
  return water_point(seen_at(*water.field, a.vec3("place"), a.number("time")));
}

void bind_water_class(Module& m) {
  m.records.push_back(water_point);
  Class water{"Water", "A field of water, made by cdem.water.*; what model:flow takes as `water`."};
  water.property("density", "number", "kg/m3", "",
                 [](const WaterObject& self) { return self.field->density(); });
  water.property("run_up", "number?", "m", "highest z that is wet at any time; on a slope only",
                 [](const WaterObject& self) { return self.slope ? Value(self.slope->run_up()) : Value(); });
  water.property(
      "run_down", "number?", "m", "lowest z of the water line; on a slope only",
      [](const WaterObject& self) { return self.slope ? Value(self.slope->run_down()) : Value(); });
  water
      .add("at", "Velocity, acceleration, pressure and surface at a place and time.",
           {vec3("place", "m").required(), number("time", "s").standard(0.0)}, point_at, "cdem.WaterPoint")
      .ordered();
  water.text = [](const Object& self) {
    return "cdem.Water: " + static_cast<const WaterObject&>(self).words;
  };
  m.classes.push_back(water);
}

} // namespace

void bind_water_fields(Module& m) {
  bind_water_class(m);
  m.add("water.uniform", "Water of one velocity everywhere below its level.", uniform_record.fields(),
        uniform, "cdem.Water");
  m.add(
      "water.field",
      "Water described by functions of place and time, which are called at every node of a unit. Without a "
      "function for the pressure, the pressure is hydrostatic below the surface, and what accelerated water "
      "adds to it follows from the acceleration. Without a function for the "
      "acceleration, the acceleration follows from the velocity.",
      function_record.fields(), field, "cdem.Water");
  m.add("water.wave",
        "A regular wave that keeps its shape, over a flat bed at z = level - depth. stream_function: order "
        "N, any depth (Rienecker "
        "and Fenton 1981); stokes: fifth order (Fenton 1985), for waves that are not long; airy: small "
        "waves. A wave higher than the breaking limit is refused.",
        wave_given.fields(), wave, "cdem.Water");
  m.add("water.sea",
        "An irregular sea of long crests: Airy waves whose energy follows the JONSWAP spectrum, with "
        "frequencies and phases drawn from the seed. Best as the waves of cdem.water.slope: at each node it "
        "sums all components.",
        sea_given.fields(), sea, "cdem.Water");
  m.add("water.slope",
        "Waves that run up and down a slope: shallow water along the bed, computed once here. Velocity along "
        "the bed and the free surface, hydrostatic pressure. For waves with k d (wave number times depth) up "
        "to about 1 at the first point. A breaking wave is a bore, without jet and "
        "without the pressure of its impact. A body beyond the ends of the bed ends the run with an error.",
        slope_given.fields(), slope_water, "cdem.Water");
  m.add(
      "water.file",
      "Water that another program has computed, from VTK's files (.vti, .vtu, .vts, .vtr, legacy .vtk) at "
      "several times. It is put on a regular grid, and is linear between its points and times. The free "
      "surface is where the water fraction is 1/2. A run that asks beyond the box or the times of the files "
      "ends with an error; above the box there may be air, where a fraction or a level tells. One file alone "
      "is water that does not change.",
      std::vector<Field>{
          text("series").doc("a .pvd file, which lists files with their times; give it or files"),
          list("files", text_type()).doc("in the order of their times"),
          list("times", number_type(), 0).unit("s").doc("of the files")} +
          water_arrays.fields() +
          std::vector<Field>{number("time_shift", "s")
                                 .standard(0.0)
                                 .doc("is added to the times, such as the model's time at the start")},
      file_water, "cdem.Water");
}

} // namespace cdem::script
