#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdem {
namespace {

geom::Vec3 area_vector(const Model& model, const geom::Triangle& n) {
  const auto& x = model.node_position;
  return 0.5 * (x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]);
}

ContactTriangle make_triangle(const Model& model, const geom::Triangle& nodes, int tet) {
  const geom::Tet& t = model.tets[tet];
  const auto& x = model.node_position;
  const double volume = (x[t[1]] - x[t[0]]).dot((x[t[2]] - x[t[0]]).cross(x[t[3]] - x[t[0]])) / 6;
  ContactTriangle triangle;
  triangle.nodes = nodes;
  triangle.tet = tet;
  triangle.block = model.tet_block[tet];
  triangle.area = area_vector(model, nodes).norm();
  triangle.height = 3 * volume / triangle.area;
  triangle.compliance =
      triangle.height / model.bodies[model.blocks[triangle.block].body].material.youngs_modulus;
  return triangle;
}

// A flat tet at the surface neither makes the contact there stiffer nor lets less into it: its height counts as a third
// of what is usual at the block's outside, at least.
void raise_flat_ones(Model& model, int begin, int outer_end) {
  auto& triangles = model.surface.triangles;
  model.surface.usual_height.push_back(0);
  std::vector<double> heights;
  for (int t = begin; t < outer_end; ++t)
    heights.push_back(triangles[t].height);
  if (heights.empty())
    return;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  model.surface.usual_height.back() = *middle;
  for (int t = begin; t < static_cast<int>(triangles.size()); ++t) {
    const double height = std::max(triangles[t].height, *middle / 3);
    triangles[t].compliance *= height / triangles[t].height;
    triangles[t].height = height;
  }
}

// The two sides of the bonded faces of a block, each the other's mate.
void add_inner_faces(Model& model, int block) {
  auto& triangles = model.surface.triangles;
  for (const MeshChunk& chunk : model.mesh.chunks) {
    if (chunk.block != block)
      continue;
    for (int i = 0; i < chunk.faces; ++i) {
      const std::int64_t face = chunk.face_batches.begin * lanes + i;
      const FaceTets& tets = model.mesh.face_tets[face];
      const FaceNodes nodes = face_nodes(model.mesh, chunk, face / lanes, static_cast<int>(face % lanes));
      const auto first = static_cast<int>(triangles.size());
      triangles.push_back(make_triangle(model, nodes.a, tets.tet_a));
      triangles.push_back(make_triangle(model, nodes.outward_b(), tets.tet_b));
      for (int side = 0; side < 2; ++side) {
        triangles[first + side].face = static_cast<int>(face);
        triangles[first + side].mate = first + 1 - side;
      }
    }
  }
}

