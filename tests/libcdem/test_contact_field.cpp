// The pressure field: its kernel by itself, and in the solver beside the semi-springs.
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/contact/field/edge_in_tet.hpp"
#include "libcdem/contact/field/field_energy.hpp"
#include "libcdem/contact/field/surface_distance.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/core/random.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

double draw(std::uint64_t seed, std::uint64_t index) {
  return geom::uniform(seed, index, 0);
}
Vec3 draw_vec(std::uint64_t seed, std::uint64_t index) {
  return {draw(seed, 3 * index), draw(seed, 3 * index + 1), draw(seed, 3 * index + 2)};
}
cdem::field::Vec<double> as_vec(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

// A triangle and a tetrahedron that overlap in some way; phi >= 0.
struct Pair {
  std::array<Vec3, 4> x;
  std::array<Vec3, 3> q;
  std::array<double, 4> phi;

  explicit Pair(std::uint64_t seed) {
    do {
      for (std::uint64_t k = 0; k < 4; ++k)
        x[k] = draw_vec(seed, k + 100 * tries);
      ++tries;
    } while ((x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])) < 0.02);
    for (std::uint64_t i = 0; i < 3; ++i)
      q[i] = 1.5 * draw_vec(seed, 50 + i) - Vec3::Constant(0.25);
    for (std::uint64_t k = 0; k < 4; ++k)
      phi[k] = draw(seed, 400 + k);
  }
  std::uint64_t tries = 0;
};

template <std::size_t N, class T>
void barycentrics(const cdem::field::TetFrame<T>& tet, const cdem::field::Vec<T> (&q)[N], T (&l)[4][N]) {
  for (std::size_t i = 0; i < N; ++i) {
    T at[4];
    cdem::field::barycentric(tet, q[i], at);
    for (int k = 0; k < 4; ++k)
      l[k][i] = at[k];
  }
}

struct Forces {
  std::array<Vec3, 3> on_source;
  std::array<Vec3, 4> on_target;
  double area = 0;
};

Forces forces_of(const Pair& p) {
  using namespace cdem::field;
  const Vec<double> x[4] = {as_vec(p.x[0]), as_vec(p.x[1]), as_vec(p.x[2]), as_vec(p.x[3])};
  const Vec<double> q[3] = {as_vec(p.q[0]), as_vec(p.q[1]), as_vec(p.q[2])};
  const double phi[4] = {p.phi[0], p.phi[1], p.phi[2], p.phi[3]};
  const TetFrame<double> tet = tet_frame(x);
  double l[4][3];
  barycentrics(tet, q, l);
  const ClippedTriangle<double> c = clip_triangle(phi, l);
  const FieldForces<double> f = field_forces(cross(minus(q[1], q[0]), minus(q[2], q[0])), c, l);
  Forces out;
  out.area = c.area;
  for (int i = 0; i < 3; ++i)
    out.on_source[i] = Vec3(f.on_source[i].x, f.on_source[i].y, f.on_source[i].z) / tet.volume6;
  for (int k = 0; k < 4; ++k)
    out.on_target[k] = Vec3(f.on_target[k].x, f.on_target[k].y, f.on_target[k].z) / tet.volume6;
  return out;
}

} // namespace
TEST_CASE("field: what presses a triangle presses the tetrahedron back, in force and in moment", "[field]") {
  int touching = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Pair p(seed);
    const Forces f = forces_of(p);
    touching += f.area > 0;
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0;
    for (int i = 0; i < 3; ++i) {
      force += f.on_source[i];
      moment += p.q[i].cross(f.on_source[i]);
      size += f.on_source[i].norm();
    }
    for (int k = 0; k < 4; ++k) {
      force += f.on_target[k];
      moment += p.x[k].cross(f.on_target[k]);
      size += f.on_target[k].norm();
    }
    CHECK(force.norm() <= 1e-13 * size);
    CHECK(moment.norm() <= 1e-12 * size);
  }
  CHECK(touching > 50);
}

