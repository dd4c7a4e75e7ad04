#include "libcdem/model/build/build_model.hpp"

#include "libcdem/model/build/face_strength.hpp"
#include "libcdem/model/build/interface_springs.hpp"

#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/model/build/convex_inertia.hpp"
#include "libcdem/model/build/light_corners.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libgeom/assembly/assembly.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/mesh/star_mesh.hpp"
#include "libgeom/meshing/zone_mesh.hpp"
#include "libgeom/query/face_overlap.hpp"

#include <cmath>

namespace cdem {
namespace {

// Places nearer than this part of a block's size are one.
constexpr double relative_tolerance = 1e-7;
// Blocks of a chunk: enough tets to fill the caches' lines, few enough to share a small model among threads.
constexpr int blocks_chunk_tets = 384;

void add_block(Model& model, BlockSeed&& seed, const geom::BlockMesh& mesh) {
  Block block;
  block.id = seed.id;
  block.parent = seed.parent;
  block.generation = seed.generation;
  block.body = seed.body;
  block.unit = seed.unit;
  block.shape = std::move(seed.shape);
  block.mass = geom::mass_properties(block.shape);
  block.size = std::cbrt(block.mass.volume);
  block.first_size = seed.first_size > 0 ? seed.first_size : block.size;
  block.zoned = model.bodies[seed.body].zone_size > 0;

  const int index = static_cast<int>(model.blocks.size());
  block.node_begin = static_cast<int>(model.node_position.size());
  block.node_end = block.node_begin + static_cast<int>(mesh.nodes.size());
  block.tet_begin = static_cast<int>(model.tets.size());
  block.tet_end = block.tet_begin + static_cast<int>(mesh.tets.size());
  model.node_position.insert(model.node_position.end(), mesh.nodes.begin(), mesh.nodes.end());
  model.node_mass.resize(block.node_end, 0.0);
  const double density = model.bodies[block.body].material.density;
  for (geom::Tet tet : mesh.tets) {
    for (int& node : tet)
      node += block.node_begin;
    const auto& x = model.node_position;
    const double volume =
        (x[tet[1]] - x[tet[0]]).dot((x[tet[2]] - x[tet[0]]).cross(x[tet[3]] - x[tet[0]])) / 6;
    for (const int node : tet) {
      model.node_mass[node] += density * volume / 4;
    }
    model.tets.push_back(tet);
    model.tet_block.push_back(index);
  }
  const bool turns = model.bodies[block.body].element == Element::finite_volume;
  model.gravitational_mass.insert(model.gravitational_mass.end(), model.node_mass.begin() + block.node_begin,
                                  model.node_mass.end());
  model.blocks.push_back(std::move(block));
  if (!turns)
    return;
  if (model.blocks.back().star())
    raise_light_corners(model, index);
  match_convex_inertia(model, index);
}

// Zones of the seeds that have none yet, of all those of a body at once: the mesher is slow to start.
void make_zones(const Model& model, std::vector<BlockSeed>& seeds) {
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    if (model.bodies[body].zone_size == 0)
      continue;
    std::vector<BlockSeed*> fresh;
    std::vector<geom::Polyhedron> shapes;
    for (BlockSeed& seed : seeds)
      if (seed.body == body && seed.zones.tets.empty()) {
        fresh.push_back(&seed);
        shapes.push_back(seed.shape);
      }
    std::vector<geom::BlockMesh> zones = geom::zone_meshes(shapes, model.bodies[body].zone_size);
    for (std::size_t i = 0; i < fresh.size(); ++i)
      fresh[i]->zones = std::move(zones[i]);
  }
}

TetBatch make_batch(const Model& model, std::int64_t first_node, const std::vector<int>& tets) {
  TetBatch batch{};
  for (int lane = 0; lane < lanes; ++lane) {
    // A lane past the end repeats the first tet with modulus 0: it adds zeros.
    const bool used = lane < static_cast<int>(tets.size());
    const int t = tets[used ? lane : 0];
    const geom::Tet& tet = model.tets[t];
    const auto& x = model.node_position;
    const geom::Vec3 e1 = x[tet[1]] - x[tet[0]], e2 = x[tet[2]] - x[tet[0]], e3 = x[tet[3]] - x[tet[0]];
    const double six_volume = e1.dot(e2.cross(e3));
    const geom::Vec3 g[3] = {e2.cross(e3) / six_volume, e3.cross(e1) / six_volume, e1.cross(e2) / six_volume};
    const Elastic& material = model.bodies[model.blocks[model.tet_block[t]].body].material;
    for (int corner = 0; corner < 4; ++corner)
      batch.node[corner][lane] = tet[corner] - static_cast<int>(first_node);
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis)
        batch.grad[3 * k + axis][lane] = g[k][axis];
    const double volume = used ? six_volume / 6 : 0;
    batch.lambda_volume[lane] = material.lame_lambda() * volume;
    batch.two_g_volume[lane] = 2 * material.shear_modulus() * volume;
  }
  return batch;
}

