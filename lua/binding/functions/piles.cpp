// Piles: units of one shape hung over a ground, or laid on it, before there is a model of them.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/functions/solving_stage.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/pile_object.hpp"
#include "lua/binding/objects/solid_objects.hpp"
#include "lua/binding/schema/angles.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/placement/drop_grid.hpp"
#include "libgeom/placement/walls.hpp"

#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

constexpr double unit_tolerance = 0.01; // of volume and height, between meshes of one unit

geom::Ground ground_of(const Arguments& a) {
  return geom::Ground(geom::surface_of(a.object<TetMeshObject>("onto")->mesh));
}

std::optional<geom::PlanBox> plan_region(const Arguments& a) {
  const auto region = a.record("region");
  if (!region)
    return std::nullopt;
  const auto corner = [&](const char* name) {
    const std::vector<double> x = region->numbers(name);
    if (x.size() != 2)
      throw InputError(std::string("region.") + name, describe(region->value(name)), "two numbers, {x, y}");
    return Eigen::Vector2d(x[0], x[1]);
  };
  return geom::PlanBox{corner("min"), corner("max")};
}

Field attitude_seed() {
  return integer("seed").at_least(0).standard().doc("of the attitudes");
}

const Record<geom::DropOptions> drop_options{
    {{attitude_seed(), &geom::DropOptions::seed},
     {number("gap", "m")
          .above(0)
          .doc("between the spheres around units, and under the lowest layer; a tenth of the unit's height"),
      &geom::DropOptions::gap},
     {integer("layers")
          .within(1, geom::max_drop_layers)
          .doc("on top of each other; as few as the region allows when left out"),
      &geom::DropOptions::layers}}};

const Record<geom::LayerOptions> layer_options{
    {{attitude_seed(), &geom::LayerOptions::seed},
     {integer("layers")
          .within(1, geom::max_layers)
          .standard()
          .doc("on top of each other, the lowest first; each has its share of the units"),
      &geom::LayerOptions::layers},
     {number("density").within(0.05, 1.5).standard().doc(
          "of each layer: phi = N Dn^2 / A, units on an area of slope times that of their equal cube's side"),
      &geom::LayerOptions::density},
     {integer("columns").at_least(1).doc("units in a row; as many as the region allows when left out"),
      &geom::LayerOptions::columns},
     {number("gap", "m").above(0).doc("clear distance; 2e-5 of the unit's height"), &geom::LayerOptions::gap},
     {integer("attitudes")
          .within(1, 1e6)
          .standard()
          .doc("of which those are taken that fit into the pattern, beside others"),
      &geom::LayerOptions::attitudes},
     {integer("nudges").within(0, 100000).standard().doc(
          "steps of a unit on its way to rest, at most; 0: only lowered on to what is there, each by itself"),
      &geom::LayerOptions::nudges},
     {number("play").within(0, 1).standard().doc(
          "how far along the contour a unit may be from its place, over its height"),
      &geom::LayerOptions::play},
     {friction_field("friction_angle")
          .standard(15.0)
          .doc("friction angle with which the units come to rest. Units of the lowest row are held, by more "
               "than the slope's angle")},
     {flag("walls").standard().doc("at both ends of the rows walls stand along the slope, on which units "
                                   "lean; the pile's box ends there"),
      &geom::LayerOptions::walls}}};

Value drop(Session&, Object*, const Arguments& a) {
  geom::DropOptions options = drop_options.read(a);
  options.region = plan_region(a);
  return std::make_shared<PileObject>(
      geom::drop_grid(a.object<TetMeshObject>("unit")->mesh, a.count("count"), ground_of(a), options));
}

std::string of_at_most(int number, int most) {
  return std::to_string(number) + " of at most " + std::to_string(most);
}

