// Armour units by mass or height, and the slope they lie on.
#include "lua/binding/functions/physical_fields.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/objects/solid_objects.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/solid/armour_units.hpp"

namespace cdem::script {

namespace {

using geom::InputError;

Value made_unit(const Arguments& a, const std::string& kind,
                const std::function<geom::Solid(double)>& build) {
  const auto mass = a.optional_number("mass"), density = a.optional_number("density");
  auto height = a.optional_number("height");
  if (height && mass)
    throw InputError("height and mass: both given; give the height, or mass and density");
  if (!height && !(mass && density))
    throw InputError(std::string(mass      ? "density"
                                 : density ? "mass"
                                           : "height") +
                     ": missing; give the height, or mass and density");
  if (!height)
    height = geom::height_of_volume(*mass / *density, build);
  auto object = std::make_shared<SolidObject>(build(*height));
  object->kind = kind;
  object->height = height;
  object->density = density;
  object->mesh_size = a.optional_number("mesh_size");
  return object;
}

// A proportion that has a default.
Field share(std::string name, std::string doc) {
  return number(std::move(name)).above(0).doc(std::move(doc));
}

std::vector<Field> unit_fields(std::vector<Field> more) {
  std::vector<Field> fields{
      number("height", "m").above(0).doubted(20, largest_quantity, "The largest units are 5 m high"),
      // Units of a laboratory weigh less, units of a breakwater more.
      number("mass", "kg")
          .above(0)
          .doc("with density, instead of height: the volume is met exactly")
          .doubted(1, 100, "A unit of 3 t has 3000; height = says that a small one is meant"),
      density_field("density"),
      number("mesh_size", "m").above(0).doc("what solid:mesh{} takes when it is given no size")};
  fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

const Record<geom::AccropodeShape> accropode_shape{
    {{choice("shape", {"slender", "stocky"}).standard("slender")},
     {share("width", "of the end bars and the core along x: 0.42 or 0.386"), &geom::AccropodeShape::width},
     {share("bar", "of an end bar along y: 0.33 or 0.30"), &geom::AccropodeShape::bar},
     {share("core", "of the core and the middle bar along z: 0.42"), &geom::AccropodeShape::core},
     {share("length", "of the middle bar along x: 1 or 0.80"), &geom::AccropodeShape::length},
     {share("taper", "size of a bar's end over that at the core: 0.70 or 0.95"),
      &geom::AccropodeShape::taper},
     {number("corner").at_least(0).doc("cut off a bar's edges, over the shorter side of its section: "
                                       "0.20; 0: square bars, which make larger tetrahedra"),
      &geom::AccropodeShape::corner}}};

const Record<geom::DolosShape> dolos_shape{
    {{share("tip", "width of a fluke at its ends, over the height").standard(), &geom::DolosShape::tip},
     {share("waist", "width of the shank, over the height").standard(), &geom::DolosShape::waist},
     {share("root", "width of a fluke at its middle, over the height").standard(), &geom::DolosShape::root}}};

const Record<geom::TetrapodShape> tetrapod_shape{
    {{share("tip", "diameter of a leg at its end, over the height").standard(), &geom::TetrapodShape::tip},
     {share("root", "diameter of a leg where it meets the others").standard(), &geom::TetrapodShape::root}}};

const Record<geom::AntiferShape> antifer_shape{
    {{share("bottom", "width of the lower face, over the height").standard(), &geom::AntiferShape::bottom},
     {share("top", "width of the upper face").standard(), &geom::AntiferShape::top},
     {number("groove").at_least(0).standard().doc("radius of the grooves; 0: none"),
      &geom::AntiferShape::groove}}};

const Record<geom::CubipodShape> cubipod_shape{
    {{share("cube", "side of the cube").standard(), &geom::CubipodShape::cube},
     {share("root", "width of a pyramid on the cube").standard(), &geom::CubipodShape::root},
     {share("tip", "width of its end").standard(), &geom::CubipodShape::tip}}};

Value accropode(Session&, Object*, const Arguments& a) {
  geom::AccropodeShape shape =
      a.text("shape") == "stocky" ? geom::AccropodeShape::stocky() : geom::AccropodeShape::slender();
  accropode_shape.read(a, shape);
  return made_unit(a, "accropode", [&](double height) { return geom::accropode(height, shape); });
}

Value dolos(Session&, Object*, const Arguments& a) {
  const geom::DolosShape shape = dolos_shape.read(a);
  return made_unit(a, "dolos", [&](double height) { return geom::dolos(height, shape); });
}

Value tetrapod(Session&, Object*, const Arguments& a) {
  const geom::TetrapodShape shape = tetrapod_shape.read(a);
  return made_unit(a, "tetrapod", [&](double height) { return geom::tetrapod(height, shape); });
}

Value cube(Session&, Object*, const Arguments& a) {
  return made_unit(a, "cube", [](double height) { return geom::cube(height); });
}

Value antifer(Session&, Object*, const Arguments& a) {
  const geom::AntiferShape shape = antifer_shape.read(a);
  return made_unit(a, "antifer cube", [&](double height) { return geom::antifer(height, shape); });
}

Value cubipod(Session&, Object*, const Arguments& a) {
  const geom::CubipodShape shape = cubipod_shape.read(a);
  return made_unit(a, "cubipod", [&](double height) { return geom::cubipod(height, shape); });
}

Value slope(Session&, Object*, const Arguments& a) {
  auto object =
      std::make_shared<SolidObject>(geom::slope(a.number("gradient"), a.number("length"), a.number("width")));
  object->kind = "slope";
  object->height = a.number("gradient") * a.number("length");
  object->mesh_size = a.optional_number("mesh_size");
  return object;
}

} // namespace

void bind_armour_units(Module& m) {
  m.add("accropode",
        "An accropode-like unit, V = 0.34 H^3: two end bars along z, a middle bar along x, a core. Centred "
        "on the origin. Proportions are fractions of the height; those left out are the shape's.",
        unit_fields(accropode_shape.fields()), accropode, "cdem.Solid");
  m.add("dolos",
        "A dolos without fillets, V = 0.163 C^3: octagonal flukes along z and y at the ends of a shank along "
        "x.",
        unit_fields(dolos_shape.fields()), dolos, "cdem.Solid");
  m.add("tetrapod", "A tetrapod, V = 0.28 H^3: four conical legs, one of them up.",
        unit_fields(tetrapod_shape.fields()), tetrapod, "cdem.Solid");
  m.add("cube", "A plain cube.", unit_fields({}), cube, "cdem.Solid");
  m.add("antifer", "An antifer cube, V = 1.0247 H^3: its sides lean in and have a round groove each.",
        unit_fields(antifer_shape.fields()), antifer, "cdem.Solid");
  m.add("cubipod",
        "A cube with a truncated pyramid on each side, as the Cubipod has; V = 0.544 H^3, H from tip to tip. "
        "Proportions are fractions of the height, and ours.",
        unit_fields(cubipod_shape.fields()), cubipod, "cdem.Solid");
  m.add("slope", "A wedge that rises along +x from x = 0, z = 0; y from -width/2 to width/2.",
        {number("gradient").above(0).required().doc("rise over run: 1/1.5"),
         number("length", "m").above(0).required().doc("along x"),
         number("width", "m").above(0).required().doc("along y"), number("mesh_size", "m").above(0)},
        slope, "cdem.Solid");
}

} // namespace cdem::script
