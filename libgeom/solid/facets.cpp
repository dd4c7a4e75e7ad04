// A circle of radius r in n chords is left by r (1 - cos(pi / n)). Triangles on a curved face may be longer than the size asked
// for, by up to a half: the chords are made for a third of the tolerance.
#include "libgeom/solid/facets.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/solid/gmsh_session.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr double most_chords = 2000; // of a circle

// Chords of a circle as large as the solid: smaller ones are cut as often.
double chords(double radius, double tolerance) {
  const double part = std::min(tolerance / 3 / radius, 1.0);
  return std::clamp(std::ceil(M_PI / std::acos(1 - part)), 6.0, most_chords);
}

// Inside a session: the faces that bound the model's volumes from outside, with their triangles.
Surface triangles_of(const Pieces& faces) {
  constexpr int linear_triangle = 2; // gmsh's number of the element
  MetNodes nodes;
  Surface surface;
  for (const auto& [dim, tag] : faces) {
    std::vector<std::size_t> elements, corners;
    gmsh::model::mesh::getElementsByType(linear_triangle, elements, corners, tag);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      Triangle t{};
      for (std::size_t c = 0; c < 3; ++c)
        t[c] = nodes.number(corners[i + c], "faces of a solid");
      surface.triangles.push_back(t);
    }
  }
  surface.points = std::move(nodes.points);
  return surface;
}

// Inside a session.
bool any_curved(const Pieces& faces) {
  return std::any_of(faces.begin(), faces.end(), [](const std::pair<int, int>& face) {
    std::string type;
    gmsh::model::getType(face.first, face.second, type);
    return type != "Plane";
  });
}

} // namespace

bool has_curved_faces(const Solid& solid) {
  return in_session("faces of a solid", [&] {
           load(solid);
           gmsh::model::occ::synchronize();
           Pieces faces;
           gmsh::model::getEntities(faces, 2);
           return any_curved(faces) ? 1 : 0;
         }) == 1;
}

void pack(std::string& out, const Surface& x) {
  pack(out, x.points);
  pack(out, x.triangles);
}
void unpack(Unpacker& in, Surface& x) {
  unpack(in, x.points);
  unpack(in, x.triangles);
  for (const Triangle& t : x.triangles)
    for (const int corner : t)
      if (corner < 0 || corner >= static_cast<int>(x.points.size()))
        Unpacker::refuse();
}

Surface facets(const Solid& solid, double tolerance) {
  const double radius = 0.5 * bounding_box(solid).size().maxCoeff();
  return in_session("facets of a solid", [&] {
    for (const auto& [name, value] :
         {std::pair<const char*, double>{"Mesh.Algorithm", 6},
          {"Mesh.MaxNumThreads1D", 1},
          {"Mesh.MaxNumThreads2D", 1},
          {"Mesh.MeshSizeExtendFromBoundary", 0},
          {"Mesh.MeshSizeFromPoints", 0},
          {"Mesh.MeshSizeFromCurvature", tolerance > 0 ? chords(radius, tolerance) : 0}})
      gmsh::option::setNumber(name, value);
    load(solid);
    gmsh::model::occ::synchronize();
    Pieces volumes, faces;
    gmsh::model::getEntities(volumes, 3);
    gmsh::model::getBoundary(volumes, faces, true, false, false);
    if (!(tolerance > 0) && any_curved(faces))
      throw InputError("tolerance: missing; the solid has curved faces");
    Pieces curves; // straight ones are one edge
    gmsh::model::getEntities(curves, 1);
    for (const auto& [dim, tag] : curves) {
      std::string type;
      gmsh::model::getType(dim, tag, type);
      if (type == "Line")
        gmsh::model::mesh::setTransfiniteCurve(tag, 2);
    }
    gmsh::model::mesh::generate(2);
    return triangles_of(faces);
  });
}

} // namespace geom
