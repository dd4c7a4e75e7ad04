#include "libcdem/results/make_snapshot.hpp"

#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/model/build/add_meshes.hpp"
#include "libcdem/results/bond_damage.hpp"
#include "libcdem/results/bond_movement.hpp"
#include "libcdem/results/bond_surface.hpp"
#include "libcdem/results/cell_fields.hpp"
#include "libcdem/results/drawn_surface.hpp"
#include "libcdem/results/empty_field.hpp"

#include <numeric>

namespace cdem {
namespace {

SnapshotField scalar(std::string name, std::string unit, std::size_t size, bool integer = false) {
  SnapshotField field = empty_field(std::move(name), std::move(unit), 1, integer);
  field.values.reserve(size);
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
    const geom::Vec3 moved =
        point_movement(nodes, at.point, [&](int node) { return shown_displacement(state, node); });
    geom::Vec3 before = geom::Vec3::Zero();
    if (!state.displacement_zero.empty())
      before = point_movement(nodes, at.point, [&](int node) { return state.displacement_zero[node]; });
    const std::uint8_t mode = state.faces[at.batch].mode[at.point][at.lane];
    const double damage = state.cohesive.empty() || has_broken(mode)
                              ? (has_broken(mode) ? 1 : 0)
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
  std::vector<int> tets(model.tets.size());
  std::iota(tets.begin(), tets.end(), 0);
  snapshot.cell_fields =
      cell_fields(model, state, tets, [](const std::string&, FieldSource) { return true; });
  const auto faces = static_cast<std::int64_t>(model.mesh.faces.size());
  add_surface(model, opened_faces(model, state, {0, faces}), snapshot);
  add_edges(model, snapshot);
  add_bonds(model, state, snapshot.bonds);
  return snapshot;
}

} // namespace cdem
