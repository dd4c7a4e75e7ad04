#include "libcdem/results/cell_fields.hpp"

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/results/bond_damage.hpp"
#include "libcdem/results/empty_field.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/results/fragments.hpp"
#include "libcdem/results/joints.hpp"

#include <algorithm>

namespace cdem {
namespace {

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
      largest[block] = {std::max(largest[block][0], point.slip),
                        std::max(largest[block][1], point.utilisation)};
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
      lost[tet - model.mesh.first_tet] += has_broken(mode) ? area : 0;
    }
  });
  for (std::size_t t = 0; t < lost.size(); ++t)
    lost[t] = bonded[t] > 0 ? lost[t] / bonded[t] : 0;
  return lost;
}

// Fills one field after the other.
class CellFields {
public:
  CellFields(const std::vector<int>& tets, const WantedField& wanted) : tets_(tets), wanted_(wanted) {}

  // add(values, tet) appends what belongs to the tet.
  template <class Add>
  void fill(SnapshotField field, FieldSource from, const Add& add) {
    if (wanted_(field.name, from)) {
      field.values.reserve(tets_.size() * static_cast<std::size_t>(field.components));
      for (const int tet : tets_)
        add(field.values, tet);
    }
    fields.push_back(std::move(field));
  }
  bool wants(const std::string& name, FieldSource from) const {
    return !tets_.empty() && wanted_(name, from);
  }

  std::vector<SnapshotField> fields;

private:
  const std::vector<int>& tets_;
  const WantedField& wanted_;
};

using Values = std::vector<double>;

void add_stresses(const Model& model, const State& state, CellFields& of) {
  const auto from = FieldSource::tet;
  of.fill(empty_field("stress", "Pa", 6), from, [&](Values& values, int tet) {
    const Stress s = tet_stress(model, state, tet);
    values.insert(values.end(), s.begin(), s.end());
  });
  of.fill(empty_field("principal_stress", "Pa", 3), from, [&](Values& values, int tet) {
    const std::array<double, 3> p = principal(tet_stress(model, state, tet));
    values.insert(values.end(), p.begin(), p.end());
  });
  of.fill(empty_field("von_mises", "Pa"), from,
          [&](Values& values, int tet) { values.push_back(von_mises(tet_stress(model, state, tet))); });
}

void add_numbers(const Model& model, CellFields& of) {
  const auto from = FieldSource::model;
  const auto number = [&](const char* name, const auto& value) {
    of.fill(empty_field(name, "", 1, true), from, [&](Values& values, int tet) {
      values.push_back(static_cast<double>(value(model.tet_block[tet])));
    });
  };
  number("block_id", [&](int b) { return model.blocks[b].id; });
  number("parent_id", [&](int b) { return model.blocks[b].parent; });
  number("generation", [&](int b) { return model.blocks[b].generation; });
  number("body", [&](int b) { return model.blocks[b].body; });
  number("unit", [&](int b) { // 0 where a body was built of one block
    return model.bodies[model.blocks[b].body].units > 1 ? model.blocks[b].unit : 0;
  });
}

void add_damage(const Model& model, const State& state, CellFields& of) {
  const auto from = FieldSource::around;
  std::vector<double> blocks, meshes;
  if (of.wants("damage", from)) {
    blocks = block_damage(model, state);
    meshes = mesh_damage(model, state);
  }
  of.fill(empty_field("damage", "1"), from, [&](Values& values, int tet) {
    const int b = model.tet_block[tet];
    values.push_back(!model.blocks[b].convex() ? meshes[tet - model.mesh.first_tet] : blocks[b]);
  });
}

void add_joints(const Model& model, const State& state, CellFields& of) {
  if (model.interfaces.empty())
    return;
  const auto from = FieldSource::around;
  std::vector<std::array<double, 2>> joints;
  if (of.wants("joint_slip", from) || of.wants("joint_utilisation", from))
    joints = block_joints(model, state);
  of.fill(empty_field("joint_slip", "m"), from,
          [&](Values& values, int tet) { values.push_back(joints[model.tet_block[tet]][0]); });
  of.fill(empty_field("joint_utilisation", "1"), from,
          [&](Values& values, int tet) { values.push_back(joints[model.tet_block[tet]][1]); });
}

void add_fragments(const Model& model, const State& state, CellFields& of) {
  const auto from = FieldSource::around;
  const std::vector<int> ranks =
      of.wants("fragment", from) ? fragment_ranks(model, state) : std::vector<int>();
  of.fill(empty_field("fragment", "", 1, true), from,
          [&](Values& values, int tet) { values.push_back(ranks[model.tets[tet][0]]); });
}

} // namespace

std::vector<SnapshotField> cell_fields(const Model& model, const State& state, const std::vector<int>& tets,
                                       const WantedField& wanted) {
  CellFields of(tets, wanted);
  add_stresses(model, state, of);
  add_numbers(model, of);
  add_damage(model, state, of);
  add_joints(model, state, of);
  add_fragments(model, state, of);
  return std::move(of.fields);
}

} // namespace cdem
