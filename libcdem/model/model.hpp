// Model: everything that stays as it is while the solver steps. Only fracture/ makes a new one, between steps.
#pragma once

#include "libcdem/joint/joint.hpp"
#include "libcdem/material/elastic.hpp"
#include "libcdem/material/plasticity.hpp"
#include "libcdem/model/bonding.hpp"
#include "libcdem/model/contact_surface.hpp"
#include "libcdem/model/element.hpp"
#include "libcdem/model/mesh.hpp"
#include "libcdem/model/region_laws.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/parallel/node.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace cdem {

struct Body {
  std::string name;
  Elastic material;
  Joint joint; // between its own blocks; its strength is that of the blocks themselves when they are cut
  Bonding bonding = {};                    // of a meshed body: which of its faces carry that joint
  Element element = Element::small_strain; // that it starts as; single blocks may turn rigid and back
  double zone_size = 0;        // m, edge length of the tets inside its convex blocks; 0: their star meshes
  RegionLaws region_laws = {}; // of a meshed body
  // Index into Model::joints of the law on faces that a joint set or cut of this name made; others have `joint`.
  std::map<std::string, int> set_joint = {};
  int units = 0;               // blocks it was built of
  int glued_joint = -1;        // the same for glued faces; -1: it has none
  PlasticLaws plasticity = {}; // of a body that moves far; empty: it is elastic

  bool has_rate_effect() const {
    return joint.rate.on() || std::any_of(region_laws.joints.begin(), region_laws.joints.end(),
                                          [](const Joint& own) { return own.rate.on(); });
  }
  const Joint& joint_of(int law) const { return law < 0 ? joint : region_laws.joints[law]; }
};

// A part of a body with nodes of its own: a convex block with its star mesh or with zones, or a connected part of a
// mesh.
struct Block {
  std::int64_t id = 0;      // stable, never used again
  std::int64_t parent = -1; // id of the block it was cut from
  int generation = 0;       // cuts between the first block and this one
  int body = 0;
  int unit = 0;              // number among the blocks its body was built of, from 1; pieces keep it
  bool meshed = false;       // its tets are of finite volume and stand in MeshData: it may move far
  bool zoned = false;        // a convex block with a finer mesh than its star mesh
  int rigid = -1;            // index into Model::rigid; -1: it deforms
  geom::Polyhedron shape;    // empty when not convex: a part of a mesh
  geom::MassProperties mass; // unit density
  double size = 0;           // h, cube root of the volume, m
  double first_size =
      0; // h of the generation-0 block it comes from, m; joints keep their thickness through cuts
  // A convex block has its vertices first. Without zones, one centre per face and the centroid follow.
  int node_begin = 0, node_end = 0;
  int tet_begin = 0, tet_end = 0;

  bool convex() const { return !shape.faces.empty(); }
  bool star() const { return convex() && !zoned; } // judged as a whole: its stress is that of the block
  int centroid_node() const { return node_end - 1; }
};

// Where an interface comes from; decides whether it may break (procedure/refine.hpp).
enum class InterfaceOrigin : std::uint8_t { original, cut };

struct Interface {
  std::int64_t id = 0;
  int block_a = 0, face_a = 0, block_b = 0, face_b = 0; // block_a < block_b
  geom::Vec3 normal = geom::Vec3::Zero();               // unit, from a to b
  int joint = 0;                                        // index into Model::joints
  double thickness = 0;                                 // L, m, equivalent thickness
  double kn = 0, ks = 0;                                // Pa/m
  InterfaceOrigin origin = InterfaceOrigin::original;
  bool may_break = true;
  double strength = 1; // tension and cohesion over those of the joint (joint/strength_scatter.hpp)
  int point_begin = 0, point_end = 0;
  int frame = -1; // into Model::frames; -1: both blocks are of small strain, the interface does not turn
  int triangle_begin = 0, triangle_end = 0;
};

// What tells how an interface between blocks that move far has turned: on each side three nodes x0 x1 x2 of its face,
// and the fixed direction `along` in the undeformed face as along[0] (x1 - x0) + along[1] (x2 - x0)
// (bond/interface_frame.hpp).
struct InterfaceFrame {
  std::array<int, 3> nodes_a{}, nodes_b{};
  std::array<double, 2> along_a{}, along_b{};
  geom::Vec3 along = geom::Vec3::Zero(); // unit, undeformed
  double size = 0;                       // m, root of the interface's area when it was made
  double area = 0;                       // m2, of its springs now
  bool renewed =
      false; // its faces have slid and were intersected anew where they stood (fracture/renew_interfaces.hpp)
};

// One spring: a point of face a against a point of face b, both interpolated linearly.
struct alignas(64) BondPoint {
  std::array<int, 3> node_a{}, node_b{};
  std::array<double, 3> weight_a{}, weight_b{};
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, from a to b
  double kn_area = 0, ks_area = 0;        // N/m
  double area = 0;                        // m2
  int interface = 0;
  bool one_to_one = false; // both sides sit on a node: weights 1, 0, 0
};

// Eight tets side by side, all of one chunk. grad: shape function gradients of corners 1..3 (corner 0 is minus their
// sum), 1/m; the moduli carry the volume, N m.
struct TetBatch {
  int node[4][lanes]; // of the chunk's nodes, from 0
  double grad[9][lanes];
  double lambda_volume[lanes];
  double two_g_volume[lanes];
};

// Part of the boundary of a block that no other block covers.
struct OuterFace {
  int block = 0, face = 0;
  int boundary = -1;                      // of a meshed block: index into MeshData::boundary
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, outward
  double area = 0;                        // m2, uncovered
  // Node, and integral of its shape function over the uncovered part, m2. Empty for a meshed block: each node has a
  // third of the area (each_face_node).
  std::vector<std::pair<int, double>> node_area;
};

