// Broken joints that are handed over to contact while they are pressed and sheared: the contacts carry on with the forces.
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/two_halves.hpp"

#include "libcdem/bond/leaving_faces.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/state/places.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

const Mat3 straight = Mat3::Identity(), odd = rotation({1, 2, -0.5}, 37 * degree);
constexpr double friction_angle = 20 * degree, steep = 15 * degree;
const Vec3 gravity_on_slope = 1000 * Vec3(std::sin(steep), 0, -std::cos(steep)); // m/s2
constexpr double edge = 0.1;                                                     // m, of a cell
const Vec3 lower(1.4, 0.4, 0.2), upper(0.6, 0.4, 0.2);                           // m
constexpr double begins = 0.3; // m, where the upper part does

// A long lower part and a short upper part, regions of one mesh; jittered, but flat where they meet.
geom::TetMesh two_parts(double jitter) {
  const int high = static_cast<int>(std::lround((lower.z() + upper.z()) / edge));
  geom::TetMesh box = geom::box_mesh({lower.x(), lower.y(), high * edge},
                                     {static_cast<int>(std::lround(lower.x() / edge)),
                                      static_cast<int>(std::lround(lower.y() / edge)), high},
                                     jitter);
  geom::TetMesh mesh;
  std::vector<int> number(box.nodes.size(), -1);
  for (const geom::Tet& tet : box.tets) {
    Vec3 centre = Vec3::Zero();
    for (const int node : tet)
      centre += box.nodes[node] / 4;
    const bool above = centre.z() > lower.z();
    if (above && (centre.x() < begins || centre.x() > begins + upper.x()))
      continue;
    geom::Tet now = tet;
    for (int& node : now) {
      if (number[node] < 0) {
        number[node] = static_cast<int>(mesh.nodes.size());
        mesh.nodes.push_back(box.nodes[node]);
      }
      node = number[node];
    }
    mesh.tets.push_back(now);
    mesh.region.push_back(above ? 1 : 0);
  }
  const double near = 0.4 * edge;
  for (Vec3& x : mesh.nodes) {
    if (std::abs(x.z() - lower.z()) < near)
      x.z() = lower.z();
    for (const double end : {begins, begins + upper.x()})
      if (std::abs(x.x() - end) < near && x.z() > lower.z() - near)
        x.x() = end;
  }
  return mesh;
}

// The upper part lies on a slope, pressed by its weight and held by friction.
System leaning(const Mat3& turn, double jitter, int threads, const Vec3& pull = gravity_on_slope) {
  cdem::Joint joint = halves_joint(false);
  joint.friction_angle = friction_angle;
  System s(build({meshed("unit", placed(two_parts(jitter), turn, Vec3::Zero()), between_halves(),
                         soft_rock(1e9), joint)},
                 {{"unit", "unit", friction(friction_angle / degree)}}));
  s.threads = threads;
  const Vec3 up = turn.col(2);
  s.hold(cdem::Selection::where([=](const Vec3& x) { return x.dot(up) < 1e-6; }, "the foot"), "xyz");
  s.conditions.gravity = gravity(turn * pull);
  REQUIRE(s.relax(1e-6).converged);
  return s;
}

void let_faces_leave(System& s) {
  each_face_spring(s.model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace& at) {
    set_hand_over(s.state.faces[at.batch], at.lane, cdem::HandOver::leaving);
  });
}

constexpr double steeper = 25 * degree, pull = 100; // m/s2
constexpr double way = 0.24; // m, that the upper part slides: its rear edge passes two rows of nodes

Vec3 pull_at(double angle) {
  return pull * Vec3(std::sin(angle), 0, -std::cos(angle));
}

