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

namespace {

// The smallest and the largest size in a ball.
std::pair<double, double> sizes_in(const MeshSize& sizes, const Vec3& centre, double radius) {
  double low = sizes.size, high = sizes.size;
  for (const Refinement& r : sizes.refinements) {
    const double distance = distance_to(r, centre) - r.radius;
    low = std::min(low, r.size + sizes.growth * std::max(0., distance - radius));
    high = std::min(high, r.size + sizes.growth * std::max(0., distance + radius));
  }
  return {low, high};
}

} // namespace

// The integral of 1 / h^3. A cell where h varies much is split into eight, so that no refinement falls between places
// that are looked at, however small it is.
double expected_tets(const MeshSize& sizes, const Box& box, double solid_volume) {
  constexpr double alike = 1.3;           // largest over smallest size in a cell that is left whole
  constexpr std::size_t most_cells = 1e5; // the rest of the cells is taken as it is
  std::vector<Box> cells{box};
  const Vec3 whole = box.size();
  double sum = 0; // of share / h^3, 1/m3
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Box cell = cells[i];
    const auto [low, high] = sizes_in(sizes, cell.centre(), 0.5 * cell.size().norm());
    if (high <= alike * low || cells.size() > most_cells) {
      const double h = std::sqrt(low * high);
      const Vec3 share = cell.size().cwiseQuotient(whole);
      sum += share.x() * share.y() * share.z() / (h * h * h);
      continue;
    }
    for (int corner = 0; corner < 8; ++corner) {
      Box part;
      for (int axis = 0; axis < 3; ++axis) {
        const double middle = cell.centre()[axis];
        const bool upper = (corner >> axis & 1) != 0;
        part.min[axis] = upper ? middle : cell.min[axis];
        part.max[axis] = upper ? cell.max[axis] : middle;
      }
      cells.push_back(part);
    }
  }
  return solid_volume * sum / 0.17; // the volume of a tet, h^3, in meshes made here; regular ones take 0.118
}

} // namespace geom
