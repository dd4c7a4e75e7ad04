// Two tetrahedra that press on each other: forces are the gradient of an energy, nothing is turned or pushed as a whole, and
// what parts them is told to the right side.
#include "libcdem/contact/pairs/tet_pressure.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace {

using cdem::Node;
using cdem::TetPressure;
using Corners = std::array<Node, 8>; // of both

constexpr double offset = 0.02; // m
const cdem::TetLaw law{3, 2, 0.3, 0};

double& part(Node& x, int axis) {
  return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

// Six times the volume.
double volume(const Node* x) {
  double e[3][3];
  for (int k = 0; k < 3; ++k) {
    e[k][0] = x[k + 1].x - x[0].x;
    e[k][1] = x[k + 1].y - x[0].y;
    e[k][2] = x[k + 1].z - x[0].z;
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
         e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

// Of all shapes and places, none flat.
std::vector<Corners> random_pairs(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-1, 1);
  std::vector<Corners> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    Corners x;
    for (int k = 0; k < 8; ++k)
      x[k] = {within(random) + 30 + (k < 4 ? 0 : 1), within(random) - 20, within(random), 0};
    for (Node* tet : {x.data(), x.data() + 4})
      if (volume(tet) < 0)
        std::swap(tet[2], tet[3]);
    if (volume(x.data()) > 0.3 && volume(x.data() + 4) > 0.3)
      pairs.push_back(x);
  }
  return pairs;
}

const std::int32_t first = 0, second = 1, only = 0;
const std::array<std::uint8_t, 2> all_open{15, 15};

cdem::PairsOfTets pair_at(const Corners& x) {
  return {x.data(), &first, &second, all_open.data(), &only, 1};
}

TetPressure pressed(const Corners& x) {
  TetPressure p;
  TetPressure* const to = &p;
  const double shear[3] = {};
  cdem::press(pair_at(x), nullptr, &offset, &law, shear, &to);
  return p;
}

} // namespace

TEST_CASE("tetrahedra: their forces are the gradient of what they store, without a resultant or a moment",
          "[contact][pairs]") {
  int pressing = 0;
  for (const Corners& x : random_pairs(600)) {
    const TetPressure p = pressed(x);
    if (!(p.pressing > 0))
      continue;
    ++pressing;
    double force[3] = {}, moment[3] = {};
    for (int k = 0; k < 8; ++k) {
      Node place = x[k];
      for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        force[axis] += p.force[k][axis];
        moment[axis] += part(place, next) * p.force[k][last] - part(place, last) * p.force[k][next];
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::abs(force[axis]) < 1e-14);
      CHECK(std::abs(moment[axis]) < 1e-12);
    }
    constexpr double step = 1e-6;
    for (int k = 0; k < 8; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        Corners forth = x, back = x;
        part(forth[k], axis) += step;
        part(back[k], axis) -= step;
        const double slope = (pressed(forth).stored - pressed(back).stored) / (2 * step);
        CHECK(p.force[k][axis] == Approx(-slope).margin(1e-8));
      }
  }
  CHECK(pressing > 50);
}

TEST_CASE("tetrahedra: they press where the largest phi is above zero, and not where a plane parts them",
          "[contact][pairs]") {
  int apart = 0;
  for (const Corners& x : random_pairs(2000)) {
    double gap = 0, phi = 0;
    cdem::parted_by_planes(pair_at(x), &gap);
    cdem::deepest_in_each_other(pair_at(x), &offset, &phi);
    const TetPressure p = pressed(x);
    CHECK((p.pressing > 0) == (phi > 0));
    if (phi > 0)
      CHECK(p.depth == Approx(phi).epsilon(1e-9));
    if (gap > 0) {
      ++apart;
      CHECK(phi < -offset);
    }
  }
  CHECK(apart > 100);
}

// Of two that are apart, no motion of the corners by less than the part of -phi that a pair sleeps for brings them together.
TEST_CASE("tetrahedra: those that sleep for a part of their distance do not meet meanwhile",
          "[contact][pairs]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-1, 1);
  int tried = 0;
  for (const Corners& x : random_pairs(3000)) {
    double phi = 0;
    cdem::deepest_in_each_other(pair_at(x), &offset, &phi);
    if (phi > 0 || phi < -0.02)
      continue;
    ++tried;
    for (int turn = 0; turn < 20; ++turn) {
      Corners moved = x;
      for (Node& corner : moved) { // both together go by 0.4 of it
        Node way{within(random), within(random), within(random), 0};
        const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
        for (int axis = 0; axis < 3; ++axis)
          part(corner, axis) += 0.2 * -phi * part(way, axis) / length;
      }
      CHECK_FALSE(pressed(moved).pressing > 0);
    }
  }
  CHECK(tried > 20);
}
