// Water tables that are not level: their height, the pressure below them in joints and on faces.
#include "tests/libcdem/system.hpp"
#include "tests/support/refusal.hpp"

#include "libcdem/load/water.hpp"
#include "libcdem/load/water_table.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/discs.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

constexpr double unit_weight = 9810; // N/m3, of water

using Table = std::shared_ptr<const cdem::WaterTable>;

cdem::Water under(const Table& table) {
  cdem::Water water;
  water.table = table;
  return water;
}

// What the water does to a body whose faces it meets: its force, N.
Vec3 force_on(const geom::Assembly& blocks, const Table& table) {
  System s(build({body("rock", blocks)}));
  cdem::Traction water;
  water.on = cdem::Selection::everything();
  water.pressure = cdem::FacePressure{{}, unit_weight, {}, table};
  s.conditions.tractions = {water};
  const cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  Vec3 sum = Vec3::Zero();
  for (const cdem::Node& force : r.external)
    sum += vec(force);
  return sum;
}

// The plane as two triangles or many, wide around a place.
geom::Surface triangles_of(const cdem::WaterTable& table, const Vec3& centre, double half, int n) {
  geom::Surface surface;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      Vec3 x = centre + half * Vec3(2.0 * i / n - 1, 2.0 * j / n - 1, 0);
      x.z() = *table.height(x);
      surface.points.push_back(x);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      surface.triangles.push_back({a, b, b + 1});
      surface.triangles.push_back({a, b + 1, a + 1});
    }
  return surface;
}

} // namespace

TEST_CASE("a plane falls towards its dip direction by the tangent of its dip", "[water]") {
  const Vec3 point(1e5, -3e4, 250);
  const double dip = 12 * degree;
  for (const double direction : {0.0, 37.0, 90.0, 200.0, 360.0}) {
    const Table table = cdem::water_plane(point, dip, direction * degree);
    const Vec3 along(std::sin(direction * degree), std::cos(direction * degree), 0),
        across(-along.y(), along.x(), 0);
    CHECK(*table->height(point) == Approx(250));
    CHECK(*table->height(point + 50 * along) == Approx(250 - 50 * std::tan(dip)));
    CHECK(*table->height(point + 50 * across + Vec3(0, 0, -80)) == Approx(250));
  }
}

TEST_CASE("a profile is straight between its rows, level beyond and the same across", "[water]") {
  const Table table = cdem::water_profile({{0, 10}, {20, 6}, {30, 5}}, {100, 50, 0}, {0, 2, 0});
  CHECK(*table->height({7, 60, -3}) == Approx(8));
  CHECK(*table->height({100, 75, 0}) == Approx(5.5));
  CHECK(*table->height({100, 0, 0}) == 10);
  CHECK(*table->height({100, 90, 0}) == 5);
  CHECK(*table->height({0, 70, 0}) == Approx(6));
}

TEST_CASE("a surface of triangles has the height of the plane that it lies in, and ends", "[water]") {
  const Vec3 centre(500, -200, 30);
  const Table plane = cdem::water_plane(centre, 9 * degree, 133 * degree);
  for (const int n : {1, 7, 40}) {
    const Table surface = cdem::water_surface(triangles_of(*plane, centre, 10, n));
    for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(9.9, -9.9, 3), Vec3(-10, 10, 0), Vec3(3.3, 7.1, 0)})
      CHECK(*surface->height(centre + offset) == Approx(*plane->height(centre + offset)));
    CHECK_FALSE(surface->height(centre + Vec3(10.1, 0, 0)));
  }
}

TEST_CASE("a body under a sloping table takes the weight of its wet volume times (tan of the slope, 1)",
          "[water][reservoir]") {
  geom::VoronoiOptions cells;
  cells.size = {1, 0.8, 0.6};
  cells.count = 12;
  const geom::Assembly blocks = geom::rotated(geom::voronoi(cells), {1, 2, 3}, 0.8, {0.5, 0.4, 0.3});
  const double dip = 20 * degree, direction = 65 * degree;
  for (const double z : {5.0, 0.4}) { // all of it under water, a part of it
    const Vec3 point(0.5, 0.4, z);
    double wet = 0;
    for (const geom::Polyhedron& block : blocks.blocks)
      if (const auto part =
              geom::cut(block, geom::Plane::through(point, geom::normal_of_dip(dip, direction))).below)
        wet += geom::mass_properties(part->shape).volume;
    REQUIRE(wet > 0.1);
    const Vec3 expected =
        unit_weight * wet * Vec3(std::tan(dip) * std::sin(direction), std::tan(dip) * std::cos(direction), 1);
    const Table plane = cdem::water_plane(point, dip, direction);
    CHECK((force_on(blocks, plane) - expected).norm() < 1e-9 * unit_weight);
    // The same plane as triangles: at the water line to the size of a triangle's parts.
    const Vec3 triangles = force_on(blocks, cdem::water_surface(triangles_of(*plane, point, 3, 5)));
    CHECK((triangles - expected).norm() < (z > 1 ? 1e-9 * unit_weight : 1e-3 * expected.norm()));
  }
}

