// Of pairs of triangles near each other, the semi-springs and semi-edges that can touch before a block leaves its skin.
//
// A spring that stands outside a fragment by more than the two skins cannot get into it; of the fragment's triangles one can
// become the nearest only if it is now nearer than the nearest one and twice the skins. Two edges cannot touch when they
// are further apart than the skins and the depth of an edge contact, when they are parallel, and when neither of their
// common normals lies in both fans of outward normals (Gauss map), each by more than they may turn.
#pragma once

#include "libcdem/contact/broad_phase/near_triangles.hpp"

namespace cdem {

// Of the smaller block's size: bodies without a law that come nearer than this meet.
inline constexpr double meeting_ratio = 1e-3;

// m, how deep a contact of two edges may begin: deeper ones have slid past each other's ends. Of one block at most.
inline double edge_depth(const ContactWork& work, int block) {
  return 5 * work.shallow[block];
}
double edge_depth(const ContactWork&, const ContactTriangle& source, const ContactTriangle& target);

struct Near {
  int source = 0;
  std::uint32_t target : 29;
  std::uint32_t springs : 3; // of a triangle: which of its semi-springs
};

// pairs: (source, target), of one or two blocks; they are sorted by source, fragment of the target and target.
std::vector<Near> near_springs(const Model&, const ContactWork&, const SearchMargin&, const ActiveSurface&,
                               Pairs& pairs, const Skins&);

// Of two blocks. The edge with the lower number is the source.
std::vector<Near> near_edges(const Model&, const State&, const ContactWork&, const SearchMargin&,
                             const ActiveSurface&, const SharedPart&, const Skins&);
// Of one block: edges of triangles that meet, by pairs that stand each once.
std::vector<Near> near_edges_within(const Model&, const State&, const ContactWork&, const SearchMargin&,
                                    const ActiveSurface&, const Pairs& meeting);
// Pairs of edges of one broken block, of which one is `searched` (per edge), those of this rank's share.
std::vector<Near> near_edges_of_fragments(const Model&, const State&, const ContactWork&, const SearchMargin&,
                                          int block, const std::vector<char>& searched);

} // namespace cdem
