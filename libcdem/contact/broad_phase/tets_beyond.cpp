#include "libcdem/contact/broad_phase/tets_beyond.hpp"

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Tets around a node and the next ones are far fewer.
constexpr int most_passed = 64;

int face_of(const geom::Tet& tet, const geom::Triangle& triangle) {
  int face = 0;
  while (std::find(triangle.begin(), triangle.end(), tet[face]) != triangle.end())
    ++face;
  return face;
}

} // namespace

std::vector<char> tets_at_surface(const Model& model, const ContactFragments& fragments, int block) {
  const ContactSurface& s = model.surface;
  const Block& b = model.blocks[block];
  std::vector<char> on_surface(s.original.size(), 0); // of the mesh before it was split
  for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
    if (fragments.active[t])
      for (const int node : s.triangles[t].nodes)
        on_surface[s.original[node]] = 1;
  std::vector<char> at_surface;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    const geom::Tet& n = model.tets[tet];
    at_surface.push_back(static_cast<char>(
        std::any_of(n.begin(), n.end(), [&](int node) { return on_surface[s.original[node]] != 0; })));
  }
  return at_surface;
}

void find_tets_beyond(const Model& model, const ContactFragments& fragments, TetsBeyond& tets_beyond) {
  const ContactSurface& s = model.surface;
  const int first = model.mesh.first_tet;
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block) {
    if (!fragments.broken[block])
      continue;
    if (tets_beyond.neighbours.empty())
      tets_beyond.neighbours = mesh_neighbours(model);
    tets_beyond.of_tet.resize(tets_beyond.neighbours.size() / 4);
    const Block& b = model.blocks[block];
    const std::vector<char> at_surface = tets_at_surface(model, fragments, block);
    for (int tet = b.tet_begin; tet < b.tet_end; ++tet)
      for (int face = 0; face < 4; ++face) {
        const int beyond = tets_beyond.neighbours[4 * (tet - first) + face];
        tets_beyond.of_tet[tet - first][face] = beyond < 0 ? TetsBeyond::none
                                                : at_surface[first + beyond / 4 - b.tet_begin]
                                                    ? first + beyond / 4
                                                    : TetsBeyond::deep;
      }
    for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
      if (const ContactTriangle& triangle = s.triangles[t]; fragments.active[t])
        tets_beyond.of_tet[triangle.tet - first][face_of(model.tets[triangle.tet], triangle.nodes)] =
            TetsBeyond::none;
  }
}

bool stands_within(const Model& model, const State& state, const TetsBeyond& tets_beyond, int triangle,
                   const geom::Vec3& place, const geom::Vec3& x) {
  int tet = model.surface.triangles[triangle].tet, before = TetsBeyond::none;
  for (int passed = 0; passed < most_passed; ++passed) {
    const std::array<int, 4>& beyond = tets_beyond.of_tet[tet - model.mesh.first_tet];
    const geom::Tet& nodes = model.tets[tet];
    int out = -1;
    double least = 2; // part of the way, at which it leaves
    for (int face = 0; face < 4; ++face) {
      // Not back: between the two sides of a face that gives is within.
      if (beyond[face] >= 0 && beyond[face] == before)
        continue;
      const auto& corners = geom::tet_faces[face];
      const auto corner = [&](int k) { return place_of(model, state, nodes[corners[k]]); };
      const geom::Vec3 foot = corner(0), normal = (corner(1) - foot).cross(corner(2) - foot);
      const double there = normal.dot(x - foot), here = normal.dot(place - foot);
      if (there <= 0)
        continue;
      // From an edge the way may leave through two faces at once: it goes on as long as it can.
      const double at = here < -1e-9 * there ? here / (here - there) : 0;
      if (at < least || (at == least && beyond[out] == TetsBeyond::none)) {
        least = at;
        out = face;
      }
    }
    if (out < 0)
      return true;
    if (beyond[out] == TetsBeyond::none)
      return false;
    if (beyond[out] == TetsBeyond::deep)
      return true;
    before = tet;
    tet = beyond[out];
  }
  return true;
}

} // namespace cdem