TEST_CASE("a level joint under a sloping table has weight times the mean depth, in joints as on faces",
          "[water]") {
  geom::PlaneCutOptions seam;
  seam.name = "seam";
  const geom::Assembly column =
      geom::cut_by_plane(geom::grid({2, 1, 2}, {8, 1, 1}), geom::Plane::through({0, 0, 1}, {0, 0, 1}), seam);
  const auto element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  cdem::BodySpec spec = body("rock", column);
  spec.element = element;
  cdem::ModelSpec model;
  model.bodies = {spec};
  cdem::Simulation s(model, 1, nullptr);
  const auto force_under = [&](const Table& table) {
    cdem::Water water = under(table);
    water.sets = {"seam"};
    return s.water(water).force;
  };
  // Falls from 1.9 m at x = 0 to 1.1 m at x = 2: 0.5 m deep on the mean, all of it wet.
  CHECK(force_under(cdem::water_plane({0, 0, 1.9}, std::atan(0.4), 90 * degree)) ==
        Approx(unit_weight * 0.5 * 2));
  CHECK(s.joints({{"seam"}, {}}).at(0).water == Approx(unit_weight * 0.5));
  CHECK(force_under(cdem::water_profile({{0, 1.9}, {2, 1.1}}, Vec3::Zero(), {1, 0, 0})) ==
        Approx(unit_weight * 0.5 * 2));
  // Dry from x = 1 on: a triangle of pressure, to the size of the parts of triangles that it is taken at.
  CHECK(force_under(cdem::water_plane({1, 0, 1}, std::atan(0.4), 90 * degree)) ==
        Approx(unit_weight * 0.5 * 0.4).epsilon(0.002));
}

TEST_CASE("pictures show the table of water that stands in joints, until it is taken away", "[water]") {
  cdem::ModelSpec model;
  model.bodies = {body("rock", geom::grid({2, 1, 2}, {2, 1, 2}))};
  cdem::Simulation s(model, 1, nullptr);
  const auto sheets = [&] { return s.picture_snapshot({}, "").water; };
  CHECK(sheets().empty());
  const Table table = cdem::water_profile({{0, 1.6}, {2, 1.2}}, Vec3::Zero(), {1, 0, 0});
  s.water(under(table));
  const std::vector<cdem::WaterSheet> shown = sheets();
  REQUIRE(shown.size() == 1);
  for (const Vec3& x : shown[0].points)
    CHECK(x.z() == Approx(*table->height(x)));
  CHECK(s.copy().picture_snapshot({}, "").water.size() == 1);
  cdem::Water lower;
  lower.level = 0.7;
  s.water(lower); // in the place of the other, everywhere
  REQUIRE(sheets().size() == 1);
  CHECK(sheets()[0].points.front().z() == Approx(0.7));
  cdem::Water none;
  none.pressure = [](const Vec3&) { return 0; };
  s.water(none);
  CHECK(sheets().empty());
}

TEST_CASE("water tables that are none are refused", "[water][input]") {
  CHECK_THAT(refusal([] { cdem::water_plane({0, 0, 0}, 90 * degree, 0); }), Contains("dip"));
  CHECK_THAT(refusal([] { cdem::water_profile({{0, 1}}, {}, {1, 0, 0}); }), Contains("at least two rows"));
  CHECK_THAT(refusal([] {
               cdem::water_profile({{0, 1}, {0, 2}}, {0, 0, 0}, {1, 0, 0});
             }),
             Contains("profile[2] = 0: must be beyond the distance of the row before, 0 m"));
  CHECK_THAT(refusal([] {
               cdem::water_profile({{0, 1}, {1, 2}}, {0, 0, 0}, {1, 0, 1});
             }),
             Contains("direction") && Contains("horizontal"));
  geom::Surface upright;
  upright.points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}};
  upright.triangles = {{0, 1, 2}};
  CHECK_THAT(refusal([&] { cdem::water_surface(upright); }), Contains("upright"));
  geom::Surface twice;
  twice.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 1}, {4, 0, 1}, {0, 4, 1}};
  twice.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Table folded = cdem::water_surface(twice);
  CHECK_THAT(refusal([&] { folded->height({1, 1, 0}); }), Contains("lies twice over (1, 1) m"));
  cdem::Simulation s = simulation(geom::grid({2, 1, 2}, {2, 1, 2}));
  const Table plane = cdem::water_plane({0, 0, 1.5}, 5 * degree, 0);
  CHECK_THAT(refusal([&] {
               s.water(under(cdem::water_surface(triangles_of(*plane, {0, 0, 0}, 0.2, 1))));
             }),
             Contains("its surface ends before") && Contains("larger than the model"));
  CHECK_THAT(refusal([&] {
               s.water(under(cdem::water_plane({0, 0, -5}, 0, 0)));
             }),
             Contains("below all joints"));
}