// Blocks of small strain.
void add_chunks(Model& model) {
  const auto n_blocks = std::count_if(model.blocks.begin(), model.blocks.end(),
                                      [](const Block& block) { return !block.meshed; });
  for (std::int64_t begin = 0; begin < n_blocks;) {
    std::int64_t end = begin;
    const int tet_begin = model.blocks[begin].tet_begin;
    while (end < n_blocks && model.blocks[end].tet_end - tet_begin <= blocks_chunk_tets)
      ++end;
    end = std::max(end, begin + 1);
    BlockChunk chunk;
    chunk.blocks = {begin, end};
    chunk.nodes = {model.blocks[begin].node_begin, model.blocks[end - 1].node_end};
    chunk.batches.begin = static_cast<std::int64_t>(model.batches.size());
    std::vector<int> tets;
    for (int t = tet_begin; t < model.blocks[end - 1].tet_end; ++t) {
      tets.push_back(t);
      if (tets.size() == lanes || t + 1 == model.blocks[end - 1].tet_end) {
        model.batches.push_back(make_batch(model, chunk.nodes.begin, tets));
        tets.clear();
      }
    }
    chunk.batches.end = static_cast<std::int64_t>(model.batches.size());
    model.chunks.push_back(chunk);
    begin = end;
  }
}

bool moves_far(const Model& model, int body) {
  return model.bodies[body].element != Element::small_strain;
}

// The three corners of a face that span the largest triangle, in the order of its loop.
std::array<int, 3> widest_corners(const Block& block, int face) {
  const std::vector<int>& loop = block.shape.faces[face].loop;
  const auto n = static_cast<int>(loop.size());
  std::array<int, 3> best{0, 1, 2};
  double most = -1;
  for (int i = 1; i + 1 < n; ++i)
    for (int j = i + 1; j < n; ++j) {
      const auto& x = block.shape.vertices;
      const double area = (x[loop[i]] - x[loop[0]]).cross(x[loop[j]] - x[loop[0]]).squaredNorm();
      if (area > most * (1 + 1e-9)) { // not for a rounding's sake
        most = area;
        best = {0, i, j};
      }
    }
  for (int& corner : best)
    corner = block.node_begin + loop[corner];
  return best;
}

// `along` of the plane of three nodes by the two edges from the first.
std::array<double, 2> in_edges(const Model& model, const std::array<int, 3>& nodes, const geom::Vec3& along) {
  const auto& x = model.node_position;
  const geom::Vec3 e1 = x[nodes[1]] - x[nodes[0]], e2 = x[nodes[2]] - x[nodes[0]];
  const geom::Vec3 n = e1.cross(e2);
  const double n2 = n.squaredNorm();
  return {along.cross(e2).dot(n) / n2, e1.cross(along).dot(n) / n2};
}

void add_frame(Model& model, Interface& interface) {
  const Block &a = model.blocks[interface.block_a], &b = model.blocks[interface.block_b];
  if (!a.meshed && !b.meshed)
    return;
  InterfaceFrame frame;
  frame.nodes_a = widest_corners(a, interface.face_a);
  frame.nodes_b = widest_corners(b, interface.face_b);
  const geom::Vec3 edge = model.node_position[frame.nodes_a[1]] - model.node_position[frame.nodes_a[0]];
  frame.along = (edge - edge.dot(interface.normal) * interface.normal).normalized();
  frame.along_a = in_edges(model, frame.nodes_a, frame.along);
  frame.along_b = in_edges(model, frame.nodes_b, frame.along);
  double area = 0;
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    area += model.points[p].area;
  frame.size = std::sqrt(area);
  frame.area = area;
  interface.frame = static_cast<int>(model.frames.size());
  model.frames.push_back(frame);
}