// The same with a joint of its own between the two, in a body of a rougher one and with a rougher law in contacts.
System leaning_on_its_joint(double jitter) {
  cdem::BodySpec unit = meshed("unit", placed(two_parts(jitter), straight, Vec3::Zero()), between_halves(),
                               soft_rock(1e9), halves_joint());
  unit.joint.friction_angle = 45 * degree;
  cdem::Joint own = unit.joint;
  own.friction_angle = friction_angle;
  own.tensile_strength = own.cohesion = 1; // Pa
  unit.region_laws.regions.push_back({0, 1});
  unit.region_laws.joints.push_back(own);
  System s(build({unit}, {{"unit", "unit", friction(35)}}));
  s.hold(cdem::Selection::where([](const Vec3& x) { return x.z() < 1e-6; }, "the foot"), "xyz");
  s.conditions.gravity = gravity(pull_at(steep));
  REQUIRE(s.relax(1e-6).converged);
  return s;
}

// m/s2, of a block on the slope.
double slides_at() {
  return pull * (std::sin(steeper) - std::tan(friction_angle) * std::cos(steeper));
}

// m, how far the lower side of the upper part has come below the upper side of the lower part, at most.
double sunk(const System& s, const Mat3& turn) {
  double deepest = 0;
  for (std::size_t t = 0; t < s.model.tets.size(); ++t) {
    double above = 0;
    for (const int n : s.model.tets[t])
      above += s.model.node_position[n].dot(turn.col(2)) / 4;
    for (const int n : s.model.tets[t])
      if (above > lower.z())
        deepest = std::max(deepest, lower.z() - cdem::place_of(s.model, s.state, n).dot(turn.col(2)));
  }
  return deepest;
}

// m, how far the middle of the upper part has moved in a direction since the model was built.
double moved(const System& s, const Mat3& turn, const Vec3& to) {
  double sum = 0, mass = 0;
  for (const geom::Tet& tet : s.model.tets) {
    double above = 0, gone = 0;
    for (const int n : tet) {
      above += s.model.node_position[n].dot(turn.col(2)) / 4;
      gone += vec(s.state.displacement[n]).dot(to) / 4;
    }
    if (above < lower.z())
      continue;
    sum += gone;
    mass += 1;
  }
  return sum / mass;
}

// m/s, of the upper part down the slope.
double speed_of_upper(const System& s, const Mat3& turn) {
  double sum = 0, mass = 0;
  for (const geom::Tet& tet : s.model.tets) {
    double above = 0;
    for (const int n : tet)
      above += s.model.node_position[n].dot(turn.col(2)) / 4;
    if (above < lower.z())
      continue;
    for (const int n : tet) {
      sum += s.model.node_mass[n] * vec(s.state.velocity[n]).dot(turn.col(0));
      mass += s.model.node_mass[n];
    }
  }
  return sum / mass;
}

} // namespace

TEST_CASE("hand-over: faces that slide let go of their springs little by little, and nothing jumps",
          "[contact][hand_over][energy]") {
  const auto [turn, jitter] = GENERATE(std::pair(straight, 0.0), std::pair(odd, 0.15));
  System s = leaning(turn, jitter, 1, pull_at(steep));
  s.conditions.gravity = gravity(turn * pull_at(steeper));
  const double size = edge / std::sqrt(2.0), far = cdem::slid_off_from * size; // m
  cdem::RunOptions options;
  options.duration = std::sqrt(2 * far / slides_at());
  double height = 0; // m, that the upper part moves up or down, at most
  options.callback_every = 20;
  options.callback = [&] { height = std::max(height, std::abs(moved(s, turn, turn.col(2)))); };
  s.run(options);
  std::int64_t leaving = 0;
  for (const cdem::FaceStateBatch& faces : s.state.faces)
    leaving += cdem::lanes - std::count(std::begin(faces.handed_over), std::end(faces.handed_over), 0);
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  const double mass = rock().density * upper.prod(), speed = speed_of_upper(s, turn);
  const double rubs =
      std::tan(friction_angle) * mass * pull * std::cos(steeper) * moved(s, turn, turn.col(0));
  // Rough as the tetrahedra lie on each other, they set the parts trembling, and nothing damps that.
  const double trembling = e.external - 0.5 * mass * speed * speed - e.friction;
  INFO("leaving " << leaving << ", height " << height << " m, friction " << e.friction / rubs
                  << ", trembling " << trembling / rubs << ", balance " << e.balance_error());
  CHECK(leaving > 40);
  CHECK(height < 2e-3 * edge);
  CHECK(e.friction == Approx(rubs).epsilon(0.03));
  CHECK(trembling < 0.08 * rubs);
  CHECK(e.balance_error() < 1.5e-3); // 4e-3 of less energy where the first of them leaves
}

