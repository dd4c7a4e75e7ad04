// Armour layers: units keep clear of each other and of the ground, lie at rest and lean on each other.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/parts.hpp"
#include "libgeom/mesh/triangle_distance.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/placement/drop_grid.hpp"
#include "libgeom/placement/pile_measures.hpp"
#include "libgeom/placement/rest.hpp"
#include "libgeom/placement/walls.hpp"
#include "libgeom/solid/armour_units.hpp"
#include "tests/libgeom/piles.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using namespace testing;
using Catch::Matchers::Contains;

TEST_CASE("a unit of a layer is lowered until it is one gap above the slope") {
  // Without attitudes to choose from or nudges, one unit's lowest corner is one gap above the plane.
  LayerOptions options;
  options.attitudes = 1;
  options.nudges = 0;
  options.gap = 0.01;
  const Vec3 normal = Vec3(-0.5, 0, 1).normalized();
  const TetMesh unit =
      meshes(place_layer(box_mesh({1, 1, 1}, {1, 1, 1}), 1, slope_ground(0.5), options).pile).front();
  double least = 1e9;
  for (const Vec3& x : unit.nodes)
    least = std::min(least, normal.dot(x));
  CHECK(least == Approx(0.01).epsilon(1e-9));
}

TEST_CASE("units keep a gap of 2e-5 of their height, unless another is given") {
  for (const double size : {1., 4.}) {
    LayerOptions options;
    options.attitudes = 1;
    options.nudges = 0;
    const Ground ground = slope_ground(0.5);
    const TetMesh unit = box_mesh({size, size, size}, {1, 1, 1});
    const Pile pile = place_layer(unit, 1, ground, options).pile;
    CHECK(distance(surfaces(pile).front(), ground.surface(), 1) == Approx(2e-5 * size).epsilon(1e-6));
  }
}

TEST_CASE("an armour layer has the density it was asked for, and no unit cuts another") {
  for (const double density : {0.5, 0.645}) {
    LayerOptions options;
    options.density = density;
    options.columns = 5;
    const double gradient = 1 / 1.5;
    const Ground ground = slope_ground(gradient);
    const Pile pile = place_layer(accropode_mesh(), 20, ground, options).pile;
    REQUIRE(pile.poses.size() == 20);
    CHECK(least_distance(pile, 0.01) >= 0.99 * 2e-5);
    for (const Surface& unit : surfaces(pile))
      REQUIRE(distance(unit, ground.surface(), 0.01) >= 0.99 * 2e-5);

    const PileMeasures measured =
        measure_pile(surfaces(pile), ground.surface(), pile.height, volume(pile.unit));
    CHECK(measured.packing_density == Approx(density).epsilon(0.05));

    // Each unit is above the gap between two of the row below: laid within a tenth of the height of their places, and all move
    // a little when they come to rest together.
    const Vec3 up = Vec3(1, 0, gradient).normalized();
    for (int i = 5; i < 20; ++i) {
      const int row = i / 5, column = i % 5, first = 5 * (row - 1), other = column + (row % 2 == 0 ? -1 : 1);
      if (other < 0 || other > 4)
        continue;
      const Vec3 here = pile.poses[i].translation, left = pile.poses[first + column].translation,
                 right = pile.poses[first + other].translation;
      CHECK(std::abs(here.y() - 0.5 * (left.y() + right.y())) <= 0.25 * pile.height);
      CHECK(up.dot(here) > std::max(up.dot(left), up.dot(right)));
    }
  }
}

TEST_CASE("every unit of an armour layer lies on the slope, against others, at rest") {
  const double gradient = 1 / 1.5, gap = 1e-3;
  const Ground ground = slope_ground(gradient);
  LayerOptions options;
  options.columns = 5;
  options.gap = gap;
  const Layer layer = place_layer(accropode_mesh(), 30, ground, options);
  const Pile& pile = layer.pile;
  CHECK(layer.put_back.size() <= 1); // at an open end of a row: it would slide off, and may move on
  const std::vector<Surface> units = surfaces(pile);
  const Features shape = features_of(surface_of(pile.unit)), slope = features_of(ground.surface());
  std::vector<Features> laid;
  laid.reserve(pile.poses.size());
  for (const Pose& pose : pile.poses)
    laid.push_back(moved(shape, pose));

  int alike = 0;
  for (int i = 0; i < 30; ++i) {
    INFO("unit " << i + 1);
    CHECK(distance(units[i], ground.surface(), 1) <= 1.5 * gap);
    std::vector<const Features*> others{&slope};
    int touched = 0;
    for (int j = 0; j < 30; ++j) {
      if (i == j)
        continue;
      others.push_back(&laid[j]);
      const double apart = distance(units[i], units[j], 0.1);
      touched += apart <= 1.5 * gap ? 1 : 0;
      const Mat3 turn = pile.poses[i].rotation.transpose() * pile.poses[j].rotation;
      alike += apart < 0.1 && Eigen::AngleAxisd(turn).angle() < 10 * M_PI / 180 ? 1 : 0;
    }
    // Inner ones, between two below and two above.
    const int row = i / 5, column = i % 5;
    if (row > 0 && row < 5 && column > 0 && column < 4)
      CHECK(touched >= 2);

    // With friction of 40 degrees nothing goes on from here.
    const Pose rest =
        come_to_rest(shape, pile.poses[i], others, resting(std::tan(40 * M_PI / 180), gap)).pose;
    if (std::count(layer.put_back.begin(), layer.put_back.end(), i) == 0)
      CHECK((rest.translation - pile.poses[i].translation).norm() <= 0.01);
  }
  CHECK(alike <= 4); // of about seventy pairs, each counted twice
}

