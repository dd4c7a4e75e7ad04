// The free surface of water as pictures show it: it is the field's, covers what is wet, and ends at the water line.
#include "libcdem/results/free_surface.hpp"
#include "libcdem/water/plain_water.hpp"
#include "libcdem/water/slope_water.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "libgeom/core/error.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using geom::Vec3;

namespace {

double area_seen_from_above(const cdem::WaterSheet& sheet) {
  double sum = 0;
  for (const geom::Triangle& t : sheet.triangles) {
    const Vec3 &a = sheet.points[t[0]], &b = sheet.points[t[1]], &c = sheet.points[t[2]];
    const double up = 0.5 * (b - a).cross(c - a).z();
    CHECK(up >= 0);
    sum += up;
  }
  return sum;
}

std::shared_ptr<const cdem::SlopeWater> still_on_slope(const Vec3& direction) {
  cdem::SlopeGiven given;
  given.bed = {{-20, -4}, {0, -4}, {40, 16}}; // 1:2 from x = 0; level 0 meets it at x = 8
  given.duration = 1;
  given.cell = 0.1;
  given.entering = [](double) { return 0.; };
  given.direction = direction;
  return std::make_shared<cdem::SlopeWater>(given);
}

} // namespace

TEST_CASE("the sheet of a wave has the field's height and covers the rectangle, far from the origin too",
          "[water]") {
  const Vec3 far(4000, -3000, 120);
  cdem::WaveGiven given;
  given.height = 1;
  given.length = 20;
  given.depth = 5;
  given.level = far.z();
  given.direction = {1, 1, 0};
  given.crest_at = far;
  const cdem::WaveField wave(given);
  const cdem::WaterSheet sheet = cdem::free_surface(wave, 0.7, {far, far + Vec3(30, 10, 4)});
  REQUIRE(!sheet.points.empty());
  CHECK(sheet.shore.empty());
  CHECK(area_seen_from_above(sheet) == Approx(300).epsilon(1e-9));
  for (std::size_t i = 0; i < sheet.points.size(); ++i) {
    const Vec3& x = sheet.points[i];
    const cdem::WaterPoint water = wave.at(x, 0.7);
    CHECK(x.z() == Approx(water.surface).margin(1e-9));
    CHECK((sheet.velocity[i] - water.velocity).norm() < 1e-9);
    CHECK(sheet.height_at(x.x(), x.y()) == Approx(x.z()).margin(1e-6));
  }
  CHECK(std::isnan(sheet.height_at(far.x() - 1, far.y())));
}

TEST_CASE("the sheet over a model that lies deep has the velocity of the surface", "[water]") {
  cdem::WaveGiven given;
  given.height = 1.5;
  given.period = 5;
  given.depth = 9;
  const cdem::WaveField wave(given);
  const cdem::WaterSheet sheet = cdem::free_surface(wave, 0.3, {{-2, 0, -9}, {3, 1, -8}});
  REQUIRE(!sheet.points.empty());
  for (std::size_t i = 0; i < sheet.points.size(); ++i)
    CHECK((sheet.velocity[i] - wave.at(sheet.points[i], 0.3).velocity).norm() < 1e-12);
}

TEST_CASE("the sheet ends at the water line, whichever way the slope looks", "[water]") {
  const auto [direction, seen] =
      GENERATE(table<Vec3, Vec3>({{{1, 0, 0}, {1, 0, 0}}, {{0, -1, 0}, {0, -1, 0}}}));
  const auto water = still_on_slope(direction);
  const Vec3 across(-seen.y(), seen.x(), 0);
  geom::Box box; // 10 m along the slope, 3 m across: the line of level 0 at 8 m
  for (const double s : {0., 10.})
    for (const double c : {0., 3.})
      box.extend(s * seen + c * across + Vec3(0, 0, 0.2 * s - 1));
  const cdem::WaterSheet sheet = cdem::free_surface(*water, 0.5, box);
  CHECK(area_seen_from_above(sheet) ==
        Approx(24).epsilon(1e-3)); // films under a thousandth of the depth are dry
  REQUIRE(!sheet.shore.empty());
  for (const auto& edge : sheet.shore)
    for (const int p : edge) {
      CHECK(sheet.points[p].dot(seen) == Approx(8).margin(0.02));
      CHECK(sheet.points[p].z() == Approx(0).margin(1e-9));
    }
}

