#include "libcdem/contact/narrow_phase/push_directions.hpp"

#include <numeric>

namespace cdem {
namespace {

constexpr double same_side = 0.5; // cosine

} // namespace

PushDirections::PushDirections(const TetContacts& contacts, const TetQuestion& question,
                               const std::vector<geom::Vec3>& force)
    : contacts_(contacts), question_(question), force_(force), begin_(contacts.tets.size() + 2, 0) {
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < force.size(); ++i)
      if (const double length = force[i].norm(); length > 0) {
        const std::size_t near = question.asked[i].near;
        visit(contacts.near.a[near], force[i], length);
        visit(contacts.near.b[near], -force[i], length);
      }
  };
  // Shifted by one: after the filling each place holds where the next one begins.
  each([&](int tet, const geom::Vec3&, double) { ++begin_[tet + 2]; });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  on_tet_.resize(begin_.back());
  each([&](int tet, const geom::Vec3& f, double length) {
    on_tet_[begin_[tet + 1]++] = {f.x(), f.y(), f.z(), length};
  });
}

geom::Vec3 PushDirections::of(std::size_t asked) const {
  const geom::Vec3& force = force_[asked];
  const double length = force.norm();
  if (!(length > 0))
    return geom::Vec3::Zero();
  const std::size_t near = question_.asked[asked].near;
  const geom::Vec3 sum =
      by_tet(contacts_.near.a[near], force, length) - by_tet(contacts_.near.b[near], -force, length);
  return sum.stableNormalized();
}

geom::Vec3 PushDirections::by_tet(int tet, const geom::Vec3& force, double length) const {
  geom::Vec3 sum = geom::Vec3::Zero();
  for (int i = begin_[tet]; i < begin_[tet + 1]; ++i) {
    const Node& more = on_tet_[i];
    const geom::Vec3 f(more.x, more.y, more.z);
    if (f.dot(force) > same_side * more.w * length)
      sum += f;
  }
  return sum.stableNormalized();
}

} // namespace cdem