TEST_CASE("a layer takes attitudes that fit between its walls, where the best one does not") {
  LayerOptions options;
  options.columns = 1;
  options.walls = true;
  options.nudges = 0;
  options.density = 1;
  const Pile pile =
      place_layer(moved(box_mesh({1, 1, 6}, {1, 1, 6}), {-0.5, -0.5, -3}), 3, slope_ground(0.5), options)
          .pile;
  CHECK(pile.poses.size() == 3);
}

TEST_CASE("units of a layer between walls lean on three things or more, row ends mostly on a wall") {
  const double gradient = 1 / 1.5, gap = 1e-3, friction = std::tan(15 * M_PI / 180);
  const Ground ground = slope_ground(gradient);
  LayerOptions options;
  options.columns = 4;
  options.gap = gap;
  options.walls = true;
  options.friction = friction;
  int told = 0, leaning = 0, ends = 0; // over both layers
  options.tell = [&](const LayerProgress& now) {
    CHECK(now.attempt >= 1);
    CHECK(now.attempt <= now.attempts);
    CHECK(now.spacing >= 1);
    CHECK(now.spacing <= now.spacings);
    CHECK(now.laid <= 16);
    ++told;
  };
  for (const std::uint64_t seed : {1, 2}) {
    options.seed = seed;
    const Layer layer = place_layer(accropode_mesh(), 16, ground, options);
    CHECK(layer.at_rest);
    CHECK(layer.leaning.empty());
    CHECK(layer.put_back.empty());
    CHECK(told > 16);
    const Pile& pile = layer.pile;
    const Features shape = features_of(surface_of(pile.unit)), slope = features_of(ground.surface());
    const Box box = bounding_box(pile);
    const Features walls[] = {
        features_of(surface_of(moved(box_mesh({60, 1, 60}, {1, 1, 1}), {-10, box.min.y() - gap - 1, -10}))),
        features_of(surface_of(moved(box_mesh({60, 1, 60}, {1, 1, 1}), {-10, box.max.y() + gap, -10})))};
    std::vector<Features> laid;
    for (const Pose& pose : pile.poses)
      laid.push_back(moved(shape, pose));

    int ends_of_layer = 0, ends_on_three = 0, three = 0;
    for (int i = 4; i < 16; ++i) {
      std::vector<const Features*> others{&slope, &walls[0], &walls[1]};
      for (int j = 0; j < 16; ++j)
        if (j != i)
          others.push_back(&laid[j]);
      const Rest rest = come_to_rest(shape, pile.poses[i], others, resting(friction, gap));
      INFO("unit " << i + 1);
      CHECK(rest.still);
      CHECK((rest.pose.translation - pile.poses[i].translation).norm() <= 0.01);
      const int on_three = std::count(rest.carried_by.begin(), rest.carried_by.end(), 1) >= 3 ? 1 : 0;
      three += on_three;
      const int row = i / 4, column = i % 4;
      if (column == (row % 2 == 0 ? 0 : 3)) { // one below only
        ++ends;
        ++ends_of_layer;
        ends_on_three += on_three;
        leaning += rest.carried_by[1] + rest.carried_by[2];
      }
    }
    CHECK(three >= 11); // of twelve
    CHECK(ends_on_three == ends_of_layer);
  }
  CHECK(2 * leaning > ends);
}

TEST_CASE("a layer of one row is at rest as it is laid") {
  LayerOptions options;
  options.columns = 3;
  const Layer layer = place_layer(accropode_mesh(), 3, slope_ground(0.5), options);
  CHECK(layer.at_rest);
  CHECK(layer.trials == 1);
}

