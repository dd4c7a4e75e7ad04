#include "libcdem/contact/broad_phase/box_lists.hpp"
#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/geometry/edge_touch.hpp"
#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <optional>

namespace cdem {
namespace {

// An edge where it is now, and how far it and its faces may turn before the next search.
struct Bar {
  geom::Vec3 x0, x1, along; // m; unit
  std::array<geom::Vec3, 2> into;
  std::array<double, 2> into_turns{}; // rad
  double turns = 0, skin = 0;         // rad, m

  double most_into_turns() const { return std::max(into_turns[0], into_turns[1]); }
};

// Either edge of a rigid pair may turn by all that the two move.
Bar bar_of(const Model& model, const State& state, const Skins& skins, const ContactEdge& e) {
  Bar bar;
  bar.x0 = place_of(model, state, e.nodes[0]);
  bar.x1 = place_of(model, state, e.nodes[1]);
  const double length = (bar.x1 - bar.x0).norm();
  bar.along = (bar.x1 - bar.x0) / length;
  bar.into = into_faces(model, state, e, bar.x0, bar.x1);
  bar.skin = skins.of(model.surface.triangles[e.triangles[0]].block);
  const double moves = skins.of_pair() ? 2 * bar.skin : bar.skin;
  bar.turns = 4 * moves / length; // twice what its ends can make of it
  for (int i = 0; i < 2; ++i) {
    const Corners x = corners_of(model, state, model.surface.triangles[e.triangles[i]].nodes);
    const double arm = ((x[0] + x[1] + x[2]) / 3 - bar.x0).norm();
    bar.into_turns[i] = 2 * (2 * moves + arm * bar.turns) / bar.into[i].norm();
  }
  return bar;
}

bool may_hold(const Bar& bar, const geom::Vec3& normal, double turns) {
  for (int i = 0; i < 2; ++i)
    if (normal.dot(bar.into[i]) > (fan_slack_of_old + turns + bar.into_turns[i]) * bar.into[i].norm())
      return false;
  return true;
}

bool may_touch(const Bar& a, const Bar& b, double depth) {
  const geom::Vec3 across = a.along.cross(b.along);
  const double sine = across.norm(), turns = a.turns + b.turns;
  const auto at = geom::nearest_on_segments(a.x0, a.x1, b.x0, b.x1);
  const double distance = (a.x0 + at.s * (a.x1 - a.x0) - b.x0 - at.t * (b.x1 - b.x0)).norm();
  if (distance > depth + a.skin + b.skin)
    return false;
  if (sine - turns < parallel_edges &&
      normal_between(a.into, b.into, a.along,
                     clear_of_faces - 2 * turns - std::max(a.most_into_turns(), b.most_into_turns())))
    return true;
  if (sine + turns < parallel_edges)
    return false;
  if (sine < 4 * turns)
    return true; // their common normal may be anything
  const geom::Vec3 normal = across / sine;
  const double normal_turns = 2 * turns / (sine - turns);
  return (may_hold(b, normal, normal_turns) && may_hold(a, -normal, normal_turns)) ||
         (may_hold(b, -normal, normal_turns) && may_hold(a, normal, normal_turns));
}

// Edges as they are now. What of them their boxes do not tell is worked out when it is first asked for.
class Bars {
public:
  Bars(const Model& model, const State& state, const ContactWork& work, const Skins& skins)
      : model_(model), state_(state), work_(work), skins_(skins) {}

