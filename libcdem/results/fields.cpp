#include "libcdem/results/fields.hpp"

#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/nearest.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

struct FieldName {
  const char* name;
  bool nodal;
};

constexpr FieldName all_fields[] = {
    {"displacement.x", true},      {"displacement.y", true},
    {"displacement.z", true},      {"displacement.magnitude", true},
    {"velocity.x", true},          {"velocity.y", true},
    {"velocity.z", true},          {"velocity.magnitude", true},
    {"stress.xx", false},          {"stress.yy", false},
    {"stress.zz", false},          {"stress.xy", false},
    {"stress.yz", false},          {"stress.xz", false},
    {"principal_stress.1", false}, {"principal_stress.2", false},
    {"principal_stress.3", false}, {"von_mises", false},
};

const FieldName& find_field(const std::string& name) {
  for (const FieldName& field : all_fields)
    if (field.name == name)
      return field;
  const std::vector<std::string> names = field_names();
  std::string list;
  for (const std::string& known : names)
    list += (list.empty() ? "" : " ") + known;
  const std::string near = geom::nearest(name, names);
  throw geom::InputError("field", "\"" + name + "\"", "one of " + list,
                         near.empty() ? near : "did you mean \"" + near + "\"?");
}

double vector_component(const Node& n, const std::string& component) {
  if (component == "x")
    return n.x;
  if (component == "y")
    return n.y;
  if (component == "z")
    return n.z;
  return std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

Node nodal_vector(const State& state, const std::string& field, int node) {
  return field[0] == 'd' ? shown_displacement(state, node) : state.velocity[node];
}

std::string component_of(const std::string& field) {
  return field.substr(field.find('.') + 1);
}

double node_value(const State& state, const std::string& field, int node) {
  return vector_component(nodal_vector(state, field, node), component_of(field));
}

// Where a field of stress has one value: a convex block (its volume mean), or a tet of a mesh.
struct Cell {
  int block = 0;
  int tet = -1; // of a mesh
};

double cell_value(const Model& model, const State& state, const std::string& field, const Cell& cell) {
  const Stress stress =
      cell.tet < 0 ? block_stress(model, state, cell.block) : tet_stress(model, state, cell.tet);
  if (field == "von_mises")
    return von_mises(stress);
  const std::string component = component_of(field);
  if (field[0] == 'p')
    return principal(stress)[component[0] - '1'];
  static const char* const components[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  const auto found = std::find(std::begin(components), std::end(components), component);
  return stress[found - std::begin(components)];
}

geom::Vec3 cell_place(const Model& model, const Cell& cell) {
  if (cell.tet < 0)
    return model.blocks[cell.block].mass.centroid;
  geom::Vec3 centre = geom::Vec3::Zero();
  for (const int node : model.tets[cell.tet])
    centre += 0.25 * model.node_position[node];
  return centre;
}

double cell_volume(const Model& model, const Cell& cell) {
  return cell.tet < 0 ? model.blocks[cell.block].mass.volume : tet_volume(model, cell.tet);
}

// Star blocks and tets by their centroid; a side, or a name of faces, selects those that have a face there.
std::vector<Cell> selected_cells(const Model& model, const Selection& on) {
  std::vector<Cell> cells;
  const bool by_faces = on.kind == Selection::Kind::side || on.kind == Selection::Kind::faces;
  std::vector<char> on_side(by_faces ? model.tets.size() : 0, 0);
  if (!on_side.empty())
    for (const int f : selected_outer_faces(model, on)) {
      const OuterFace& face = model.outer_faces[f];
      if (face.boundary >= 0)
        on_side[model.mesh.boundary[face.boundary].tet] = 1;
      else if (model.blocks[face.block].zoned)
        each_boundary_triangle(model, face.block, [&](int, const BoundaryTriangle& triangle) {
          if (triangle.face == face.face)
            on_side[triangle.tet] = 1;
        });
    }
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    if (block.star()) {
      if (selects_block(model, on, b))
        cells.push_back({b, -1});
      continue;
    }
    for (int t = block.tet_begin; t < block.tet_end; ++t)
      if (on_side.empty() ? selects_place(model, on, cell_place(model, {b, t}), b) : on_side[t] != 0)
        cells.push_back({b, t});
  }
  return cells;
}

[[noreturn]] void nothing_there(const Selection& on, const char* what) {
  throw geom::InputError("on", on.text, std::string("a place that holds ") + what,
                         "nothing of the model lies there");
}

} // namespace

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const FieldName& field : all_fields)
    names.emplace_back(field.name);
  return names;
}

