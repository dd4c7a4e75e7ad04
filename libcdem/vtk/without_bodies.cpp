// Leaves bodies out of a snapshot: what stays is numbered anew, in its order.
#include "libcdem/vtk/without_bodies.hpp"

#include <algorithm>

namespace cdem {
namespace {

// The values of those places that have a new number (not -1).
SnapshotField kept_values(const SnapshotField& field, const std::vector<int>& number) {
  SnapshotField kept{field.name, field.unit, field.components, {}, field.integer, field.names};
  if (field.values.empty()) // named only
    return kept;
  const auto width = static_cast<std::size_t>(field.components);
  for (std::size_t place = 0; place < number.size(); ++place)
    if (number[place] >= 0)
      for (std::size_t k = 0; k < width; ++k)
        kept.values.push_back(field.values[place * width + k]);
  return kept;
}

template <std::size_t N>
std::array<int, N> renumbered(std::array<int, N> places, const std::vector<int>& number) {
  for (int& place : places)
    place = number[static_cast<std::size_t>(place)];
  return places;
}

// 0, 1, ... for those that stay, -1 for the others.
std::vector<int> numbers_of(const std::vector<bool>& stays) {
  std::vector<int> number(stays.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < stays.size(); ++i)
    if (stays[i])
      number[i] = next++;
  return number;
}

} // namespace

Snapshot without_bodies(const Snapshot& all, const std::vector<int>& bodies) {
  const auto is_body = [](const SnapshotField& field) { return field.name == "body"; };
  const auto body = std::find_if(all.cell_fields.begin(), all.cell_fields.end(), is_body);
  if (bodies.empty() || body == all.cell_fields.end() || all.tets.empty())
    return all;

  std::vector<bool> tet_stays(all.tets.size()), point_stays(all.points.size());
  for (std::size_t t = 0; t < all.tets.size(); ++t) {
    const auto of = static_cast<int>(body->values[t]);
    tet_stays[t] = std::find(bodies.begin(), bodies.end(), of) == bodies.end();
    if (tet_stays[t])
      for (const int point : all.tets[t])
        point_stays[static_cast<std::size_t>(point)] = true;
  }
  const std::vector<int> tet_number = numbers_of(tet_stays), point_number = numbers_of(point_stays);

  Snapshot rest;
  rest.time = all.time;
  rest.step = all.step;
  rest.title = all.title;
  rest.body_names = all.body_names;
  rest.bonds = all.bonds;
  rest.water = all.water;
  for (std::size_t i = 0; i < all.points.size(); ++i)
    if (point_stays[i])
      rest.points.push_back(all.points[i]);
  for (std::size_t t = 0; t < all.tets.size(); ++t)
    if (tet_stays[t])
      rest.tets.push_back(renumbered(all.tets[t], point_number));
  for (const SnapshotField& field : all.point_fields)
    rest.point_fields.push_back(kept_values(field, point_number));
  for (const SnapshotField& field : all.cell_fields)
    rest.cell_fields.push_back(kept_values(field, tet_number));
  for (std::size_t s = 0; s < all.surface.size(); ++s) {
    const int tet = tet_number[static_cast<std::size_t>(all.surface_tet[s])];
    if (tet < 0)
      continue;
    rest.surface.push_back(renumbered(all.surface[s], point_number));
    rest.surface_tet.push_back(tet);
  }
  for (const std::array<int, 2>& edge : all.block_edges)
    if (point_stays[static_cast<std::size_t>(edge[0])])
      rest.block_edges.push_back(renumbered(edge, point_number));
  return rest;
}

} // namespace cdem