  // Those of one triangle of which the boxes meet the region, by number.
  void add(int triangle, const geom::Box& region) {
    for (int e = work_.edges.begin[triangle]; e < work_.edges.begin[triangle + 1]; ++e) {
      geom::Box box;
      for (const int node : work_.edges.all[e].nodes)
        box.extend(place_of(model_, state_, node));
      if (apart(box, region))
        continue;
      edges_.push_back(e);
      boxes_.push_back(box);
      bars_.emplace_back();
    }
  }
  const std::vector<int>& edges() const { return edges_; }
  const std::vector<geom::Box>& boxes() const { return boxes_; }
  int triangle(std::size_t k) const { return work_.edges.all[edges_[k]].triangles[0]; }
  const Bar& operator[](std::size_t k) {
    if (!bars_[k])
      bars_[k] = bar_of(model_, state_, skins_, work_.edges.all[edges_[k]]);
    return *bars_[k];
  }
  double skin(std::size_t k) const { return skins_.of(model_.surface.triangles[triangle(k)].block); }

private:
  const Model& model_;
  const State& state_;
  const ContactWork& work_;
  Skins skins_;
  std::vector<int> edges_;
  std::vector<geom::Box> boxes_;
  std::vector<std::optional<Bar>> bars_;
};

// Adds the pair if it can touch.
void add_near(const Model& model, const ContactWork& work, const SearchMargin& margins, Bars& one,
              std::size_t k, Bars& other, std::size_t l, std::vector<Near>& out) {
  const ContactTriangle &a = model.surface.triangles[one.triangle(k)],
                        &b = model.surface.triangles[other.triangle(l)];
  const double depth = std::max(edge_depth(work.sizes, a, b), margins.known(a.block, b.block));
  if (apart(grown(one.boxes()[k], depth + one.skin(k) + other.skin(l)), other.boxes()[l]) ||
      !may_touch(one[k], other[l], depth))
    return;
  const auto [first, second] = std::minmax(one.edges()[k], other.edges()[l]);
  Near near;
  near.source = first;
  near.target = static_cast<std::uint32_t>(second) & last_contact_triangle;
  near.springs = 0;
  out.push_back(near);
}

} // namespace

double edge_depth(const SurfaceSizes& sizes, const ContactTriangle& source, const ContactTriangle& target) {
  return std::min(
      {edge_depth(sizes, source.block), edge_depth(sizes, target.block), depth_limit(sizes, source, target)});
}

std::vector<Near> near_edges(const Model& model, const State& state, const ContactWork& work,
                             const SearchMargin& margins, const ActiveSurface& active, const SharedPart& part,
                             const Skins& skins) {
  // No two edges that touch are further apart than this; their triangles meet then.
  const double depth =
      std::max(std::min(edge_depth(work.sizes, part.block_a), edge_depth(work.sizes, part.block_b)),
               margins.known(part.block_a, part.block_b));
  const double reach = depth + skins.between(part.block_a, part.block_b);
  Bars one(model, state, work, skins), other(model, state, work, skins);
  for (const int i : part.of_a)
    one.add(active.triangles[i], grown(active.outlines[part.block_b], reach));
  if (one.edges().empty())
    return {};
  for (const int i : part.of_b)
    other.add(active.triangles[i], grown(active.outlines[part.block_a], reach));
  std::vector<Near> out;
  each_meeting(one.boxes(), reach, other.boxes(),
               [&](std::size_t k, std::size_t l) { add_near(model, work, margins, one, k, other, l, out); });
  return out;
}

std::vector<Near> near_edges_within(const Model& model, const State& state, const ContactWork& work,
                                    const SearchMargin& margins, const ActiveSurface& active,
                                    const Pairs& meeting) {
  geom::Box everywhere;
  std::swap(everywhere.min, everywhere.max);
  const auto bars_of = [&](int place) {
    Bars bars(model, state, work, Skins(work.travel.skin));
    bars.add(active.triangles[place], everywhere);
    return bars;
  };
  std::vector<Near> out;
  for (const auto& [i, j] : meeting) {
    Bars one = bars_of(i), other = bars_of(j);
    for (std::size_t k = 0; k < one.edges().size(); ++k)
      for (std::size_t l = 0; l < other.edges().size(); ++l)
        add_near(model, work, margins, one, k, other, l, out);
  }
  return out;
}

} // namespace cdem