void check_field(const std::string& field) {
  find_field(field);
}

std::array<double, 3> principal(const Stress& stress) {
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(matrix(stress), Eigen::EigenvaluesOnly);
  const geom::Vec3& e = solver.eigenvalues();
  return {e[2], e[1], e[0]};
}

double von_mises(const Stress& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

std::vector<FieldValue> values(const Model& model, const State& state, const std::string& field,
                               const Selection& on) {
  std::vector<FieldValue> list;
  if (find_field(field).nodal) {
    for (const int node : selected_nodes(model, on))
      list.push_back({node_value(state, field, node), model.node_position[node],
                      model.blocks[block_of(model, node)].id});
    if (list.empty())
      nothing_there(on, "nodes");
  } else {
    for (const Cell& cell : selected_cells(model, on))
      list.push_back(
          {cell_value(model, state, field, cell), cell_place(model, cell), model.blocks[cell.block].id});
    if (list.empty())
      nothing_there(on, "block centroids, or a side");
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const FieldValue& a, const FieldValue& b) { return a.block < b.block; });
  return list;
}

double mean_value(const Model& model, const State& state, const std::string& field, const Selection& on) {
  double sum = 0, weight = 0;
  const auto add = [&](double value, double w) {
    sum += w * value;
    weight += w;
  };
  if (!find_field(field).nodal) {
    for (const Cell& cell : selected_cells(model, on))
      add(cell_value(model, state, field, cell), cell_volume(model, cell));
    if (weight == 0)
      nothing_there(on, "block centroids, or a side");
    return sum / weight;
  }
  if (on.kind == Selection::Kind::side || on.kind == Selection::Kind::plane ||
      on.kind == Selection::Kind::faces)
    for (const int f : selected_outer_faces(model, on))
      each_face_node(model, model.outer_faces[f],
                     [&](int node, double area) { add(node_value(state, field, node), area); });
  if (weight > 0)
    return sum / weight;
  for (const int node : selected_nodes(model, on))
    add(node_value(state, field, node), node_volume(model, node));
  if (weight == 0)
    nothing_there(on, "nodes");
  return sum / weight;
}

std::optional<double> value_at(const Model& model, const State& state, const std::string& field,
                               const geom::Vec3& place, const TetsByPlace& tets) {
  const bool nodal = find_field(field).nodal;
  const std::optional<PlaceInTet> at = tets.find(model, place);
  if (!at)
    return std::nullopt;
  if (!nodal)
    return cell_value(model, state, field, {at->block, model.blocks[at->block].star() ? -1 : at->tet});
  // The vector is interpolated and then measured: its length at the nodes says little about that between them.
  Node value;
  for (int k = 0; k < 4; ++k) {
    const Node n = nodal_vector(state, field, model.tets[at->tet][k]);
    value.x += at->weight[k] * n.x;
    value.y += at->weight[k] * n.y;
    value.z += at->weight[k] * n.z;
  }
  return vector_component(value, component_of(field));
}

double value_at(const Model& model, const State& state, const std::string& field, const geom::Vec3& place) {
  if (const auto value = value_at(model, state, field, place, *tets_by_place(model)))
    return *value;
  throw geom::InputError("at", geom::shown(place),
                         "a place inside a block; the model's box is from " + geom::shown(model.box.min) +
                             " to " + geom::shown(model.box.max) + " m");
}

} // namespace cdem
