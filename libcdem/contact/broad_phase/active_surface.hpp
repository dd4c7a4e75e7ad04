// The part of the contact surfaces that a search uses: the outer triangles and those on broken faces, by block, in
// boxes that contain everything that may touch them before the next search.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes BlockTravel::skin where all are searched: thin for what hardly moves, so that little is near; thick for what flies by
// itself. Returns how far each block moves in a step, m.
std::vector<double> choose_skins(const Model&, const State&, ContactWork&, bool all);

// m, how far two blocks may move before they are searched again: each by its own skin, or both together by that of a rigid
// pair, of which each has half.
class Skins {
public:
  explicit Skins(const std::vector<double>& of_blocks) : of_blocks_(&of_blocks) {}
  Skins(const std::vector<double>& of_blocks, double of_pair) : of_blocks_(&of_blocks), of_pair_(of_pair) {}

  bool of_pair() const { return of_pair_ >= 0; }
  double of(int block) const { return of_pair() ? 0.5 * of_pair_ : (*of_blocks_)[block]; }
  double between(int a, int b) const { return of(a) + of(b); }
  // What boxes that hold the skin of a block are to be grown by.
  double beyond_own(int block) const { return of_pair() ? of(block) - (*of_blocks_)[block] : 0; }

private:
  const std::vector<double>* of_blocks_; // m, per block
  double of_pair_ = -1;                  // m; -1: each by its own
};

// m: a quarter of the tet's height, of those much higher than usual in their block a quarter of the usual.
double depth_of(const SurfaceSizes&, const ContactTriangle&);

// m, around triangles that belong together: those that were further from each other than both at first may meet.
double far_at_first(const SurfaceSizes&, const ContactTriangle&);

// Largest depth of a contact between two blocks for which the search allows, m.
class SearchMargin {
public:
  SearchMargin(const Model&, const State&, const ContactWork&);

  double operator()(const ContactTriangle& t) const {
    return std::max(whole_[t.block] ? depth_of(work_.sizes, t) : 0, at_least_[t.block]);
  }
  // m, no contact of the two blocks is deeper, of those known.
  double known(int block_a, int block_b) const { return std::min(deepest_[block_a], deepest_[block_b]); }
  // What a triangle's box has to hold around it for it to meet another before the next search.
  double margin(int triangle) const {
    const ContactTriangle& t = surface_.triangles[triangle];
    return work_.travel.skin[t.block] + (*this)(t);
  }

private:
  const ContactSurface& surface_;
  const ContactWork& work_;
  std::vector<char> whole_;     // per block: anything may stand in it, as where a stage begins or faces break
  std::vector<double> deepest_; // m, per block, of the contacts that are known
  std::vector<double> at_least_; // m, per block
};

// A triangle where it is now.
struct Facet {
  Corners x;         // m
  geom::Vec3 normal; // unit
};

struct ActiveSurface {
  std::vector<int> triangles;         // by block
  std::vector<int> place;             // per triangle of the model: its number here; -1: it is not active
  std::vector<int> block_begin;       // (n_blocks + 1) into triangles
  std::vector<Facet> facets;          // per triangle
  std::vector<geom::Box> boxes;       // per triangle, with its margin
  std::vector<geom::Box> block_boxes; // per block, with margins
  std::vector<geom::Box> outlines;    // per block, without
  std::vector<geom::Box> fragment_outlines; // per fragment of a broken block, likewise

  bool finite() const;
  // Whether x is in the outline of a fragment, grown by so much, m. fragment: by its number; -1: of a whole block, yes.
  bool in_outline(int fragment, const geom::Vec3& x, double by) const {
    return fragment < 0 || fragment_outlines[fragment].contains(x, by);
  }
};
ActiveSurface active_surface(const Model&, const State&, const ContactFragments&, const SearchMargin&,
                             int threads);

} // namespace cdem
