// The potential of two tetrahedra that overlap: its gradient, its balance, where it begins, and that all widths agree.
#include "libcdem/contact/response/tet_potential.hpp"

#include "libgeom/core/types.hpp"

#include <catch2/catch.hpp>

#include <Eigen/LU>

#include <random>

using namespace cdem;
using geom::Vec3;

namespace {

using EightCorners = std::array<Vec3, 8>; // of two tetrahedra

double six_volumes(const EightCorners& x, int tet) {
  const Vec3* const t = x.data() + 4 * tet;
  return (t[1] - t[0]).dot((t[2] - t[0]).cross(t[3] - t[0]));
}

EightCorners turned_out(EightCorners x) {
  for (int tet = 0; tet < 2; ++tet)
    if (six_volumes(x, tet) < 0)
      std::swap(x[4 * tet + 2], x[4 * tet + 3]);
  return x;
}

// Two tetrahedra of about a metre, whose middles stand `apart` metres from each other along x.
EightCorners random_pair(std::mt19937& random, double apart) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (;;) {
    EightCorners x;
    for (int i = 0; i < 8; ++i)
      x[i] = Vec3(uniform(random) + (i < 4 ? 0 : apart), uniform(random), uniform(random));
    x = turned_out(x);
    if (six_volumes(x, 0) > 0.3 && six_volumes(x, 1) > 0.3)
      return x;
  }
}

TetPairPress batch_of(double phi0) {
  TetPairPress batch{};
  for (int lane = 0; lane < lanes; ++lane) {
    for (int i = 0; i < 8; ++i)
      batch.of.node[i][lane] = 8 * lane + i;
    batch.phi0[lane] = phi0;
    batch.stiffness[lane] = 1;
  }
  return batch;
}

std::vector<Node> places_of(const std::array<EightCorners, lanes>& pairs) {
  std::vector<Node> places;
  for (const EightCorners& x : pairs)
    for (const Vec3& corner : x)
      places.push_back({corner.x(), corner.y(), corner.z(), 0});
  return places;
}

TetPairPress pressed(const std::array<EightCorners, lanes>& pairs, double phi0 = 0) {
  TetPairPress batch = batch_of(phi0);
  const std::vector<Node> places = places_of(pairs);
  press_pairs(places.data(), &batch, 1);
  find_deepest(places.data(), &batch.of, 1);
  return batch;
}

std::array<EightCorners, lanes> same(const EightCorners& x) {
  std::array<EightCorners, lanes> pairs;
  pairs.fill(x);
  return pairs;
}

Vec3 force(const TetPairPress& batch, int corner, int lane = 0) {
  return {batch.force[corner][0][lane], batch.force[corner][1][lane], batch.force[corner][2][lane]};
}

} // namespace

TEST_CASE("forces of overlapping tetrahedra are the gradient of their energy", "[contact]") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> any(0, 23);
  constexpr double e = 1e-6; // m
  int overlapping = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const EightCorners x = random_pair(random, 1);
    const TetPairPress here = pressed(same(x), 0.01);
    if (here.energy[0] < 1e-6)
      continue;
    ++overlapping;
    std::array<EightCorners, lanes> moved = same(x);
    std::array<int, 4> of;
    for (int i = 0; i < 4; ++i) {
      of[i] = any(random);
      moved[2 * i][of[i] / 3][of[i] % 3] += e;
      moved[2 * i + 1][of[i] / 3][of[i] % 3] -= e;
    }
    const TetPairPress around = pressed(moved, 0.01);
    for (int i = 0; i < 4; ++i)
      CHECK(force(here, of[i] / 3)[of[i] % 3] ==
            Approx((around.energy[2 * i + 1] - around.energy[2 * i]) / (2 * e)).margin(2e-8));
  }
  CHECK(overlapping > 500);
}

TEST_CASE("forces of overlapping tetrahedra keep momentum and angular momentum", "[contact]") {
  std::mt19937 random(7);
  for (int trial = 0; trial < 500; ++trial) {
    const EightCorners x = random_pair(random, 0.8);
    const TetPairPress batch = pressed(same(x));
    Vec3 sum = Vec3::Zero(), turn = Vec3::Zero();
    for (int i = 0; i < 8; ++i) {
      sum += force(batch, i);
      turn += x[i].cross(force(batch, i));
    }
    CHECK(sum.norm() < 1e-14);
    CHECK(turn.norm() < 1e-14);
  }
}

TEST_CASE("tetrahedra press each other just where they overlap", "[contact]") {
  std::mt19937 random(11);
  int parted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    EightCorners x = random_pair(random, 1.6);
    const TetPairPress batch = pressed(same(x));
    const double deepest = batch.of.deepest[0];
    CHECK((batch.energy[0] > 0) == (deepest > 0));
    if (deepest > 0) {
      CHECK(pressed(same(x), 1.0001 * deepest).energy[0] == 0);
      CHECK(pressed(same(x), 0.99 * deepest).energy[0] > 0);
      continue;
    }
    // They do not touch before one has come as far, in any direction.
    ++parted;
    std::array<EightCorners, lanes> moved = same(x);
    std::normal_distribution<double> normal;
    for (EightCorners& one : moved) {
      const Vec3 way = Vec3(normal(random), normal(random), normal(random)).normalized() * (-0.999 * deepest);
      for (int i = 0; i < 4; ++i)
        one[i] += way;
    }
    const TetPairPress after = pressed(moved);
    for (int lane = 0; lane < lanes; ++lane)
      CHECK(after.energy[lane] == 0);
  }
  CHECK(parted > 200);
}

TEST_CASE("edges of tetrahedra that cross press in proportion to the depth, as a corner does", "[contact]") {
  // Regular ones with edges of 1 m.
  const double half = 0.5, height = std::sqrt(0.5), tall = std::sqrt(2.0 / 3), wide = 1 / std::sqrt(3);
  const double depth = GENERATE(1e-4, 1e-2, 0.1);
  const auto lifted = [](const EightCorners& x) {
    const TetPairPress batch = pressed(same(turned_out(x)));
    Vec3 sum = Vec3::Zero();
    for (int i = 4; i < 8; ++i)
      sum += force(batch, i);
    CHECK(sum.head<2>().norm() < 1e-12);
    return sum.z();
  };
  // The edge stands at depth / sqrt 3 below two faces, and from there out it rises to the surface.
  const Vec3 down(0, 0, -depth);
  CHECK(lifted({Vec3(-half, 0, 0), Vec3(half, 0, 0), Vec3(0, half, -height), Vec3(0, -half, -height),
                down + Vec3(0, -half, 0), down + Vec3(0, half, 0), down + Vec3(half, 0, height),
                down + Vec3(-half, 0, height)}) == Approx(depth / 18));
  const Vec3 tip = down + Vec3(1, 0.3, 0); // far from the edges and the middle of a large face
  CHECK(lifted({Vec3(5, 0, 0), Vec3(-3, 4, 0), Vec3(-3, -4, 0), Vec3(0, 0, -5), tip,
                tip + Vec3(wide, 0, tall), tip + Vec3(-wide / 2, half, tall),
                tip + Vec3(-wide / 2, -half, tall)}) == Approx(0.75 * depth));
}