TEST_CASE("field: the part of a triangle in a tetrahedron is that of a fine sampling", "[field]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Pair p(seed);
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
      edges.col(k) = p.x[k + 1] - p.x[0];
    const Mat3 inverse = edges.inverse();
    constexpr int n = 400;
    double area = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const double u = (i + 1.0 / 3) / n, v = (j + 1.0 / 3) / n;
        const Vec3 l = inverse * (p.q[0] + u * (p.q[1] - p.q[0]) + v * (p.q[2] - p.q[0]) - p.x[0]);
        area += l.minCoeff() > 0 && l.sum() < 1 ? 1.0 / (n * n) : 0;
      }
    CHECK(forces_of(p).area == Approx(area).margin(0.01));
  }
}

TEST_CASE("field: eight lanes have the bits of one number", "[field]") {
  using namespace cdem::field;
  using cdem::simd::Oct;
  for (std::uint64_t first = 1; first <= 160; first += cdem::lanes) {
    Vec<Oct> x[4], q[3];
    Oct phi[4];
    for (int lane = 0; lane < cdem::lanes; ++lane) {
      const Pair p(first + static_cast<std::uint64_t>(lane));
      for (int k = 0; k < 4; ++k) {
        x[k].x[lane] = p.x[k].x(), x[k].y[lane] = p.x[k].y(), x[k].z[lane] = p.x[k].z();
        phi[k][lane] = p.phi[k];
      }
      for (int i = 0; i < 3; ++i)
        q[i].x[lane] = p.q[i].x(), q[i].y[lane] = p.q[i].y(), q[i].z[lane] = p.q[i].z();
    }
    Oct l[4][3], ends[4][2];
    barycentrics(tet_frame(x), q, l);
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 2; ++i)
        ends[k][i] = l[k][i];
    const ClippedTriangle<Oct> c = clip_triangle(phi, l);
    const ClippedEdge<Oct> e = clip_edge(phi, ends);
    bool same = true;
    for (int lane = 0; lane < cdem::lanes; ++lane) {
      const Pair p(first + static_cast<std::uint64_t>(lane));
      const Vec<double> y[4] = {as_vec(p.x[0]), as_vec(p.x[1]), as_vec(p.x[2]), as_vec(p.x[3])};
      const Vec<double> r[3] = {as_vec(p.q[0]), as_vec(p.q[1]), as_vec(p.q[2])};
      const double value[4] = {p.phi[0], p.phi[1], p.phi[2], p.phi[3]};
      double m[4][3], tips[4][2];
      barycentrics(tet_frame(y), r, m);
      for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 2; ++i)
          tips[k][i] = m[k][i];
      const ClippedTriangle<double> d = clip_triangle(value, m);
      const ClippedEdge<double> f = clip_edge(value, tips);
      same = same && c.area[lane] == d.area && c.p[lane] == d.p && c.pu[lane] == d.pu && c.pv[lane] == d.pv &&
             c.deepest[lane] == d.deepest && e.length[lane] == f.length && e.i[lane] == f.i &&
             e.it[lane] == f.it && e.square[lane] == f.square;
    }
    CHECK(same);
  }
}

TEST_CASE("field: the distance to a surface is that of looking at every triangle", "[field]") {
  const geom::TetMesh mesh = geom::box_mesh({1, 2, 3}, {3, 4, 5});
  std::vector<cdem::field::SurfaceDistance::Corners> triangles;
  System s(build({meshed("a", mesh), meshed("b", placed(mesh, Mat3::Identity(), {5, 0, 0}))}));
  for (const cdem::BoundaryTriangle& t : s.model.mesh.boundary)
    if (t.block == 0)
      triangles.push_back({s.model.node_position[t.nodes[0]], s.model.node_position[t.nodes[1]],
                           s.model.node_position[t.nodes[2]]});
  const cdem::field::SurfaceDistance distance(triangles);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Vec3 x = draw_vec(9, i).cwiseProduct(Vec3(1, 2, 3));
    const double expected = x.cwiseMin(Vec3(1, 2, 3) - x).minCoeff();
    CHECK(distance(x) == Approx(expected).epsilon(1e-12));
  }
}