// Shows how far a layer is, and ends it when the user asks for that.
class LayingObserver {
public:
  LayingObserver(Session& session, int count)
      : session_(session), observer_(session.settings.observer), count_(count) {
    progress_.kind = "place";
    progress_.counts = "unit";
    progress_.preparing = true;
  }
  void operator()(const geom::LayerProgress& now) {
    if (observer_ && observer_->stop_requested()) {
      session_.checkpoints.stop();
      throw Interrupted();
    }
    progress_.step = now.laid;
    progress_.max_steps = now.laid < count_ ? count_ : 0; // how long the rest takes nobody knows
    progress_.note = now.doing;
    if (now.unsupported > 0)
      progress_.note += ", " + std::to_string(now.unsupported) + " of them with fewer than three supports";
    if (now.layers > 1)
      progress_.note += ", layer " + std::to_string(now.layer) + " of " + std::to_string(now.layers);
    if (now.attempts > 1)
      progress_.note += ", attempt " + of_at_most(now.attempt, now.attempts);
    progress_.note += ", spacing " + of_at_most(now.spacing, now.spacings);
    tell();
  }
  void end() {
    progress_.last = true;
    tell();
  }

private:
  void tell() {
    if (!observer_ || session_.checkpoints.silent())
      return;
    progress_.wall_time = session_.elapsed() - begun_;
    observer_->progress(progress_);
  }

  Session& session_;
  std::shared_ptr<Observer> observer_;
  int count_;
  double begun_ = session_.elapsed();
  Progress progress_;
};

constexpr std::size_t units_named = 40;

std::string numbers_text(const std::vector<int>& units) {
  std::string text;
  for (std::size_t i = 0; i < units.size() && i < units_named; ++i)
    text += (text.empty() ? "" : ", ") + std::to_string(units[i] + 1);
  if (units.size() > units_named)
    text += " and " + std::to_string(units.size() - units_named) + " more";
  return (units.size() == 1 ? "unit " : "units ") + text;
}

// Relative difference of a settled layer's density from the density asked for, above which the user is warned.
constexpr double density_told_of = 0.05;

void tell(Session& session, const geom::Layer& layer, double density) {
  const std::string name = "cdem.place: ";
  if (layer.density && std::abs(*layer.density / density - 1) > density_told_of)
    session.warn(name + "density = " + number_text(density) + " came to " + three_digits(*layer.density) +
                 ", as near as these units lie at rest on this ground in rows of so many; ask for another "
                 "density, other columns or a wider ground");
  if (!layer.at_rest)
    session.warn(
        name + "the units were laid one by one, but did not come to rest together, clear of each other; they "
               "will move when they settle; try another seed, a lower density or a larger gap");
  if (layer.measures)
    session.message(name + "in the middle of the pile the packing density of a layer is " +
                    three_digits(*layer.density) + ", the porosity " +
                    three_digits(layer.measures->porosity) + ", the thickness of all layers " +
                    three_digits(layer.measures->thickness / layer.pile.height) + " of a unit's height");
  if (layer.attempts > 1)
    session.message(name + "laid " + std::to_string(layer.attempts) +
                    " times, each with other attitudes, as units slid off, leant on too little or did not "
                    "rest; the best is taken");
  if (!layer.put_back.empty())
    session.message(name + numbers_text(layer.put_back) +
                    " would have slid further than half a height, and " +
                    (layer.put_back.size() == 1 ? "stays as laid; it" : "stay as laid; they") +
                    " may slide when " + (layer.put_back.size() == 1 ? "it settles" : "they settle"));
  if (!layer.leaning.empty())
    session.warn(name + std::to_string(layer.leaning.size()) + " of " +
                 std::to_string(layer.pile.poses.size()) +
                 " units have fewer than three supports: " + numbers_text(layer.leaning) +
                 "; they may move when they settle. At an open end of a row a unit has but the slope and one "
                 "unit to lean on: walls = true gives it a third; or try another seed or density");
}