// Consecutive blocks, or a part of a meshed one: the smallest piece of parallel work. Its nodes belong to no other
// chunk. batches: of small-strain tets; empty for a part of a mesh, whose forces come by MeshChunk.
struct BlockChunk {
  Range blocks, nodes, batches;
};

// A spring that pulls at a node, as one of the three nodes of its side a (0 to 2) or b (3 to 5), or as the only one of side
// a (6) or b (7).
struct SpringEnd {
  static constexpr std::uint32_t only_a = 6, only_b = 7;
  std::uint32_t code = 0; // 8 times the spring, plus that number

  SpringEnd() = default;
  SpringEnd(int point, std::uint32_t end) : code(static_cast<std::uint32_t>(point) << 3U | end) {}
  int point() const { return static_cast<int>(code >> 3U); }
  std::uint32_t end() const { return code & 7U; }
  // force on the node += weight * spring force (positive on side a, negative on side b).
  double weight(const std::vector<BondPoint>& points) const {
    if (end() >= only_a)
      return end() == only_a ? 1 : -1;
    const BondPoint& p = points[point()];
    return end() < 3 ? p.weight_a[end()] : -p.weight_b[end() - 3];
  }
};

// A meshed block that keeps the shape it had when it was made rigid.
struct RigidBody {
  int block = 0;
  double mass = 0; // kg
  geom::Mat3 inertia =
      geom::Mat3::Identity(); // kg m2, about the centroid, in the directions it was made rigid in
  geom::Mat3 inverse_inertia = geom::Mat3::Identity();
  geom::Vec3 principal = geom::Vec3::Ones(); // kg m2, principal moments, ascending
  geom::Mat3 axes = geom::Mat3::Identity();  // their directions, column by column
};

struct Model {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Block> blocks;                     // in the order of their nodes
  std::map<std::pair<int, int>, int> pair_joint; // bodies (smaller first) -> joint between them

  std::vector<geom::Vec3> node_position; // undeformed, m (n_nodes)
  // kg (n_nodes). What moves, and what weighs: a quarter of each tet around a node. They differ in convex blocks that move
  // far (build/convex_inertia).
  std::vector<double> node_mass;
  std::vector<double> gravitational_mass;

  std::vector<geom::Tet> tets; // global nodes (n_tets)
  std::vector<int> tet_block;  // (n_tets)
  std::vector<TetBatch> batches;

  std::vector<Interface> interfaces;
  std::vector<InterfaceFrame> frames;     // of those that may turn
  std::vector<BondPoint> points;          // springs (n_points)
  std::vector<geom::Vec3> point_position; // undeformed, m (n_points); the mean of both sides
  // m, from side a's undeformed place to side b's (n_points); empty while they lie on each other at every spring, as when
  // an interface is built; written by renew_interfaces
  std::vector<geom::Vec3> point_apart;
  std::vector<geom::Triangle> bond_triangles; // over points

  std::vector<std::int64_t> bond_begin; // (n_nodes + 1) into spring_ends
  std::vector<SpringEnd> spring_ends;   // of each node, springs ascending

  std::vector<OuterFace> outer_faces;

  MeshData mesh;
  ContactSurface surface;       // empty without contacts of meshed bodies
  std::vector<RigidBody> rigid; // by block

  std::vector<BlockChunk> chunks; // those of blocks of small strain, then one for each MeshChunk
  std::vector<Range> point_chunks;

  geom::Box box;        // undeformed
  geom::Box built_box;  // the same when the model was built: its sides are places for conditions
  double length = 0;    // diagonal of the box, m
  double tolerance = 0; // places nearer than this are one, m
  std::int64_t next_id = 1;
};

// All blocks that the chunk is made of keep their shape: it has nothing to compute.
bool is_rigid(const Model&, const MeshChunk&);

// visit(first node, end) for the runs of nodes of a chunk of convex blocks that deform.
template <class Visit>
void each_deformable_run(const Model& model, const MeshChunk& chunk, const Visit& visit) {
  for (std::int64_t b = chunk.blocks.begin; b < chunk.blocks.end;) {
    if (model.blocks[b].rigid >= 0) {
      ++b;
      continue;
    }
    const std::int64_t first = b;
    while (b < chunk.blocks.end && model.blocks[b].rigid < 0)
      ++b;
    visit(Range{model.blocks[first].node_begin, model.blocks[b - 1].node_end});
  }
}

// visit(index into MeshData::boundary, triangle) for the outer triangles of a block that moves far, in order.
template <class Visit>
void each_boundary_triangle(const Model& model, int block, const Visit& visit) {
  const auto& all = model.mesh.boundary; // by block
  const auto first =
      std::lower_bound(all.begin(), all.end(), block,
                       [](const BoundaryTriangle& triangle, int b) { return triangle.block < b; });
  for (auto i = first; i != all.end() && i->block == block; ++i)
    visit(static_cast<int>(i - all.begin()), *i);
}

// The interface's own strength in it.
Joint joint_of(const Model&, const Interface&);

// For face f of tet t of the mesh, at 4 t + f (t from MeshData::first_tet on): the same number of that face in the tet
// on its other side, or -1 outside. Freed faces count like the others.
std::vector<int> mesh_neighbours(const Model&);

int block_of(const Model&, int node);       // index into Model::blocks
double node_volume(const Model&, int node); // m3

// f(node, integral of its shape function over the face, m2).
template <class F>
void each_face_node(const Model& model, const OuterFace& face, F&& f) {
  if (face.boundary >= 0)
    for (const int node : model.mesh.boundary[face.boundary].nodes)
      f(node, face.area / 3);
  else
    for (const auto& [node, area] : face.node_area)
      f(node, area);
}

} // namespace cdem
