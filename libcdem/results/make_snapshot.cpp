#include "libcdem/results/make_snapshot.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/interface/spring_forces.hpp"
#include "libcdem/results/fields.hpp"

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

// Of one bond: 0 whole, 1 broken; a contact that was none has nothing to lose.
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

void add_cells(const Model& model, const State& state, Snapshot& snapshot) {
  const std::size_t n = model.tets.size();
  SnapshotField stress = scalar("stress", "Pa", 6 * n);
  SnapshotField principal_stress = scalar("principal_stress", "Pa", 3 * n);
  SnapshotField mises = scalar("von_mises", "Pa", n);
  SnapshotField id = scalar("block_id", "", n, true), parent = scalar("parent_id", "", n, true);
  SnapshotField generation = scalar("generation", "", n, true), body = scalar("body", "", n, true);
  SnapshotField damage = scalar("damage", "1", n);
  stress.components = 6;
  principal_stress.components = 3;
  const std::vector<double> damages = block_damage(model, state);
  for (std::size_t t = 0; t < n; ++t) {
    const int b = model.tet_block[t];
    const Block& block = model.blocks[b];
    Stress s = elastic_stress(model.bodies[block.body].material,
                              displacement_gradient(model, state.displacement, static_cast<int>(t)));
    for (int c = 0; c < 6; ++c)
      s[c] += state.initial_stress[b][c];
    const std::array<double, 3> p = principal(s);
    stress.values.insert(stress.values.end(), s.begin(), s.end());
    principal_stress.values.insert(principal_stress.values.end(), p.begin(), p.end());
    mises.values.push_back(von_mises(s));
    id.values.push_back(static_cast<double>(block.id));
    parent.values.push_back(static_cast<double>(block.parent));
    generation.values.push_back(block.generation);
    body.values.push_back(block.body);
    damage.values.push_back(damages[b]);
  }
  snapshot.cell_fields = {
      std::move(stress), std::move(principal_stress), std::move(mises), std::move(id),
      std::move(parent), std::move(generation),       std::move(body),  std::move(damage)};
}

void add_surface(const Model& model, Snapshot& snapshot) {
  for (const Block& block : model.blocks) {
    for (const auto& edge : geom::edges(block.shape))
      snapshot.block_edges.push_back({block.node_begin + edge[0], block.node_begin + edge[1]});
    // The star mesh makes one tet for each triangle of the faces' fans, corner 0 at the centroid, in the same order.
    for (int t = block.tet_begin; t < block.tet_end; ++t) {
      snapshot.surface.push_back({model.tets[t][1], model.tets[t][2], model.tets[t][3]});
      snapshot.surface_tet.push_back(t);
    }
  }
}

void add_bonds(const Model& model, const State& state, BondSnapshot& bonds) {
  const std::size_t n = model.points.size();
  bonds.points = model.point_position;
  bonds.triangles = model.bond_triangles;
  SnapshotField mode = scalar("mode", "", n, true), opening = scalar("opening", "m", n),
                slip = scalar("slip", "m", n);
  SnapshotField traction = scalar("traction", "Pa", 3 * n), displacement = scalar("displacement", "m", 3 * n);
  SnapshotField damage = scalar("damage", "1", n);
  traction.components = displacement.components = 3;
  for (std::size_t p = 0; p < n; ++p) {
    const BondPoint& point = model.points[p];
    const geom::Vec3 j = jump(point, state.displacement);
    const double normal = j.dot(point.normal);
    const geom::Vec3 t = cdem::traction(model, state, static_cast<int>(p));
    geom::Vec3 u = geom::Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Node &a = state.displacement[point.node_a[k]], &b = state.displacement[point.node_b[k]];
      u += 0.5 *
           (point.weight_a[k] * geom::Vec3(a.x, a.y, a.z) + point.weight_b[k] * geom::Vec3(b.x, b.y, b.z));
    }
    mode.values.push_back(state.bond_mode[p]);
    damage.values.push_back(damage_of(state, p));
    opening.values.push_back(normal);
    slip.values.push_back((j - normal * point.normal).norm());
    traction.values.insert(traction.values.end(), t.data(), t.data() + 3);
    displacement.values.insert(displacement.values.end(), u.data(), u.data() + 3);
  }
  bonds.point_fields = {std::move(mode), std::move(damage),   std::move(opening),
                        std::move(slip), std::move(traction), std::move(displacement)};

  SnapshotField interface_id = scalar("interface_id", "", bonds.triangles.size(), true);
  SnapshotField worst = scalar("mode", "", bonds.triangles.size(), true);
  for (const Interface& interface : model.interfaces)
    for (int t = interface.triangle_begin; t < interface.triangle_end; ++t) {
      interface_id.values.push_back(static_cast<double>(interface.id));
      const geom::Triangle& triangle = bonds.triangles[t];
      worst.values.push_back(std::max(
          {state.bond_mode[triangle[0]], state.bond_mode[triangle[1]], state.bond_mode[triangle[2]]}));
    }
  bonds.triangle_fields = {std::move(interface_id), std::move(worst)};
}

} // namespace

Snapshot make_snapshot(const Model& model, const State& state, const std::string& title) {
  Snapshot snapshot;
  snapshot.time = state.time;
  snapshot.step = state.step;
  snapshot.title = title;
  snapshot.points = model.node_position;
  snapshot.tets = model.tets;
  snapshot.point_fields = {vectors("displacement", "m", state.displacement),
                           vectors("velocity", "m/s", state.velocity)};
  add_cells(model, state, snapshot);
  add_surface(model, snapshot);
  add_bonds(model, state, snapshot.bonds);
  return snapshot;
}

} // namespace cdem
