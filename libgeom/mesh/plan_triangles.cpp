#include "libgeom/mesh/plan_triangles.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace geom {
namespace {

using PlanKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PlanVertex = CGAL::Triangulation_vertex_base_with_info_2<int, PlanKernel>; // the number of its point
using PlanDelaunay =
    CGAL::Delaunay_triangulation_2<PlanKernel, CGAL::Triangulation_data_structure_2<PlanVertex>>;

} // namespace

Surface plan_triangles(const std::vector<Vec3>& points, const std::string& field) {
  const auto name = [&](std::size_t i) { return field + "[" + std::to_string(i + 1) + "]"; };
  if (points.size() < 3)
    throw InputError(field, counted(points.size(), "point"), "at least three points {x, y, z} (m)");
  PlanDelaunay plan;
  PlanDelaunay::Face_handle near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& x = points[i];
    if (!x.allFinite())
      throw InputError(name(i), place_text(x), "three finite numbers (m)");
    const std::size_t before = plan.number_of_vertices();
    const auto vertex = plan.insert({x.x(), x.y()}, near);
    if (plan.number_of_vertices() == before)
      throw InputError(name(i), place_text(x), "a place in plan of its own",
                       "point " + std::to_string(vertex->info() + 1) + " is there already");
    vertex->info() = static_cast<int>(i);
    near = vertex->face();
  }
  if (plan.dimension() < 2)
    throw InputError(field, std::to_string(points.size()) + " points on one line in plan",
                     "points that span a surface", "a profile is the same across");
  Surface surface{points, {}};
  for (auto face = plan.finite_faces_begin(); face != plan.finite_faces_end(); ++face)
    surface.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return surface;
}

} // namespace geom
