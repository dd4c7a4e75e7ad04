#include "libcdem/contact/broad_phase/near_fragments.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/broad_phase/search_shares.hpp"
#include "libcdem/contact/broad_phase/solid_grid.hpp"
#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using geom::Vec3;

// Work of a tetrahedron that only asks which of those searched are near, over that of one that is searched itself.
constexpr double load_of_known = 0.2;

// What all sources share.
struct Surroundings {
  const Model& model;
  const ContactWork& work;
  const SearchMargin& margins;
  const ActiveSurface& active;
  const std::vector<Solid>& solids;
  const SolidGrid &all, &searched; // of tetrahedra
  const std::vector<char>& is_searched;
  const std::vector<double>& allowed;      // m, may_still_go
  double skin = 0, inner = 0, tallest = 0; // m, the thickest skins and the highest tetrahedron of the block
};

// What one tetrahedron's semi-springs are near. Those at one of its corners ask for what is near that corner together.
class NearSolid {
public:
  explicit NearSolid(const Surroundings& all)
      : all_(all), work_(all.work), seen_(all.solids.size(), -1), met_(all.work.movers.count(), -1) {}

  void add(const State& state, const Solid& own, Pairs& movers) {
    mover_ = own.mover;
    grid_ = all_.is_searched[mover_] ? &all_.all : &all_.searched;
    near_.clear();
    ++own_;
    for (int i = 0; i < 4; ++i) {
      targets_[i].clear();
      tets_[i].clear();
    }
    const std::array<Vec3, 4> x = corners_of_tet(all_.model, state, own.tet);
    for (int k = 0; k < 4; ++k)
      add_corner(own, k, x);
    for (int i = 0; i < 4; ++i) {
      keep(own.triangles[i], targets_[i]);
      keep_tets(own.triangles[i], tets_[i]);
    }
    for (const int other : near_)
      movers.emplace_back(std::min(mover_, other), std::max(mover_, other));
  }

