// Solids of flat faces, boxes, cylinders, cones and balls, by OpenCASCADE through gmsh.
#include "libgeom/solid/gmsh_session.hpp"

#include "libgeom/core/check.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace geom {

namespace occ = gmsh::model::occ;

namespace {

// Inside a session: the volume within a surface, its number in gmsh's model.
int add_volume(const FacetedSurface& surface) {
  std::vector<int> points, faces;
  for (const Vec3& x : surface.vertices)
    points.push_back(occ::addPoint(x.x(), x.y(), x.z()));
  std::map<std::array<int, 2>, int> lines; // by ends, ascending: neighbouring faces share them
  for (const auto& loops : surface.faces) {
    std::vector<int> wires;
    for (const auto& loop : loops) {
      std::vector<int> curves;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int a = loop[i], b = loop[(i + 1) % loop.size()];
        const auto [line, added] = lines.try_emplace({std::min(a, b), std::max(a, b)}, 0);
        if (added)
          line->second = occ::addLine(points[line->first[0]], points[line->first[1]]);
        curves.push_back(line->second);
      }
      wires.push_back(occ::addCurveLoop(curves));
    }
    faces.push_back(occ::addPlaneSurface(wires));
  }
  return occ::addVolume({occ::addSurfaceLoop(faces)});
}

FacetedSurface surface_of(const Polyhedron& polyhedron) {
  FacetedSurface surface;
  surface.vertices = polyhedron.vertices;
  for (const PolyhedronFace& face : polyhedron.faces)
    surface.faces.push_back({face.loop});
  return surface;
}

} // namespace

namespace {

// By the divergence theorem over the triangles of each loop, m3.
double enclosed_volume(const FacetedSurface& surface) {
  const Vec3 origin = surface.vertices.front();
  double volume = 0;
  for (const auto& loops : surface.faces)
    for (const auto& loop : loops)
      for (std::size_t i = 2; i < loop.size(); ++i)
        volume +=
            (surface.vertices[loop[0]] - origin)
                .dot((surface.vertices[loop[i - 1]] - origin).cross(surface.vertices[loop[i]] - origin)) /
            6;
  return volume;
}

constexpr double same_volume = 1e-5; // of it: OpenCASCADE's rounding and no more

} // namespace

Solid make_solid(const FacetedSurface& surface) {
  for (const Vec3& x : surface.vertices)
    require_place("vertices", x);
  return in_session("solid of flat faces", [&] {
    const int volume = add_volume(surface);
    const double expected = enclosed_volume(surface);
    double made = 0;
    occ::synchronize();
    occ::getMass(3, volume, made);
    if (!(std::abs(made - expected) <= same_volume * std::abs(expected)))
      throw InputError("solid of flat faces: its faces enclose " + text(expected) +
                       " m3, but the geometry kernel makes a solid of " + text(made) +
                       " m3 of them; some of its faces touch or cover each other, or are far thinner than "
                       "the rest: mend them in the program that made the surface");
    return store("solid of flat faces");
  });
}

Solid make_solid(const Polyhedron& polyhedron) {
  return make_solid(surface_of(polyhedron));
}

Solid box(const Vec3& size, const Vec3& origin) {
  require_positive("size", size);
  require_length("size", size.minCoeff());
  require_place("origin", origin);
  require_place("size", size);
  return make_solid(make_box(origin, origin + size));
}

Solid cylinder(const Vec3& base, const Vec3& axis, double radius) {
  require_place("base", base);
  require_finite("axis", axis);
  require_length("axis (length)", axis.norm());
  require_length("radius", radius);
  return in_session("cylinder", [&] {
    occ::addCylinder(base.x(), base.y(), base.z(), axis.x(), axis.y(), axis.z(), radius);
    return store("cylinder");
  });
}

Solid cone(const Vec3& base, const Vec3& axis, double radius, double top) {
  if (radius == top && radius > 0) // OpenCASCADE has no such cone
    return cylinder(base, axis, radius);
  require_place("base", base);
  require_finite("axis", axis);
  require_length("axis (length)", axis.norm());
  if (radius != 0)
    require_length("radius", radius);
  if (top != 0)
    require_length("top_radius", top);
  return in_session("cone", [&] {
    occ::addCone(base.x(), base.y(), base.z(), axis.x(), axis.y(), axis.z(), radius, top);
    return store("cone");
  });
}

Solid sphere(const Vec3& centre, double radius) {
  require_place("centre", centre);
  require_length("radius", radius);
  return in_session("sphere", [&] {
    occ::addSphere(centre.x(), centre.y(), centre.z(), radius);
    return store("sphere");
  });
}

} // namespace geom