// Stiffness per area of two half layers of thickness L/2 in series (Han 2010 eq 8 when the two materials are one).
void set_stiffness(const Model& model, Interface& interface) {
  const Elastic& a = model.bodies[model.blocks[interface.block_a].body].material;
  const Elastic& b = model.bodies[model.blocks[interface.block_b].body].material;
  const Joint joint = joint_of(model, interface);
  const auto series = [&](double p, double q) { return 2 / (interface.thickness * (1 / p + 1 / q)); };
  interface.kn = joint.normal_stiffness.value_or(series(a.youngs_modulus, b.youngs_modulus));
  interface.ks = joint.shear_stiffness.value_or(series(a.shear_modulus(), b.shear_modulus()));
  validate(joint, interface.kn, interface.ks);
}

// Blocks that stand behind each other are met for the first time one after the other then, when springs are worked out.
std::vector<geom::SharedFace> in_order_of_later_block(std::vector<geom::SharedFace> faces) {
  std::stable_sort(faces.begin(), faces.end(), [](const geom::SharedFace& x, const geom::SharedFace& y) {
    return x.block_b < y.block_b;
  });
  return faces;
}

std::vector<geom::Vec3> block_nodes(const Model& model, const Block& block) {
  return {model.node_position.begin() + block.node_begin, model.node_position.begin() + block.node_end};
}

// A law of its own for an interface, and for the contact that is left once its blocks have parted.
void take_joint_at(Model& model, const Block& a, const Block& b, const geom::FaceOverlap& faces,
                   InterfaceTraits& traits) {
  geom::Vec3 centroid = geom::Vec3::Zero();
  for (const geom::OverlapPoint& p : faces.points)
    centroid += p.area / faces.area * p.position;
  Joint joint = (*traits.joint_at)(centroid);
  validate(joint);
  auto base = model.surface.left_by.find(traits.joint);
  const auto own = model.surface.joint.find(std::minmax(a.body, b.body));
  const int left = base != model.surface.left_by.end() ? base->second
                   : own != model.surface.joint.end()  ? own->second
                                                       : -1;
  traits.joint = static_cast<int>(model.joints.size());
  traits.thickness = joint.thickness.value_or(joint.thickness_ratio * 0.5 * (a.first_size + b.first_size));
  traits.may_break = !joint.glued;
  if (left >= 0) {
    Joint contact = model.joints[left];
    contact.friction_angle =
        has_law(joint.law) ? geom::portable::atan2(friction_left(joint), 1) : joint.friction_angle;
    model.surface.left_by[traits.joint] = traits.joint + 1;
    model.joints.push_back(std::move(joint));
    model.joints.push_back(std::move(contact));
  } else {
    model.joints.push_back(std::move(joint));
  }
}

void add_interface(Model& model, const geom::SharedFace& pair, const InterfaceRule& rule,
                   const std::vector<geom::BlockMesh>& meshes) {
  const Block& a = model.blocks[pair.block_a];
  const Block& b = model.blocks[pair.block_b];
  Interface interface;
  interface.block_a = pair.block_a;
  interface.face_a = pair.face_a;
  interface.block_b = pair.block_b;
  interface.face_b = pair.face_b;
  interface.normal = geom::face_normal(a.shape, pair.face_a);
  const double tolerance = relative_tolerance * std::min(a.size, b.size);
  const geom::FaceOverlap faces =
      geom::overlap(block_nodes(model, a), meshes[pair.block_a].fans[pair.face_a], block_nodes(model, b),
                    meshes[pair.block_b].fans[pair.face_b], interface.normal, tolerance);
  if (faces.points.empty())
    return;

  InterfaceTraits traits = rule(model, pair.block_a, pair.face_a, pair.block_b, pair.face_b);
  if (traits.joint_at)
    take_joint_at(model, a, b, faces, traits);
  interface.id = traits.id ? traits.id : model.next_id++;
  interface.joint = traits.joint;
  interface.thickness = traits.thickness;
  interface.origin = traits.origin;
  interface.may_break = traits.may_break;
  double area = 0;
  for (const geom::OverlapPoint& p : faces.points)
    area += p.area;
  const double apart = (b.mass.centroid - a.mass.centroid).dot(interface.normal);
  interface.strength = traits.strength.value_or(
      interface_strength(model.joints[interface.joint], a.mass.centroid, b.mass.centroid, area * apart / 3));
  set_stiffness(model, interface);

  append_springs(model, static_cast<int>(model.interfaces.size()), interface, faces);
  add_frame(model, interface);
  model.interfaces.push_back(interface);
}

