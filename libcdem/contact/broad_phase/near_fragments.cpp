#include "libcdem/contact/broad_phase/near_fragments.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/broad_phase/solid_grid.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using geom::Vec3;

// What all sources share.
struct Surroundings {
  const Model& model;
  const ContactWork& work;
  const SearchMargin& margins;
  const ActiveSurface& active;
  const std::vector<Solid>& solids;
  const SolidGrid &all, &searched; // of tetrahedra
  const std::vector<char>& is_searched;
  double skin = 0, inner = 0, tallest = 0; // m, the thickest skins and the highest tetrahedron of the block
};

// What one tetrahedron's semi-springs are near. Those at one of its corners ask for what is near that corner together.
class NearSolid {
public:
  explicit NearSolid(const Surroundings& all) : all_(all), work_(all.work) {}

  void add(const State& state, const Solid& own, Pairs& movers) {
    mover_ = own.mover;
    grid_ = all_.is_searched[mover_] ? &all_.all : &all_.searched;
    near_.clear();
    for (std::vector<int>& targets : targets_)
      targets.clear();
    const std::array<Vec3, 4> x = corners_of_tet(all_.model, state, own.tet);
    for (int k = 0; k < 4; ++k)
      add_corner(own, k, x);
    for (int i = 0; i < 4; ++i)
      keep(own.triangles[i], targets_[i]);
    for (const int other : near_)
      movers.emplace_back(std::min(mover_, other), std::max(mover_, other));
  }

  // Of all tetrahedra that were added.
  std::vector<Near> springs() {
    sources_.push_back({std::numeric_limits<int>::max(), pairs_.size()});
    Pairs sorted;
    sorted.reserve(pairs_.size());
    std::vector<std::size_t> order(sources_.size() - 1);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return sources_[a].place < sources_[b].place; });
    for (const std::size_t i : order)
      sorted.insert(sorted.end(), pairs_.begin() + static_cast<std::ptrdiff_t>(sources_[i].begin),
                    pairs_.begin() + static_cast<std::ptrdiff_t>(sources_[i + 1].begin));
    return near_springs(all_.model, work_, all_.margins, all_.active, sorted, work_.inner_skin);
  }

