#include "libcdem/contact/broad_phase/contact_fragments.hpp"

#include "libcdem/bond/fragments.hpp"

#include <algorithm>
#include <utility>

namespace cdem {
namespace {

// As ContactFragments::active, of a triangle of this face.
char activity(const State& state, int face) {
  if (face < 0)
    return 1;
  const std::uint8_t told = state.faces[face / lanes].told[face % lanes];
  if ((told & ToldOfFace::gone) != 0)
    return 2;
  return static_cast<char>((told & ToldOfFace::broken) != 0);
}

void number_fragments(const Model& model, ContactFragments& fragments) {
  const ContactSurface& s = model.surface;
  fragments.number_of_triangle.assign(s.triangles.size(), -1);
  std::vector<int> number(model.node_position.size(), -1); // by the smallest node
  int count = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (fragments.broken[s.triangles[t].block]) {
      int& known = number[fragments.of_triangle[t]];
      if (known < 0)
        known = count++;
      fragments.number_of_triangle[t] = known;
    }
  // One piece has no bond inside it.
  fragments.one_piece.assign(count, 1);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (fragments.number_of_triangle[t] >= 0 && s.triangles[t].face >= 0 &&
        fragments.of_triangle[t] == fragments.of_triangle[s.triangles[t].mate])
      fragments.one_piece[fragments.number_of_triangle[t]] = 0;
}

// Such a fragment is convex, and its four triangles are its surface.
void find_single_tets(const Model& model, ContactFragments& fragments) {
  const ContactSurface& s = model.surface;
  constexpr std::array<int, 4> none{-1, -1, -1, -1};
  fragments.triangles_of_tet.assign(fragments.one_piece.size(), none);
  if (fragments.triangles_of_tet.empty())
    return;
  std::vector<int> tets(model.node_position.size(), 0); // per fragment
  for (const geom::Tet& tet : model.tets)
    ++tets[fragments.of_node[tet[0]]];
  for (int t = 0; t < static_cast<int>(s.triangles.size()); ++t) {
    const int number = fragments.number_of_triangle[t];
    if (number < 0 || !fragments.active[t] || tets[fragments.of_triangle[t]] != 1)
      continue;
    std::array<int, 4>& triangles = fragments.triangles_of_tet[number];
    *std::find(triangles.begin(), triangles.end(), -1) = t;
  }
  for (std::array<int, 4>& triangles : fragments.triangles_of_tet)
    if (triangles[3] < 0)
      triangles = none;
}

} // namespace

void find_contact_fragments(const Model& model, const State& state, ContactFragments& fragments) {
  const ContactSurface& s = model.surface;
  const ContactFragments before = std::exchange(fragments, {});
  fragments.of_node = fragments_of_nodes(model, state, Joins::told);
  fragments.of_triangle.resize(s.triangles.size());
  fragments.active.resize(s.triangles.size());
  fragments.broken.assign(model.blocks.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    fragments.of_triangle[t] = fragments.of_node[s.triangles[t].nodes[0]];
    fragments.active[t] = activity(state, s.triangles[t].face);
    if (s.triangles[t].face >= 0 && fragments.active[t])
      fragments.broken[s.triangles[t].block] = 1;
  }
  number_fragments(model, fragments);
  find_single_tets(model, fragments);
  fragments.changed.assign(s.triangles.size(), 0);
  for (std::size_t t = 0; t < before.of_triangle.size(); ++t)
    fragments.changed[t] = static_cast<char>(
        fragments.broken[s.triangles[t].block] &&
        (before.of_triangle[t] != fragments.of_triangle[t] || before.active[t] != fragments.active[t]));
}

} // namespace cdem