Value lay(Session& session, Object*, const Arguments& a) {
  geom::LayerOptions options = layer_options.read(a);
  options.region = plan_region(a);
  options.friction = geom::portable::tan(radians(a.number("friction_angle")));
  const int count = a.count("count");
  LayingObserver observer(session, count);
  options.tell = [&](const geom::LayerProgress& now) { observer(now); };
  geom::Layer layer;
  try {
    layer = geom::place_layer(a.object<TetMeshObject>("unit")->mesh, count, ground_of(a), options);
  } catch (...) {
    observer.end();
    throw;
  }
  observer.end();
  if (options.nudges > 0)
    tell(session, layer, options.density);
  return std::make_shared<PileObject>(std::move(layer.pile));
}

Value read_pile(Session& session, Object*, const Arguments& a) {
  const std::filesystem::path path = session.files.to_read(a.text("file"));
  return pile_from(read_file(path), a.text("file"));
}

Value save_pile(Session& session, PileObject& self, const Arguments& a) {
  require_ending(a.text("file"), ".json");
  if (!session.settings.check_only)
    write_file(session.files.to_write(a.text("file")), pile_text(self));
  return {};
}

Value scaled(Session&, PileObject& self, const Arguments& a) {
  return std::make_shared<PileObject>(geom::scaled(self.pile, a.number("factor")), self.units);
}

Value with_unit(Session&, PileObject& self, const Arguments& a) {
  const geom::TetMesh& unit = a.object<TetMeshObject>("unit")->mesh;
  geom::Pile pile = geom::pile_of(unit);
  const double volume = geom::volume(pile.unit), before = geom::volume(self.pile.unit);
  const geom::Vec3 apart = geom::bounding_box(pile.unit).size() - geom::bounding_box(self.pile.unit).size();
  if (std::abs(volume / before - 1) > unit_tolerance || apart.norm() > unit_tolerance * self.pile.height)
    throw InputError("unit", three_digits(volume) + " m3",
                     "another mesh of the same unit, of " + number_text(before) +
                         " m3 and as long, wide and high",
                     "scale the pile first where the size differs");
  pile.height = self.pile.height;
  pile.poses = self.pile.poses;
  return std::make_shared<PileObject>(std::move(pile), self.units);
}

Value walls(Session&, PileObject& self, const Arguments& a) {
  return std::make_shared<TetMeshObject>(geom::walls_around(
      self.pile, ground_of(a), {a.optional_number("height"), a.optional_number("thickness")}));
}

struct UnitPose : geom::Pose, UnitNow {};

std::vector<UnitPose> poses(const PileObject& self) {
  std::vector<UnitPose> rows;
  for (std::size_t i = 0; i < self.units.size(); ++i)
    rows.push_back({self.pile.poses[i], self.units[i]});
  return rows;
}

const Record<UnitPose> pose_record{
    "Pose",
    "Place and attitude of a unit; of one that has broken, those that its largest piece gives it.",
    {{integer("unit").doc("its number in the body, from 1"), &UnitPose::number},
     {vec3("centroid", "m"), &UnitPose::translation},
     {list("rotation", vec3_type(), 3).required().doc("rows of the matrix that turns the unit"),
      [](const UnitPose& pose) { return as_value(pose.rotation); }},
     {integer("pieces").doc("into which it has broken; 1: it is whole"), &UnitPose::pieces},
     {number("largest_piece").doc("part of the unit's volume in it"), &UnitPose::largest_piece}}};