private:
  const ContactTriangle& triangle(int place) const {
    return all_.model.surface.triangles[all_.active.triangles[place]];
  }
  int mover(int place) const { return work_.movers.of_triangle[all_.active.triangles[place]]; }
  int fragment(int place) const { return work_.fragment[all_.active.triangles[place]]; }
  // m. What a fragment does relative to itself is not watched: until it leaves its skin.
  double skins(int of) const {
    return of == mover_ ? 2 * work_.skin[of] : work_.inner_skin[mover_] + work_.inner_skin[of];
  }
  // m, that the rounding of distances and what bonds give may take, of targets of a mover.
  double slack(int of) const {
    return 8 * (bonded(all_.model, work_, work_.movers.block[of], of) ? bond_gives : same_place_at_least) *
           all_.tallest;
  }

  void add_corner(const Solid& own, int k, const std::array<Vec3, 4>& x) {
    const int node = all_.model.tets[own.tet][k];
    bool asked = false;
    for (int i = 0; i < 4; ++i) {
      if (own.triangles[i] < 0)
        continue;
      const geom::Triangle& nodes = triangle(own.triangles[i]).nodes;
      const auto corner = static_cast<int>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
      if (corner == 3)
        continue;
      if (!asked)
        find_around(x, k);
      asked = true;
      if (!around_.empty())
        add_spring(own.triangles[i], weighted(all_.active.facets[own.triangles[i]].x, spring_weights(corner)),
                   targets_[i]);
    }
  }

  // Fills around_ for all semi-springs at the corner, and near_.
  void find_around(const std::array<Vec3, 4>& x, int k) {
    double drawn = 0; // m, of the semi-springs from the corner, at most
    for (const Vec3& other : x)
      drawn = std::max(drawn, 2 * drawn_in * (other - x[k]).norm());
    around_.clear();
    const double most = 8 * bond_gives * all_.tallest + drawn;
    const double reach =
        std::max({work_.skin[mover_] + all_.skin, 3 * (work_.inner_skin[mover_] + all_.inner),
                  work_.movers.one_piece[mover_] ? 0 : 3 * skins(mover_)});
    grid_->each_near(x[k], reach + most, [&](int i) {
      const Solid& solid = all_.solids[i];
      if (solid.mover == mover_ && work_.movers.one_piece[mover_])
        return;
      const double outside = solid.outside(x[k]) - drawn;
      if (outside >
          std::max(work_.skin[mover_] + work_.skin[solid.mover], 3 * skins(solid.mover) + slack(solid.mover)))
        return;
      if (std::find(around_.begin(), around_.end(), i) != around_.end())
        return;
      around_.push_back(i);
      if (solid.mover != mover_ && std::find(near_.begin(), near_.end(), solid.mover) == near_.end())
        near_.push_back(solid.mover);
    });
    std::sort(around_.begin(), around_.end(), [&](int a, int b) {
      return std::pair(all_.solids[a].mover, a) < std::pair(all_.solids[b].mover, b);
    });
  }

  void add_spring(int source, const Vec3& spring, std::vector<int>& targets) {
    for (std::size_t begin = 0, end = 0; begin < around_.size(); begin = end) {
      const int of = all_.solids[around_[begin]].mover;
      double least = std::numeric_limits<double>::infinity();
      for (; end < around_.size() && all_.solids[around_[end]].mover == of; ++end)
        if (of != mover_ || may_meet_any(source, around_[end]))
          least = std::min(least, all_.solids[around_[end]].outside(spring));
      if (least > skins(of))
        continue;
      const double nearest = least > 0 ? 0 : least_distance(spring, begin, end);
      if (of != mover_ && nearest <= skins(of)) {
        for (std::size_t i = begin; i < end; ++i)
          if (all_.solids[around_[i]].outside(spring) <= 3 * skins(of) + slack(of))
            add_triangles(source, around_[i], targets);
        continue;
      }
      // Inside a fragment by more than the skins: all that are not much further than the nearest.
      const double deepest = 2 * depth_of(work_, triangle(source)) + skins(of);
      const double reach = (of == mover_ ? deepest : std::min(nearest, deepest)) + 2 * skins(of) + slack(of);
      grid_->each_near(spring, reach, [&](int i) {
        if (all_.solids[i].mover == of && all_.solids[i].outside(spring) <= reach)
          add_triangles(source, i, targets);
      });
    }
  }

  double least_distance(const Vec3& x, std::size_t begin, std::size_t end) const {
    double least2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i)
      for (const int target : all_.solids[around_[i]].triangles)
        if (target >= 0) {
          const Corners& y = all_.active.facets[target].x;
          const auto at = geom::nearest_on_triangle(x, y[0], y[1], y[2]);
          least2 = std::min(least2, (weighted(y, at.weights) - x).squaredNorm());
        }
    return std::sqrt(least2);
  }

  // Of what hangs together, triangles that were far from each other at first.
  bool may_meet(int source, int target) const {
    return mover(target) != mover_ ||
           (!work_.movers.one_piece[mover_] &&
            apart_at_first(all_.model, work_, all_.active.triangles[source], all_.active.triangles[target]));
  }
  bool may_meet_any(int source, int solid) const {
    const auto& targets = all_.solids[solid].triangles;
    return std::any_of(targets.begin(), targets.end(),
                       [&](int target) { return target >= 0 && may_meet(source, target); });
  }

  void add_triangles(int source, int solid, std::vector<int>& targets) const {
    for (const int target : all_.solids[solid].triangles)
      if (target >= 0 && may_meet(source, target))
        targets.push_back(target);
  }

  void keep(int source, std::vector<int>& targets) {
    std::sort(targets.begin(), targets.end(),
              [&](int a, int b) { return std::pair(fragment(a), a) < std::pair(fragment(b), b); });
    targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
    if (targets.empty())
      return;
    sources_.push_back({source, pairs_.size()});
    for (const int target : targets)
      pairs_.emplace_back(source, target);
  }

  const Surroundings& all_;
  const ContactWork& work_;
  const SolidGrid* grid_ = nullptr;
  int mover_ = 0;
  std::vector<int> around_;                 // solids, by mover
  std::vector<int> near_;                   // movers
  std::array<std::vector<int>, 4> targets_; // of each triangle of the tetrahedron
  Pairs pairs_;
  struct Source {
    int place;
    std::size_t begin; // into pairs_, up to that of the next
  };
  std::vector<Source> sources_;
};

} // namespace

NearFragments near_fragments(const Model& model, const State& state, const ContactWork& work,
                             const SearchMargin& margins, const ActiveSurface& active, int block,
                             const std::vector<char>& searched, int threads) {
  const std::vector<Solid> solids = solids_of(model, state, work, active, block);
  std::vector<int> all, of_searched;
  double inner = 0, tallest = 0;
  for (int i = 0; i < static_cast<int>(solids.size()); ++i) {
    all.push_back(i);
    if (searched[solids[i].mover])
      of_searched.push_back(i);
    inner = std::max(inner, work.inner_skin[solids[i].mover]);
  }
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i)
    tallest = std::max(tallest, model.surface.triangles[active.triangles[i]].height);
  const SolidGrid grid(model, state, solids, all), grid_of_searched(model, state, solids, of_searched);
  const Surroundings around{
      model, work,   margins, active, solids, grid, grid_of_searched, searched, work.skin[block],
      inner, tallest};
  constexpr std::int64_t solids_per_chunk = 64;
  const std::vector<Range> chunks = split(static_cast<std::int64_t>(solids.size()), solids_per_chunk);
  std::vector<Pairs> movers(chunks.size());
  NearFragments found;
  found.springs.resize(chunks.size());
  for_chunks(static_cast<std::int64_t>(chunks.size()), threads, [&](std::int64_t c) {
    NearSolid near(around);
    for (std::int64_t i = chunks[c].begin; i < chunks[c].end; ++i)
      near.add(state, solids[i], movers[c]);
    found.springs[c] = near.springs();
  });
  std::vector<std::vector<int>> others(work.movers.count()); // of which the number is higher
  for (const Pairs& part : movers)
    for (const auto& [a, b] : part)
      others[a].push_back(b);
  for (int m = 0; m < work.movers.count(); ++m) {
    std::sort(others[m].begin(), others[m].end());
    others[m].erase(std::unique(others[m].begin(), others[m].end()), others[m].end());
    for (const int other : others[m])
      found.movers.emplace_back(m, other);
  }
  return found;
}

} // namespace cdem
