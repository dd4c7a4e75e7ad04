#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/broad_phase/contact_fragments.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <tuple>

namespace cdem {
namespace {

// No place of the triangle is nearer to x than this, m2.
double least_distance2(const geom::Vec3& x, const Corners& triangle) {
  const geom::Vec3 low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]),
                   high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
  return (low - x).cwiseMax(x - high).cwiseMax(0.0).squaredNorm();
}

// Springs of one source triangle that may meet one fragment.
class SpringsOfSource {
public:
  SpringsOfSource(const Model& model, const ContactWork& work, const SearchMargin& margins,
                  const ActiveSurface& active, const Skins& skins)
      : s_(model.surface), model_(model), work_(work), margins_(margins), active_(active), skins_(skins) {}

  // pairs [begin, end)
  void add(const Pairs& pairs, std::size_t begin, std::size_t end, std::vector<Near>& out) {
    const int source = pairs[begin].first;
    const ContactTriangle &from = triangle(source), &first = triangle(pairs[begin].second);
    const double skins = skins_.between(from.block, first.block);
    gives_ = gives_of(model_, work_, first.block, fragment(pairs[begin].second));
    double margin_of_targets = 0, one_place_of_targets = 0; // the largest
    for (std::size_t i = begin; i < end; ++i) {
      const ContactTriangle& to = triangle(pairs[i].second);
      margin_of_targets = std::max(margin_of_targets, margins_(to));
      one_place_of_targets = std::max(one_place_of_targets, one_place(to));
    }
    const double deepest = std::min(2 * depth_of(work_.sizes, from), margins_(from) + margin_of_targets);
    find_nearest(pairs, begin, end, skins,
                 (1 + 8 * same_place) * (deepest + 3 * skins) + 8 * one_place_of_targets);
    const bool cracked = held_by_bonds(work_.fragments, fragment(pairs[begin].second));
    std::array<double, 3> need{};
    for (int corner = 0; corner < 3; ++corner) {
      const Nearest& found = nearest_[corner];
      need[corner] = -1;
      if (found.target < 0)
        continue;
      const ContactTriangle& to = triangle(found.target);
      const double d = std::sqrt(found.distance2);
      const double deep = std::min(2 * depth_limit(work_.sizes, from, to), margins_(from) + margins_(to));
      if (d <= (found.inside() || cracked ? deep + skins : skins))
        need[corner] = d + 2 * skins;
    }
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t springs = 0;
      for (int corner = 0; corner < 3; ++corner)
        if (need[corner] >= 0 && distance_[i - begin][corner] <= (1 + 2 * same_place) * need[corner] +
                                                                     one_place(triangle(pairs[i].second)))
          springs |= 1u << corner;
      if (springs == 0)
        continue;
      Near near;
      near.source = active_.triangles[source];
      near.target = static_cast<std::uint32_t>(active_.triangles[pairs[i].second]) & last_contact_triangle;
      near.springs = springs & 7u;
      out.push_back(near);
    }
  }

private:
  const ContactTriangle& triangle(int place) const { return s_.triangles[active_.triangles[place]]; }
  int fragment(int place) const { return work_.fragments.number_of_triangle[active_.triangles[place]]; }
  // m, within which places count as one with the nearest.
  double one_place(const ContactTriangle& to) const { return gives_ * to.height; }

  // What is further off than `reach` is left out: nothing comes of it, nor is it one place with what something comes of.
  void find_nearest(const Pairs& pairs, std::size_t begin, std::size_t end, double skins, double reach) {
    const Corners& x = active_.facets[pairs[begin].first].x;
    std::array<geom::Vec3, 3> spring;
    std::array<bool, 3> gets_in{};
    for (int corner = 0; corner < 3; ++corner) {
      spring[corner] = weighted(x, spring_weights(corner));
      gets_in[corner] =
          may_get_into(model_, work_, active_, spring[corner], triangle(pairs[begin].first).block,
                       triangle(pairs[begin].second).block, skins_) &&
          active_.in_outline(fragment(pairs[begin].second), spring[corner], skins);
    }
    nearest_ = {};
    distance_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const int target = pairs[i].second;
      const Facet& to = active_.facets[target];
      auto& each = distance_.emplace_back();
      for (int corner = 0; corner < 3; ++corner) {
        each[corner] = std::numeric_limits<double>::infinity();
        if (!gets_in[corner] || least_distance2(spring[corner], to.x) > reach * reach)
          continue;
        const Nearest found = nearest_of(target, spring[corner], to.x, to.normal);
        each[corner] = std::sqrt(found.distance2);
        take_nearer(nearest_[corner], found, to.x, to.normal, triangle(target).height, gives_);
      }
    }
  }

  const ContactSurface& s_;
  const Model& model_;
  const ContactWork& work_;
  const SearchMargin& margins_;
  const ActiveSurface& active_;
  const Skins& skins_;
  double gives_ = 0;                            // of the fragment
  std::array<Nearest, 3> nearest_;              // of each spring
  std::vector<std::array<double, 3>> distance_; // m, of each target from each spring
};

// By source, fragment of the target and target: sources are counted, and only the few targets of each are compared.
template <class Piece>
void sort_by_source(Pairs& pairs, const Piece& fragment) {
  const auto before = [&](const std::pair<int, int>& a, const std::pair<int, int>& b) {
    return std::tuple(a.first, fragment(a), a.second) < std::tuple(b.first, fragment(b), b.second);
  };
  if (pairs.empty() || std::is_sorted(pairs.begin(), pairs.end(), before))
    return;
  int least = pairs.front().first, most = least;
  for (const auto& pair : pairs) {
    least = std::min(least, pair.first);
    most = std::max(most, pair.first);
  }
  const std::size_t n_sources = static_cast<std::size_t>(most - least) + 1;
  if (n_sources > pairs.size()) {
    std::sort(pairs.begin(), pairs.end(), before);
    return;
  }
  std::vector<std::uint32_t> next(n_sources + 1, 0);
  for (const auto& pair : pairs)
    ++next[pair.first - least + 1];
  for (std::size_t i = 1; i <= n_sources; ++i)
    next[i] += next[i - 1];
  Pairs sorted(pairs.size());
  for (const auto& pair : pairs)
    sorted[next[pair.first - least]++] = pair;
  for (std::size_t i = 0, begin = 0; i < n_sources; begin = next[i++])
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin), sorted.begin() + next[i], before);
  pairs = std::move(sorted);
}

} // namespace

std::vector<Near> near_springs(const Model& model, const ContactWork& work, const SearchMargin& margins,
                               const ActiveSurface& active, Pairs& pairs, const Skins& skins) {
  const auto fragment = [&](const std::pair<int, int>& p) {
    return work.fragments.of_triangle[active.triangles[p.second]];
  };
  sort_by_source(pairs, fragment);
  std::vector<Near> out;
  if (pairs.empty())
    return out;
  SpringsOfSource springs(model, work, margins, active, skins);
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].first == pairs[begin].first &&
           fragment(pairs[end]) == fragment(pairs[begin]))
      ++end;
    springs.add(pairs, begin, end, out);
  }
  return out;
}

} // namespace cdem