// Convex edges between two outer triangles of a block, by the first of them.
void add_edges(Model& model, int begin, int end) {
  ContactSurface& s = model.surface;
  struct Side {
    int triangle, corner; // the edge runs from this corner to the next
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (int t = begin; t < end; ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const int a = s.original[s.triangles[t].nodes[corner]],
                b = s.original[s.triangles[t].nodes[(corner + 1) % 3]];
      sides[std::minmax(a, b)].push_back({t, corner});
    }
  std::vector<ContactEdge> found;
  for (const auto& [nodes, both] : sides)
    if (both.size() == 2) // not where parts of the outside touch along an edge
      if (const auto edge =
              convex_edge(model, both[0].triangle, both[0].corner, both[1].triangle, both[1].corner))
        found.push_back(*edge);
  std::sort(found.begin(), found.end(),
            [](const ContactEdge& a, const ContactEdge& b) { return a.id() < b.id(); });
  s.edges.insert(s.edges.end(), found.begin(), found.end());
}

// Those of a block, whose outer triangles begin there, in a surface with other nodes.
void keep_edges(const ContactSurface& before, int block, int begin, ContactSurface& s) {
  const int was = before.block_begin[block];
  const auto first = std::partition_point(before.edges.begin(), before.edges.end(),
                                          [&](const ContactEdge& edge) { return edge.triangles[0] < was; });
  for (auto edge = first; edge != before.edges.end() && edge->triangles[0] < before.block_begin[block + 1];
       ++edge) {
    const int triangle = edge->triangles[0] - was + begin;
    const geom::Triangle& nodes = s.triangles[triangle].nodes;
    s.edges.push_back({{nodes[edge->corner], nodes[(edge->corner + 1) % 3]},
                       {triangle, edge->triangles[1] - was + begin},
                       edge->corner});
  }
}

// Visits the interfaces that leave another contact than their bodies have, with its law.
template <class Visit>
void each_left(const Model& model, const Visit& visit) {
  for (const Interface& interface : model.interfaces)
    if (const auto left = model.surface.left_by.find(interface.joint);
        interface.frame >= 0 && left != model.surface.left_by.end())
      visit(interface, left->second);
}

std::vector<BlockPairLaw> pair_laws(const Model& model) {
  std::vector<BlockPairLaw> pairs;
  each_left(model, [&](const Interface& interface, int left) {
    pairs.push_back({{interface.block_a, interface.block_b}, left});
  });
  // If there are two interfaces between the same blocks, the first counts.
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const BlockPairLaw& a, const BlockPairLaw& b) { return a.blocks < b.blocks; });
  pairs.erase(std::unique(pairs.begin(), pairs.end(),
                          [](const BlockPairLaw& a, const BlockPairLaw& b) { return a.blocks == b.blocks; }),
              pairs.end());
  return pairs;
}

} // namespace

void build_surface(Model& model, const ContactSurface* before) {
  ContactSurface& s = model.surface;
  s.pairs = pair_laws(model);
  std::map<std::pair<int, int>, int> left_at; // by block and face; of several interfaces the first counts
  each_left(model, [&](const Interface& interface, int left) {
    left_at.emplace(std::pair(interface.block_a, interface.face_a), left);
    left_at.emplace(std::pair(interface.block_b, interface.face_b), left);
  });
  s.triangles.clear();
  s.edges.clear();
  s.block_begin.clear();
  s.usual_height.clear();
  const auto touches_itself = [&](int body) { return s.joint.count({body, body}) > 0; };
  const auto meshed = std::count_if(model.blocks.begin(), model.blocks.end(),
                                    [](const Block& block) { return block.meshed; });
  if (meshed < 2 && s.joint.empty())
    return;
  s.original.assign(model.node_position.size(), -1);
  for (std::size_t i = 0; i < model.mesh.original.size(); ++i)
    s.original[static_cast<std::size_t>(model.mesh.first_node) + i] = model.mesh.original[i];
  std::size_t next = 0;
  s.block_begin.push_back(0);
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const int begin = static_cast<int>(s.triangles.size());
    for (; next < model.mesh.boundary.size() && model.mesh.boundary[next].block == b; ++next) {
      const BoundaryTriangle& outer = model.mesh.boundary[next];
      s.triangles.push_back(make_triangle(model, outer.nodes, outer.tet));
      if (const auto left = left_at.find({b, outer.face}); left != left_at.end())
        s.triangles.back().left = left->second;
    }
    const int outer_end = static_cast<int>(s.triangles.size());
    if (before)
      keep_edges(*before, b, begin, s);
    else
      add_edges(model, begin, outer_end);
    if (!model.blocks[b].convex() && touches_itself(model.blocks[b].body))
      add_inner_faces(model, b);
    raise_flat_ones(model, begin, outer_end);
    s.block_begin.push_back(static_cast<int>(s.triangles.size()));
  }
}

ContactEdge edge_between(const ContactSurface& s, int triangle_a, int corner_a, int triangle_b,
                         int corner_b) {
  const bool a_first = triangle_a < triangle_b;
  const int triangle = a_first ? triangle_a : triangle_b, corner = a_first ? corner_a : corner_b;
  const geom::Triangle& n = s.triangles[triangle].nodes;
  return {{n[corner], n[(corner + 1) % 3]}, {triangle, a_first ? triangle_b : triangle_a}, corner};
}