namespace {

cdem::Model field_model(const std::vector<cdem::BodySpec>& bodies, const std::vector<cdem::PairSpec>& pairs) {
  cdem::ModelSpec spec;
  spec.bodies = bodies;
  spec.pairs = pairs;
  spec.contact_method = cdem::ContactMethod::field;
  return cdem::first_model(spec);
}

// Inner nodes and the corners between them are moved a little: nothing in it lies in a row.
geom::TetMesh shaken(geom::TetMesh mesh, double by, std::uint64_t seed) {
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    mesh.nodes[i] += by * (draw_vec(seed, i) - Vec3::Constant(0.5));
  return mesh;
}

void shift(System& s, int block, const Vec3& by) {
  for (int i = s.model.blocks[block].node_begin; i < s.model.blocks[block].node_end; ++i)
    s.state.displacement[i] = node(vec(s.state.displacement[i]) + by);
}

std::vector<Vec3> contact_forces_of(System& s) {
  cdem::Workspace work(s.model, s.state, s.conditions);
  cdem::contact_forces(s.model, s.state, work, 1);
  std::vector<Vec3> f;
  for (const cdem::Node& n : work.contact_force)
    f.push_back(vec(n));
  return f;
}

System two_shaken_boxes(const Vec3& overlap) {
  System s(field_model(
      {meshed("one", shaken(box_at({1, 0.8, 0.6}, {2, 2, 1}, rotation({1, 2, 3}, 0.4), {0, 0, 0}), 0.05, 1)),
       meshed("two", shaken(box_at({0.7, 0.7, 0.7}, {1, 2, 2}, rotation({3, -1, 1}, 1.1), {1.4, 0.3, 0.1}),
                            0.05, 2))},
      {{"one", "two", friction(0)}}));
  shift(s, 1, overlap);
  return s;
}

} // namespace

TEST_CASE("field: the forces are the gradient of the energy", "[field]") {
  System s = two_shaken_boxes({-0.50, 0, 0});
  const std::vector<Vec3> f = contact_forces_of(s);
  REQUIRE_FALSE(s.state.contacts.empty());
  double largest = 0;
  for (const Vec3& at : f)
    largest = std::max(largest, at.norm());
  const double step = 1e-6;
  double error = 0;
  for (std::size_t i = 0; i < f.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy_at = [&](double by) {
        double* const u = &s.state.displacement[i].x + axis;
        const double before = *u;
        *u = before + by;
        const double energy = cdem::field::field_energy(s.model, s.state, 0);
        *u = before;
        return energy;
      };
      error = std::max(error, std::abs((energy_at(step) - energy_at(-step)) / (2 * step) + f[i][axis]));
    }
  CHECK(error < 1e-6 * largest);
}

TEST_CASE("field: two flat faces carry kn' = 1 / (hA/EA + hB/EB) a depth", "[field]") {
  const double depth = 1e-4;
  for (const bool given : {false, true}) {
    cdem::Joint law = friction(0);
    if (given)
      law.normal_stiffness = 3e9;
    cdem::Elastic soft = rock();
    soft.youngs_modulus /= 3;
    System s(field_model(
        {meshed("plate", box_at({3, 3, 0.6}, {5, 5, 3}, Mat3::Identity(), {0, 0, -0.3})),
         meshed("block", box_at({1, 1, 1}, {2, 2, 2}, Mat3::Identity(), {0.13, 0.07, 0.5}), {}, soft)},
        {{"plate", "block", law}}));
    shift(s, 1, {0, 0, -depth});
    const std::vector<Vec3> f = contact_forces_of(s);
    Vec3 sum = Vec3::Zero();
    for (int i = s.model.blocks[1].node_begin; i < s.model.blocks[1].node_end; ++i)
      sum += f[i];
    const double stiffness = given ? 3e9 : 1 / (0.2 / rock().youngs_modulus + 0.5 / soft.youngs_modulus);
    // The block's four lower edges are lines: w / 2 of each length more, times the depth. Sides meet at right angles.
    CHECK(sum.z() == Approx(stiffness * depth).epsilon(0.15));
    CHECK(Vec3(sum.x(), sum.y(), 0).norm() < 1e-9 * sum.z());
  }
}

