#include "libcdem/contact/narrow_phase/parted.hpp"

#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/geometry/positions.hpp"

#include <algorithm>
#include <limits>

namespace cdem {
namespace {

class PlanesOfPair {
public:
  PlanesOfPair(const Model& model, const State& state, const ContactWork& work, const RigidPair& pair)
      : model_(model), state_(state), a_(pair.a), b_(pair.b), of_a_(work.rigid_pairs.planes[pair.a]),
        of_b_(work.rigid_pairs.planes[pair.b]),
        slack_(std::max(slack_of(model, work, pair.a), slack_of(model, work, pair.b))) {}

  int count() const { return static_cast<int>(of_a_.size() + of_b_.size()); }

  // m, by how much a plane parts the two; below 0: the other block reaches so far behind it.
  double gap(int plane) const {
    const auto first = static_cast<int>(of_a_.size());
    const bool of_a = plane < first;
    const geom::Triangle& nodes = model_.surface.triangles[of_a ? of_a_[plane] : of_b_[plane - first]].nodes;
    const Corners x = corners_of(model_, state_, nodes);
    const geom::Vec3 normal = unit_normal(x);
    const Block& other = model_.blocks[of_a ? b_ : a_];
    double least = std::numeric_limits<double>::infinity();
    for (int node = other.node_begin; node < other.node_end; ++node)
      least = std::min(least, (place_of(model_, state_, node) - x[0]).dot(normal));
    return least - slack_;
  }

private:
  const Model& model_;
  const State& state_;
  int a_, b_;
  const std::vector<int>&of_a_, &of_b_; // triangles
  double slack_;                        // m
};

} // namespace

// Those that parted them best are tried first. The others are not, until the two have moved so far that one of them may:
// a guess for the planes of large blocks, which only makes it find less.
double parted_by(const Model& model, const State& state, const ContactWork& work, RigidPair& pair) {
  const PlanesOfPair planes(model, state, work, pair);
  for (const int plane : pair.planes)
    if (plane >= 0)
      if (const double gap = planes.gap(plane); gap > 0)
        return gap;
  if (pair.moved < pair.others_until)
    return 0;
  using Gap = std::pair<double, int>;
  std::array<Gap, 5> largest; // the last one: of those that are not kept
  largest.fill({-std::numeric_limits<double>::infinity(), -1});
  for (int plane = 0; plane < planes.count(); ++plane) {
    Gap gap(planes.gap(plane), plane);
    for (Gap& known : largest)
      if (gap.first > known.first)
        std::swap(gap, known);
  }
  for (std::size_t i = 0; i < pair.planes.size(); ++i)
    pair.planes[i] = largest[i].second;
  pair.others_until = pair.from - largest.back().first;
  return std::max(0.0, largest[0].first);
}

} // namespace cdem