  // Near springs of all tetrahedra that were added.
  std::vector<Near> springs(const State& state) {
    sources_.push_back({std::numeric_limits<int>::max(), pairs_.size()});
    Pairs sorted;
    std::vector<std::uint8_t> of_springs;
    sorted.reserve(pairs_.size());
    of_springs.reserve(pairs_.size());
    std::vector<std::size_t> order(sources_.size() - 1);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return sources_[a].place < sources_[b].place; });
    for (const std::size_t i : order)
      for (std::size_t k = sources_[i].begin; k < sources_[i + 1].begin; ++k) {
        sorted.push_back(pairs_[k]);
        of_springs.push_back(of_springs_[k]);
      }
    std::vector<Near> found = near_springs(all_.model, state, work_, all_.margins, all_.active, sorted,
                                           of_springs, Skins(work_.inner_skin));
    found.insert(found.end(), of_tets_.begin(), of_tets_.end());
    return found;
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
  // m, how far apart the sides of a bond that holds may stand: what is between them is inside the mover, and outside its
  // tetrahedra.
  double gap(int of) const { return gives_of(all_.model, work_, work_.movers.block[of], of) * all_.tallest; }
  // m, that the rounding of distances and what bonds give may take, of targets of a mover.
  double slack(int of) const { return 8 * gap(of); }

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
        find_around(node, x, k);
      asked = true;
      if (!around_.empty())
        add_spring(own.triangles[i], corner, targets_[i], tets_[i]);
    }
  }

  // Fills around_ for all semi-springs at the corner, and near_. What hangs together with the tetrahedron there is left out.
  void find_around(int node, const std::array<Vec3, 4>& x, int k) {
    const Pairs::const_iterator hanging = work_.first_at_joint(node), end = work_.movers_at_joint.end();
    const auto hangs = [&](int mover) {
      for (auto at = hanging; at != end && at->first == hanging->first; ++at)
        if (at->second == mover)
          return true;
      return false;
    };
    double drawn = 0; // m, of the semi-springs from the corner, at most
    for (const Vec3& other : x)
      drawn = std::max(drawn, 2 * drawn_in * (other - x[k]).norm());
    around_.clear();
    const double most = 8 * work_.bonds_give[work_.movers.block[mover_]] * all_.tallest + drawn;
    const double reach =
        std::max({all_.allowed[mover_] + all_.skin, 3 * (work_.inner_skin[mover_] + all_.inner),
                  work_.movers.one_piece[mover_] ? 0 : 3 * skins(mover_)});
    ++asked_;
    grid_->each_near(x[k], reach + most, [&](int i) {
      if (seen_[i] == asked_)
        return;
      seen_[i] = asked_;
      const Solid& solid = all_.solids[i];
      if (solid.mover == mover_ && work_.movers.one_piece[mover_])
        return;
      if (both_tets(solid.mover) && met_[solid.mover] == own_)
        return;
      const double outside = solid.outside(x[k]) - drawn;
      const double near = all_.allowed[mover_] + all_.allowed[solid.mover];
      if (outside >
          (both_tets(solid.mover) ? near : std::max(near, 3 * skins(solid.mover) + slack(solid.mover))))
        return;
      if (!both_tets(solid.mover) &&
          !(solid.mover != mover_ && hangs(solid.mover))) // else the narrow phase goes by the pair
        around_.push_back({solid.mover, i, outside});
      if (solid.mover != mover_ && met_[solid.mover] != own_) {
        met_[solid.mover] = own_;
        near_.push_back(solid.mover);
      }
    });
    std::sort(around_.begin(), around_.end(), [](const Around& a, const Around& b) {
      return std::pair(a.mover, a.solid) < std::pair(b.mover, b.solid);
    });
  }

  // A triangle, by its place, and which semi-springs of a triangle look at it.
  struct Target {
    int place;
    std::uint8_t springs;
  };

  // A mover that is a single tet, and which of a triangle's semi-springs may come near it.
  struct NearTet {
    int mover;
    std::uint32_t springs;
  };

  void add_spring(int source, int corner, std::vector<Target>& targets, std::vector<NearTet>& tets) {
    const Vec3 spring = weighted(all_.active.facets[source].x, spring_weights(corner));
    for (std::size_t begin = 0, end = 0; begin < around_.size(); begin = end) {
      const int of = around_[begin].mover;
      const double near = skins(of), close = near + gap(of);
      double least = std::numeric_limits<double>::infinity();
      for (; end < around_.size() && around_[end].mover == of; ++end) {
        if (around_[end].outside > close)
          continue;
        const int solid = around_[end].solid;
        const double outside = all_.solids[solid].outside(spring);
        if (outside < least && outside <= close && (of != mover_ || may_meet_any(source, solid)))
          least = outside;
      }
      if (least > close)
        continue;
      if (of != mover_ && is_single_tet(all_.model, work_, of)) {
        const auto known =
            std::find_if(tets.begin(), tets.end(), [&](const NearTet& t) { return t.mover == of; });
        if (known == tets.end())
          tets.push_back({of, 1u << corner});
        else
          known->springs |= 1u << corner;
        continue;
      }
      // Whether a semi-spring is inside is told by the nearest triangle of the fragment's closed surface. The planes of
      // tetrahedra give no distance: behind an edge of the fragment tetrahedra that only touch the edge count as nearer
      // than the one of the triangle behind which the semi-spring is. So triangles are chosen by the distance of one of
      // them: the nearest is no further away.
      const double nearest = least_distance(spring, begin, end);
      if (of != mover_ && nearest <= near) {
        for (std::size_t i = begin; i < end; ++i)
          if (all_.solids[around_[i].solid].outside(spring) <= nearest + 2 * near + slack(of))
            add_triangles(source, corner, around_[i].solid, targets);
        continue;
      }
      // Further from the surface than the skins.
      const double deepest = 2 * depth_of(work_, triangle(source)) + near;
      const double reach = (of == mover_ ? deepest : std::min(nearest, deepest)) + 2 * near + slack(of);
      grid_->each_near(spring, reach, [&](int i) {
        if (all_.solids[i].mover == of && all_.solids[i].outside(spring) <= reach)
          add_triangles(source, corner, i, targets);
      });
    }
  }

  double least_distance(const Vec3& x, std::size_t begin, std::size_t end) const {
    double least2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i)
      for (const int target : all_.solids[around_[i].solid].triangles)
        if (target >= 0) {
          const Corners& y = all_.active.facets[target].x;
          const auto at = geom::nearest_on_triangle(x, y[0], y[1], y[2]);
          least2 = std::min(least2, (weighted(y, at.weights) - x).squaredNorm());
        }
    return std::sqrt(least2);
  }

  // Triangles of one connected piece may meet only if they were apart in the undeformed body.
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

  bool both_tets(int of) const {
    return is_single_tet(all_.model, work_, mover_) && is_single_tet(all_.model, work_, of);
  }

  void add_triangles(int source, int corner, int solid, std::vector<Target>& targets) const {
    for (const int target : all_.solids[solid].triangles)
      if (target >= 0 && may_meet(source, target))
        targets.push_back({target, static_cast<std::uint8_t>(1u << corner)});
  }

  void keep(int source, std::vector<Target>& targets) {
    std::sort(targets.begin(), targets.end(), [&](const Target& a, const Target& b) {
      return std::pair(fragment(a.place), a.place) < std::pair(fragment(b.place), b.place);
    });
    if (targets.empty())
      return;
    const std::size_t begin = pairs_.size();
    sources_.push_back({source, begin});
    for (const Target& target : targets) {
      if (pairs_.size() == begin || pairs_.back().second != target.place) {
        pairs_.emplace_back(source, target.place);
        of_springs_.push_back(0);
      }
      of_springs_.back() |= target.springs;
    }
  }

  // All triangles of such tets: the narrow phase tells by their planes whether they are any.
  void keep_tets(int source, const std::vector<NearTet>& tets) {
    for (const NearTet& tet : tets)
      for (const int target : work_.movers.triangles_of_tet[tet.mover]) {
        Near near;
        near.source = all_.active.triangles[source];
        near.target = static_cast<std::uint32_t>(target) & last_contact_triangle;
        near.springs = tet.springs & 7u;
        of_tets_.push_back(near);
      }
  }

  const Surroundings& all_;
  const ContactWork& work_;
  const SolidGrid* grid_ = nullptr;
  int mover_ = 0;
  struct Around { // a tetrahedron
    int mover, solid;
    double outside; // m, at least, that all semi-springs at the corner stand outside it
  };
  std::vector<Around> around_;                 // by mover
  std::vector<int> near_;                      // movers
  std::array<std::vector<Target>, 4> targets_; // of each triangle of the tetrahedron
  std::array<std::vector<NearTet>, 4> tets_;   // the same, of movers that are single tets
  std::vector<Near> of_tets_;
  std::vector<int> seen_; // per solid: the last question that met it
  std::vector<int> met_;  // per mover: the last tetrahedron added that met it
  int asked_ = 0, own_ = 0;
  Pairs pairs_;
  std::vector<std::uint8_t>
      of_springs_; // per pair: which semi-springs of the source look at the target, a bit each
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
  double skin = 0, inner = 0, tallest = 0;
  for (int i = 0; i < static_cast<int>(solids.size()); ++i) {
    all.push_back(i);
    if (searched[solids[i].mover])
      of_searched.push_back(i);
    skin = std::max(skin, margins.allowed()[solids[i].mover]);
    inner = std::max(inner, work.inner_skin[solids[i].mover]);
  }
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i)
    tallest = std::max(tallest, model.surface.triangles[active.triangles[i]].height);
  const SolidGrid grid(model, state, solids, all), grid_of_searched(model, state, solids, of_searched);
  const Surroundings around{
      model, work,  margins, active, solids, grid, grid_of_searched, searched, margins.allowed(),
      skin,  inner, tallest};
  constexpr std::int64_t solids_per_chunk = 64;
  const std::vector<Range> chunks = split(static_cast<std::int64_t>(solids.size()), solids_per_chunk);
  std::vector<Pairs> movers(chunks.size());
  NearFragments found;
  found.springs.resize(chunks.size());
  std::vector<double> loads(chunks.size(), 0.0);
  for (std::size_t i = 0; i < solids.size(); ++i)
    loads[i / solids_per_chunk] += searched[solids[i].mover] ? 1 : load_of_known;
  const std::vector<std::int64_t> own = own_share(work, loads);
  for_chunks(static_cast<std::int64_t>(own.size()), threads, [&](std::int64_t k) {
    const std::int64_t c = own[k];
    NearSolid near(around);
    for (std::int64_t i = chunks[c].begin; i < chunks[c].end; ++i)
      near.add(state, solids[i], movers[c]);
    found.springs[c] = near.springs(state);
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
