#include "libgeom/mesh/mesh_size.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace geom {

void validate(const MeshSize& sizes) {
  require_positive("size", sizes.size);
  require_between("growth", sizes.growth, 0.05, 2);
  for (const Refinement& r : sizes.refinements) {
    require_positive("refine.size", r.size);
    require_between("refine.radius", r.radius, 0, 1e5, "m");
    for (const Vec3& x : r.line)
      require_finite("refine.line", x);
    if (r.line.empty() && !(r.box.min.array() < r.box.max.array()).all())
      throw InputError("refine.box.min", text(r.box.min), "below box.max in every axis");
  }
}

double distance_to(const Refinement& refinement, const Vec3& x) {
  const std::vector<Vec3>& line = refinement.line;
  if (line.empty())
    return (x - x.cwiseMax(refinement.box.min).cwiseMin(refinement.box.max)).norm();
  double least = (x - line.front()).norm();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3 along = line[i] - line[i - 1];
    const double length2 = along.squaredNorm();
    const double s = length2 > 0 ? std::clamp((x - line[i - 1]).dot(along) / length2, 0., 1.) : 0;
    least = std::min(least, (x - line[i - 1] - s * along).norm());
  }
  return least;
}

double size_at(const MeshSize& sizes, const Vec3& x) {
  double size = sizes.size;
  for (const Refinement& r : sizes.refinements)
    size = std::min(size, r.size + sizes.growth * std::max(0., distance_to(r, x) - r.radius));
  return size;
}

double expected_tets(const MeshSize& sizes, const Box& box, double solid_volume) {
  constexpr int n = 16;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3 share = (Vec3(i, j, k) + Vec3::Constant(0.5)) / n;
        const double h = size_at(sizes, box.min + share.cwiseProduct(box.size()));
        sum += 1 / (h * h * h);
      }
  return solid_volume * sum / (n * n * n) /
         0.17; // the volume of a tet, h^3, in meshes made here; regular ones take 0.118
}

} // namespace geom