TEST_CASE("hand-over: the same bits for every number of threads", "[contact][hand_over][threads]") {
  const auto hash_with = [](int threads) {
    System s = leaning(odd, 0.15, threads);
    let_faces_leave(s);
    cdem::RunOptions options;
    options.steps = 300;
    s.run(options);
    return cdem::hash(s.state);
  };
  CHECK(hash_with(1) == hash_with(2));
}

namespace {

struct Slide {
  double acceleration = 0; // m/s2, mean
  double deepest = 0;      // m, of the upper part's nodes, below the upper side of the lower part
  double across = 0;       // N, normal forces of all contacts, along the slope, mean
};

Slide slide(System& s, const Mat3& turn) {
  s.conditions.gravity = gravity(turn * pull_at(steeper));
  Slide found;
  std::int64_t looks = 0;
  cdem::RunOptions options;
  options.duration = std::sqrt(2 * way / slides_at());
  options.callback_every = 1;
  options.callback = [&] {
    Vec3 sum = Vec3::Zero();
    for (const cdem::Contact& c : s.state.contacts)
      sum += normal_force(s, c) * (c.normal.dot(turn.col(2)) > 0 ? c.normal : Vec3(-c.normal));
    found.across += sum.dot(turn.col(0));
    ++looks;
    found.deepest = std::max(found.deepest, sunk(s, turn));
  };
  s.run(options);
  found.across = std::abs(found.across) / static_cast<double>(looks);
  found.acceleration = speed_of_upper(s, turn) / options.duration;
  return found;
}

} // namespace

// Semi-springs of the lower part that the rear edge has passed stand beside the upper part, a little above its lower side
// where it has sunk in.
TEST_CASE("hand-over: a part that slides off a broken joint meets nothing behind its rear edge",
          "[contact][hand_over][behind]") {
  const auto [turn, jitter] = GENERATE(std::pair(straight, 0.0), std::pair(odd, 0.15));
  System s = leaning(turn, jitter, 1, pull_at(steep));
  const Slide found = slide(s, turn);
  INFO("deepest " << found.deepest << " m, across " << found.across << " N");
  CHECK(found.acceleration == Approx(slides_at()).epsilon(0.09)); // friction within 2.5 %
  CHECK(found.deepest < 5e-3 * edge);
  CHECK(found.across < 0.02 * rock().density * upper.prod() * pull);
}

