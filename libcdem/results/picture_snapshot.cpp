#include "libcdem/results/picture_snapshot.hpp"

#include "libcdem/model/build/add_meshes.hpp"
#include "libcdem/ranks/joined.hpp"
#include "libcdem/ranks/state_shares.hpp"
#include "libcdem/results/bond_damage.hpp"
#include "libcdem/results/bond_movement.hpp"
#include "libcdem/results/bond_surface.hpp"
#include "libcdem/results/cell_fields.hpp"
#include "libcdem/results/drawn_surface.hpp"
#include "libcdem/results/empty_field.hpp"

#include <algorithm>

namespace cdem {
namespace {

std::string base_of(const std::string& field) {
  return field.substr(0, field.find('.'));
}

void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

// Place of a number in a sorted list that holds it.
int place_in(const std::vector<int>& sorted, std::int64_t number) {
  return static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), number) - sorted.begin());
}

// Those of an ascending list that lie in the range.
template <class T>
std::vector<T> within(const std::vector<T>& ascending, Range range) {
  return {std::lower_bound(ascending.begin(), ascending.end(), range.begin),
          std::lower_bound(ascending.begin(), ascending.end(), range.end)};
}

// What this rank computes of lists that run along the model, and how the shares of all come together.
class Shares {
public:
  explicit Shares(const State& state) : shares_(state.parted.get()) {}

  // begin: a member of StateShares, the first of each rank.
  template <class T, class Begin>
  std::vector<T> own(const std::vector<T>& ascending, const Begin& begin) const {
    return shares_ ? within(ascending, shares_->own((shares_->*begin)())) : ascending;
  }
  template <class Begin>
  Range range(const Begin& begin, std::size_t all) const {
    return shares_ ? shares_->own((shares_->*begin)()) : Range{0, static_cast<std::int64_t>(all)};
  }
  template <class T>
  std::vector<T> for_all(std::vector<T> own) const {
    return shares_ ? joined(own) : own;
  }
  template <class T>
  std::vector<T> for_lead(std::vector<T> own) const {
    return shares_ ? joined_on_lead(own) : own;
  }
  bool draws() const { return !shares_ || ranks().leads(); }

private:
  const StateShares* shares_; // null: the State is whole
};

void add(std::vector<double>& values, const geom::Vec3& v) {
  values.insert(values.end(), v.data(), v.data() + 3);
}

// Fields of tets: those that the model tells of are made where the picture is drawn.
std::vector<SnapshotField> shown_cell_fields(const Model& model, const State& state, const PictureWish& wish,
                                             const std::vector<int>& tets, const Shares& shares) {
  const std::string base = base_of(wish.field);
  const auto wanted = [&](const std::string& name) {
    return name == base || (wish.stress && name == "stress");
  };
  std::vector<SnapshotField> fields = cell_fields(
      model, state, shares.own(tets, &StateShares::tet_begin),
      [&](const std::string& name, FieldSource from) { return from != FieldSource::model && wanted(name); });
  for (SnapshotField& field : fields)
    if (wanted(field.name))
      field.values = shares.for_lead(std::move(field.values));
  if (!shares.draws())
    return fields;
  std::vector<SnapshotField> of_model = cell_fields(
      model, state, tets, [](const std::string&, FieldSource from) { return from == FieldSource::model; });
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (!of_model[i].values.empty())
      fields[i] = std::move(of_model[i]);
  return fields;
}

// A face of a mesh some of whose springs have broken and none is a contact that never was bonded; or a triangle over
// springs of interfaces.
struct BrokenFace {
  std::int64_t face = 0; // batch * lanes + lane
  int mode = 0;          // of the spring that has gone furthest
};

std::vector<BrokenFace> broken_faces(const Model& model, const State& state, Range batches) {
  std::vector<BrokenFace> found;
  for (const MeshChunk& chunk : model.mesh.chunks) {
    if (chunk.face_batches.begin < batches.begin || chunk.face_batches.begin >= batches.end)
      continue;
    for (int face = 0; face < chunk.faces; ++face) {
      const auto& mode = state.faces[chunk.face_batches.begin + face / lanes].mode;
      const std::uint8_t worst =
          std::max({mode[0][face % lanes], mode[1][face % lanes], mode[2][face % lanes]});
      if (has_broken(worst))
        found.push_back({chunk.face_batches.begin * lanes + face, worst});
    }
  }
  return found;
}

class BrokenBonds {
public:
  BrokenBonds(const Model& model, const State& state, const Shares& shares)
      : model_(model), state_(state), shares_(shares) {
    bonds_.triangle_fields = {empty_field("interface_id", "", 1, true), empty_field("mode", "", 1, true)};
    bonds_.point_fields = {empty_field("displacement", "m", 3)};
    add_interfaces();
    add_faces();
  }
  BondSnapshot take() { return std::move(bonds_); }

private:
  const Model& model_;
  const State& state_;
  const Shares& shares_;
  BondSnapshot bonds_;

  void add_triangle(const geom::Triangle& points, std::int64_t interface, int mode) {
    bonds_.triangles.push_back(points);
    bonds_.triangle_fields[0].values.push_back(static_cast<double>(interface));
    bonds_.triangle_fields[1].values.push_back(mode);
  }

