// Contact where edges and corners meet: they carry on over nodes, and blocks in rows do not feel those across them.
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/contact/geometry/edge_touch.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <set>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

// Moves the upper body as it is. pace: m/s; step: s, at most.
void move_upper(System& s, const Vec3& way, std::int64_t every, std::function<void()> look, double pace = 0.5,
                double step = 2e-6) {
  cdem::Fix fix = fixed(body_of("upper"));
  fix.velocity = pace * way.normalized();
  s.conditions.fixes.push_back(fix);
  const double duration = way.norm() / pace;
  cdem::RunOptions options;
  options.steps = std::lround(std::ceil(duration / step - 1e-6));
  options.time_step = duration / static_cast<double>(options.steps);
  options.callback_every = every;
  options.callback = std::move(look);
  s.run(options);
  s.conditions.fixes.pop_back();
}

using Flat = std::array<double, 2>; // x, z

// m2, of two convex polygons, their corners counter-clockwise (Sutherland and Hodgman 1974).
double area_of_overlap(std::vector<Flat> of, const std::vector<Flat>& by) {
  const auto left_of = [](const Flat& a, const Flat& b, const Flat& p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
  };
  for (std::size_t i = 0; i < by.size(); ++i) {
    const Flat &a = by[i], &b = by[(i + 1) % by.size()];
    std::vector<Flat> kept;
    for (std::size_t k = 0; k < of.size(); ++k) {
      const Flat &p = of[k], &q = of[(k + 1) % of.size()];
      const double here = left_of(a, b, p), there = left_of(a, b, q);
      if (here >= 0)
        kept.push_back(p);
      if ((here > 0 && there < 0) || (here < 0 && there > 0))
        kept.push_back(
            {p[0] + here / (here - there) * (q[0] - p[0]), p[1] + here / (here - there) * (q[1] - p[1])});
    }
    of = std::move(kept);
  }
  double twice = 0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const Flat &p = of[k], &q = of[(k + 1) % of.size()];
    twice += p[0] * q[1] - p[1] * q[0];
  }
  return 0.5 * twice;
}

} // namespace

TEST_CASE("contact: edges in line part along the direction in which their overlap shrinks the fastest",
          "[contact][edges]") {
  // Prisms tip on tip, their faces at these angles from the horizontal, the upper one moved by `shift`.
  const auto [lower, upper] =
      GENERATE(std::pair(Flat{45, 45}, Flat{45, 45}), std::pair(Flat{20, 60}, Flat{20, 60}),
               std::pair(Flat{30, 70}, Flat{10, 40}), std::pair(Flat{60, 75}, Flat{60, 75}));
  const auto triangle = [](const Flat& angles, double up, const Flat& at) -> std::vector<Flat> {
    const auto foot = [&](double angle, double side) -> Flat {
      return {at[0] + side * std::cos(angle * degree), at[1] - up * std::sin(angle * degree)};
    };
    // Those of the upper one lie opposite: turned by half a turn about the tip.
    return {at, foot(angles[0], -up), foot(angles[1], up)};
  };
  for (const Flat& shift : {Flat{0, -2e-3}, Flat{-1e-3, -2e-3}, Flat{1.5e-3, -2e-3}, Flat{4e-3, -2.5e-3}}) {
    const std::vector<Flat> below = triangle(lower, 1, {0, 0}), above = triangle(upper, -1, shift);
    const auto area = [&](const Flat& way) {
      std::vector<Flat> moved = above;
      for (Flat& p : moved)
        p = {p[0] + way[0], p[1] + way[1]};
      return area_of_overlap(moved, below);
    };
    if (area({0, 0}) <= 0)
      continue;
    const auto prism = [](const char* name, const std::vector<Flat>& section) {
      std::vector<Vec3> corners;
      for (const Flat& p : section)
        for (const double y : {0.0, 1.0})
          corners.emplace_back(p[0], y, p[1]);
      geom::Assembly shape;
      shape.blocks.push_back(geom::convex_hull(corners));
      cdem::BodySpec spec = body(name, shape);
      spec.element = cdem::Element::rigid;
      return spec;
    };
    const double apart = 1; // m: they meet by their displacement
    std::vector<Flat> lifted = above;
    for (Flat& p : lifted)
      p[1] += apart;
    System s(build({prism("lower", below), prism("upper", lifted)}, {{"lower", "upper", friction(0)}}));
    for (int i = 0; i < static_cast<int>(s.state.displacement.size()); ++i)
      if (block_of(s.model, i) == 1)
        s.state.displacement[i].z = -apart;
    const auto tip = [&](int block) {
      for (const cdem::ContactEdge& e : s.model.surface.edges) {
        const auto at_tip = [&](int node) {
          const Vec3 place = cdem::place_of(s.model, s.state, node);
          const Flat& own = block == 0 ? below[0] : above[0];
          return std::abs(place.x() - own[0]) + std::abs(place.z() - own[1]) < 1e-9;
        };
        if (s.model.surface.triangles[e.triangles[0]].block == block && at_tip(e.nodes[0]) &&
            at_tip(e.nodes[1]))
          return e;
      }
      throw std::runtime_error("no edge at the tip");
    };
    const cdem::NearestOfEdges nearest = cdem::nearest_of_edges(s.model, s.state, tip(1), tip(0));
    REQUIRE(nearest.stretch);
    const double small = 1e-6;
    const Vec3 grows((area({small, 0}) - area({-small, 0})) / (2 * small), 0,
                     (area({0, small}) - area({0, -small})) / (2 * small));
    CAPTURE(lower[0], lower[1], upper[0], upper[1], shift[0], shift[1]);
    CHECK((nearest.stretch->normal + grows.normalized()).norm() < 1e-3);
  }
}

