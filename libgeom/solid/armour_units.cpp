#include "libgeom/solid/armour_units.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <array>
#include <cmath>

namespace geom {
namespace {

// One section of a bar: a rectangle with its four corners cut (unless the cut is 0), square to the bar.
struct Section {
  double place = 0; // along the bar
  double half_width = 0, half_depth = 0;
  double corner = 0; // legs of the triangles cut off; 0 in all sections or in none
};

Section shrunk(const Section& s, double place, double ratio) {
  return {place, ratio * s.half_width, ratio * s.half_depth, ratio * s.corner};
}

// A bar through sections of one proportion, so that its side faces are flat. Right-handed axes: width x depth
// = along.
Solid bar(const std::vector<Section>& sections, const Vec3& centre, const Vec3& width, const Vec3& depth) {
  const Vec3 along = width.cross(depth);
  Polyhedron out;
  for (const Section& s : sections) {
    const double w = s.half_width, d = s.half_depth, c = s.corner;
    std::vector<std::array<double, 2>> ring{{w, d - c}, {-w, d - c}, {-w, c - d}, {w, c - d}};
    if (c > 0)
      ring = {{w, c - d},  {w, d - c},  {w - c, d},  {c - w, d},
              {-w, d - c}, {-w, c - d}, {c - w, -d}, {w - c, -d}};
    for (const auto& [x, y] : ring)
      out.vertices.push_back(centre + s.place * along + x * width + y * depth);
  }
  const int all = static_cast<int>(out.vertices.size()), sides = all / static_cast<int>(sections.size());
  out.faces.resize(2); // the ends
  for (int i = 0; i < sides; ++i) {
    out.faces[0].loop.push_back(sides - 1 - i);
    out.faces[1].loop.push_back(all - sides + i);
  }
  for (int ring = 0; ring < all - sides; ring += sides)
    for (int i = 0; i < sides; ++i) {
      const int j = (i + 1) % sides;
      out.faces.push_back({{ring + i, ring + j, ring + sides + j, ring + sides + i}});
    }
  return make_solid(out);
}

void require_fraction(const std::string& field, double value, double low, double high) {
  require_between(field, value, low, high, "");
}

// Units are made 1 m high and then scaled: OpenCASCADE's tolerances are lengths, and what works at one size
// works at every size.
Solid sized(const Solid& unit, double height) {
  require_positive("height", height);
  return scaled(unit, height, Vec3::Zero());
}

} // namespace

Solid accropode(double height, const AccropodeShape& shape) {
  require_fraction("width", shape.width, 0.1, 0.9);
  require_fraction("bar", shape.bar, 0.1, 0.45);
  require_fraction("core", shape.core, 0.1, 0.9);
  require_between("length", shape.length, shape.width + 0.02, 2);
  require_fraction("taper", shape.taper, 0.2, 1);
  if (shape.corner != 0)
    require_between("corner", shape.corner, 0.02, 0.45, "or 0: square bars");

  const double H = 1, x = 0.5 * shape.width * H, b = 0.5 * shape.bar * H, z = 0.5 * shape.core * H;
  const double web = 0.5 * H - 2 * b; // half of the gap between the end bars
  const double end_corner = shape.corner * 2 * std::min(x, b);
  const double nose_corner = shape.corner * 2 * std::min(web, z);

  std::vector<Solid> parts;
  // The core's edges lie on the end bars' edges: where they nearly met there would be slivers.
  parts.push_back(box({2 * x, 2 * (web + end_corner), 2 * z}, {-x, -web - end_corner, -z}));
  for (const double side : {-1., 1.}) {
    const Section at_core{-z, x, b, end_corner};
    parts.push_back(bar({shrunk(at_core, -0.5 * H, shape.taper), at_core, shrunk(at_core, z, 1),
                         shrunk(at_core, 0.5 * H, shape.taper)},
                        {0, side * (0.5 * H - b), 0}, Vec3::UnitX(), Vec3::UnitY()));
  }
  const Section at_core{-x, web, z, nose_corner};
  parts.push_back(bar({shrunk(at_core, -0.5 * shape.length * H, shape.taper), at_core, shrunk(at_core, x, 1),
                       shrunk(at_core, 0.5 * shape.length * H, shape.taper)},
                      Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ()));
  return sized(united(parts), height);
}

Solid dolos(double height, const DolosShape& shape) {
  require_fraction("tip", shape.tip, 0.05, 0.45);
  require_fraction("waist", shape.waist, 0.1, 0.45);
  require_between("root", shape.root, std::max(shape.waist, shape.tip), 0.48, "and as wide as waist and tip");

  const double C = 1;
  const double facet = std::sqrt(2.) - 1; // of a regular octagon, over its width
  const auto octagon = [&](double place, double width, double side) {
    return Section{place, 0.5 * width * C, 0.5 * width * C, 0.5 * (width - side) * C};
  };
  const auto regular = [&](double place, double width) { return octagon(place, width, facet * width); };
  // The shank's edges end on edges of the flukes: regular, they would miss them by little and make slivers.
  const double side = facet * (shape.root - (shape.root - shape.tip) * shape.waist);
  const double middle = 0.5 * C * (1 - shape.root); // of a fluke, along x
  const std::vector<Section> fluke{regular(-0.5 * C, shape.tip), regular(0, shape.root),
                                   regular(0.5 * C, shape.tip)};
  const Solid unit = united({bar({octagon(-middle, shape.waist, side), octagon(middle, shape.waist, side)},
                                 Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ()),
                             bar(fluke, {-middle, 0, 0}, Vec3::UnitX(), Vec3::UnitY()),
                             bar(fluke, {middle, 0, 0}, Vec3::UnitZ(), Vec3::UnitX())});
  return sized(unit, height);
}

Solid tetrapod(double height, const TetrapodShape& shape) {
  require_fraction("tip", shape.tip, 0.05, 0.6);
  require_between("root", shape.root, shape.tip, 0.7, "and as wide as tip");

  // Legs are at arccos(-1/3) to each other; sine and cosine of a lower leg's angle below the horizontal:
  const double sine = 1. / 3, cosine = std::sqrt(8.) / 3;
  const double tip = 0.5 * shape.tip, root = 0.5 * shape.root; // in heights
  // Up the leg on top and down to the lowest point of the others' rims: length (1 + sine) + tip cosine =
  // height.
  const double length = (1 - tip * cosine) / (1 + sine);
  // Two legs meet in the plane halfway between them, where a point at radius r is r / sqrt(2) along both.
  const double meeting = root / std::sqrt(2.);
  const double at_centre = root + (root - tip) * meeting / (length - meeting);
  const Vec3 centre(0, 0, 0.5 - length);

  // OpenCASCADE is not to be trusted with four cones that meet: each leg is cut by the planes halfway to the
  // others first, which leaves four pieces that only touch. These planes meet along the rays opposite to the
  // other legs.
  Polyhedron part;
  part.vertices = {centre};
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * M_PI * i / 3;
    part.vertices.push_back(
        centre + 5 * length * Vec3(-cosine * portable::cos(turn), -cosine * portable::sin(turn), sine));
  }
  part.faces = {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 1, 3}}, {{1, 2, 3}}};
  const Solid leg = common(cone(centre, {0, 0, length}, at_centre, tip), make_solid(part));
  std::vector<Solid> legs{leg};
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * M_PI * i / 3;
    // About the bisector of up and the leg, which leaves the other two in place.
    const Vec3 lower(cosine * portable::cos(turn), cosine * portable::sin(turn), -sine);
    legs.push_back(rotated(leg, lower + Vec3::UnitZ(), M_PI, centre));
  }
  return sized(united(legs), height);
}

