#include "tests/libcdem/random_cuts.hpp"

#include "libcdem/fracture/rebuild.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <numeric>

namespace testing {

int largest_block(const cdem::Model& model) {
  const auto smaller = [](const cdem::Block& a, const cdem::Block& b) {
    return a.mass.volume < b.mass.volume;
  };
  return static_cast<int>(std::max_element(model.blocks.begin(), model.blocks.end(), smaller) -
                          model.blocks.begin());
}

std::vector<int> all_blocks(const cdem::Model& model) {
  std::vector<int> all(model.blocks.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void cut_at_random(System& s, const std::vector<int>& blocks, std::uint64_t seed) {
  std::vector<cdem::Successor> successors;
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b) {
    const cdem::Block& block = s.model.blocks[b];
    if (std::find(blocks.begin(), blocks.end(), b) == blocks.end()) {
      successors.push_back(cdem::whole_block(s.model, b));
      continue;
    }
    const auto draw = [&](std::uint64_t n) {
      return geom::normal(seed, static_cast<std::uint64_t>(block.id), n);
    };
    const geom::Plane plane = geom::shifted_clear_of_vertices(
        block.shape, geom::Plane::through(block.mass.centroid, {draw(0), draw(1), draw(2)}),
        0.01 * block.size);
    const geom::Cut parts = geom::cut(block.shape, plane);
    for (const geom::Part* part : {&*parts.below, &*parts.above}) {
      cdem::Successor piece;
      piece.old_block = b;
      piece.shape = part->shape;
      piece.old_face = part->parent_face;
      piece.whole = false;
      successors.push_back(std::move(piece));
    }
  }
  cdem::Rebuilt rebuilt = cdem::rebuild(s.model, s.state, std::move(successors), {}, cdem::MayBreak::all);
  s.adopt(std::move(rebuilt.model), std::move(rebuilt.state));
}

} // namespace testing