namespace {

// Two bars that meet ridge on ridge, the longer one below. Seen along the ridges (y) the upper one is turned about its ridge by `roll`,
// and its ridge lies `aside` and `deep` below the lower one. It is turned about the vertical by `yaw` and about x by `tilt`.
struct TwoRidges {
  TwoRidges(cdem::Element element, double roll, double yaw, double tilt, double aside, double deep)
      : s(build({bar("lower", element, 1.4, {0, 0, 0}, rotation({0, 1, 0}, 45 * degree)),
                 bar("upper", element, 1, {aside, 0, 2 * half - deep + apart},
                     rotation({0, 0, 1}, yaw * degree) * rotation({1, 0, 0}, tilt * degree) *
                         rotation({0, 1, 0}, (45 + roll) * degree))},
                {{"lower", "upper", friction(0)}})) {
    for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
      if (block_of(s.model, static_cast<int>(i)) == 1)
        s.state.displacement[i].z -= apart;
  }

  cdem::ContactEdge ridge(int block) const {
    const double up = block == 0 ? 1 : -1;
    const cdem::ContactEdge* highest = nullptr;
    double most = -1e300;
    for (const cdem::ContactEdge& e : s.model.surface.edges)
      if (s.model.surface.triangles[e.triangles[0]].block == block)
        if (const double z = up * (s.model.node_position[e.nodes[0]] + s.model.node_position[e.nodes[1]]).z();
            z > most) {
          most = z;
          highest = &e;
        }
    return *highest;
  }
  cdem::NearestOfEdges nearest() const {
    return cdem::nearest_of_edges(s.model, s.state, ridge(1), ridge(0));
  }
  // Over half of the stiffness of a crossing and over the measure, m2.
  double stored() const {
    const auto& stretch = nearest().stretch;
    return stretch ? stretch->share * stretch->depth * stretch->depth : 0;
  }
  void move(const std::vector<Vec3>& way, double part) {
    for (std::size_t i = 0; i < way.size(); ++i) {
      s.state.displacement[i].x += part * way[i].x();
      s.state.displacement[i].y += part * way[i].y();
      s.state.displacement[i].z += part * way[i].z();
    }
  }

  System s;

private:
  static constexpr double side = 0.4, half = side * 0.70710678118654752;
  static constexpr double apart = 1; // m: they meet by their displacement

  // place: of the middle of the lower side's ridge of the upper bar, from that of the lower bar.
  static cdem::BodySpec bar(const char* name, cdem::Element element, double length, const Vec3& place,
                            const Mat3& turn) {
    const bool upper = place.z() > 0;
    const Vec3 own = upper ? Vec3(0.5 * side, 0, -0.5 * side) : Vec3(0, 0, 0);
    std::vector<Vec3> corners;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5})
          corners.push_back(turn * (Vec3(side * x, length * y, side * z) - own) + place -
                            (upper ? Vec3(0, 0, half) : Vec3(0, 0, 0)));
    geom::Assembly shape;
    shape.blocks.push_back(geom::convex_hull(corners));
    cdem::BodySpec spec = body(name, shape);
    spec.element = element;
    return spec;
  }
};

} // namespace

