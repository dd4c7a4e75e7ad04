// The part of the contact surfaces that a search uses: the outer triangles and those on broken faces, by block, in
// boxes that contain everything that may touch them before the next search.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

struct Renewed; // broad_phase/renewed.hpp

// Writes MoverMotion::skin: thin for what hardly moves, so that little is near; thick for what flies by itself. Movers are
// known; those that are searched. Returns how far each mover moves in a step, m.
std::vector<double> choose_skins(const Model&, const State&, ContactWork&, const Renewed&);

// m, how far two movers may move before they are searched again: each by its own skin, or both together by that of a rigid
// pair, of which each has half.
class Skins {
public:
  explicit Skins(const std::vector<double>& of_movers) : of_movers_(&of_movers) {}
  Skins(const std::vector<double>& of_movers, double of_pair) : of_movers_(&of_movers), of_pair_(of_pair) {}

  bool of_pair() const { return of_pair_ >= 0; }
  double of(int mover) const { return of_pair() ? 0.5 * of_pair_ : (*of_movers_)[mover]; }
  double between(int a, int b) const { return of(a) + of(b); }
  // What boxes that hold the skin of a mover are to be grown by.
  double beyond_own(int mover) const { return of_pair() ? of(mover) - (*of_movers_)[mover] : 0; }

private:
  const std::vector<double>* of_movers_; // m, per mover
  double of_pair_ = -1;                  // m; -1: each by its own
};

// m: a quarter of the tet's height, of those much higher than usual in their block a quarter of the usual.
double depth_of(const SurfaceSizes&, const ContactTriangle&);

// m, around triangles that belong together: those that were further from each other than both at first may meet.
double far_at_first(const SurfaceSizes&, const ContactTriangle&);

// Largest depth of a contact between two blocks for which the search allows, m.
class SearchMargin {
public:
  SearchMargin(const Model&, const State&, const ContactWork&, const Renewed&);

  // m, per mover: no node of it goes further from where it is now before it is searched next.
  const std::vector<double>& allowed() const { return allowed_; }

  double operator()(const ContactTriangle& t) const {
    return std::max(whole_[t.block] ? depth_of(work_.sizes, t) : 0, at_least_[t.block]);
  }
  // m, no contact of the two blocks is deeper, of those known.
  double known(int block_a, int block_b) const { return std::min(deepest_[block_a], deepest_[block_b]); }
  // What a triangle's box has to hold around it for it to meet another before the next search.
  double margin(int triangle) const {
    return allowed_[work_.movers.of_triangle[triangle]] + (*this)(surface_.triangles[triangle]);
  }

private:
  const ContactSurface& surface_;
  const ContactWork& work_;
  std::vector<char> whole_;     // per block: anything may stand in it, as where a stage begins or faces break
  std::vector<double> deepest_; // m, per block, of the contacts that are known
  std::vector<double> at_least_; // m, per block
  std::vector<double> allowed_;
};

// A triangle where it is now.
struct Facet {
  Corners x;         // m
  geom::Vec3 normal; // unit
};

struct ActiveSurface {
  std::vector<int> triangles;   // by block
  std::vector<int> place;       // per triangle of the model: its number here; -1: it is not active
  std::vector<int> block_begin; // (n_blocks + 1) into triangles
  std::vector<Facet> facets;    // per triangle
  std::vector<geom::Box> boxes; // per triangle, with its margin
  // Per triangle: what is near it in other blocks is searched, as a source and as a target.
  std::vector<char> source_searched, target_searched;
  std::vector<geom::Box> block_boxes; // per block, with margins
  std::vector<geom::Box> outlines;    // per block, without

  bool finite() const;
};
ActiveSurface active_surface(const Model&, const State&, const Movers&, const SearchMargin&, const Renewed&,
                             int threads);

} // namespace cdem