TEST_CASE("water without a surface has no sheet, and a dry place an empty one", "[water]") {
  const geom::Box box{{30, 0, 12}, {35, 3, 14}}; // far up the slope
  const cdem::WaterSheet dry = cdem::free_surface(*still_on_slope({1, 0, 0}), 0.5, box);
  CHECK(dry.size[0] > 0);
  CHECK(dry.points.empty());
  cdem::UniformWater stream;
  stream.velocity = [](double) { return Vec3(2, 0, 0); };
  CHECK(cdem::free_surface(*cdem::uniform_water(stream), 0, box).size[0] == 0);
}

TEST_CASE("there is no sheet where and when the field is not known", "[water]") {
  const geom::Box box{{0, 0, -1}, {10, 3, 1}};
  CHECK(cdem::free_surface(*still_on_slope({1, 0, 0}), 7, box).points.empty()); // known up to 1 s
  cdem::FunctionWater half;
  half.velocity = [](const Vec3&, double) { return Vec3(Vec3::Zero()); };
  half.surface = [](const Vec3& x, double) {
    if (x.x() > 4.0002)
      throw geom::InputError("known up to 4 m");
    return 0.5;
  };
  const cdem::WaterSheet sheet = cdem::free_surface(*cdem::function_water(half), 0, box);
  CHECK(area_seen_from_above(sheet) == Approx(12).epsilon(1e-4));
  CHECK(sheet.shore.empty());
}

TEST_CASE("arrows tell the field's velocity, on the surface or below it in a section", "[water]") {
  cdem::UniformWater stream;
  stream.velocity = [](double time) { return Vec3(2, time, 0); };
  stream.level = 1;
  const auto water = cdem::uniform_water(stream);
  cdem::WaterWish wish;
  wish.velocity = true;
  const geom::Box box{{0, 0, 0}, {4, 2, 2}};
  const auto on_surface = cdem::free_surface(*water, 3, box, wish).arrows;
  REQUIRE(on_surface.size() > 20);
  for (const cdem::WaterArrow& arrow : on_surface) {
    CHECK(arrow.place.z() == Approx(1));
    CHECK((arrow.velocity - Vec3(2, 3, 0)).norm() < 1e-9);
  }
  wish.point = Vec3(1, 0.5, 0);
  wish.normal = {1, 1, 0};
  const auto in_section = cdem::free_surface(*water, 3, box, wish).arrows;
  REQUIRE(in_section.size() > 5);
  for (const cdem::WaterArrow& arrow : in_section) {
    CHECK(arrow.place.z() < 1);
    CHECK((arrow.place - *wish.point).dot(wish.normal) == Approx(0).margin(1e-9));
  }
}

TEST_CASE("a snapshot gets the sheet of each field that loads the model, once, where its bodies stand now",
          "[water]") {
  cdem::Snapshot snapshot;
  snapshot.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  snapshot.surface = {{0, 2, 1}, {0, 1, 3}};
  snapshot.point_fields = {{"displacement", "m", 3, std::vector<double>{5, 0, 0, 5, 0, 0, 5, 0, 0, 5, 0, 0}}};
  cdem::UniformWater still;
  still.velocity = [](double) { return Vec3(Vec3::Zero()); };
  still.level = 0.5;
  cdem::Flow flow;
  flow.water = cdem::uniform_water(still);
  cdem::Conditions conditions;
  conditions.flows = {flow, flow,
                      cdem::Flow{}}; // of the same water on two bodies, and a stream without a field
  cdem::add_water(conditions, {}, snapshot);
  REQUIRE(snapshot.water.size() == 1);
  CHECK(snapshot.water[0].height_at(5.5, 0.5) == Approx(0.5));
  snapshot.water.clear();
  cdem::WaterWish none;
  none.shown = false;
  cdem::add_water(conditions, none, snapshot);
  CHECK(snapshot.water.empty());
}