TEST_CASE("hand-over: a part that comes back to where it was torn off slides as if it had never left",
          "[contact][hand_over][back]") {
  cdem::Bonding bonding = between_halves();
  bonding.kind = GENERATE(cdem::BondKind::springs, cdem::BondKind::cohesive);
  const double lift = GENERATE(0.02, 0.5) * edge; // m
  CAPTURE(bonding.is_cohesive(), lift);
  cdem::Joint smooth = halves_joint();
  smooth.friction_angle = 0;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("unit", two_parts(0), bonding, soft_rock(1e9), smooth)};
  spec.pairs = {{"unit", "unit", friction(0)}};
  cdem::Simulation torn(spec, 1, nullptr);
  torn.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0, 0, lower.z()}, {0, 0, 1})));
  System s(torn.model());
  s.state = torn.state();
  s.hold(cdem::Selection::where([](const Vec3& x) { return x.z() < 1e-6; }, "the foot"), "xyz");
  const auto faces_left = [&] {
    int count = 0;
    each_face_spring(s.model.mesh, [&](const cdem::MeshChunk&, const cdem::FaceSpringPlace& at) {
      count += at.point == 0 && cdem::handed_over(s.state.faces[at.batch], at.lane) ? 1 : 0;
    });
    return count;
  };
  const auto run = [&](double duration, double damping = 0) {
    cdem::RunOptions options;
    options.duration = duration; // s
    options.local_damping = damping;
    s.run(options);
  };
  const auto fly = [&](double way) { // m, up, without any force; then it stands
    constexpr double pace = 0.5;     // m/s
    const auto move = [&](double speed) {
      for (const geom::Tet& tet : s.model.tets)
        for (const int n : tet)
          if ((s.model.node_position[tet[0]] + s.model.node_position[tet[1]] + s.model.node_position[tet[2]] +
               s.model.node_position[tet[3]])
                  .z() > 4 * lower.z())
            s.state.velocity[n].z = speed;
    };
    move(way > 0 ? pace : -pace);
    run(std::abs(way) / pace);
    move(0);
  };
  fly(lift);
  CHECK(faces_left() > 0);
  fly(-0.999 * lift);
  CHECK(faces_left() == 0);
  constexpr double angle = 5 * degree, duration = 0.01; // s
  s.conditions.gravity = gravity(pull_at(0));
  run(duration, 0.5);
  s.conditions.gravity = gravity(pull_at(angle));
  run(duration);
  CHECK(speed_of_upper(s, straight) == Approx(pull * std::sin(angle) * duration).epsilon(0.01));
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-2);
}

TEST_CASE("hand-over: a joint with a friction of its own keeps it", "[contact][hand_over][regions]") {
  System s = leaning_on_its_joint(GENERATE(0.0, 0.15));
  CHECK(slide(s, straight).acceleration == Approx(slides_at()).epsilon(0.09));
}

TEST_CASE("hand-over: parts of a mesh meet by the default of contacts, what one breaks into by its joint",
          "[contact][hand_over][input]") {
  geom::TetMesh two = geom::box_mesh({1, 1, 1}, {1, 1, 1});
  const geom::TetMesh other = placed(two, straight, Vec3(0, 0, 1.1));
  const auto first = static_cast<int>(two.nodes.size());
  two.nodes.insert(two.nodes.end(), other.nodes.begin(), other.nodes.end());
  for (geom::Tet tet : other.tets) {
    for (int& node : tet)
      node += first;
    two.tets.push_back(tet);
    two.region.push_back(0);
  }
  two.region.assign(two.tets.size(), 0);
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  everywhere.kind = GENERATE(cdem::BondKind::springs, cdem::BondKind::cohesive);
  cdem::ModelSpec spec;
  spec.bodies = {meshed("units", two, everywhere)};
  spec.bodies[0].joint.friction_angle = 40 * degree;
  spec.default_contact = friction(15);
  const auto angle = [&](int block) { // degrees, between the first block and this one
    cdem::Simulation s(spec, 1, nullptr);
    return cdem::contact_joint(s.model(), 0, block)->friction_angle / degree;
  };
  CHECK(angle(1) == Approx(15));
  CHECK(angle(0) == Approx(40));
  spec.pairs = {{"units", "units", friction(25)}};
  CHECK(angle(1) == Approx(25));
  CHECK(angle(0) == Approx(25));
}

TEST_CASE("hand-over: a part slides off with the same bits for every number of threads",
          "[contact][hand_over][behind][threads]") {
  const auto hash_with = [](int threads) {
    System s = leaning(odd, 0.15, threads, pull_at(steep));
    slide(s, odd);
    return cdem::hash(s.state);
  };
  CHECK(hash_with(1) == hash_with(2));
}
