// Bodies that are drawn without colour, or left out.
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/without_bodies.hpp"
#include "tests/vtk/sample.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include <cmath>

using namespace cdem;

TEST_CASE("what is left of a snapshot is what its other bodies alone would give") {
  const auto with_bodies = [](Snapshot s) { // each block is a body
    SnapshotField body = *std::find_if(s.cell_fields.begin(), s.cell_fields.end(),
                                       [](const SnapshotField& f) { return f.name == "block_id"; });
    body.name = "body";
    s.cell_fields.push_back(body);
    SnapshotField place{"place", "m", 3, {}};
    for (const geom::Vec3& x : s.points)
      place.values.insert(place.values.end(), x.data(), x.data() + 3);
    s.point_fields.push_back(place);
    return s;
  };
  const auto bricks = sample::grid(3, 1, 3, 1);
  const Snapshot rest = without_bodies(with_bodies(sample::blocks(bricks, 0.2)), {2, 3});
  const Snapshot alone = with_bodies(sample::blocks({bricks[0]}, 0.2));
  CHECK(rest.points == alone.points);
  CHECK(rest.tets == alone.tets);
  CHECK(rest.surface == alone.surface);
  CHECK(rest.surface_tet == alone.surface_tet);
  CHECK(rest.block_edges == alone.block_edges);
  REQUIRE(rest.point_fields.size() == alone.point_fields.size());
  CHECK(rest.point_fields.back().values == alone.point_fields.back().values);
  REQUIRE(rest.cell_fields.size() == alone.cell_fields.size());
  for (std::size_t i = 0; i < rest.cell_fields.size(); ++i)
    CHECK(rest.cell_fields[i].values == alone.cell_fields[i].values);

  // In the middle, numbers change.
  const Snapshot middle = without_bodies(with_bodies(sample::blocks(bricks, 0.2)), {1});
  for (std::size_t t = 0; t < middle.surface.size(); ++t)
    for (const int point : middle.surface[t]) {
      const geom::Tet& tet = middle.tets[static_cast<std::size_t>(middle.surface_tet[t])];
      CHECK(std::find(tet.begin(), tet.end(), point) != tet.end());
    }
  for (const geom::Vec3& x : middle.points)
    CHECK(x.x() >= 1);
}

TEST_CASE("plain bodies lose their values, others keep them") {
  Snapshot s = sample::blocks(sample::grid(2, 1, 2, 1), 1);
  const auto block = std::find_if(s.cell_fields.begin(), s.cell_fields.end(),
                                  [](const SnapshotField& f) { return f.name == "block_id"; });
  SnapshotField body = *block;
  body.name = "body"; // the two blocks are bodies 1 and 2
  SnapshotField heat{"heat", "K", 1, std::vector<double>(s.points.size(), 7.0)};
  s.cell_fields.push_back(body);
  s.point_fields.push_back(heat);
  for (const std::string name : {"heat", "block_id"}) {
    FieldValues values = field_values(s, name);
    const std::vector<double> before = values.values;
    leave_plain(s, {2}, values);
    int kept = 0, lost = 0;
    for (std::size_t t = 0; t < s.surface.size(); ++t) {
      const bool plain = body.values[static_cast<std::size_t>(s.surface_tet[t])] == 2;
      const std::size_t at = values.on_points ? static_cast<std::size_t>(s.surface[t][0]) : t;
      CHECK(std::isnan(values.values[at]) == plain);
      CHECK((plain || values.values[at] == before[at]));
      ++(plain ? lost : kept);
    }
    CHECK((kept > 0 && lost > 0));
  }
}
