// Which tetrahedron holds a place of the undeformed model.
#pragma once

#include "libcdem/model/model.hpp"

#include <array>
#include <memory>
#include <optional>

namespace cdem {

struct PlaceInTet {
  int block = 0, tet = 0;
  std::array<double, 4> weight{}; // of the tet's nodes; their sum is 1
};

// Boxes of a grid over the model, each with the tetrahedra that reach into it.
class TetsByPlace {
public:
  explicit TetsByPlace(const Model&);
  // The first tetrahedron of the first block, by its id, of those that hold the place; nothing where none does.
  std::optional<PlaceInTet> find(const Model&, const geom::Vec3& place) const;
  // The same among the tetrahedra of all named bodies but `body`.
  std::optional<PlaceInTet> find_beside(const Model&, const geom::Vec3& place, int body) const;

private:
  template <class Looked>
  std::optional<PlaceInTet> find_of(const Model&, const geom::Vec3& place, const Looked&) const;
  int box_of(double x, int axis) const;
  std::size_t number(const std::array<int, 3>& box) const;

  geom::Vec3 from_ = geom::Vec3::Zero(),
             size_ = geom::Vec3::Ones(); // m, the first corner, and the size of a box
  std::array<int, 3> count_{1, 1, 1};
  std::vector<std::int64_t> begin_; // per box, into tets_
  std::vector<int> tets_;           // of each box in the order of their blocks' ids, then of their own
};

// Kept while the model stays the same.
std::shared_ptr<const TetsByPlace> tets_by_place(const Model&);

} // namespace cdem
