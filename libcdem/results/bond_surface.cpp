#include "libcdem/results/bond_surface.hpp"

#include "libcdem/state/places.hpp"

namespace cdem {
namespace {

SnapshotField field(const char* name, const char* unit, int components, bool integer) {
  SnapshotField f;
  f.name = name;
  f.unit = unit;
  f.components = components;
  f.integer = integer;
  return f;
}

} // namespace

BondSurface::BondSurface(const std::vector<Column>& columns) {
  faces.point_fields = {field("displacement", "m", 3, false)};
  for (const Column& column : columns)
    faces.triangle_fields.push_back(field(column.name, column.unit, 1, column.integer));
}

void BondSurface::add(const Corners& corners, const std::vector<double>& row) {
  const int first = static_cast<int>(faces.points.size());
  faces.triangles.push_back({first, first + 1, first + 2});
  for (const auto& [place, moved] : corners) {
    faces.points.push_back(place);
    auto& values = faces.point_fields[0].values;
    values.insert(values.end(), moved.data(), moved.data() + 3);
  }
  for (std::size_t i = 0; i < faces.triangle_fields.size(); ++i)
    faces.triangle_fields[i].values.push_back(row[i]);
}

BondSurface::Corners spring_corners(const Model& model, const State& state, const geom::Triangle& triangle) {
  BondSurface::Corners corners;
  for (int i = 0; i < 3; ++i) {
    const BondPoint& point = model.points[triangle[i]];
    geom::Vec3 moved = geom::Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      moved += 0.5 * (point.weight_a[k] * vec(state.displacement[point.node_a[k]]) +
                      point.weight_b[k] * vec(state.displacement[point.node_b[k]]));
    corners[i] = {model.point_position[triangle[i]], moved};
  }
  return corners;
}

Snapshot snapshot_of(const Model& model, const State& state, const std::string& title) {
  Snapshot snapshot;
  snapshot.time = state.time;
  snapshot.step = state.step;
  snapshot.title = title;
  for (const Body& body : model.bodies)
    snapshot.body_names.push_back(body.name);
  return snapshot;
}

} // namespace cdem