std::optional<ContactEdge> convex_edge(const Model& model, int triangle_a, int corner_a, int triangle_b,
                                       int corner_b) {
  const ContactSurface& s = model.surface;
  const geom::Triangle &n = s.triangles[triangle_a].nodes, &m = s.triangles[triangle_b].nodes;
  const geom::Vec3 u = area_vector(model, n).normalized(), v = area_vector(model, m).normalized();
  const geom::Vec3 away = model.node_position[m[(corner_b + 2) % 3]] - model.node_position[n[corner_a]];
  if (away.dot(u) >= 0 || geom::portable::acos(std::clamp(u.dot(v), -1.0, 1.0)) < least_edge_turn)
    return std::nullopt;
  return edge_between(s, triangle_a, corner_a, triangle_b, corner_b);
}

ContactStiffness contact_stiffness(const Joint& joint, double compliance) {
  const double normal = joint.normal_stiffness.value_or(1 / compliance);
  return {normal, joint.shear_stiffness.value_or(normal)};
}

namespace {

// What an interface with a law of its own leaves between them; null: there is none.
const Joint* pair_law(const Model& model, int block_a, int block_b) {
  const auto& pairs = model.surface.pairs;
  const std::array<int, 2> blocks{std::min(block_a, block_b), std::max(block_a, block_b)};
  const auto own =
      std::lower_bound(pairs.begin(), pairs.end(), blocks,
                       [](const BlockPairLaw& pair, const auto& wanted) { return pair.blocks < wanted; });
  return own != pairs.end() && own->blocks == blocks ? &model.joints[own->joint] : nullptr;
}

} // namespace

const Joint* contact_joint(const Model& model, int block_a, int block_b) {
  if (const Joint* const own = pair_law(model, block_a, block_b))
    return own;
  const int body = model.blocks[block_a].body;
  if (block_a == block_b)
    if (const auto within = model.surface.within.find(body); within != model.surface.within.end())
      return &model.joints[within->second];
  const auto found = model.surface.joint.find(std::minmax(body, model.blocks[block_b].body));
  return found == model.surface.joint.end() ? nullptr : &model.joints[found->second];
}

int law_left_between(const Model& model, const TrianglesOfSide& a, const TrianglesOfSide& b) {
  int least = -1;
  for (const int t : {a[0], a[1], b[0], b[1]})
    if (const int left = model.surface.triangles[t].left;
        left >= 0 && (least < 0 || model.joints[left].friction_angle < model.joints[least].friction_angle))
      least = left;
  return least;
}

const Joint* contact_joint(const Model& model, const TrianglesOfSide& a, const TrianglesOfSide& b) {
  const int block_a = model.surface.triangles[a[0]].block, block_b = model.surface.triangles[b[0]].block;
  const Joint* const of_blocks = contact_joint(model, block_a, block_b);
  if (model.surface.pairs.empty() || of_blocks == nullptr || block_a == block_b ||
      model.blocks[block_a].body != model.blocks[block_b].body || pair_law(model, block_a, block_b))
    return of_blocks;
  const int left = law_left_between(model, a, b);
  return left < 0 ? of_blocks : &model.joints[left];
}

double friction_within(const Model& model, const Joint& law, int tet_a, int tet_b) {
  const Body& body = model.bodies[model.blocks[model.tet_block[tet_a]].body];
  if (!body.region_laws.empty()) {
    const auto region = [&](int tet) { return model.mesh.region[tet - model.mesh.first_tet]; };
    if (const int own = body.region_laws.between(region(tet_a), region(tet_b)); own >= 0)
      return friction_left(body.region_laws.joints[own]);
  }
  return geom::portable::tan(law.friction_angle);
}

} // namespace cdem