Solid cube(double height) {
  require_positive("height", height);
  return box(Vec3::Constant(height), Vec3::Constant(-0.5 * height));
}

Solid cubipod(double height, const CubipodShape& shape) {
  require_fraction("cube", shape.cube, 0.4, 0.95);
  require_between("root", shape.root, 0.1, shape.cube - 0.02, "and narrower than the cube");
  require_between("tip", shape.tip, 0.05, shape.root, "and as narrow as root");
  const auto section = [](double place, double width) { return Section{place, 0.5 * width, 0.5 * width, 0}; };
  const std::vector<Section> bar_through{section(-0.5, shape.tip), section(-0.5 * shape.cube, shape.root),
                                         section(0.5 * shape.cube, shape.root), section(0.5, shape.tip)};
  std::vector<Solid> parts{cube(shape.cube)};
  for (int axis = 0; axis < 3; ++axis)
    parts.push_back(bar(bar_through, Vec3::Zero(), Vec3::Unit((axis + 1) % 3), Vec3::Unit((axis + 2) % 3)));
  return sized(united(parts), height);
}

Solid antifer(double height, const AntiferShape& shape) {
  require_fraction("bottom", shape.bottom, 0.5, 2);
  require_fraction("top", shape.top, 0.5, 2);
  require_fraction("groove", shape.groove, 0, 0.2);

  const double H = 1, low = 0.5 * shape.bottom * H, high = 0.5 * shape.top * H;
  Polyhedron body = make_box({-low, -low, -0.5 * H}, {low, low, 0.5 * H});
  for (Vec3& x : body.vertices)
    if (x.z() > 0)
      x.head<2>() *= high / low;
  const Solid smooth = make_solid(body);
  if (shape.groove == 0)
    return sized(smooth, height);
  std::vector<Solid> grooves;
  for (int side = 0; side < 4; ++side) {
    const Vec3 outward(portable::cos(0.5 * M_PI * side), portable::sin(0.5 * M_PI * side), 0);
    const Vec3 from = low * outward - 0.5 * H * Vec3::UnitZ(), to = high * outward + 0.5 * H * Vec3::UnitZ();
    const Vec3 over = 0.5 * (to - from); // beyond both ends, so that they come out level with the faces
    grooves.push_back(cylinder(from - over, to - from + 2 * over, shape.groove * H));
  }
  return sized(cut(smooth, grooves), height);
}

Solid slope(double gradient, double length, double width) {
  require_between("gradient", gradient, 0.01, 10);
  require_positive("length", length);
  require_positive("width", width);
  const double y = 0.5 * width, top = gradient * length;
  Polyhedron wedge;
  wedge.vertices = {{0, -y, 0}, {length, -y, 0}, {length, -y, top},
                    {0, y, 0},  {length, y, 0},  {length, y, top}};
  wedge.faces = {{{0, 1, 2}}, {{3, 5, 4}}, {{0, 3, 4, 1}}, {{1, 4, 5, 2}}, {{0, 2, 5, 3}}};
  return make_solid(wedge);
}

double height_of_volume(double volume, const std::function<Solid(double)>& build) {
  require_positive("volume", volume, "m3");
  return std::cbrt(volume / mass_properties(build(1)).volume);
}

} // namespace geom
