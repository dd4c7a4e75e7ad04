#include "libcdem/results/make_snapshot.hpp"

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/model/build/add_meshes.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libcdem/results/bond_surface.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/results/joints.hpp"
#include "libcdem/state/places.hpp"

#include <map>

namespace cdem {
namespace {

SnapshotField scalar(std::string name, std::string unit, std::size_t size, bool integer = false) {
  SnapshotField field;
  field.name = std::move(name);
  field.unit = std::move(unit);
  field.values.reserve(size);
  field.integer = integer;
  return field;
}

// Displacements since they were last set to zero, m.
std::vector<Node> shown_displacements(const State& state) {
  std::vector<Node> u(state.displacement.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = shown_displacement(state, static_cast<int>(i));
  return u;
}

SnapshotField vectors(std::string name, std::string unit, const std::vector<Node>& nodes) {
  SnapshotField field = scalar(std::move(name), std::move(unit), 3 * nodes.size());
  field.components = 3;
  for (const Node& n : nodes)
    field.values.insert(field.values.end(), {n.x, n.y, n.z});
  return field;
}

bool broken(std::uint8_t mode) {
  return mode == static_cast<std::uint8_t>(BondMode::broken_tension) ||
         mode == static_cast<std::uint8_t>(BondMode::broken_shear);
}

// Damage of one bond: 0 whole, 1 broken. A contact that never was bonded has no damage.
double damage_of(const State& state, std::size_t p) {
  if (broken(state.bond_mode[p]))
    return 1;
  return state.bond_damage.empty() || state.bond_mode[p] == static_cast<std::uint8_t>(BondMode::contact)
             ? 0
             : state.bond_damage[p];
}

// Mean damage of the bonded area around each block: the broken part of it where bonds are brittle.
std::vector<double> block_damage(const Model& model, const State& state) {
  std::vector<double> bonded(model.blocks.size(), 0.0), lost(model.blocks.size(), 0.0);
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const Interface& interface = model.interfaces[model.points[p].interface];
    if (state.bond_mode[p] == static_cast<std::uint8_t>(BondMode::contact))
      continue;
    for (const int block : {interface.block_a, interface.block_b}) {
      bonded[block] += model.points[p].area;
      lost[block] += damage_of(state, p) * model.points[p].area;
    }
  }
  for (std::size_t b = 0; b < lost.size(); ++b)
    lost[b] = bonded[b] > 0 ? lost[b] / bonded[b] : 0;
  return lost;
}

// Largest slip (m) and utilisation of the joints around each block.
std::vector<std::array<double, 2>> block_joints(const Model& model, const State& state) {
  std::vector<std::array<double, 2>> largest(model.blocks.size(), {0, 0});
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p) {
    const Interface& interface = model.interfaces[model.points[p].interface];
    const JointPoint point = joint_point(model, state, p);
    for (const int block : {interface.block_a, interface.block_b})
      largest[block] = {std::max(largest[block][0], point.slip), std::max(largest[block][1], point.use)};
  }
  return largest;
}

// Broken part of the bonds around each tet of a mesh.
std::vector<double> mesh_damage(const Model& model, const State& state) {
  std::vector<double> bonded(model.tets.size() - static_cast<std::size_t>(model.mesh.first_tet), 0.0),
      lost = bonded;
  each_face_spring(model.mesh, [&](const MeshChunk&, const FaceSpringPlace& at) {
    const FaceTets& tets = model.mesh.face_tets[at.batch * lanes + at.lane];
    const double area = model.mesh.faces[at.batch].area[at.lane];
    const std::uint8_t mode = state.faces[at.batch].mode[at.point][at.lane];
    if (mode == static_cast<std::uint8_t>(BondMode::contact))
      return;
    for (const int tet : {tets.tet_a, tets.tet_b}) {
      bonded[tet - model.mesh.first_tet] += area;
      lost[tet - model.mesh.first_tet] += broken(mode) ? area : 0;
    }
  });
  for (std::size_t t = 0; t < lost.size(); ++t)
    lost[t] = bonded[t] > 0 ? lost[t] / bonded[t] : 0;
  return lost;
}

// Number of each block among those of its body, from 1; 0 where it is the only one.
std::vector<int> shown_unit_numbers(const Model& model) {
  std::vector<int> blocks_in(model.bodies.size(), 0), number = unit_numbers(model);
  for (const Block& block : model.blocks)
    ++blocks_in[block.body];
  for (std::size_t b = 0; b < number.size(); ++b)
    if (blocks_in[model.blocks[b].body] == 1)
      number[b] = 0;
  return number;
}

void add_cells(const Model& model, const State& state, Snapshot& snapshot) {
  const std::size_t n = model.tets.size();
  SnapshotField stress = scalar("stress", "Pa", 6 * n);
  SnapshotField principal_stress = scalar("principal_stress", "Pa", 3 * n);
  SnapshotField mises = scalar("von_mises", "Pa", n);
  SnapshotField id = scalar("block_id", "", n, true), parent = scalar("parent_id", "", n, true);
  SnapshotField generation = scalar("generation", "", n, true), body = scalar("body", "", n, true);
  SnapshotField unit = scalar("unit", "", n, true);
  const std::vector<int> units = shown_unit_numbers(model);
  SnapshotField damage = scalar("damage", "1", n);
  stress.components = 6;
  principal_stress.components = 3;
  const std::vector<double> damages = block_damage(model, state), mesh_damages = mesh_damage(model, state);
  for (std::size_t t = 0; t < n; ++t) {
    const int b = model.tet_block[t];
    const Block& block = model.blocks[b];
    const Stress s = tet_stress(model, state, static_cast<int>(t));
    const std::array<double, 3> p = principal(s);
    stress.values.insert(stress.values.end(), s.begin(), s.end());
    principal_stress.values.insert(principal_stress.values.end(), p.begin(), p.end());
    mises.values.push_back(von_mises(s));
    id.values.push_back(static_cast<double>(block.id));
    parent.values.push_back(static_cast<double>(block.parent));
    generation.values.push_back(block.generation);
    body.values.push_back(block.body);
    unit.values.push_back(units[b]);
    damage.values.push_back(!block.convex() ? mesh_damages[t - model.mesh.first_tet] : damages[b]);
  }
  snapshot.cell_fields = {std::move(stress), std::move(principal_stress), std::move(mises), std::move(id),
                          std::move(parent), std::move(generation),       std::move(body),  std::move(unit),
                          std::move(damage)};
}

void add_joint_cells(const Model& model, const State& state, Snapshot& snapshot) {
  if (model.interfaces.empty())
    return;
  SnapshotField slip = scalar("joint_slip", "m", model.tets.size()),
                use = scalar("joint_utilisation", "1", model.tets.size());
  const auto joints = block_joints(model, state);
  for (const int block : model.tet_block) {
    slip.values.push_back(joints[block][0]);
    use.values.push_back(joints[block][1]);
  }
  snapshot.cell_fields.push_back(std::move(slip));
  snapshot.cell_fields.push_back(std::move(use));
}

// Edges at which the surface of a mesh turns by more than this are drawn: cos of 30 degrees.
constexpr double flat = 0.866;

bool opened(const FaceStateBatch& state, int lane) {
  for (const auto& point : state.mode)
    if (is_intact(point[lane]))
      return false;
  return true;
}

// The outer faces of meshes and zoned blocks, both sides of faces whose three springs have broken, and sharp edges.
void add_mesh_surface(const Model& model, const State& state, Snapshot& snapshot) {
  struct Side {
    geom::Vec3 normal;
    int face; // of a zoned block
  };
  std::map<std::array<int, 2>, Side> first_at; // the first triangle that has the edge
  for (const BoundaryTriangle& triangle : model.mesh.boundary) {
    if (model.blocks[triangle.block].star())
      continue; // add_surface
    snapshot.surface.push_back(triangle.nodes);
    snapshot.surface_tet.push_back(triangle.tet);
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
      if (!first && (found->second.normal.dot(normal) < flat || found->second.face != triangle.face))
        snapshot.block_edges.push_back(ends);
    }
  }
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!opened(state.faces[batch], lane))
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    const FaceTets& tets = model.mesh.face_tets[batch * lanes + lane];
    snapshot.surface.push_back(nodes.a);
    snapshot.surface_tet.push_back(tets.tet_a);
    snapshot.surface.push_back(nodes.outward_b());
    snapshot.surface_tet.push_back(tets.tet_b);
  });
}

