// Every wrong argument of a builder is answered by one line with field, value and what is allowed.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

using namespace geom;
using testing::refusal;

namespace {

const double not_a_number = std::nan(""), infinite = std::numeric_limits<double>::infinity();

const Assembly cube = grid({1, 1, 1}, {1, 1, 1});

std::string joint_message(const std::function<void(JointSet&)>& spoil) {
  JointSet set;
  spoil(set);
  return refusal([&] { cut_by_joints(cube, {set}); });
}

std::string brick_message(const std::function<void(BrickOptions&)>& spoil) {
  BrickOptions o;
  spoil(o);
  return refusal([&] { bricks(o); });
}

std::string voronoi_message(const std::function<void(VoronoiOptions&)>& spoil) {
  VoronoiOptions o;
  spoil(o);
  return refusal([&] { voronoi(o); });
}

} // namespace

TEST_CASE("grid refuses what is no grid") {
  CHECK(refusal([] {
          grid({0.3, -1, 0.03}, {1, 1, 1});
        }) == "size = {0.3, -1, 0.03}: must be three finite lengths > 0 m");
  CHECK(refusal([] {
          grid({0, 1, 1}, {1, 1, 1});
        }) == "size = {0, 1, 1}: must be three finite lengths > 0 m");
  CHECK(refusal([] {
          grid({1, not_a_number, 1}, {1, 1, 1});
        }) == "size = {1, nan, 1}: must be three finite lengths > 0 m");
  CHECK(refusal([] {
          grid({1, 1, infinite}, {1, 1, 1});
        }) == "size = {1, 1, inf}: must be three finite lengths > 0 m");
  CHECK(refusal([] {
          grid({1, 1, 1}, {10, 0, 1});
        }) == "divisions = {10, 0, 1}: must be three whole numbers >= 1");
  CHECK(refusal([] {
          grid({1, 1, 1}, {1000, 1000, 1000});
        }) == "divisions = {1000, 1000, 1000}: must be such that there are at most 10 million blocks (this "
              "asks for about "
              "1e+09); use fewer divisions");
  CHECK(refusal([] {
          grid({1, 1, 1}, {1, 1, 1}, {0, 0, not_a_number});
        }) == "origin = {0, 0, nan}: must be three finite numbers");
}

TEST_CASE("voronoi refuses what has no cells") {
  CHECK(voronoi_message([](auto& o) { o.size.x() = 0; }) ==
        "size = {0, 1, 1}: must be three finite lengths > 0 m");
  CHECK(voronoi_message([](auto& o) { o.origin.x() = infinite; }) ==
        "origin = {inf, 0, 0}: must be three finite numbers");
  CHECK(voronoi_message([](auto& o) { o.count = 0; }) == "count = 0: must be a whole number >= 1");
  CHECK(voronoi_message([](auto& o) { o.count = 20000000; }) ==
        "count = 20000000: must be such that there are at most 10 million blocks (this asks for about "
        "2e+07); use "
        "fewer blocks");
  CHECK(voronoi_message([](auto& o) { o.relaxations = -1; }) ==
        "relaxations = -1: must be a whole number from 0 to 1000");
}

TEST_CASE("bricks refuses what is no wall") {
  CHECK(brick_message([](auto& o) { o.size.z() = -1; }) ==
        "size = {1, 1, -1}: must be three finite lengths > 0 m");
  CHECK(brick_message([](auto& o) { o.brick.y() = not_a_number; }) ==
        "brick = {1, nan, 1}: must be three finite lengths > 0 m");
  CHECK(brick_message([](auto& o) { o.shift = 1.5; }) == "shift = 1.5: must be from 0 to 1");
  CHECK(brick_message([](auto& o) { o.shift = not_a_number; }) == "shift = nan: must be from 0 to 1");
  CHECK(brick_message([](auto& o) { o.origin.y() = not_a_number; }) ==
        "origin = {0, nan, 0}: must be three finite numbers");
  CHECK(brick_message([](auto& o) { o.brick = Vec3::Constant(1e-3); }) ==
        "brick = {0.001, 0.001, 0.001}: must be such that there are at most 10 million blocks (this asks for "
        "about "
        "1e+09); use larger bricks");
}

TEST_CASE("cut_by_joints refuses what is no joint set") {
  CHECK(joint_message([](auto& s) { s.spacing = 0; }) == "spacing = 0: must be finite and > 0 m");
  CHECK(joint_message([](auto& s) { s.spacing = not_a_number; }) ==
        "spacing = nan: must be finite and > 0 m");
  CHECK(joint_message([](auto& s) { s.spacing = 1e-9; }) ==
        "spacing = 1e-09: must be such that there are at most 10 million blocks (this asks for about 1e+09); "
        "use a "
        "wider spacing or fewer blocks");
  CHECK(joint_message([](auto& s) { s.dip = 2; }) == "dip = 114.591559: must be from 0 to 90 degrees");
  CHECK(joint_message([](auto& s) { s.dip = not_a_number; }) == "dip = nan: must be from 0 to 90 degrees");
  CHECK(joint_message([](auto& s) { s.dip_direction = -1; }) ==
        "dip_direction = -57.29577951: must be from 0 to 360 degrees");
  CHECK(joint_message([](auto& s) { s.spacing_scatter = 0.5; }) ==
        "spacing_scatter = 0.5: must be >= 0 and < 0.5 (of the spacing)");
  CHECK(joint_message([](auto& s) { s.dip_scatter = -1; }) ==
        "dip_scatter = -57.29577951: must be from 0 to 45 degrees");
  CHECK(joint_message([](auto& s) { s.direction_scatter = 1; }) ==
        "direction_scatter = 57.29577951: must be from 0 to 45 degrees");
  JointSet set;
  set.spacing = 1e-3;
  const Assembly far_apart{{make_box({0, 0, 0}, {1, 1, 1}), make_box({1e6, 0, 1e6}, {1e6 + 1, 1, 1e6 + 1})}};
  CHECK(refusal([&] { cut_by_joints(far_apart, {set}); }) ==
        "spacing = 0.001: must be such that there are at most a million planes in a set (this asks for about "
        "1000001000); use a wider spacing");
}

TEST_CASE("editing an assembly refuses what has no meaning") {
  CHECK(refusal([] {
          cut_by_plane(cube, {Vec3::Zero(), 0});
        }) == "normal = {0, 0, 0}: must be three finite numbers, not all zero");
  CHECK(refusal([] {
          cut_by_plane(cube, {Vec3::UnitX(), not_a_number});
        }) == "offset = nan: must be a finite number (m)");
  CHECK(refusal([] {
          cut_by_plane(cube, {Vec3::UnitX(), 0}, {{}, -1});
        }) == "clearance = -1: must be finite and >= 0 m");
  CHECK(refusal([] {
          translated(cube, {not_a_number, 0, 0});
        }) == "shift = {nan, 0, 0}: must be three finite numbers");
  CHECK(refusal([] {
          rotated(cube, {0, 0, 0}, 1);
        }) == "axis = {0, 0, 0}: must be three finite numbers, not all zero");
  CHECK(refusal([] { rotated(cube, {0, 0, 1}, infinite); }) == "angle = inf: must be a finite number");
  CHECK(refusal([] {
          rotated(cube, {0, 0, 1}, 1, {not_a_number, 0, 0});
        }) == "centre = {nan, 0, 0}: must be three finite numbers");
}