namespace {

constexpr cdem::ContactMethod both_methods[] = {cdem::ContactMethod::semi_springs,
                                                cdem::ContactMethod::field};

cdem::Model model_by(cdem::ContactMethod method, const std::vector<cdem::BodySpec>& bodies,
                     const std::vector<cdem::PairSpec>& pairs) {
  cdem::ModelSpec spec;
  spec.bodies = bodies;
  spec.pairs = pairs;
  spec.contact_method = method;
  return cdem::first_model(spec);
}

// Two boxes of meshes without order that fly into each other, turning.
System two_that_collide(cdem::ContactMethod method, double angle) {
  System s(model_by(
      method,
      {meshed("one", shaken(box_at({1, 0.8, 0.6}, {3, 3, 2}, rotation({1, 2, 3}, 0.4), {0, 0, 0}), 0.05, 1)),
       meshed("two", shaken(box_at({0.7, 0.7, 0.7}, {2, 3, 2}, rotation({3, -1, 1}, 1.1), {1.4, 0.3, 0.1}),
                            0.05, 2))},
      {{"one", "two", friction(angle)}}));
  for (int i = 0; i < static_cast<int>(s.state.velocity.size()); ++i)
    s.state.velocity[i] = node(block_of(s.model, i) == 1
                                   ? Vec3(Vec3(-6, 0.5, -1) + Vec3(0, 3, 5).cross(s.model.node_position[i]))
                                   : Vec3(2, 1, 0));
  return s;
}

double force_on_block(const System& s, int axis) { // N, of contacts without friction
  double sum = 0;
  if (s.model.field.empty()) {
    for (const cdem::Contact& c : s.state.contacts)
      sum += (cdem::blocks_of(s.model, c).first == 1 ? 1 : -1) * normal_force(s, c) * c.normal[axis];
    return sum;
  }
  System copy = s;
  const std::vector<Vec3> f = contact_forces_of(copy);
  for (int i = s.model.blocks[1].node_begin; i < s.model.blocks[1].node_end; ++i)
    sum += f[i][axis];
  return sum;
}

} // namespace

TEST_CASE("field: two bodies that collide keep momentum, angular momentum and energy", "[field]") {
  for (const cdem::ContactMethod method : both_methods) {
    const double angle = GENERATE(0.0, 40.0);
    System s = two_that_collide(method, angle);
    const Momentum before = momentum(s, Places::present);
    const double start = cdem::kinetic_energy(s.model, s.state);
    double worst = 0;
    bool touched = false;
    cdem::RunOptions options;
    options.duration = 0.1;
    options.callback_every = 50;
    options.callback = [&] {
      touched = touched || !s.state.contacts.empty();
      worst = std::max(worst, std::abs(cdem::energy(s.model, s.state).total() / start - 1));
    };
    s.run(options);
    REQUIRE(touched);
    REQUIRE(s.state.contacts.empty());
    const Momentum after = momentum(s, Places::present);
    const double last = cdem::energy(s.model, s.state).total() / start - 1;
    const bool by_field = method == cdem::ContactMethod::field;
    CAPTURE(by_field, angle, worst, last, s.state.spent.friction / start, s.log.deepest_contact);
    CHECK((after.linear - before.linear).norm() < 1e-12 * before.linear.norm());
    CHECK((after.angular - before.angular).norm() < 1e-10 * before.angular.norm());
    CHECK(std::abs(last) < 2e-3);
    CHECK(s.state.spent.friction >= 0);
  }
}

