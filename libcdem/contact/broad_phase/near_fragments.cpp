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
  const std::vector<int>& mover_of; // per solid: read more often than all else of it
  // Of tetrahedra: of all, of those of movers that are searched or have new surface, and of those of movers that are searched.
  const SolidGrid &all, &surfaced, &searched;
  const std::vector<double>& allowed; // m, may_still_go
  double skin = 0, inner = 0;         // m, the thickest of the block
  double tallest = 0,
         deepest = 0; // m, the highest tetrahedron of the block, and how deep a contact of it may be

  const ContactTriangle& triangle(int place) const {
    return model.surface.triangles[active.triangles[place]];
  }
  // m. What a fragment does relative to itself is not watched: until it leaves its skin.
  double skins(int a, int b) const {
    return a == b ? 2 * allowed[a] : work.inner_skin[a] + work.inner_skin[b];
  }
  // m, that the rounding of distances and what bonds give may take, of targets of a mover.
  double slack(int of) const { return 8 * gap(of); }
  // m, how far apart the sides of a bond that holds may stand: what is between them is inside the mover, and outside its
  // tetrahedra.
  double gap(int of) const { return gives_of(model, work, work.movers.block[of], of) * tallest; }
  // m, from which a triangle of b may matter to a semi-spring of a; b: -1: of any mover, and the same the other way round.
  double reach(int a, int b) const {
    const double near = b < 0 ? std::max(skins(a, a), work.inner_skin[a] + inner) : skins(a, b);
    return deepest + std::max(3 * near, allowed[a] + (b < 0 ? skin : allowed[b])) + slack(b < 0 ? a : b);
  }
  // Triangles of one connected piece may meet only if they were apart in the undeformed body.
  bool may_meet(int source, int target) const {
    const int a = active.triangles[source], b = active.triangles[target], mover = work.movers.of_triangle[a];
    return work.movers.of_triangle[b] != mover ||
           (!work.movers.one_piece[mover] && apart_at_first(model, work, a, b));
  }
  bool may_meet_any(int source, const Solid& solid) const {
    return std::any_of(solid.triangles.begin(), solid.triangles.end(),
                       [&](int target) { return target >= 0 && may_meet(source, target); });
  }
};

// m, of the semi-springs from a corner, at most.
double drawn_from(const std::array<Vec3, 4>& x, int corner) {
  double drawn = 0;
  for (const Vec3& other : x)
    drawn = std::max(drawn, 2 * drawn_in * (other - x[corner]).norm());
  return drawn;
}

// Whether a semi-spring of one may meet a triangle of the other before the next search.
bool may_reach(const Surroundings& all, const State& state, const Solid& from, const Solid& to) {
  if (from.mover == to.mover && std::none_of(from.triangles.begin(), from.triangles.end(), [&](int source) {
        return source >= 0 && all.may_meet_any(source, to);
      }))
    return false;
  const double reach = all.reach(from.mover, to.mover);
  const std::array<Vec3, 4> x = corners_of_tet(all.model, state, from.tet);
  for (int k = 0; k < 4; ++k)
    if (to.outside(x[k]) <= reach + drawn_from(x, k))
      return true;
  return false;
}

// Per tetrahedron: what is searched of it, of its triangles the most; of a mover that is searched, with others of that mover. Adds to Renewed::sources what is near new surface.
std::vector<Renewed::Rows> rows_of_solids(const Surroundings& all, const State& state, Renewed& renewed) {
  using Rows = Renewed::Rows;
  const auto of_places = [&](const Solid& solid, const auto& visit) {
    for (const int place : solid.triangles)
      if (place >= 0)
        visit(all.active.triangles[place]);
  };
  std::vector<Rows> rows(all.solids.size(), Rows::none);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Solid& solid = all.solids[i];
    if (renewed.within[solid.mover]) {
      rows[i] = Rows::all;
      continue;
    }
    bool surfaced = false;
    of_places(solid, [&](int t) {
      rows[i] = std::max(rows[i], renewed.sources[t]);
      surfaced = surfaced || all.work.changed[t] == Change::surface;
    });
    if (!surfaced)
      continue;
    const std::array<Vec3, 4> x = corners_of_tet(all.model, state, solid.tet);
    const Vec3 middle = (x[0] + x[1] + x[2] + x[3]) / 4;
    double radius = 0; // m
    for (const Vec3& corner : x)
      radius = std::max(radius, (corner - middle).norm());
    all.all.each_near(middle, radius + all.reach(solid.mover, -1), [&](int other) {
      if (rows[other] == Rows::none && may_reach(all, state, all.solids[other], solid))
        rows[other] = Rows::of_surfaced;
    });
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    of_places(all.solids[i], [&](int t) { renewed.sources[t] = rows[i]; });
  return rows;
}