void add_surface(const Model& model, Snapshot& snapshot) {
  for (const Block& block : model.blocks) {
    if (!block.star())
      continue;
    for (const auto& edge : geom::edges(block.shape))
      snapshot.block_edges.push_back({block.node_begin + edge[0], block.node_begin + edge[1]});
    // The star mesh makes one tet for each triangle of the faces' fans, corner 0 at the centroid, in the same order.
    for (int t = block.tet_begin; t < block.tet_end; ++t) {
      snapshot.surface.push_back({model.tets[t][1], model.tets[t][2], model.tets[t][3]});
      snapshot.surface_tet.push_back(t);
    }
  }
}

// Bond fields, filled spring by spring.
struct BondFields {
  explicit BondFields(std::size_t n)
      : mode(scalar("mode", "", n, true)), damage(scalar("damage", "1", n)),
        opening(scalar("opening", "m", n)), slip(scalar("slip", "m", n)),
        traction(scalar("traction", "Pa", 3 * n)), displacement(scalar("displacement", "m", 3 * n)) {
    traction.components = displacement.components = 3;
  }
  SnapshotField mode, damage, opening, slip, traction, displacement;

  void add(std::uint8_t bond_mode, double lost, const geom::Vec3& jump, const geom::Vec3& normal,
           const geom::Vec3& pull, const geom::Vec3& moved) {
    const double open = jump.dot(normal);
    mode.values.push_back(bond_mode);
    damage.values.push_back(lost);
    opening.values.push_back(open);
    slip.values.push_back((jump - open * normal).norm());
    traction.values.insert(traction.values.end(), pull.data(), pull.data() + 3);
    displacement.values.insert(displacement.values.end(), moved.data(), moved.data() + 3);
  }
};

