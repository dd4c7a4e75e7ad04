#include "libcdem/vtk/section.hpp"

#include "libcdem/vtk/field_values.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdem {
namespace {

Snapshot empty_copy(const Snapshot& all) {
  Snapshot s;
  s.time = all.time;
  s.step = all.step;
  s.title = all.title;
  s.body_names = all.body_names;
  return s;
}

void add_seen_from_both_sides(Snapshot& s, const geom::Triangle& t, std::int64_t cell) {
  s.surface.push_back(t);
  s.surface.push_back({t[0], t[2], t[1]});
  s.surface_tet.insert(s.surface_tet.end(), {cell, cell});
}

// Over the largest distance: nodes that are nearer to the plane lie on it. Otherwise a plane along faces of blocks would
// cut off some of their nodes and not others, and leave holes.
constexpr double rounding = 1e-9;

// Cuts tets one after the other; edges of one block are cut once. What lies on the plane counts as above it.
class Slicer {
public:
  Slicer(const Snapshot& all, const CutPlane& plane) : all_(all), section_(empty_copy(all)) {
    for (const SnapshotField& field : all.point_fields)
      section_.point_fields.push_back(
          {field.name, field.unit, field.components, {}, field.integer, field.names});
    double reach = 0; // m
    for (const geom::Vec3& x : all.points)
      reach = std::max(reach, (x - plane.point).norm());
    for (const geom::Vec3& x : all.points) {
      const double height = (x - plane.point).dot(plane.normal);
      height_.push_back(std::abs(height) < rounding * reach ? 0 : height);
    }
  }

  void cut(const geom::Tet& tet, std::int64_t cell) {
    std::vector<int> above, below;
    for (const int node : tet)
      (height_[node] >= 0 ? above : below).push_back(node);
    if (above.empty() || below.empty())
      return;
    std::vector<int> around; // places of the polygon in order
    if (above.size() == 2) {
      around = {between(above[0], below[0]), between(above[0], below[1]), between(above[1], below[1]),
                between(above[1], below[0])};
    } else {
      const int tip = above.size() == 1 ? above[0] : below[0];
      for (const int node : above.size() == 1 ? below : above)
        around.push_back(between(tip, node));
    }
    for (std::size_t i = 2; i < around.size(); ++i)
      add_seen_from_both_sides(section_, {around[0], around[i - 1], around[i]}, cell);
  }
  // Where the plane crosses a face of a block stands one of the block's edges.
  void outline(const geom::Triangle& face) {
    std::vector<int> ends;
    for (int k = 0; k < 3; ++k)
      if ((height_[face[k]] >= 0) != (height_[face[(k + 1) % 3]] >= 0))
        ends.push_back(between(face[k], face[(k + 1) % 3]));
    if (ends.size() == 2)
      section_.block_edges.push_back({ends[0], ends[1]});
  }
  Snapshot take() { return std::move(section_); }

private:
  int between(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [at, is_new] = made_.try_emplace({low, high}, static_cast<int>(section_.points.size()));
    if (!is_new)
      return at->second;
    const double part = height_[low] / (height_[low] - height_[high]);
    section_.points.push_back(all_.points[low] + part * (all_.points[high] - all_.points[low]));
    for (std::size_t f = 0; f < all_.point_fields.size(); ++f) {
      const SnapshotField& field = all_.point_fields[f];
      for (int k = 0; k < field.components; ++k) {
        const double from = field.values[static_cast<std::size_t>(low) * field.components + k],
                     to = field.values[static_cast<std::size_t>(high) * field.components + k];
        section_.point_fields[f].values.push_back(from + part * (to - from));
      }
    }
    return at->second;
  }

  const Snapshot& all_;
  Snapshot section_;
  std::vector<double> height_; // m, of the points over the plane
  std::map<std::pair<int, int>, int> made_;
};

} // namespace

Snapshot section_of(const Snapshot& all, const CutPlane& plane) {
  Slicer slicer(all, {plane.point, plane.normal.normalized()});
  for (std::size_t t = 0; t < all.tets.size(); ++t)
    slicer.cut(all.tets[t], static_cast<std::int64_t>(t));
  for (const geom::Triangle& face : all.surface)
    slicer.outline(face);
  Snapshot section = slicer.take();
  if (section.surface.empty())
    throw geom::InputError("section",
                           "point " + geom::text(plane.point) + ", normal " + geom::text(plane.normal),
                           "a plane that crosses some block");
  section.tets = all.tets; // surface_tet and the fields of tets speak of them
  section.cell_fields = all.cell_fields;
  return section;
}

namespace {

// Edges that one triangle alone has. The triangles do not share points.
std::vector<std::array<int, 2>> outline_of(const BondSnapshot& bonds) {
  using Place = std::array<double, 3>;
  std::map<std::array<Place, 2>, std::pair<int, std::array<int, 2>>> found; // how often, and the points
  for (const geom::Triangle& t : bonds.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<int, 2> ends{t[k], t[(k + 1) % 3]};
      std::array<Place, 2> places;
      for (std::size_t end = 0; end < 2; ++end)
        Eigen::Map<geom::Vec3>(places[end].data()) = bonds.points[ends[end]];
      std::sort(places.begin(), places.end());
      auto& [count, points] = found[places];
      ++count;
      points = ends;
    }
  std::vector<std::array<int, 2>> edges;
  for (const auto& [places, edge] : found)
    if (edge.first == 1)
      edges.push_back(edge.second);
  return edges;
}

} // namespace

Snapshot joints_of(const Snapshot& all) {
  Snapshot s = empty_copy(all);
  s.points = all.bonds.points;
  s.point_fields = all.bonds.point_fields;
  s.cell_fields = all.bonds.triangle_fields;
  for (std::size_t t = 0; t < all.bonds.triangles.size(); ++t)
    add_seen_from_both_sides(s, all.bonds.triangles[t], static_cast<std::int64_t>(t));
  s.block_edges = outline_of(all.bonds);
  const int first = static_cast<int>(s.points.size());
  s.points.insert(s.points.end(), all.points.begin(), all.points.end());
  for (SnapshotField& field : s.point_fields)
    if (const SnapshotField* own = find_field(all.point_fields, field.name))
      field.values.insert(field.values.end(), own->values.begin(), own->values.end());
    else
      field.values.resize(s.points.size() * static_cast<std::size_t>(field.components));
  for (const std::array<int, 2>& edge : all.outline)
    s.outline.push_back({first + edge[0], first + edge[1]});
  return s;
}

} // namespace cdem
