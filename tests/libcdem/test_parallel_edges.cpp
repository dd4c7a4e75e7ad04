// Edges that are nearly parallel: what their overlap stores, and how it presses.
#include "libcdem/contact/geometry/edge_touch.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

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
