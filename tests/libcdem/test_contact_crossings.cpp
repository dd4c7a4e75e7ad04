// Contact of bars that cross on their edges or lie across each other, of blocks in rows, and of a lone corner.
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

TEST_CASE("contact: crossed edges stop each other", "[contact][edges]") {
  // Two bars, each on one of its edges, crossed: no corner of one comes near a face of the other. Between nodes, or over
  // one of one of them, or of both.
  const Vec3 at = GENERATE(Vec3(0.21, 0.17, 0), Vec3(0.21, 0, 0), Vec3(0, 0, 0));
  const Mat3 on_edge = rotation({1, 0, 0}, 45 * degree);
  const double half = std::sqrt(0.5) * 0.4;
  System s(build({meshed("lower", box_at({3, 0.4, 0.4}, {4, 1, 1}, on_edge, {0, 0, 0})),
                  meshed("upper", box_at({3, 0.4, 0.4}, {4, 1, 1}, rotation({0, 0, 1}, 75 * degree) * on_edge,
                                         at + Vec3(0, 0, 2 * half + 0.01)))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 1)
      s.state.velocity[i] = node({0, 0, -1});
  const double kinetic = 0.5 * rock().density * 3 * 0.4 * 0.4; // J
  double lowest = 10;
  bool edges = false;
  cdem::RunOptions options;
  options.duration = 0.03;
  options.callback_every = 10;
  options.callback = [&] {
    lowest = std::min(lowest, centroid(s, 1).z());
    for (const cdem::Contact& c : s.state.contacts)
      edges = edges || c.kind == cdem::Contact::edge;
  };
  s.run(options);
  CHECK(edges);
  CHECK(lowest > 2 * half - 0.01);
  CHECK(centroid(s, 1).z() > lowest + 1e-4);
  CHECK(s.state.spent.friction < 1e-3 * kinetic);
}

TEST_CASE("contact: edges that are nearly parallel stop each other too", "[contact][edges]") {
  // Ridge on ridge, crossed by a small angle or not at all.
  const double angle = GENERATE(0.0, 0.05, 0.3, 0.7, 1.0, 2.0, 2.8, 3.0);
  CAPTURE(angle);
  const Mat3 on_edge = rotation({1, 0, 0}, 45 * degree);
  const double half = std::sqrt(0.5) * 0.4, cell = 0.1;
  System s(
      build({meshed("lower", box_at({2, 0.4, 0.4}, {20, 1, 1}, on_edge, {0, 0, 0})),
             meshed("upper", box_at({2, 0.4, 0.4}, {20, 1, 1}, rotation({0, 0, 1}, angle * degree) * on_edge,
                                    Vec3(0.03, 0, 2 * half + 1e-3)))},
            {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 1)
      s.state.velocity[i] = node({0, 0, -0.2});
  const double kinetic = 0.5 * rock().density * 2 * 0.4 * 0.4 * 0.2 * 0.2; // J
  double lowest = 10;
  bool edges = false;
  cdem::RunOptions options;
  options.duration = 0.05;
  options.callback_every = 10;
  options.callback = [&] {
    lowest = std::min(lowest, centroid(s, 1).z());
    for (const cdem::Contact& c : s.state.contacts)
      edges = edges || c.kind == cdem::Contact::edge;
  };
  s.run(options);
  const double deepest = angle < 0.6 ? 0.03 * cell : 0.005 * cell;
  CHECK(lowest > 2 * half - deepest);
  CHECK(centroid(s, 1).z() > lowest + 1e-3);
  // Where two edges no longer run beside each other, their pair ends with what its last stretch stored.
  CHECK(std::abs(s.state.spent.friction) < 1e-5 * kinetic);
  CHECK(edges);
}

TEST_CASE("contact: two bars ridge on ridge stop each other at the same depth at any angle",
          "[contact][edges]") {
  const double angle = GENERATE(0.0, 0.01, 0.05, 0.3, 0.57, 1.0, 5.0, 45.0, 90.0);
  CAPTURE(angle);
  const Vec3 size(2, 0.4, 0.4);
  const double half = std::sqrt(0.5) * 0.4, gap = 2e-3, speed = 0.6, stiffness = 1e10;
  const auto bar = [&](const char* name, const Mat3& turn, double z) {
    geom::Assembly shape = geom::grid(size, {1, 1, 1}, -0.5 * size);
    const Eigen::AngleAxisd by(turn);
    cdem::BodySpec body{name, geom::translated(geom::rotated(shape, by.axis(), by.angle()), Vec3(0, 0, z)),
                        rock(), friction(0)};
    body.element = cdem::Element::rigid;
    return body;
  };
  const Mat3 on_edge = rotation({1, 0, 0}, 45 * degree);
  cdem::Joint law = friction(0);
  law.normal_stiffness = stiffness;
  System s(build(
      {bar("lower", on_edge, 0), bar("upper", rotation({0, 0, 1}, angle * degree) * on_edge, 2 * half + gap)},
      {{"lower", "upper", law}}));
  s.hold(body_of("lower"), "xyz");
  s.state.rigid[1].velocity = {0, 0, -speed};
  cdem::RunOptions options;
  options.duration = 2.5 * gap / speed;
  options.callback_every = 1;
  double lowest = 10;
  options.callback = [&] { lowest = std::min(lowest, centroid(s, 1).z()); };
  s.run(options);
  const double area = 0.2 * 2 / 3,
               mass = rock().density * 2 * 0.4 *
                      0.4; // of both edges, whose triangles meet in the middle of the faces
  CHECK(2 * half - lowest == Approx(speed * std::sqrt(mass / (0.5 * stiffness * area))).epsilon(0.05));
  const auto& [x, y, z] = s.state.rigid[1].velocity;
  const auto& spin = s.state.rigid[1].angular_momentum; // N m s
  CHECK(z > 0.99 * speed);
  CHECK(std::hypot(x, y) < 1e-3 * speed);
  CHECK(std::hypot(spin[0], spin[1], spin[2]) < 1e-3 * mass * speed);
}

namespace {

// Two bars of 2 x 0.4 x 0.4 m of eight cells, ridge on ridge, turned by an angle. The upper one falls on the lower one.
struct Ridges {
  static constexpr double half = 0.4 * 0.70710678118654752, gap = 2e-3, speed = 0.6, cell = 0.25, area = 0.05,
                          stiffness = 1e10;

  // sideways: m, along the lower ridge.
  Ridges(double angle, double sideways, cdem::Element element, cdem::Element of_lower = cdem::Element::rigid,
         double friction_angle = 0)
      : s(build({bar("lower", Mat3::Identity(), 0, 0, of_lower),
                 bar("upper", rotation({0, 0, 1}, angle * degree), sideways, 2 * half + gap, element)},
                {{"lower", "upper", law(friction_angle)}})) {
    if (element == cdem::Element::rigid)
      s.state.rigid[1].velocity = {0, 0, -speed};
    for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
      if (block_of(s.model, i) == 1)
        s.state.velocity[i] = node({0, 0, -speed});
  }

  // Returns the largest depth.
  double meet(double duration) {
    double lowest = 10;
    cdem::RunOptions options;
    options.duration = duration;
    options.callback_every = 1;
    options.callback = [&] { lowest = std::min(lowest, centroid(s, 1).z()); };
    s.run(options);
    return 2 * half - lowest;
  }

  // Part of half the stiffness of a crossing, times the square of the depth, that is stored: the overlap of the ridges, over that
  // within half a cell from where it is deepest.
  static double stored(double angle, double depth) {
    const auto overlap =
        [&](double within) { // of the quadratic depth^2 - (x tan angle)^2, to both sides, over depth^2
          const double slope = std::tan(angle * degree) / depth, to = std::min(within, 1 / slope);
          return 2 * to * (1 - slope * slope * to * to / 3);
        };
    return overlap(1) / overlap(0.5 * cell);
  }
  static double mass() { return rock().density * 2 * 0.4 * 0.4; }
  // Depth, m, at which an energy is stored that the bar had.
  static double depth(double angle) {
    const double crossing = 0.5 * stiffness * 2 * area / 3; // N/m
    double at = 1e-3;
    for (int i = 0; i < 50; ++i)
      at = std::sqrt(mass() * speed * speed / (crossing * stored(angle, at)));
    return at;
  }

  System s;

private:
  static cdem::Joint law(double friction_angle) {
    cdem::Joint law = friction(friction_angle);
    law.normal_stiffness = stiffness;
    return law;
  }
  static cdem::BodySpec bar(const char* name, const Mat3& turn, double sideways, double up,
                            cdem::Element element) {
    cdem::BodySpec body = meshed(
        name, box_at({2, 0.4, 0.4}, {8, 1, 1}, turn * rotation({1, 0, 0}, 45 * degree), {sideways, 0, up}));
    body.element = element;
    return body;
  }
};

} // namespace

TEST_CASE("contact: ridges of several cells stop each other without loss at any angle", "[contact][edges]") {
  const double angle = GENERATE(0.0, 0.01, 0.05, 0.3, 0.57, 1.0, 5.0, 45.0, 90.0);
  const double sideways = GENERATE(0.0, 0.03, 0.125); // at, beside and between the nodes of the other one
  CAPTURE(angle, sideways);
  Ridges bars(angle, sideways, cdem::Element::rigid);
  bars.s.hold(body_of("lower"), "xyz");
  const double before = cdem::kinetic_energy(bars.s.model, bars.s.state), depth = bars.meet(0.016);
  CHECK(bars.s.state.contacts.empty());
  CHECK(depth == Approx(Ridges::depth(angle)).epsilon(0.05));
  CHECK(cdem::kinetic_energy(bars.s.model, bars.s.state) == Approx(before).epsilon(1e-2));
  CHECK(std::abs(bars.s.state.spent.friction) < 1e-5 * before);
  // A ridge that lies on another tends to slide off it, and where the two are shifted they do not reach equally far to both sides.
  const auto& [x, y, z] = bars.s.state.rigid[1].velocity;
  if (sideways == 0 || angle == 0 || angle > 0.04)
    CHECK(std::hypot(x, y) < 1e-3 * Ridges::speed);
  CHECK(z > 0.7 * Ridges::speed);
}

TEST_CASE("contact: a deformable ridge that falls on another keeps its energy", "[contact][edges]") {
  const double angle = GENERATE(0.0, 0.05, 0.3, 5.0);
  CAPTURE(angle);
  Ridges bars(angle, 0.03, cdem::Element::finite_volume);
  bars.s.hold(body_of("lower"), "xyz");
  const double before = cdem::kinetic_energy(bars.s.model, bars.s.state), depth = bars.meet(0.016);
  CHECK(bars.s.state.contacts.empty());
  CHECK(depth == Approx(Ridges::depth(angle)).epsilon(0.1));
  CHECK(cdem::energy(bars.s.model, bars.s.state).total() == Approx(before).epsilon(1e-2));
  const Vec3 momentum = testing::momentum(bars.s, Places::present).linear / (Ridges::mass() * Ridges::speed);
  CHECK(std::hypot(momentum.x(), momentum.y()) < 5e-3); // its tetrahedra are not symmetric, and it slides off
}

TEST_CASE("contact: ridges that rub on each other at a small angle keep their angular momentum",
          "[contact][edges]") {
  const auto element = GENERATE(cdem::Element::rigid, cdem::Element::finite_volume);
  Ridges bars(0.2, 0.03, element, element, 30);
  System& s = bars.s;
  const Vec3 past(0.2, 0.05, 0); // m/s
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    if (block_of(s.model, i) == 1)
      s.state.velocity[i] = node(past - Vec3(0, 0, Ridges::speed));
  const auto all = [&] {
    if (element == cdem::Element::finite_volume)
      return momentum(s, Places::present);
    Momentum sum;
    for (std::size_t i = 0; i < s.state.rigid.size(); ++i) {
      const Vec3 linear = s.model.rigid[i].mass * cdem::vec(s.state.rigid[i].velocity);
      sum.linear += linear;
      sum.angular +=
          cdem::vec(s.state.rigid[i].centroid).cross(linear) + cdem::vec(s.state.rigid[i].angular_momentum);
    }
    return sum;
  };
  if (element == cdem::Element::rigid)
    s.state.rigid[1].velocity = {past.x(), past.y(), -Ridges::speed};
  const Momentum before = all();
  bars.meet(0.012);
  const Momentum after = all();
  const double scale = Ridges::mass() * Ridges::speed;
  CHECK(s.state.contacts.empty());
  CHECK(s.state.spent.friction > 0.01 * 0.5 * scale * Ridges::speed);
  CHECK((after.linear - before.linear).norm() < 1e-10 * scale);
  CHECK((after.angular - before.angular).norm() < 1e-10 * scale);
}

TEST_CASE("contact: bars that cross on their edges at a mesh node part straight", "[contact][edges]") {
  // Bars of several cells, crossed at a node of both, of one or of none. Without friction the common normal is upright.
  const double aside = GENERATE(0.0, 5e-4, 2e-3, 0.01, 0.11);
  const int cells = GENERATE(7, 8); // of the upper bar: its middle lies between nodes, or at one
  CAPTURE(aside, cells);
  const Mat3 on_edge = rotation({1, 0, 0}, 45 * degree);
  const double half = std::sqrt(0.5) * 0.4, gap = 1e-3, speed = 0.6;
  cdem::Joint law = friction(0);
  law.normal_stiffness = 1e10;
  cdem::BodySpec lower = meshed("lower", box_at({2, 0.4, 0.4}, {8, 2, 2}, on_edge, {aside, 0, 0})),
                 upper = meshed("upper",
                                box_at({2, 0.4, 0.4}, {cells, 2, 2},
                                       rotation({0, 0, 1}, 90 * degree) * on_edge, {0, 0, 2 * half + gap}));
  lower.element = upper.element = cdem::Element::rigid;
  System s(build({lower, upper}, {{"lower", "upper", law}}));
  s.hold(body_of("lower"), "xyz");
  s.state.rigid[1].velocity = {0, 0, -speed};
  cdem::RunOptions options;
  options.duration = 0.012;
  s.run(options);
  const auto& [x, y, z] = s.state.rigid[1].velocity;
  const auto& spin = s.state.rigid[1].angular_momentum; // N m s
  const double mass = rock().density * 2 * 0.4 * 0.4;
  CHECK(s.state.contacts.empty());
  CHECK(z > 0.99 * speed);
  CHECK(std::hypot(x, y) < 1e-3 * speed);
  CHECK(std::hypot(spin[0], spin[1], spin[2]) < 1e-3 * mass * speed);
}

TEST_CASE("contact: a bar that lies flat across another rests on the crossings of their outlines",
          "[contact][edges]") {
  // No corner of a triangle is where they overlap; the normals are those of the faces, at the border of all fans.
  System s(build({meshed("lower", box_at({2.8, 0.4, 0.4}, {5, 1, 1}, Mat3::Identity(), {0, 0, -0.2})),
                  meshed("upper", box_at({2.8, 0.3, 0.4}, {5, 1, 1}, rotation({0, 0, 1}, 80 * degree),
                                         {0, 0, 0.2 + 1e-4}))},
                 {{"lower", "upper", friction(30)}}));
  s.hold(body_of("lower"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 0.05;
  options.local_damping = 0.5;
  s.run(options);
  const double start = centroid(s, 1).z(), weight = rock().density * 2.8 * 0.3 * 0.4 * 9.81;
  double least = 1e30, most = 0, late = 0;
  options.callback_every = 10;
  options.callback = [&] {
    double sum = 0;
    for (const cdem::Contact& c : s.state.contacts) {
      CHECK(c.kind == cdem::Contact::edge);
      sum += normal_force(s, c) * std::abs(c.normal.z());
      late = std::max(late, c.reference_penetration);
    }
    least = std::min(least, sum);
    most = std::max(most, sum);
  };
  s.run(options);
  CHECK(late == 0);
  CHECK(least == Approx(weight).epsilon(0.01));
  CHECK(most == Approx(weight).epsilon(0.01));
  CHECK(std::abs(centroid(s, 1).z() - start) < 1e-8);
}

TEST_CASE("contact: blocks in rows touch the ones beside them, not those across an edge or a corner",
          "[contact][edges]") {
  // Pressed together by a thousandth of an element, as rock and concrete are before they break, and not quite in line.
  const int divisions = GENERATE(1, 2, 3);
  const double size = 0.5, strain = 1e-3 / divisions;
  std::vector<geom::TetMesh> cubes;
  for (int i = 0; i < 8; ++i) {
    const Vec3 cell(i & 1, i >> 1 & 1, i >> 2);
    const Vec3 off(std::sin(2.0 * i), std::sin(3.0 * i), std::sin(5.0 * i));
    cubes.push_back(box_at(Vec3::Constant(size), {divisions, divisions, divisions},
                           rotation({1, 1, 0.3 * i}, 2e-4 * strain * i),
                           size * ((1 - strain) * cell + 0.3 * strain * off)));
  }
  cdem::BodySpec bodies = meshed("cubes", cubes[0]);
  bodies.meshes = cubes;
  System s(build({bodies}, {{"cubes", "cubes", friction(30)}}));
  s.hold(body_of("cubes"), "xyz");
  cdem::RunOptions options;
  options.steps = 1;
  s.run(options);
  std::set<std::pair<int, int>> met;
  for (const cdem::Contact& c : s.state.contacts) {
    const auto [a, b] = cdem::blocks_of(s.model, c);
    met.insert(std::minmax(a, b));
  }
  std::set<std::pair<int, int>> beside;
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4})
      if (!(i & bit))
        beside.emplace(i, i | bit);
  CHECK(met == beside);
}

TEST_CASE("contact: a lone corner is felt as soon as its springs are in", "[contact]") {
  const double size = 0.5, edge = size / 2;
  const Mat3 on_corner = Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1)).toRotationMatrix();
  System s(build({meshed("floor", box_at({2, 2, 0.5}, {3, 3, 1}, Mat3::Identity(), {0.1, 0.1, -0.25})),
                  meshed("cube", box_at({size, size, size}, {2, 2, 2}, on_corner,
                                        {0, 0, std::sqrt(0.75) * size + 1e-6}))},
                 {{"floor", "cube", friction(0)}}));
  s.hold(body_of("floor"), "xyz");
  cdem::Fix down = fixed(body_of("cube"));
  down.velocity = Vec3(0, 0, -0.1);
  s.conditions.fixes.push_back(down);
  const auto force_at = [&](double depth) {
    cdem::RunOptions options;
    options.time_step = 1e-6;
    options.duration = (depth - s.state.time * 0.1 + 1e-6) / 0.1;
    s.run(options);
    double sum = 0;
    for (const cdem::Contact& c : s.state.contacts)
      sum += normal_force(s, c);
    return sum;
  };
  // Its triangles have an edge of the cube there, which rises by 1 / sqrt(3) of its length, and a face's diagonal, which
  // rises by two of them; the springs stand in by 0.005 of both.
  const double in = 3 * 0.005 * edge / std::sqrt(3.0);
  CHECK(force_at(0.98 * in) == 0);
  const double first = force_at(1.2 * in), second = force_at(1.4 * in);
  CHECK(first > 0);
  CHECK(second / first == Approx(2).epsilon(0.02));
}