TEST_CASE("field: a block that slides over a meshed plate is carried evenly", "[field]") {
  for (const cdem::ContactMethod method : both_methods) {
    cdem::BodySpec block =
        meshed("block", box_at({0.3, 0.2, 0.2}, {3, 2, 2}, Mat3::Identity(), {0.31, 0.013, 0.1 + 1e-4}));
    cdem::BodySpec plate =
        meshed("plate", box_at({1.2, 0.6, 0.2}, {12, 6, 2}, Mat3::Identity(), {0.5, 0, -0.1}));
    plate.element = block.element = cdem::Element::rigid;
    constexpr double speed = 2;
    System s(model_by(method, {plate, block}, {{"plate", "block", friction(0)}}));
    s.hold(body_of("plate"), "xyz");
    s.hold(body_of("block"), "xyz");
    cdem::RunOptions options;
    options.steps = 100;
    options.time_step = 1e-5;
    s.conditions.fixes.back().velocity = Vec3(0, 0, -(1e-4 + 1e-4) / (options.time_step * 100));
    s.run(options);
    s.conditions.fixes.back().velocity = Vec3(speed, 0, 0);
    double least = std::numeric_limits<double>::infinity(), most = 0, along = 0;
    options.steps = 0;
    options.duration = 0.15 / speed;
    options.callback_every = 25;
    options.callback = [&] {
      least = std::min(least, force_on_block(s, 2));
      most = std::max(most, force_on_block(s, 2));
      along = std::max(along, std::abs(force_on_block(s, 0)));
    };
    s.run(options);
    const bool by_field = method == cdem::ContactMethod::field;
    const double ripple = (most - least) / (most + least), drag = along / most;
    CAPTURE(by_field, ripple, drag, most);
    REQUIRE(least > 0);
    if (by_field) {
      CHECK(ripple < 1e-6);
      CHECK(drag < 1e-6);
    }
  }
}

TEST_CASE("field: a block on a slope rests at 0.9 tan(phi) and slides at 1.1", "[field]") {
  for (const cdem::ContactMethod method : both_methods)
    for (const double part : {0.9, 1.1}) {
      cdem::Joint law = friction(30);
      law.normal_stiffness = 1e8;
      System s(model_by(method,
                        {meshed("plate", box_at({3, 2, 0.4}, {6, 4, 1}, Mat3::Identity(), {0.7, 0, -0.2})),
                         meshed("block", box_at({1, 1, 0.3}, {3, 3, 1}, Mat3::Identity(), {0, 0, 0.15}))},
                        {{"plate", "block", law}}));
      s.hold(body_of("plate"), "xyz");
      const double slope = std::atan(part * std::tan(30 * degree));
      s.conditions.gravity = gravity(9.81 * Vec3(std::sin(slope), 0, -std::cos(slope)));
      s.hold(body_of("block"), "x");
      REQUIRE(s.relax(1e-6).converged);
      s.conditions.fixes.pop_back();
      const double x0 = centroid(s, 1).x();
      cdem::RunOptions options;
      options.duration = 0.1;
      s.run(options);
      const double first = centroid(s, 1).x() - x0;
      s.run(options);
      const double second = centroid(s, 1).x() - x0 - first;
      // The second difference: how it was let go does not count.
      const double acceleration = (second - first) / 0.01;
      const double expected = 9.81 * (std::sin(slope) - std::tan(30 * degree) * std::cos(slope));
      const bool by_field = method == cdem::ContactMethod::field;
      CAPTURE(by_field, part, first, second, acceleration, expected);
      if (part < 1)
        CHECK(std::abs(second) < 1e-6);
      else
        CHECK(acceleration == Approx(expected).epsilon(0.01));
    }
}

TEST_CASE("field: the same bits for every number of threads, and however often it is looked for", "[field]") {
  const auto hash_with = [](int threads, bool anew_every_200_steps) {
    System s = two_that_collide(cdem::ContactMethod::field, 35);
    s.threads = threads;
    cdem::RunOptions options;
    options.duration = 0.08;
    std::optional<cdem::Moment> moment;
    cdem::run({s.model, s.state, s.conditions, s.log, s.last_good, s.observer, s.threads, 1, nullptr,
               anew_every_200_steps ? &moment : nullptr},
              options);
    CHECK(s.log.deepest_contact > 0);
    return cdem::hash(s.state);
  };
  const auto once = hash_with(1, false);
  CHECK(hash_with(2, false) == once);
  CHECK(hash_with(2, true) == once);
}

TEST_CASE("field: a mesh that may break is refused", "[field][input]") {
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  CHECK_THROWS_WITH(
      field_model(
          {meshed("floor", box_at({2, 2, 0.4}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.2})),
           meshed("unit", box_at({0.5, 0.5, 0.5}, {1, 1, 1}, Mat3::Identity(), {0, 0, 0.5}), everywhere)},
          {{"floor", "unit", friction(30)}}),
      Catch::Contains("\"semi_springs\" with the body \"unit\": its mesh may break"));
}
