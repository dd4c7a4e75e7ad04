#include "libcdem/results/drawn_surface.hpp"

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/results/empty_field.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace cdem {
namespace {

// Edges at which the surface of a mesh turns by more than this are drawn: cos of 30 degrees.
constexpr double flat = 0.866;

bool opened(const FaceStateBatch& state, int lane) {
  return std::none_of(std::begin(state.mode), std::end(state.mode),
                      [&](const auto& point) { return is_intact(point[lane]); });
}

using FacePair =
    std::array<int, 3>; // block, and two faces of its shape that meet in an edge; the smaller one first

FacePair pair_of(int block, int one, int other) {
  return {block, std::min(one, other), std::max(one, other)};
}

// By the two vertices in the order in which the face goes along them.
using EdgeFaces = std::map<std::array<int, 2>, int>;

EdgeFaces faces_at_edges(const geom::Polyhedron& shape) {
  EdgeFaces faces;
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f) {
    const std::vector<int>& loop = shape.faces[f].loop;
    for (std::size_t i = 0; i < loop.size(); ++i)
      faces[{loop[i], loop[(i + 1) % loop.size()]}] = f;
  }
  return faces;
}

struct ShapeEdge {
  int other = 0; // the face beyond it
  geom::Vec3 from, to;
};

std::vector<ShapeEdge> edges_of_face(const geom::Polyhedron& shape, int face) {
  const EdgeFaces faces = faces_at_edges(shape);
  std::vector<ShapeEdge> edges;
  for (const auto& [ends, f] : faces)
    if (const auto beyond = faces.find({ends[1], ends[0]}); f == face && beyond != faces.end())
      edges.push_back({beyond->second, shape.vertices[ends[0]], shape.vertices[ends[1]]});
  return edges;
}

// The middle of one lies on the other, and both run the same way.
bool lie_along(const ShapeEdge& a, const ShapeEdge& b, double tolerance) {
  const auto holds = [&](const ShapeEdge& line, const geom::Vec3& x) {
    const geom::Vec3 along = line.to - line.from;
    const double part = (x - line.from).dot(along) / along.squaredNorm();
    return part > 0 && part < 1 && (line.from + part * along - x).norm() < tolerance;
  };
  const geom::Vec3 one = a.to - a.from, other = b.to - b.from;
  return one.cross(other).norm() < tolerance * std::max(one.norm(), other.norm()) &&
         (holds(a, 0.5 * (b.from + b.to)) || holds(b, 0.5 * (a.from + a.to)));
}

// Edges at which a glued face comes to the surface, and this goes on over it: nothing ends there.
std::set<FacePair> seams(const Model& model) {
  std::set<FacePair> found;
  for (const Interface& interface : model.interfaces) {
    if (!model.joints[interface.joint].glued)
      continue;
    const geom::Polyhedron &a = model.blocks[interface.block_a].shape,
                           &b = model.blocks[interface.block_b].shape;
    for (const ShapeEdge& of_a : edges_of_face(a, interface.face_a))
      for (const ShapeEdge& of_b : edges_of_face(b, interface.face_b))
        if (lie_along(of_a, of_b, model.tolerance) &&
            geom::face_normal(a, of_a.other).dot(geom::face_normal(b, of_b.other)) > flat) {
          found.insert(pair_of(interface.block_a, interface.face_a, of_a.other));
          found.insert(pair_of(interface.block_b, interface.face_b, of_b.other));
        }
  }
  return found;
}

using NodeEdges = std::vector<std::array<int, 2>>;

// shown(block): whether its edges are wanted.
template <class Shown>
void add_edges_of_meshes(const Model& model, const std::set<FacePair>& seams, const Shown& shown,
                         NodeEdges& edges) {
  struct Side {
    geom::Vec3 normal;
    int face; // of a zoned block
  };
  std::map<std::array<int, 2>, Side> first_at; // the first triangle that has the edge
  for (const BoundaryTriangle& triangle : model.mesh.boundary) {
    if (!shown(model.blocks[triangle.block]))
      continue;
    const auto& x = model.node_position;
    const geom::Vec3 normal = (x[triangle.nodes[1]] - x[triangle.nodes[0]])
                                  .cross(x[triangle.nodes[2]] - x[triangle.nodes[0]])
                                  .normalized();
    for (int i = 0; i < 3; ++i) {
      const std::array<int, 2> ends{triangle.nodes[i], triangle.nodes[(i + 1) % 3]};
      const int a = model.mesh.original[ends[0] - model.mesh.first_node],
                b = model.mesh.original[ends[1] - model.mesh.first_node];
      const auto [found, first] =
          first_at.emplace(std::array<int, 2>{std::min(a, b), std::max(a, b)}, Side{normal, triangle.face});
      if (!first && (found->second.normal.dot(normal) < flat || found->second.face != triangle.face) &&
          seams.count(pair_of(triangle.block, found->second.face, triangle.face)) == 0)
        edges.push_back(ends);
    }
  }
}

// Of convex blocks: where two faces meet that are not wholly covered, at more than 30 degrees.
void add_outer_edges(const Model& model, NodeEdges& edges) {
  std::set<std::array<int, 2>> outer; // block, face
  for (const OuterFace& face : model.outer_faces)
    outer.insert({face.block, face.face});
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    const EdgeFaces faces = faces_at_edges(block.shape);
    for (const auto& [ends, face] : faces) {
      const auto beyond = faces.find({ends[1], ends[0]});
      if (ends[0] < ends[1] && beyond != faces.end() && outer.count({b, face}) > 0 &&
          outer.count({b, beyond->second}) > 0 &&
          geom::face_normal(block.shape, face).dot(geom::face_normal(block.shape, beyond->second)) < flat)
        edges.push_back({block.node_begin + ends[0], block.node_begin + ends[1]});
    }
  }
}

} // namespace