TEST_CASE("who watches a layer being laid can end it") {
  LayerOptions options;
  options.columns = 3;
  options.tell = [](const LayerProgress& now) {
    if (now.laid == 2)
      throw std::runtime_error("enough");
  };
  CHECK_THROWS_WITH(place_layer(accropode_mesh(), 12, slope_ground(0.5), options), "enough");
}

TEST_CASE("a layer on thin ground stays on it") {
  // Two hundredths of the units' height thick, level, its upper side at z = 0.
  LayerOptions options;
  options.columns = 3;
  const Ground ground(surface_of(moved(box_mesh({8, 6, 0.02}, {2, 2, 1}), {0, 0, -0.02})));
  for (const Pose& pose : place_layer(accropode_mesh(), 6, ground, options).pile.poses)
    CHECK(pose.translation.z() > 0.3);
}

TEST_CASE("a layer that cannot be laid is refused") {
  const Ground ground = slope_ground(0.5);
  const auto lay = [&](int count, const std::function<void(LayerOptions&)>& change) {
    LayerOptions options;
    change(options);
    return refusal([&] { place_layer(accropode_mesh(), count, ground, options); });
  };
  CHECK_THAT(lay(0, [](LayerOptions&) {}), Contains("count = 0: must be at least 1"));
  CHECK_THAT(lay(2, [](LayerOptions& o) { o.layers = 3; }),
             Contains("count = 2: must be at least as many as there are layers"));
  CHECK_THAT(lay(5, [](LayerOptions& o) { o.layers = 0; }), Contains("layers = 0: must be from 1 to 20"));
  CHECK_THAT(lay(5, [](LayerOptions& o) { o.density = 0; }),
             Contains("density = 0: must be from 0.05 to 1.5"));
  CHECK_THAT(lay(5, [](LayerOptions& o) { o.gap = -1; }), Contains("gap = -1: must be finite and > 0 m"));
  CHECK_THAT(lay(5, [](LayerOptions& o) { o.columns = 0; }), Contains("columns = 0: must be at least 1"));
  CHECK_THAT(lay(5, [](LayerOptions& o) { o.columns = 100; }), Contains("columns = 100: must be at most"));
  CHECK_THAT(lay(100000, [](LayerOptions&) {}), Contains("count = 100000: must be at most"));
  CHECK_THAT(lay(5,
                 [](LayerOptions& o) {
                   o.region = PlanBox{{30, 0}, {50, 9}};
                 }),
             Contains("is beside the ground"));
  CHECK_THAT(lay(5,
                 [](LayerOptions& o) {
                   o.region = PlanBox{{30, 0}, {30.5, 9}};
                 }),
             Contains("room for one unit"));
}

TEST_CASE("a layer and a drop grid of units four times the size are the same, four times the size") {
  const double factor = 4;
  const auto laid = [&](double size) {
    TetMesh unit = accropode_mesh(), slope = box_mesh({40, 20, 1}, {2, 2, 1});
    for (Vec3& x : slope.nodes) {
      x.y() -= 10;
      x.z() += 0.6 * x.x() - 1;
      x *= size;
    }
    for (Vec3& x : unit.nodes)
      x *= size;
    LayerOptions options;
    options.columns = 3;
    options.gap = 1e-4 * size;
    options.walls = true;
    const Ground ground{surface_of(slope)};
    std::vector<Pose> poses = place_layer(unit, 9, ground, options).pile.poses;
    for (const Pose& pose : drop_grid(unit, 9, ground).poses)
      poses.push_back(pose);
    return poses;
  };
  const std::vector<Pose> small = laid(1), large = laid(factor);
  REQUIRE(large.size() == small.size());
  for (std::size_t i = 0; i < small.size(); ++i) {
    INFO("unit " << i + 1);
    // Cube roots of volumes differ in the last digit; the way down to rest makes more of it, the more the smaller the gap.
    CHECK((large[i].rotation - small[i].rotation).norm() < 1e-5);
    CHECK((large[i].translation / factor - small[i].translation).norm() < 1e-5);
  }
}

TEST_CASE("between walls a layer in which units lean on too little is laid anew with other attitudes") {
  LayerOptions options;
  options.columns = 2;
  options.density = 0.35; // so wide that some find but two things to lean on
  options.walls = true;
  Layer layer;
  for (options.seed = 5; options.seed < 40 && (layer.attempts == 1 || layer.attempts == 4); ++options.seed)
    layer = place_layer(accropode_mesh(), 6, slope_ground(1 / 1.5), options);
  // The same attitudes would be in vain four times.
  CHECK(layer.attempts > 1);
  CHECK(layer.attempts < 4);
  CHECK(layer.trials >= layer.attempts);
  CHECK(layer.at_rest);
  CHECK(layer.leaning.empty());
  CHECK(layer.put_back.empty());
}