// Where a spring's point has moved, m: the mean of its two sides. u(node): displacement.
template <class Displacement>
geom::Vec3 point_movement(const BondPoint& point, const Displacement& u) {
  geom::Vec3 moved = geom::Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    moved +=
        0.5 * (point.weight_a[k] * vec(u(point.node_a[k])) + point.weight_b[k] * vec(u(point.node_b[k])));
  return moved;
}

void add_springs(const Model& model, const State& state, BondFields& fields, BondSnapshot& bonds) {
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const BondPoint& point = model.points[p];
    const geom::Vec3 moved = point_movement(point, [&](int node) { return shown_displacement(state, node); });
    if (!state.displacement_zero.empty())
      bonds.points[p] += point_movement(point, [&](int node) { return state.displacement_zero[node]; });
    fields.add(state.bond_mode[p], damage_of(state, p), movement_past(model, state, static_cast<int>(p)),
               point.normal, traction(model, state, static_cast<int>(p)), moved);
  }
}

void add_face_springs(const Model& model, const State& state, BondFields& fields, BondSnapshot& bonds) {
  if (model.mesh.faces.empty())
    return;
  const std::vector<Node> position = present_places(model, state);
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    const FaceBatch& batch = model.mesh.faces[at.batch];
    const FaceNodes nodes = face_nodes(model.mesh, chunk, at.batch, at.lane);
    const FaceSpring spring = face_point_response(model, state, position, chunk, at);
    geom::Vec3 moved = geom::Vec3::Zero(), before = geom::Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Node a = shown_displacement(state, nodes.a[k]), b = shown_displacement(state, nodes.b[k]);
      const double weight = 0.5 * (k == at.point ? 2.0 / 3 : 1.0 / 6);
      moved += weight * geom::Vec3(a.x + b.x, a.y + b.y, a.z + b.z);
      if (!state.displacement_zero.empty())
        before +=
            weight * (vec(state.displacement_zero[nodes.a[k]]) + vec(state.displacement_zero[nodes.b[k]]));
    }
    const std::uint8_t mode = state.faces[at.batch].mode[at.point][at.lane];
    const double damage = state.cohesive.empty() || broken(mode)
                              ? (broken(mode) ? 1 : 0)
                              : state.cohesive[at.batch * lanes + at.lane].damage[at.point];
    fields.add(mode, damage, spring.gap, spring.normal, spring.force / batch.area[at.lane], moved);
    bonds.points.push_back(face_point(model, chunk, at) + before);
    if (at.point == 2) {
      const int last = static_cast<int>(bonds.points.size()) - 1;
      bonds.triangles.push_back({last - 2, last - 1, last});
    }
  });
}

void add_bonds(const Model& model, const State& state, BondSnapshot& bonds) {
  bonds.points = model.point_position;
  bonds.triangles = model.bond_triangles;
  BondFields fields(model.points.size() + 3 * model.mesh.face_tets.size());
  add_springs(model, state, fields, bonds);
  add_face_springs(model, state, fields, bonds);

  SnapshotField interface_id = scalar("interface_id", "", bonds.triangles.size(), true);
  SnapshotField worst = scalar("mode", "", bonds.triangles.size(), true);
  for (const Interface& interface : model.interfaces)
    interface_id.values.insert(interface_id.values.end(), interface.triangle_end - interface.triangle_begin,
                               static_cast<double>(interface.id));
  // Faces of a mesh have no interface: -1.
  interface_id.values.resize(bonds.triangles.size(), -1);
  for (const geom::Triangle& t : bonds.triangles)
    worst.values.push_back(
        std::max({fields.mode.values[t[0]], fields.mode.values[t[1]], fields.mode.values[t[2]]}));
  bonds.triangle_fields = {std::move(interface_id), std::move(worst)};
  bonds.point_fields = {std::move(fields.mode), std::move(fields.damage),   std::move(fields.opening),
                        std::move(fields.slip), std::move(fields.traction), std::move(fields.displacement)};
}

} // namespace

Snapshot make_snapshot(const Model& model, const State& state, const std::string& title) {
  Snapshot snapshot = snapshot_of(model, state, title);
  snapshot.points = model.node_position;
  for (std::size_t i = 0; i < state.displacement_zero.size(); ++i)
    snapshot.points[i] += vec(state.displacement_zero[i]);
  snapshot.tets = model.tets;
  snapshot.point_fields = {vectors("displacement", "m", shown_displacements(state)),
                           vectors("velocity", "m/s", state.velocity)};
  add_cells(model, state, snapshot);
  add_joint_cells(model, state, snapshot);
  add_surface(model, snapshot);
  add_mesh_surface(model, state, snapshot);
  add_bonds(model, state, snapshot.bonds);
  return snapshot;
}

} // namespace cdem