TEST_CASE("contact: nearly parallel edges press with the derivative of what they store", "[contact][edges]") {
  // Over the measure, which a contact keeps. The bars do not move along their ridges: these would reach further past each other.
  const double roll = GENERATE(0.0, 20.0, 38.0), yaw = GENERATE(0.0, 0.02, 1.0),
               tilt = GENERATE(0.0, 0.005, 0.1), aside = GENERATE(0.0, 3e-5, -6e-5);
  CAPTURE(roll, yaw, tilt, aside);
  TwoRidges bars(cdem::Element::rigid, roll, yaw, tilt, aside, 1e-4);
  System& s = bars.s;
  const auto nearest = bars.nearest();
  if (!nearest.stretch) // they pass beside each other
    return;
  const cdem::EdgeStretch& stretch = *nearest.stretch;
  const double force = 2 * stretch.share * stretch.depth; // over the same as what is stored
  for (const auto& [shift, spin] :
       {std::pair(Vec3(0, 0, 1), Vec3(0, 0, 0)), std::pair(Vec3(1, 0, 0), Vec3(0, 0, 0)),
        std::pair(Vec3(0, 0, 0), Vec3(0, 0, 1)), std::pair(Vec3(0, 0, 0), Vec3(1, 0, 0))}) {
    std::vector<Vec3> way(s.state.displacement.size(), Vec3::Zero());
    for (std::size_t i = 0; i < way.size(); ++i)
      if (block_of(s.model, static_cast<int>(i)) == 1)
        way[i] = shift + spin.cross(cdem::place_of(s.model, s.state, static_cast<int>(i)) - stretch.place);
    const double work = force * stretch.normal.dot(shift + stretch.lever * spin), small = 1e-9;
    bars.move(way, small);
    const double after = bars.stored();
    bars.move(way, -2 * small);
    const double before = bars.stored();
    bars.move(way, small);
    CHECK((after - before) / (2 * small) == Approx(-work).epsilon(2e-3).margin(2e-3 * force));
  }
}

TEST_CASE("contact: what nearly parallel edges store does not jump as they turn past each other",
          "[contact][edges]") {
  const double roll = GENERATE(0.0, 20.0, 38.0), yaw = GENERATE(0.0, 0.05, -0.5);
  const bool tilts = GENERATE(false, true);
  CAPTURE(roll, yaw, tilts);
  const double aside = 4e-4, deep = 1e-3;
  double before = -1, most = 0, jump = 0;
  for (int i = -400; i <= 400; ++i) {
    const double angle = 2.5e-4 * i; // degrees
    TwoRidges bars(cdem::Element::rigid, roll, yaw + (tilts ? 0 : angle), tilts ? angle : 0, aside, deep);
    const double stored = bars.stored();
    if (before >= 0)
      jump = std::max(jump, std::abs(stored - before));
    before = stored;
    most = std::max(most, stored);
  }
  REQUIRE(most > 0);
  CHECK(jump < 0.02 * most);
}

TEST_CASE("contact: an edge pressed on another carries on over the nodes of both", "[contact][edges]") {
  // Two bars on edge, crossed, moved as they are: pressed together by d, then along the bisector over four nodes of each.
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0);
  const double phi = GENERATE(0.0, 20.0);
  cdem::Joint law = friction(phi);
  law.shear_stiffness = 1e9;
  System s(build({meshed("lower", box_at({0.9, 0.3, 0.3}, {9, 2, 2}, rotation({1, 0, 0}, 45 * degree),
                                         {0.43, 0.43, -across})),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2}, rotation({0, 1, 0}, 45 * degree),
                                         {0.24, 0.26, across + gap}))},
                 {{"lower", "upper", law}}));
  s.hold(body_of("lower"), "xyz");
  const auto move = [&](const Vec3& way) {
    std::vector<double> forces;
    const auto look = [&] {
      Vec3 force = Vec3::Zero();
      for (const cdem::Contact& c : s.state.contacts)
        force +=
            (cdem::blocks_of(s.model, c).first == 1 ? 1 : -1) * (normal_force(s, c) * c.normal + c.shear);
      forces.push_back(force.norm());
    };
    move_upper(s, way, 5, look, 2); // 4e-6 m a step
    return forces;
  };
  const double pressed = move({0, 0, -gap - d}).back();
  REQUIRE(pressed > 0);
  const std::vector<double> forces = move({0.41, 0.37, 0});
  // Until it slides friction grows. Beside a node, as far as the edges are pressed, the semi-springs there act too.
  const double slides = pressed * std::sqrt(1 + std::pow(std::tan(phi * degree), 2));
  int odd = 0;
  for (const double force : forces) {
    CHECK(force > 0.99 * pressed);
    CHECK(force < 3 * slides);
    odd += force > 1.01 * slides;
  }
  CHECK(odd < 0.02 * static_cast<double>(forces.size()));
}

