#include "libgeom/placement/ground.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

namespace geom {
namespace {

constexpr double looks_up = 1e-6; // z of a unit normal: steeper faces are walls

std::string corners(const PlanBox& box) {
  return "{" + text(box.min.x()) + ", " + text(box.min.y()) + "} to {" + text(box.max.x()) + ", " +
         text(box.max.y()) + "}";
}

} // namespace

Ground::Ground(Surface surface) : surface_(std::move(surface)) {
  for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
    const std::array<Vec3, 3> t = surface_.corners(i);
    const Vec3 area = (t[1] - t[0]).cross(t[2] - t[0]);
    if (area.z() > looks_up * area.norm())
      upper_.push_back(t);
  }
  if (upper_.empty())
    throw InputError("onto: the ground has no face that looks up (z+)");
}

PlanBox Ground::plan() const {
  PlanBox box{upper_.front()[0].head<2>(), upper_.front()[0].head<2>()};
  for (const auto& triangle : upper_)
    for (const Vec3& x : triangle) {
      box.min = box.min.cwiseMin(x.head<2>());
      box.max = box.max.cwiseMax(x.head<2>());
    }
  return box;
}

std::optional<double> Ground::height(double x, double y) const {
  std::optional<double> highest;
  const Eigen::Vector2d p(x, y);
  for (const auto& t : upper_) {
    const auto side = [&](int i) {
      const Eigen::Vector2d a = t[i].head<2>(), b = t[(i + 1) % 3].head<2>();
      return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
    };
    const Eigen::Vector3d weight(side(1), side(2), side(0)); // of corners 0, 1, 2, times twice the area
    const double area = weight.sum();
    if ((weight.array() < -1e-12 * area).any())
      continue;
    const double z = (weight.x() * t[0].z() + weight.y() * t[1].z() + weight.z() * t[2].z()) / area;
    highest = highest ? std::max(*highest, z) : z;
  }
  return highest;
}

Vec3 Ground::normal(const PlanBox& part) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& t : upper_) {
    Eigen::Vector2d low = t[0].head<2>(), high = low;
    for (const Vec3& x : t) {
      low = low.cwiseMin(x.head<2>());
      high = high.cwiseMax(x.head<2>());
    }
    if ((low.array() <= part.max.array()).all() && (high.array() >= part.min.array()).all())
      sum += (t[1] - t[0]).cross(t[2] - t[0]);
  }
  return sum.squaredNorm() > 0 ? Vec3(sum.normalized()) : Vec3::UnitZ();
}

PlanBox region_of(const Ground& ground, const std::optional<PlanBox>& given) {
  PlanBox plan = ground.plan();
  if (!given)
    return plan;
  if (!given->min.allFinite() || !given->max.allFinite() || !(given->size().array() > 0).all())
    throw InputError("region", corners(*given), "two corners of finite numbers, min below max in x and y");
  if ((given->min.array() > plan.max.array()).any() || (given->max.array() < plan.min.array()).any())
    throw InputError("region", corners(*given), "over the ground, whose plan is from " + corners(plan),
                     "units dropped there would miss it");
  return *given;
}

} // namespace geom