std::vector<std::int64_t> opened_faces(const Model& model, const State& state, Range batches) {
  std::vector<std::int64_t> places;
  for (const MeshChunk& chunk : model.mesh.chunks) {
    if (chunk.face_batches.begin < batches.begin || chunk.face_batches.begin >= batches.end)
      continue;
    for (int face = 0; face < chunk.faces; ++face)
      if (opened(state.faces[chunk.face_batches.begin + face / lanes], face % lanes))
        places.push_back(chunk.face_batches.begin * lanes + face);
  }
  return places;
}

void add_surface(const Model& model, const std::vector<std::int64_t>& opened, Snapshot& snapshot) {
  const auto add = [&](const geom::Triangle& nodes, int tet) {
    snapshot.surface.push_back(nodes);
    snapshot.surface_tet.push_back(tet);
  };
  for (const Block& block : model.blocks) {
    if (!block.star())
      continue;
    // The star mesh makes one tet for each triangle of the faces' fans, corner 0 at the centroid, in the same order.
    for (int t = block.tet_begin; t < block.tet_end; ++t)
      add({model.tets[t][1], model.tets[t][2], model.tets[t][3]}, t);
  }
  for (const BoundaryTriangle& triangle : model.mesh.boundary)
    if (!model.blocks[triangle.block].star())
      add(triangle.nodes, triangle.tet);
  each_face_of(model.mesh, opened, [&](const MeshChunk& chunk, std::int64_t face) {
    const FaceNodes nodes = face_nodes(model.mesh, chunk, face / lanes, static_cast<int>(face % lanes));
    add(nodes.a, model.mesh.face_tets[face].tet_a);
    add(nodes.outward_b(), model.mesh.face_tets[face].tet_b);
  });
}

void add_edges(const Model& model, Snapshot& snapshot) {
  const std::set<FacePair> hidden = seams(model);
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    if (!block.star())
      continue;
    const EdgeFaces faces = hidden.empty() ? EdgeFaces() : faces_at_edges(block.shape);
    const auto is_hidden = [&](int from, int to) {
      const auto one = faces.find({from, to}), other = faces.find({to, from});
      return one != faces.end() && other != faces.end() &&
             hidden.count(pair_of(b, one->second, other->second)) > 0;
    };
    for (const auto& [from, to] : geom::edges(block.shape))
      if (!is_hidden(from, to))
        snapshot.block_edges.push_back({block.node_begin + from, block.node_begin + to});
  }
  add_edges_of_meshes(
      model, hidden, [](const Block& block) { return !block.star(); }, snapshot.block_edges);
}

void add_outline(const Model& model, const State& state, Snapshot& snapshot) {
  NodeEdges edges;
  add_outer_edges(model, edges);
  add_edges_of_meshes(
      model, {}, [](const Block& block) { return !block.convex(); }, edges);
  SnapshotField moved = empty_field("displacement", "m", 3);
  for (const std::array<int, 2>& ends : edges) {
    const int first = static_cast<int>(snapshot.points.size());
    snapshot.outline.push_back({first, first + 1});
    for (const int node : ends) {
      snapshot.points.push_back(model.node_position[node]);
      if (!state.displacement_zero.empty())
        snapshot.points.back() += vec(state.displacement_zero[node]);
      const Node u = shown_displacement(state, node);
      moved.values.insert(moved.values.end(), {u.x, u.y, u.z});
    }
  }
  snapshot.point_fields = {std::move(moved)};
}

} // namespace cdem