TEST_CASE("a second layer lies on the first, at rest on three things, and leaves it as it is") {
  const double gradient = 1 / 1.5, gap = 1e-3;
  const Ground ground = slope_ground(gradient);
  LayerOptions options;
  options.columns = 3;
  options.attitudes = 100;
  options.gap = gap;
  options.walls = true;
  const Layer one = place_layer(accropode_mesh(), 9, ground, options);
  options.layers = 2;
  const Layer two = place_layer(accropode_mesh(), 17, ground, options);
  CHECK(two.at_rest);
  CHECK(two.leaning.size() <= 1);
  CHECK(two.put_back.empty());
  const Pile& pile = two.pile;
  REQUIRE(pile.poses.size() == 17);
  for (int i = 0; i < 9; ++i) {
    CHECK(pile.poses[i].translation == one.pile.poses[i].translation);
    CHECK(pile.poses[i].rotation == one.pile.poses[i].rotation);
  }
  CHECK(least_distance(pile, 0.01) >= 0.99 * gap);
  const std::vector<Surface> units = surfaces(pile);
  const Vec3 normal = ground.normal({{0, -10}, {40, 10}}), up = Vec3(1, 0, gradient).normalized();
  for (int i = 9; i < 17; ++i) {
    INFO("unit " << i + 1);
    CHECK(distance(units[i], ground.surface(), 1) >= 0.99 * gap);
    int below = 0;
    for (int j = 0; j < 9; ++j)
      below += distance(units[i], units[j], 0.1) <= 1.5 * gap ? 1 : 0;
    CHECK(below >= 1);
    // As far up as the unit of the same row below, and higher. A unit of the top row may come down into the half place
    // that is free beside a wall.
    const Vec3 here = pile.poses[i].translation, there = pile.poses[i - 9].translation;
    if (i < 15)
      CHECK(normal.dot(here - there) > 0.3 * pile.height);
    CHECK(std::abs(up.dot(here - there)) < 0.7 * pile.height);
  }
}

TEST_CASE("walls stand at the ends of the pile and on the ground, clear of it and of each other") {
  const TetMesh cube = box_mesh({1, 1, 1}, {1, 1, 1});
  for (const double gradient : {0., 0.5, -0.5}) {
    const Ground ground = slope_ground(gradient);
    const Pile pile = drop_grid(cube, 20, ground);
    const TetMesh walls = walls_around(pile, ground);
    validate(walls, "walls");
    const Box inside = bounding_box(pile), outside = bounding_box(walls);
    // On a slope the upper end is open.
    CHECK(count_parts(walls) == (gradient == 0 ? 4 : 3));
    CHECK(outside.min.y() == Approx(inside.min.y() - 1));
    CHECK(outside.max.y() == Approx(inside.max.y() + 1));
    for (const Vec3& x : walls.nodes) {
      const double over = x.z() - *ground.height(x.x(), x.y());
      CHECK(over > 0.99 * wall_clearance);
      CHECK(over < (inside.max.z() - inside.min.z()) + 20 * std::abs(gradient) + 3);
      const bool between = x.x() > inside.min.x() + 1e-9 && x.x() < inside.max.x() - 1e-9 &&
                           x.y() > inside.min.y() + 1e-9 && x.y() < inside.max.y() - 1e-9;
      CHECK(!between);
    }
    // Nothing of the ground reaches into them.
    const Surface surface = surface_of(walls);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      const auto t = surface.corners(i);
      const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
      CHECK(middle.z() > *ground.height(middle.x(), middle.y()));
    }
  }
}

TEST_CASE("walls clear a ground that is higher between their nodes, and reach below one that has ended") {
  TetMesh mesh = box_mesh({20, 8, 1}, {40, 1, 1});
  for (Vec3& x : mesh.nodes)
    x.z() += std::abs(std::fmod(x.x(), 2.0) - 1) < 0.3 ? 0.4 : 0; // ridges 2 m apart
  const Ground ground(surface_of(mesh));
  const Pile pile = drop_grid(box_mesh({1.5, 1.5, 1.5}, {1, 1, 1}), 6, ground);
  const TetMesh walls = walls_around(pile, ground);
  const Surface surface = surface_of(walls);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto t = surface.corners(i);
    for (const double a : {0.1, 0.3, 0.5, 0.8}) {
      const Vec3 x = a * t[0] + 0.5 * (1 - a) * (t[1] + t[2]);
      if (const auto z = ground.height(x.x(), x.y()))
        CHECK(x.z() > *z);
      else
        CHECK(x.z() > 1); // its lowest place
    }
  }
}