  void add_interfaces() {
    const Range points = shares_.range(&StateShares::point_begin, state_.bond_mode.size());
    const std::vector<std::uint8_t> mode = shares_.for_all(std::vector<std::uint8_t>(
        state_.bond_mode.begin() + points.begin, state_.bond_mode.begin() + points.end));
    const auto worst = [&](const geom::Triangle& t) {
      return std::max({mode[t[0]], mode[t[1]], mode[t[2]]});
    };
    std::vector<int> shown;
    for (const geom::Triangle& t : model_.bond_triangles)
      if (has_broken(worst(t)))
        shown.insert(shown.end(), t.begin(), t.end());
    sort_unique(shown);
    std::vector<double> movement;
    for (const int p : shares_.own(shown, &StateShares::point_begin))
      add(movement, point_movement(model_.points[p], [&](int n) { return shown_displacement(state_, n); }));
    bonds_.point_fields[0].values = shares_.for_lead(std::move(movement));
    if (!shares_.draws())
      return;
    for (const int p : shown) {
      bonds_.points.push_back(model_.point_position[p]);
      if (!state_.displacement_zero.empty())
        bonds_.points.back() +=
            point_movement(model_.points[p], [&](int n) { return state_.displacement_zero[n]; });
    }
    for (const Interface& interface : model_.interfaces)
      for (int i = interface.triangle_begin; i < interface.triangle_end; ++i)
        if (const geom::Triangle& t = model_.bond_triangles[i]; has_broken(worst(t)))
          add_triangle({place_in(shown, t[0]), place_in(shown, t[1]), place_in(shown, t[2])}, interface.id,
                       worst(t));
  }

  // The rank that owns a face knows how both of its sides move.
  void add_faces() {
    const std::vector<BrokenFace> own =
        broken_faces(model_, state_, shares_.range(&StateShares::face_begin, model_.mesh.faces.size()));
    const auto each = [&](const std::vector<BrokenFace>& list, const auto& visit) {
      std::vector<std::int64_t> places;
      places.reserve(list.size());
      for (const BrokenFace& face : list)
        places.push_back(face.face);
      auto next = list.begin();
      each_face_of(model_.mesh, places, [&](const MeshChunk& chunk, std::int64_t face) {
        for (int point = 0; point < 3; ++point)
          visit(chunk, FaceSpringPlace{face / lanes, point, static_cast<int>(face % lanes)}, *next);
        ++next;
      });
    };
    std::vector<double> movement;
    each(own, [&](const MeshChunk& chunk, const FaceSpringPlace& at, const BrokenFace&) {
      add(movement, point_movement(face_nodes(model_.mesh, chunk, at.batch, at.lane), at.point,
                                   [&](int n) { return shown_displacement(state_, n); }));
    });
    const std::vector<double> all_movement = shares_.for_lead(std::move(movement));
    std::vector<double>& displacement = bonds_.point_fields[0].values;
    displacement.insert(displacement.end(), all_movement.begin(), all_movement.end());
    each(shares_.for_lead(own), [&](const MeshChunk& chunk, const FaceSpringPlace& at,
                                    const BrokenFace& face) {
      bonds_.points.push_back(face_point(model_, chunk, at));
      if (!state_.displacement_zero.empty())
        bonds_.points.back() += point_movement(face_nodes(model_.mesh, chunk, at.batch, at.lane), at.point,
                                               [&](int n) { return state_.displacement_zero[n]; });
      if (at.point == 2) {
        const int last = static_cast<int>(bonds_.points.size()) - 1;
        add_triangle({last - 2, last - 1, last}, -1, face.mode);
      }
    });
  }
};

} // namespace

bool needs_whole(const PictureWish& wish) {
  const std::string base = base_of(wish.field);
  return base == "damage" || base == "joint_slip" || base == "joint_utilisation" || base == "fragment";
}

Snapshot make_picture_snapshot(const Model& model, const State& state, const PictureWish& wish,
                               const std::string& title) {
  const Shares shares(state);
  Snapshot all = snapshot_of(model, state, title); // over nodes and tets of the model
  add_surface(model,
              shares.for_all(opened_faces(model, state,
                                          shares.range(&StateShares::face_begin, model.mesh.faces.size()))),
              all);
  std::vector<int> tets(all.surface_tet.begin(), all.surface_tet.end()), nodes;
  sort_unique(tets);
  for (const int tet : tets)
    nodes.insert(nodes.end(), model.tets[tet].begin(), model.tets[tet].end());
  sort_unique(nodes);

  Snapshot shown = snapshot_of(model, state, title);
  shown.point_fields = {empty_field("displacement", "m", 3), empty_field("velocity", "m/s", 3)};
  for (SnapshotField& field : shown.point_fields) {
    const bool velocity = field.name == "velocity";
    if (velocity && base_of(wish.field) != "velocity")
      continue;
    std::vector<double> values;
    for (const int node : shares.own(nodes, &StateShares::node_begin))
      add(values, vec(velocity ? state.velocity[node] : shown_displacement(state, node)));
    field.values = shares.for_lead(std::move(values));
  }
  shown.cell_fields = shown_cell_fields(model, state, wish, tets, shares);
  if (wish.broken_bonds)
    shown.bonds = BrokenBonds(model, state, shares).take();
  shown.bonds.left_out = !model.points.empty() || !model.mesh.faces.empty();
  if (!shares.draws())
    return shown;

  for (const int node : nodes) {
    shown.points.push_back(model.node_position[node]);
    if (!state.displacement_zero.empty())
      shown.points.back() += vec(state.displacement_zero[node]);
  }
  const auto renumber = [&](auto corners) {
    for (int& node : corners)
      node = place_in(nodes, node);
    return corners;
  };
  for (const int tet : tets)
    shown.tets.push_back(renumber(model.tets[tet]));
  for (const geom::Triangle& triangle : all.surface)
    shown.surface.push_back(renumber(triangle));
  for (const std::int64_t tet : all.surface_tet)
    shown.surface_tet.push_back(place_in(tets, tet));
  add_edges(model, all);
  for (const std::array<int, 2>& edge : all.block_edges)
    shown.block_edges.push_back(renumber(edge));
  return shown;
}

} // namespace cdem