// A face's nodes carry the integral of their shape functions over the face less that over what other faces cover.
void add_outer_faces(Model& model, const std::vector<geom::BlockMesh>& meshes) {
  std::map<std::pair<int, int>, std::map<int, double>> covered;
  for (const Interface& interface : model.interfaces)
    for (int p = interface.point_begin; p < interface.point_end; ++p)
      for (int k = 0; k < 3; ++k) {
        const BondPoint& point = model.points[p];
        covered[{interface.block_a, interface.face_a}][point.node_a[k]] += point.area * point.weight_a[k];
        covered[{interface.block_b, interface.face_b}][point.node_b[k]] += point.area * point.weight_b[k];
      }
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    for (int f = 0; f < static_cast<int>(block.shape.faces.size()); ++f) {
      std::map<int, double> node_area;
      double area = 0;
      for (const geom::Triangle& t : meshes[b].fans[f]) {
        const geom::Vec3& x0 = model.node_position[block.node_begin + t[0]];
        const geom::Vec3& x1 = model.node_position[block.node_begin + t[1]];
        const geom::Vec3& x2 = model.node_position[block.node_begin + t[2]];
        const double triangle_area = 0.5 * (x1 - x0).cross(x2 - x0).norm();
        area += triangle_area;
        for (const int corner : t)
          node_area[block.node_begin + corner] += triangle_area / 3;
      }
      const double whole = area;
      const auto cover = covered.find({b, f});
      if (cover != covered.end())
        for (const auto& [node, covered_area] : cover->second) {
          node_area[node] -= covered_area;
          area -= covered_area;
        }
      if (area <= 1e-9 * whole)
        continue;
      OuterFace outer;
      outer.block = b;
      outer.face = f;
      outer.normal = geom::face_normal(block.shape, f);
      outer.area = area;
      outer.node_area.assign(node_area.begin(), node_area.end());
      model.outer_faces.push_back(std::move(outer));
    }
  }
}

} // namespace

geom::BlockMesh zones_of(const Model& model, int block) {
  const Block& b = model.blocks[block];
  geom::BlockMesh mesh;
  if (!b.zoned)
    return mesh;
  mesh.nodes.assign(model.node_position.begin() + b.node_begin, model.node_position.begin() + b.node_end);
  mesh.tets.assign(model.tets.begin() + b.tet_begin, model.tets.begin() + b.tet_end);
  for (geom::Tet& tet : mesh.tets)
    for (int& node : tet)
      node -= b.node_begin;
  mesh.fans.resize(b.shape.faces.size());
  mesh.fan_tets.resize(b.shape.faces.size());
  each_boundary_triangle(model, block, [&](int, const BoundaryTriangle& triangle) {
    geom::Triangle nodes = triangle.nodes;
    for (int& node : nodes)
      node -= b.node_begin;
    mesh.fans[triangle.face].push_back(nodes);
    mesh.fan_tets[triangle.face].push_back(triangle.tet - b.tet_begin);
  });
  return mesh;
}

namespace {

// The law of the joint set or cut that made two faces of two blocks of one body; -1: none of its own. If both sides
// have one, as when another joint runs along a face, that of the first block counts. A face is glued on both sides or
// not at all.
int joint_of_cut(const Body& body, const geom::PolyhedronFace& a, const geom::PolyhedronFace& b) {
  if (a.glued && b.glued)
    return body.glued_joint;
  for (const geom::PolyhedronFace* face : {&a, &b})
    if (const auto found = body.set_joint.find(face->cut); !face->glued && found != body.set_joint.end())
      return found->second;
  return -1;
}

} // namespace