TEST_CASE("contact: an edge pressed on a bent one carries on over its nodes, bent outwards and inwards",
          "[contact][edges]") {
  // The lower ridge goes up and down by a kink at every node; the upper one is moved along it, d below it.
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0), slice = 0.1;
  const double kink = GENERATE(1e-5, 0.008, 0.6); // rad
  const double turn = GENERATE(0.0, -35.0, 45.0) * degree;
  const double sideways = GENERATE(0.0, 0.5); // the upper one's nodes pass, too
  const double rise = 0.5 * slice * std::tan(0.5 * kink);
  const auto height = [&](double x) { // of the ridge
    const double part = x / slice - std::floor(x / slice);
    const double up = rise * (2 * part - 1);
    return static_cast<int>(std::floor(x / slice)) % 2 == 0 ? up : -up;
  };
  geom::TetMesh bent =
      box_at({0.9, 0.3, 0.3}, {9, 2, 2}, rotation({1, 0, 0}, 45 * degree), {0.45, 0.02, -across});
  for (Vec3& x : bent.nodes)
    x.z() += height(x.x() + 1e-9);
  const double start = 0.25;
  System s(build({meshed("lower", bent),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2},
                                         rotation({0, 0, 1}, turn) * rotation({0, 1, 0}, 45 * degree),
                                         {start, 0.02, across + gap + height(start)}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  double least = 1e30, most = 0, latest = 0;
  int not_one = 0;
  const auto look = [&] {
    double force = 0;
    int edges = 0;
    for (const cdem::Contact& c : s.state.contacts) {
      force += normal_force(s, c);
      latest = std::max(latest, c.reference_penetration);
      edges += c.kind == cdem::Contact::edge ? 1 : 0;
    }
    not_one += edges == 1 ? 0 : 1;
    least = std::min(least, force);
    most = std::max(most, force);
  };
  move_upper(s, {0, 0, -gap - d}, 1000000, [] {});
  look();
  const double pressed = least, stored = cdem::contact_energy(s.model, s.state, 0);
  REQUIRE(pressed > 0);
  double x = start, z = height(start);
  const auto cross_to = [&](double to, double pace) {
    const double way = to - x; // of the crossing
    move_upper(s, {way * (1 - sideways * std::tan(turn)), way * sideways, height(to - 1e-9) - z}, 1, look,
               pace);
    x = to;
    z = height(to - 1e-9);
  };
  for (const double ridge_node : {0.3, 0.4, 0.5, 0.6}) {
    cross_to(ridge_node - 5e-4, 25);
    cross_to(ridge_node, 1); // 2 um a step
    cross_to(ridge_node + 5e-4, 1);
  }
  CHECK(not_one == 0);
  // Depth is that below the ridge, which is inclined, and over a node bent inwards the way to the node.
  CHECK(least > (1 - 0.1 * kink) * pressed);
  CHECK(most < (1 + 0.2 * kink) * pressed);
  CHECK(latest < 0.01 * d);
  CHECK(s.state.spent.friction < 1e-3 * stored);
}

TEST_CASE("contact: an edge led off the end of another lets go, however short the last of its edges is",
          "[contact][edges]") {
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0), last = GENERATE(0.1, 0.005, 0.001);
  geom::TetMesh lower =
      box_at({0.9, 0.3, 0.3}, {9, 2, 2}, rotation({1, 0, 0}, 45 * degree), {-0.45, 0.02, -across});
  for (Vec3& x : lower.nodes)
    if (std::abs(x.x() + 0.1) < 1e-6)
      x.x() = -last;
  System s(build({meshed("lower", lower),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2}, rotation({0, 1, 0}, 45 * degree),
                                         {-0.05, 0, across + gap}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  std::size_t contacts = 0;
  const auto move = [&](const Vec3& way) {
    contacts = 0;
    move_upper(
        s, way, 1, [&] { contacts += s.state.contacts.size(); }, 20, 1.5e-7);
    return s.state.contacts.size();
  };
  REQUIRE(move({0, 0, -gap - d}) == 1);
  CHECK(move({0.0495, 0, 0}) == 1);
  move({0.001, 0, 0});
  move({0.02, 0, 0});
  CHECK(contacts == 0);
}

TEST_CASE("contact: an edge across a corner of an outline presses on both sides of it", "[contact][edges]") {
  // The plate's outline is bent by 28 degrees in its plane: a straight edge crosses it twice, in and out again.
  const double d = 2e-4, gap = 1e-4, slope = 0.25, at = 0.16;
  geom::TetMesh plate = box_at({0.8, 0.3, 0.3}, {2, 2, 2}, Mat3::Identity(), {0, 0, -0.15});
  for (Vec3& x : plate.nodes)
    x.y() -= slope * std::abs(x.x());
  System s(build({meshed("plate", plate),
                  meshed("upper", box_at({0.9, 0.3, 0.3}, {1, 2, 2}, rotation({1, 0, 0}, 45 * degree),
                                         {0, 0.15 - slope * at, 0.3 / std::sqrt(2.0) + gap}))},
                 {{"plate", "upper", friction(0)}}));
  s.hold(body_of("plate"), "xyz");
  move_upper(s, {0, 0, -gap - d}, 1000000, [] {});
  REQUIRE(s.state.contacts.size() == 2);
  for (const cdem::Contact& c : s.state.contacts) {
    CHECK(c.kind == cdem::Contact::edge);
    CHECK(c.depth == Approx(d).epsilon(0.01));
    CHECK(c.reference_penetration == 0);
  }
}

TEST_CASE("contact: bent edges that hit each other beside their nodes let go without loss",
          "[contact][edges]") {
  // Rigid, each bent by 10 degrees outwards or inwards in the middle. All that is lost is stored and let go elsewhere.
  const double bend = GENERATE(10.0, -10.0) * degree, turn = GENERATE(40.0, 75.0) * degree;
  const Vec3 off = GENERATE(Vec3(0.003, 0.001, 0), Vec3(-0.002, 0.0005, 0)), velocity(1, 0.4, -1);
  const auto bar = [&](const Mat3& attitude, const Vec3& at, double side) {
    geom::TetMesh mesh = box_at({2, 0.2, 0.2}, {2, 1, 1}, rotation({1, 0, 0}, 45 * degree), {0, 0, 0});
    for (Vec3& x : mesh.nodes)
      x.z() -= side * std::tan(0.5 * bend) * std::abs(x.x());
    return placed(mesh, attitude, at);
  };
  const double apart = 0.2 * std::sqrt(2.0) + 1e-3;
  std::vector<cdem::BodySpec> bodies{
      meshed("lower", bar(Mat3::Identity(), {0, 0, 0}, 1)),
      meshed("upper", bar(rotation({0, 0, 1}, turn), off + Vec3(0, 0, apart), -1))};
  for (cdem::BodySpec& body : bodies)
    body.element = cdem::Element::rigid;
  System s(build(bodies, {{"lower", "upper", friction(0)}}));
  s.state.rigid[1].velocity = {velocity.x(), velocity.y(), velocity.z()};
  const double kinetic = 0.5 * s.model.rigid[1].mass * velocity.squaredNorm();
  cdem::RunOptions options;
  options.duration = 0.01;
  double deepest = 0;
  options.callback_every = 1;
  options.callback = [&] {
    for (const cdem::Contact& c : s.state.contacts)
      deepest = std::max(deepest, c.depth);
  };
  s.run(options);
  CHECK(deepest > 0);
  CHECK(s.state.contacts.empty());
  CHECK(s.state.spent.friction < 0.01 * kinetic);
}

TEST_CASE("contact: edges beside the nodes of two bent ridges press the more the deeper they are",
          "[contact][edges]") {
  // Roofs 0.6 m high, both bent in plan and upwards, that cross at 20 degrees some millimetres beside their nodes: edges
  // that follow on both are near, and apart.
  const auto roof = [](const std::array<Vec3, 3>& ridge, const Vec3& across, const Vec3& down) {
    geom::TetMesh mesh = geom::box_mesh({2, 2, 1}, {2, 2, 1});
    for (Vec3& x : mesh.nodes) {
      const double side = std::round(x.y()) - 1.0;
      x = ridge[std::lround(x.x())] + side * across + (x.z() > 0.5 ? 0.6 * std::abs(side) : 1.0) * down;
    }
    return mesh;
  };
  System s(build(
      {meshed("lower",
              roof({Vec3(-0.980751, 0.070889, -0.181938), Vec3(0, 0, 0), Vec3(0.980751, 0.070889, -0.181938)},
                   Vec3::UnitY(), -Vec3::UnitZ())),
       meshed("upper", roof({Vec3(-0.968527, -0.125531, -0.209118), Vec3(0.000848, 0.001054, 0.001331),
                             Vec3(0.820639, 0.533645, -0.209118)},
                            Vec3(0.345710, -0.938341, 0), Vec3::UnitZ()))},
      {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  double last = 0;
  int falls = 0;
  move_upper(s, {0, 0, -3e-3}, 1, [&] {
    double force = 0;
    for (const cdem::Contact& c : s.state.contacts)
      force += normal_force(s, c);
    falls += force < 0.999 * last ? 1 : 0;
    last = force;
  });
  CHECK(last > 0);
  CHECK(falls == 0);
  CHECK(s.state.spent.friction < 1e-6 * cdem::contact_energy(s.model, s.state, 0));
}

TEST_CASE("contact: over nodes of uneven edges what is stored goes on or is lost, and never grows",
          "[contact][edges]") {
  // The lower bar's slices are 0.04 and 0.16 long in turn: soft and stiff edges.
  const double d = 2e-4, gap = 1e-4, across = 0.3 / std::sqrt(2.0);
  geom::TetMesh uneven = geom::box_mesh({0.9, 0.3, 0.3}, {9, 2, 2});
  for (Vec3& x : uneven.nodes) {
    const auto slice = static_cast<int>(std::lround(x.x() / 0.1));
    x = Vec3(0.2 * (slice / 2) + (slice % 2) * 0.04, x.y(), x.z()) - Vec3(0.45, 0.15, 0.15);
  }
  System s(build({meshed("lower", placed(uneven, rotation({1, 0, 0}, 45 * degree), {0.43, 0.43, -across})),
                  meshed("upper", box_at({0.3, 0.9, 0.3}, {2, 9, 2}, rotation({0, 1, 0}, 45 * degree),
                                         {0.24, 0.26, across + gap}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  std::vector<double> stored, friction_taken;
  std::size_t most = 0;
  const auto move = [&](const Vec3& way) {
    move_upper(s, way, 20, [&] {
      stored.push_back(cdem::contact_energy(s.model, s.state, 0));
      friction_taken.push_back(s.state.spent.friction);
      most = std::max(most, s.state.contacts.size());
    });
  };
  move({0, 0, -gap - d});
  const double before = stored.back(), taken = friction_taken.back();
  stored.clear();
  friction_taken.clear();
  most = 0;
  move({0.41, 0, 0});
  REQUIRE(most == 1);
  double least = before;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    CHECK(stored[i] <
          least * (1 + 1e-6)); // it falls where the next edge could store it only deeper than it is
    least = std::min(least, stored[i]);
    CHECK(stored[i] + friction_taken[i] - taken == Approx(before).epsilon(1e-6));
  }
  CHECK(least > 0.05 * before);
  CHECK(least < 0.7 * before);
}

TEST_CASE("contact: edges pressed deep carry on, and end the run as too deep", "[contact][edges]") {
  const double half = std::sqrt(0.5) * 0.4;
  const Mat3 on_edge = rotation({1, 0, 0}, 45 * degree);
  System s(build({meshed("lower", box_at({3, 0.4, 0.4}, {4, 1, 1}, on_edge, {0, 0, 0})),
                  meshed("upper", box_at({3, 0.4, 0.4}, {4, 1, 1}, rotation({0, 0, 1}, 75 * degree) * on_edge,
                                         {0.21, 0.17, 2 * half}))},
                 {{"lower", "upper", friction(0)}}));
  s.hold(body_of("lower"), "xyz");
  cdem::Fix down = fixed(body_of("upper"));
  down.velocity = Vec3(0, 0, -1);
  s.conditions.fixes.push_back(down);
  double last = 0;
  cdem::RunOptions options;
  options.duration = 0.2;
  options.callback_every = 20;
  options.callback = [&] {
    double sum = 0;
    for (const cdem::Contact& c : s.state.contacts)
      sum += normal_force(s, c);
    CHECK(sum > 0.999 * last);
    last = sum;
  };
  CHECK_THROWS_WITH(s.run(options), Catch::Contains("of a tet's height"));
  CHECK(s.state.time == Approx(0.25 * 0.4).epsilon(0.01)); // at a quarter of the height
}