void bind_class(Module& m) {
  m.records.push_back(pose_record);
  Class pile{"Pile", "Units of one shape, each with its place and attitude: made by cdem.drop, cdem.place, "
                     "cdem.read_pile and model:pile. The shape of a meshed body with one block for each."};
  pile.length = [](const Object& self) {
    return static_cast<std::int64_t>(static_cast<const PileObject&>(self).pile.poses.size());
  };
  pile.text = [](const Object& self) {
    const geom::Pile& p = static_cast<const PileObject&>(self).pile;
    return "cdem.Pile (" + geom::counted(p.poses.size(), "unit") + " of " +
           geom::counted(p.unit.tets.size(), "tet") + ")";
  };
  pile.property("count", "integer", "", "how many units",
                [](const PileObject& p) { return p.pile.poses.size(); });
  pile.property("height", "number", "m", "of a unit: that of its mesh along z",
                [](const PileObject& p) { return p.pile.height; });
  pile.property("unit_volume", "number", "m3", "of the unit's mesh",
                [](const PileObject& p) { return geom::volume(p.pile.unit); });
  pile.property("nominal_diameter", "number", "m", "Dn, side of a cube of that volume",
                [](const PileObject& p) { return geom::nominal_diameter(p.pile); });
  pile.property("broken", "integer", "", "units of which no piece has more than nine tenths of the volume",
                [](const PileObject& p) {
                  return std::count_if(p.units.begin(), p.units.end(),
                                       [](const UnitNow& unit) { return unit.broken(); });
                });
  pile.add("scaled", "The same pile in another size: all lengths about the origin times the factor.",
           {number("factor").above(0).required()}, scaled, "cdem.Pile");
  pile.add("with_unit",
           "The same places and attitudes with another mesh of the unit, such as a finer one; it must stand "
           "along the same axes.",
           {object("unit", "TetMesh").required()}, with_unit, "cdem.Pile");
  pile.add("walls",
           "Walls that keep the pile together, such as those of a flume, as the mesh of a rigid body that is "
           "held. They stand at both sides and at the foot of the ground; on level ground they stand all "
           "round. Their inner faces stand at the ends of the pile's box. Their lower edges keep a small gap "
           "from the ground, so that walls and ground can be bodies of one model.",
           {object("onto", "TetMesh").required().doc("the ground, z up"),
            number("height", "m")
                .above(0)
                .doc("over the ground; that of the highest unit when left out, two units at least"),
            number("thickness", "m").above(0).doc("a unit's height when left out")},
           walls, "cdem.TetMesh");
  pile.add(
      "poses", "Place and attitude of each unit.", {},
      [](PileObject& self) { return pose_record.list(poses(self)); }, "cdem.Pose[]");
  pile.add(
      "box", "Smallest axis-aligned box that holds all units where they are.", {},
      [](PileObject& self) { return geom::bounding_box(self.pile); }, "cdem.Box");
  pile.add("save", "Writes the pile, for cdem.read_pile in another script.",
           {text("file").required().doc("ends in .json").output()}, save_pile);
  m.classes.push_back(pile);
}

} // namespace

void bind_piles(Module& m) {
  const std::vector<Field> unit{
      object("unit", "TetMesh").required().doc("a unit's mesh"),
      integer("count").within(1, 1e6).required().doc("how many units"),
      object("onto", "TetMesh").required().doc("the ground, z up; a slope's mesh"),
      record("region", {list("min", number_type(), 2).required(), list("max", number_type(), 2).required()})
          .doc("part of the ground's plan, corners {x, y}; all of it when left out")};
  m.add(
      "drop",
      "Units that hang over the ground in random attitudes, to be dropped. They hang on a grid in the middle "
      "of the region, so far apart that they are clear of each other in every attitude. Rows run across the "
      "rise of the ground, the lowest first.",
      unit + drop_options.fields(), drop, "cdem.Pile");
  m.add(
      "place",
      "One or more layers of armour units on a slope, in the staggered pattern of a packing density. The "
      "units "
      "are laid row by row from the toe: each comes down above the gap between two units of the row below "
      "and "
      "slides against them. Then the units come to rest together under their weight with friction. The "
      "lowest row does not take part, as it is to be held. The next layer is laid on the one below in the "
      "same "
      "way, its units above the gaps; its lowest row is to be held too. The units of a layer follow those of "
      "the layer below, and in a layer those of the lowest row come first.",
      unit + layer_options.fields(), lay, "cdem.Pile");
  m.add("read_pile", "A pile that pile:save{} wrote.", {text("file").required()}, read_pile, "cdem.Pile");
  bind_class(m);
}

} // namespace cdem::script