InterfaceTraits default_traits(const Model& model, int block_a, int face_a, int block_b, int face_b) {
  const Block& a = model.blocks[block_a];
  const Block& b = model.blocks[block_b];
  const auto pair = std::minmax(a.body, b.body);
  const auto found = model.pair_joint.find(pair);
  if (found == model.pair_joint.end())
    throw geom::InputError(
        "contacts: bodies \"" + model.bodies[pair.first].name + "\" and \"" + model.bodies[pair.second].name +
        "\" touch but no joint between them is given; add {\"" + model.bodies[pair.first].name + "\", \"" +
        model.bodies[pair.second].name + "\", joint} or default = joint to contacts");
  InterfaceTraits traits;
  traits.joint = found->second;
  if (a.body == b.body)
    if (const int own = joint_of_cut(model.bodies[a.body], a.shape.faces[face_a], b.shape.faces[face_b]);
        own >= 0)
      traits.joint = own;
  const Joint& joint = model.joints[traits.joint];
  traits.thickness = joint.thickness.value_or(joint.thickness_ratio * 0.5 * (a.first_size + b.first_size));
  traits.may_break = !joint.glued;
  return traits;
}

namespace {

// Blocks of a body that is built for the first time are its units.
void number_units(Model& model) {
  for (const int b : blocks_by_id(model))
    if (Block& block = model.blocks[b]; block.unit == 0)
      block.unit = ++model.bodies[block.body].units;
}

} // namespace

Model build_model(const Model& frame, std::vector<BlockSeed> seeds, const InterfaceRule& rule,
                  std::vector<MeshSeed> meshes) {
  Model model;
  model.bodies = frame.bodies;
  model.joints = frame.joints;
  model.pair_joint = frame.pair_joint;
  model.next_id = frame.next_id;
  model.built_box = frame.built_box;
  model.surface.joint = frame.surface.joint;
  model.surface.within = frame.surface.within;
  model.surface.left_by = frame.surface.left_by;

  std::vector<geom::Polyhedron> shapes;
  std::vector<geom::BlockMesh> block_meshes;
  double smallest = std::numeric_limits<double>::infinity();
  shapes.reserve(seeds.size());
  block_meshes.reserve(seeds.size());
  model.blocks.reserve(seeds.size());
  for (BlockSeed& seed : seeds)
    if (seed.id == 0)
      seed.id = model.next_id++;
  // Blocks of small strain first.
  const auto far = std::stable_partition(seeds.begin(), seeds.end(),
                                         [&](const BlockSeed& seed) { return !moves_far(model, seed.body); });
  const auto small_strain = static_cast<std::size_t>(far - seeds.begin());
  make_zones(model, seeds);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (i == small_strain)
      start_meshes(model);
    BlockSeed& seed = seeds[i];
    block_meshes.push_back(seed.zones.tets.empty() ? geom::star_mesh(seed.shape) : std::move(seed.zones));
    add_block(model, std::move(seed), block_meshes.back());
    shapes.push_back(model.blocks.back().shape);
    smallest = std::min(smallest, model.blocks.back().size);
    model.blocks.back().meshed = i >= small_strain;
  }
  if (small_strain == seeds.size())
    start_meshes(model);
  for (const geom::SharedFace& pair :
       in_order_of_later_block(geom::shared_faces(shapes, relative_tolerance * smallest)))
    add_interface(model, pair, rule, block_meshes);
  add_outer_faces(model, block_meshes);
  add_chunks(model);
  add_convex_blocks(model, block_meshes);
  add_meshes(model, std::move(meshes));
  add_rigid_bodies(model);
  index_springs(model);
  build_surface(model);

  for (const Block& block : model.blocks)
    smallest = std::min(smallest, block.size);
  for (const geom::Vec3& x : model.node_position)
    model.box.extend(x);
  if (frame.blocks.empty())
    model.built_box = model.box;
  number_units(model);
  model.length = model.box.size().norm();
  model.tolerance = relative_tolerance * smallest;
  return model;
}

} // namespace cdem