// What one tetrahedron's semi-springs are near. Those at one of its corners ask for what is near that corner together.
class NearSolid {
public:
  explicit NearSolid(const Surroundings& all)
      : all_(all), work_(all.work), seen_(all.solids.size(), -1), apart_(all.solids.size()),
        met_(all.work.movers.count(), -1) {}

  void add(const State& state, const Renewed& renewed, const Solid& own, Renewed::Rows rows, Pairs& movers) {
    using Rows = Renewed::Rows;
    solid_ = &own;
    mover_ = own.mover;
    const bool searched = renewed.movers[mover_] != 0;
    grid_ = searched || rows == Rows::all ? &all_.all
            : rows == Rows::of_surfaced   ? &all_.surfaced
                                          : &all_.searched;
    meets_own_ = !work_.movers.one_piece[mover_] &&
                 (rows == Rows::all || (rows == Rows::of_surfaced && renewed.surfaced[mover_] != 0));
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
  int fragment(int place) const { return work_.fragment[all_.active.triangles[place]]; }
  double skins(int of) const { return all_.skins(mover_, of); }
  // Whether triangles of the tetrahedron and of another one of its mover may.
  bool may_meet(int solid) {
    Apart& apart = apart_[solid];
    if (apart.asked != own_) {
      apart.asked = own_;
      apart.any = std::any_of(solid_->triangles.begin(), solid_->triangles.end(), [&](int source) {
        return source >= 0 && all_.may_meet_any(source, all_.solids[solid]);
      });
    }
    return apart.any;
  }

  void add_corner(const Solid& own, int k, const std::array<Vec3, 4>& x) {
    const int node = all_.model.tets[own.tet][k];
    bool asked = false;
    for (int i = 0; i < 4; ++i) {
      if (own.triangles[i] < 0)
        continue;
      const geom::Triangle& nodes = all_.triangle(own.triangles[i]).nodes;
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
    const double drawn = drawn_from(x, k);
    around_.clear();
    const double most = 8 * work_.bonds_give[work_.movers.block[mover_]] * all_.tallest + drawn;
    const double reach =
        std::max({all_.allowed[mover_] + all_.skin, 3 * (work_.inner_skin[mover_] + all_.inner),
                  meets_own_ ? 3 * skins(mover_) : 0});
    ++asked_;
    grid_->each_near(x[k], reach + most, [&](int i) {
      if ((all_.mover_of[i] == mover_ && !meets_own_) || seen_[i] == asked_)
        return;
      seen_[i] = asked_;
      if (all_.mover_of[i] == mover_ && !may_meet(i))
        return;
      const Solid& solid = all_.solids[i];
      if (both_tets(solid.mover) && met_[solid.mover] == own_)
        return;
      const double outside = solid.outside(x[k]) - drawn;
      const double near = all_.allowed[mover_] + all_.allowed[solid.mover];
      if (outside >
          (both_tets(solid.mover) ? near : std::max(near, 3 * skins(solid.mover) + all_.slack(solid.mover))))
        return;
      if (!both_tets(solid.mover) &&
          !(solid.mover != mover_ &&
            work_.hangs_at(node,
                           work_.movers.fragment[solid.mover]))) // else the narrow phase goes by the pair
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
      const double near = skins(of), close = near + all_.gap(of);
      double least = std::numeric_limits<double>::infinity();
      for (; end < around_.size() && around_[end].mover == of; ++end) {
        if (around_[end].outside > close)
          continue;
        const int solid = around_[end].solid;
        const double outside = all_.solids[solid].outside(spring);
        if (outside < least && outside <= close &&
            (of != mover_ || all_.may_meet_any(source, all_.solids[solid])))
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
      // So are those up to a tetrahedron that holds the semi-spring, or may do so: it is inside then (near_springs.cpp).
      const double deepest = 2 * depth_of(work_, all_.triangle(source)) + near,
                   furthest = std::min(deepest, distance_needed(source, spring, begin, end, near, deepest)),
                   reach = furthest + 2 * near + all_.slack(of);
      if (furthest <= near) {
        for (std::size_t i = begin; i < end; ++i)
          if (all_.solids[around_[i].solid].outside(spring) <= reach)
            add_triangles(source, corner, around_[i].solid, targets);
        continue;
      }
      ++asked_;
      grid_->each_near(spring, reach, [&](int i) {
        if (all_.mover_of[i] != of || seen_[i] == asked_)
          return;
        seen_[i] = asked_;
        if ((of != mover_ || may_meet(i)) && all_.solids[i].outside(spring) <= reach)
          add_triangles(source, corner, i, targets);
      });
    }
  }

  // m, of the nearest triangle, or of the nearest one of a tetrahedron that stands nearer than `near` and is no deeper than
  // `deepest`: whichever is further.
  double distance_needed(int source, const Vec3& x, std::size_t begin, std::size_t end, double near,
                         double deepest) const {
    double nearest = std::numeric_limits<double>::infinity(), holding = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Solid& solid = all_.solids[around_[i].solid];
      double least2 = std::numeric_limits<double>::infinity();
      for (const int target : solid.triangles)
        if (target >= 0 && all_.may_meet(source, target)) {
          const Corners& y = all_.active.facets[target].x;
          const auto at = geom::nearest_on_triangle(x, y[0], y[1], y[2]);
          least2 = std::min(least2, (weighted(y, at.weights) - x).squaredNorm());
        }
      const double least = std::sqrt(least2);
      nearest = std::min(nearest, least);
      if (least > holding && least <= deepest && solid.outside(x) <= near)
        holding = least;
    }
    return std::max(nearest, holding);
  }

  bool both_tets(int of) const {
    return is_single_tet(all_.model, work_, mover_) && is_single_tet(all_.model, work_, of);
  }

  void add_triangles(int source, int corner, int solid, std::vector<Target>& targets) const {
    for (const int target : all_.solids[solid].triangles)
      if (target >= 0 && all_.may_meet(source, target))
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
  const Solid* solid_ = nullptr;
  int mover_ = 0;
  bool meets_own_ = false; // its own mover is looked at
  struct Around {          // a tetrahedron
    int mover, solid;
    double outside; // m, at least, that all semi-springs at the corner stand outside it
  };
  std::vector<Around> around_;                 // by mover
  std::vector<int> near_;                      // movers
  std::array<std::vector<Target>, 4> targets_; // of each triangle of the tetrahedron
  std::array<std::vector<NearTet>, 4> tets_;   // the same, of movers that are single tets
  std::vector<Near> of_tets_;
  std::vector<int> seen_; // per solid: the last question that met it
  struct Apart {
    int asked = 0; // own_ then
    bool any = false;
  };
  std::vector<Apart> apart_; // per solid
  std::vector<int> met_;     // per mover: the last tetrahedron added that met it
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
                             Renewed& renewed, int threads) {
  const std::vector<Solid> solids = solids_of(model, state, work, active, block);
  std::vector<int> all, of_surfaced, of_searched, mover;
  double skin = 0, inner = 0, tallest = 0, deepest = 0;
  for (int i = 0; i < static_cast<int>(solids.size()); ++i) {
    all.push_back(i);
    mover.push_back(solids[i].mover);
    if (renewed.movers[solids[i].mover] || renewed.surfaced[solids[i].mover])
      of_surfaced.push_back(i);
    if (renewed.movers[solids[i].mover])
      of_searched.push_back(i);
    skin = std::max(skin, margins.allowed()[solids[i].mover]);
    inner = std::max(inner, work.inner_skin[solids[i].mover]);
  }
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i) {
    const ContactTriangle& triangle = model.surface.triangles[active.triangles[i]];
    tallest = std::max(tallest, triangle.height);
    deepest = std::max(deepest, 2 * depth_of(work, triangle));
  }
  const bool all_searched = of_searched.size() == all.size(),
             none_surfaced = of_surfaced.size() == of_searched.size(); // but those that are searched
  const auto grid_of = [&](const std::vector<int>& members) {
    return SolidGrid(model, state, solids, members);
  };
  const SolidGrid grid = grid_of(all), of_some = grid_of(all_searched ? std::vector<int>{} : of_searched),
                  of_more = grid_of(none_surfaced ? std::vector<int>{} : of_surfaced);
  const SolidGrid &searched = all_searched ? grid : of_some, &surfaced = none_surfaced ? searched : of_more;
  const Surroundings around{model,    work,     margins,           active, solids, mover,   grid,
                            surfaced, searched, margins.allowed(), skin,   inner,  tallest, deepest};
  const std::vector<Renewed::Rows> rows = rows_of_solids(around, state, renewed);
  constexpr std::int64_t solids_per_chunk = 64;
  const std::vector<Range> chunks = split(static_cast<std::int64_t>(solids.size()), solids_per_chunk);
  std::vector<Pairs> movers(chunks.size());
  NearFragments found;
  found.springs.resize(chunks.size());
  std::vector<double> loads(chunks.size(), 0.0);
  for (std::size_t i = 0; i < solids.size(); ++i)
    loads[i / solids_per_chunk] +=
        rows[i] != Renewed::Rows::none || renewed.movers[solids[i].mover] ? 1 : load_of_known;
  const std::vector<std::int64_t> own = own_share(work, loads);
  for_chunks(static_cast<std::int64_t>(own.size()), threads, [&](std::int64_t k) {
    const std::int64_t c = own[k];
    NearSolid near(around);
    for (std::int64_t i = chunks[c].begin; i < chunks[c].end; ++i)
      near.add(state, renewed, solids[i], rows[i], movers[c]);
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
