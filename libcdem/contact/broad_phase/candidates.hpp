// Finds, for pairs of near triangles, the semi-springs and semi-edges that can touch before a block leaves its skin.
//
// A spring that stands outside a fragment by more than the two skins cannot get into it. A triangle of the fragment can
// become the nearest only if its distance is now less than the least distance plus twice the skins. Two edges cannot
// touch when they are further apart than the skins and the depth of an edge contact, when they are parallel, and when
// neither of their common normals lies in both fans of outward normals (Gauss map), each by more than they may turn.
#pragma once

#include "libcdem/contact/broad_phase/near_triangles.hpp"

namespace cdem {

// Bodies without a law meet when their distance is less than this fraction of the smaller block's size.
inline constexpr double meeting_ratio = 1e-3;

// m, largest depth at which a contact of two edges may begin, for one of the two blocks: deeper edges have slid past
// each other's ends.
inline double edge_depth(const SurfaceSizes& sizes, int block) {
  return 5 * sizes.shallow[block];
}
double edge_depth(const SurfaceSizes&, const ContactTriangle& source, const ContactTriangle& target);

struct Near {
  int source = 0;
  std::uint32_t target : 29;
  std::uint32_t springs : 3; // of a triangle: which of its semi-springs
};

// pairs: (source, target), of one or two blocks; they are sorted by source, fragment of the target and target.
std::vector<Near> near_springs(const Model&, const ContactWork&, const SearchMargin&, const ActiveSurface&,
                               Pairs& pairs, const Skins&);

// Near edges of two blocks. The edge with the lower number is the source.
std::vector<Near> near_edges(const Model&, const State&, const ContactWork&, const SearchMargin&,
                             const ActiveSurface&, const SharedPart&, const Skins&);
// Near edges within one block, of triangles that meet; each pair stands once.
std::vector<Near> near_edges_within(const Model&, const State&, const ContactWork&, const SearchMargin&,
                                    const ActiveSurface&, const Pairs& meeting);

} // namespace cdem
