// Bodies that are continuous until they crack: nothing changes while they are whole, nothing jumps when nodes are freed,
// they crack at their strength whichever way the mesh lies, and a crack takes its fracture energy.
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/fracture/critical_plane.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/results/energy.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/going_on.hpp"
#include "tests/libcdem/two_halves.hpp"

#include <catch2/catch.hpp>

#include <numeric>
#include <random>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

Mat3 some_turn() {
  return rotation({1, -2, 0.5}, 70 * degree);
}

// Frees some of the nodes, by a fixed draw.
void free_some(System& s, double part) {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> uniform;
  std::vector<char> of_original(s.model.node_position.size(), 0), nodes(s.model.node_position.size(), 0);
  for (char& freed : of_original)
    freed = static_cast<char>(uniform(draw) < part);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = of_original[s.model.mesh.original[i]];
  cdem::Freed rebuilt = cdem::split_nodes(s.model, s.state, nodes);
  s.adopt(std::move(rebuilt.model), std::move(rebuilt.state));
}

void strain(System& s, const Mat3& gradient) {
  const Mat3 stress = hooke(concrete(), gradient);
  for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
    s.state.displacement[i] = node(gradient * s.model.node_position[i]);
  for (int t = 0; t < static_cast<int>(s.model.tets.size()); ++t)
    set_mesh_stress(s.model, s.state, t,
                    {stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2), stress(0, 2)});
}

// Both ends along `axis` are led apart (closed in, < 0) by this speed, m/s; the largest mean traction there, Pa.
double pull(System& s, int axis, double speed, double duration, double area) {
  const std::string name(1, "xyz"[axis]);
  for (const double side : {-1.0, 1.0}) {
    cdem::Fix lead = fixed(cdem::Selection::side(name + (side < 0 ? "-" : "+")), name);
    lead.velocity = 0.5 * side * speed * Vec3::Unit(axis);
    s.conditions.fixes.push_back(lead);
  }
  double peak = 0;
  cdem::RunOptions options;
  options.duration = duration;
  options.callback_every = 5;
  const cdem::Selection end = cdem::Selection::side(name + "+");
  options.callback = [&] {
    const std::vector<Vec3> forces = s.net_forces();
    double sum = 0;
    for (std::size_t i = 0; i < forces.size(); ++i)
      if (std::abs(s.model.node_position[i][axis] - s.model.box.max[axis]) < 1e-9)
        sum -= forces[i][axis];
    peak = std::max(peak, (speed > 0 ? 1 : -1) * sum / area);
  };
  s.run(options);
  return peak;
}

} // namespace

TEST_CASE("cohesive bodies: whole ones are continuous, with the nodes of their mesh and the same bits",
          "[cohesive][mesh]") {
  const geom::TetMesh mesh = unstructured({0.6, 0.25, 0.25}, 0.1);
  const auto hash = [&](const cdem::Bonding& bonding) {
    System s(build({meshed("concrete", mesh, bonding, concrete(), concrete_joint(cdem::Softening::linear))}));
    CHECK(s.model.node_position.size() == mesh.nodes.size());
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
      s.state.velocity[i] = node(0.05 * s.model.node_position[i]);
    cdem::RunOptions options;
    options.steps = 200;
    s.run(options);
    std::vector<double> places;
    for (const cdem::Node& u : s.state.displacement)
      places.insert(places.end(), {u.x, u.y, u.z});
    return places;
  };
  CHECK(hash(cohesive()) == hash({}));
}

TEST_CASE("cohesive bodies: uniform stress stays uniform whichever nodes are freed",
          "[cohesive][mesh][patch]") {
  const double part = GENERATE(0.1, 0.5, 1.0);
  Mat3 gradient;
  gradient << 4e-5, 1e-5, -2e-5, 0, -3e-5, 1e-5, 1e-5, 2e-5, 2e-5;
  gradient = 0.5e-4 * (gradient + gradient.transpose().eval()); // the areas are those of now: second order
  System s(build({concrete_body(placed(unstructured({0.6, 0.25, 0.25}, 0.1), some_turn(), {1, 2, 3}))}));
  strain(s, gradient);
  free_some(s, part);
  CHECK_FALSE(s.model.mesh.sides.empty());
  const Mat3 stress = hooke(concrete(), gradient);
  // Each outer triangle carries a third of its traction at each corner, whatever copy that is.
  std::vector<Vec3> left = s.net_forces();
  double scale = 0;
  for (const cdem::OuterFace& face : s.model.outer_faces) {
    scale = std::max(scale, face.area * stress.norm());
    cdem::each_face_node(s.model, face,
                         [&](int node, double area) { left[node] += area * stress * face.normal; });
  }
  double worst = 0;
  for (const Vec3& f : left)
    worst = std::max(worst, f.norm());
  CHECK(worst < 1e-7 * scale);

  SECTION("and a strain that grows uniformly gives each tet Hooke's stress") {
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
      s.state.velocity[i] = node(gradient * s.model.node_position[i]);
    s.load_all_faces(stress);
    cdem::RunOptions options;
    options.steps = 1;
    options.breaking = false;
    const double dt = s.run(options).time_step;
    for (int t = 0; t < static_cast<int>(s.model.tets.size()); t += 7)
      CHECK((tet_stress(s, t) - (1 + dt) * stress).norm() < 1e-3 * stress.norm());
  }
}

TEST_CASE("cohesive bodies: the plane that fails", "[cohesive][law]") {
  const cdem::RockStrength rock = cdem::rock_strength(concrete_joint(cdem::Softening::linear));
  const Mat3 turn = some_turn();
  const auto stress = [&](double a, double b, double c) {
    return Mat3(turn * Vec3(a, b, c).asDiagonal() * turn.transpose());
  };
  const double sine = 0.5, cosine = std::cos(30 * degree);
  SECTION("in tension square to the largest stress, from the strength on") {
    const Vec3 face = turn * Vec3(0.9, 0.3, -0.3).normalized();
    CHECK_FALSE(critical_plane(stress(0.999 * tension, 1e6, -1e6), rock, face));
    const auto plane = critical_plane(stress(1.001 * tension, 1e6, -1e6), rock, face);
    REQUIRE(plane);
    CHECK(plane->mode == cdem::BondMode::broken_tension);
    CHECK((plane->normal - turn * Vec3::UnitX()).norm() < 1e-6);
    CHECK_FALSE(critical_plane(stress(1.001 * tension, 1e6, -1e6), rock, turn * Vec3(0.6, 0.8, 0)));
  }
  SECTION("in shear where Mohr and Coulomb say") {
    const double s1 = -1e6, s3 = (s1 * (1 + sine) - 2 * cohesion * cosine) / (1 - sine);
    CHECK(cdem::strength_utilisation(stress(s1, -2e6, s3), rock) == Approx(1).epsilon(1e-9));
    const Vec3 wanted = turn * Vec3(std::sin(60 * degree), 0, std::cos(60 * degree));
    const auto plane = critical_plane(1.001 * stress(s1, -2e6, s3), rock, -wanted);
    REQUIRE(plane);
    CHECK(plane->mode == cdem::BondMode::broken_shear);
    CHECK((plane->normal + wanted).norm() < 1e-6);
    const Vec3 t = stress(s1, -2e6, s3) * plane->normal;
    const double tn = t.dot(plane->normal);
    CHECK((t - tn * plane->normal).norm() + tn * std::tan(30 * degree) == Approx(cohesion).epsilon(1e-9));
  }
  SECTION("free to turn about the axis of two equal stresses it comes nearest to the face") {
    const double strength = 2 * cohesion * cosine / (1 - sine);
    const Vec3 face =
        turn * Vec3(std::sin(60 * degree) * 0.6, std::sin(60 * degree) * 0.8, std::cos(60 * degree));
    const auto plane = critical_plane(stress(0, 0, -1.001 * strength), rock, face);
    REQUIRE(plane);
    CHECK((plane->normal - face).norm() < 1e-6);
  }
  SECTION("the bound on the use of strength holds for every stress and is reached by some") {
    std::mt19937 draw(3);
    std::normal_distribution<double> normal;
    for (const double least : {0.5, 1.0}) {
      const cdem::UtilisationBound bound(rock, least);
      int reached = 0, told = 0;
      for (int i = 0; i < 4000; ++i) {
        double s[6];
        for (double& component : s)
          component = 0.3 * cohesion * normal(draw);
        Mat3 matrix;
        matrix << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
        const bool uses = cdem::strength_utilisation(matrix, rock) >= least, may = bound.beyond(s) > 0;
        CHECK((may || !uses));
        reached += uses ? 1 : 0;
        told += may ? 1 : 0;
      }
      CHECK(reached > 400);
      CHECK(told < 1.4 * reached);
    }
  }
}

TEST_CASE("cohesive bodies: a bar free to crack anywhere bears its strength and takes its fracture energy",
          "[cohesive][mesh][energy]") {
  const double edge = GENERATE(0.1, 0.07);
  const double width = 0.25, tough = 4 * energy_1; // a cohesive zone of ten faces
  cdem::BodySpec body = concrete_body(unstructured({1, width, width}, edge), cdem::Softening::linear, 20);
  body.joint.fracture_energy_1 = tough;
  body.joint.fracture_energy_2 = 10 * tough;
  System s(build({body}));
  const double peak = pull(s, 0, 0.05, 0.009, width * width);
  INFO("edge " << edge << ", peak " << peak / tension);
  CHECK(peak == Approx(tension).epsilon(0.03));
  CHECK(s.log.broken_tension > 0);
  CHECK(s.log.broken_shear == 0);
  CHECK(balance(s) < 1e-3);
  const double dissipated = s.state.spent.breaking / (tough * width * width);
  const double given_back = -cdem::energy(s.model, s.state).springs / (tough * width * width);
  INFO("dissipated over G A " << dissipated << ", given back by cracks " << given_back);
  CHECK(dissipated > 0.85);
  CHECK(dissipated < 1.15);
  CHECK(std::abs(given_back) < 0.01);
}

TEST_CASE("cohesive bodies: a prism between smooth platens bears the strength of Mohr and Coulomb",
          "[cohesive][mesh][energy]") {
  const double edge = GENERATE(0.06, 0.045);
  const double width = 0.2;
  System s(build({concrete_body(unstructured({width, width, 0.4}, edge))}));
  const double peak = pull(s, 2, -0.5, 0.0008, width * width);
  const double strength = 2 * cohesion * std::cos(30 * degree) / (1 - std::sin(30 * degree));
  INFO("edge " << edge << ", peak " << peak / strength);
  CHECK(peak > 0.9 * strength);
  CHECK(peak < 1.05 * strength);
  CHECK(balance(s) < 1e-3);
}

TEST_CASE("cohesive bodies: a plane between two regions parts at its strength, however it lies",
          "[cohesive][mesh]") {
  const Mat3 turn = GENERATE(Mat3(Mat3::Identity()), some_turn());
  const double width = side;
  const geom::TetMesh mesh = two_halves(3);
  const Vec3 along = turn.col(2);
  cdem::Bonding bonding = cohesive();
  bonding.everywhere = false;
  bonding.between_regions = true;
  cdem::Elastic straight = concrete();
  straight.poissons_ratio = 0;
  System s(build({meshed("concrete", placed(mesh, turn, Vec3::Zero()), bonding, straight,
                         concrete_joint(cdem::Softening::linear))}));
  // A uniform strain rate and nothing sideways: no waves.
  const double rate = 0.005;

  for (int i = 0; i < static_cast<int>(s.model.node_position.size()); ++i) {
    const double z = along.dot(s.model.node_position[i]);
    s.state.velocity[i] = node(rate * (z - half) * along);
    if (z < 1e-9 || z > side - 1e-9) {
      cdem::Fix lead;
      lead.on = at_place(s.model.node_position[i]);
      lead.velocity = rate * (z - half) * along;
      s.conditions.fixes.push_back(lead);
    }
  }
  double peak = 0;
  cdem::RunOptions options;
  options.duration = 1.6 * tension / concrete().youngs_modulus / rate;
  options.callback_every = 5;
  options.callback = [&] {
    const std::vector<Vec3> forces = s.net_forces();
    double sum = 0;
    for (std::size_t i = 0; i < forces.size(); ++i)
      if (along.dot(s.model.node_position[i]) > side - 1e-9)
        sum -= forces[i].dot(along);
    peak = std::max(peak, sum / (width * width));
  };
  s.run(options);
  INFO("peak " << peak / tension);
  CHECK(s.log.broken_tension > 0);
  CHECK(peak == Approx(tension).epsilon(0.01));
}

TEST_CASE("cohesive bodies: a ragged border between two regions parts", "[cohesive][mesh][energy]") {
  const double edge = GENERATE(0.1, 0.07);
  const double width = 0.25;
  geom::TetMesh mesh = unstructured({1, width, width}, edge);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double x = 0;
    for (const int node : mesh.tets[t])
      x += 0.25 * mesh.nodes[node].x();
    mesh.region[t] = x > 0.5;
  }
  cdem::BodySpec body = concrete_body(mesh, cdem::Softening::linear, 20);
  body.bonding.everywhere = false;
  body.bonding.between_regions = true;
  System s(build({body}));
  const double peak = pull(s, 0, 0.05, 0.006, width * width);
  const double dissipated = s.state.spent.breaking / (energy_1 * width * width);
  INFO("edge " << edge << ", peak " << peak / tension << ", dissipated over G A " << dissipated
               << ", balance " << balance(s) << ", broken " << s.log.broken_tension << " "
               << s.log.broken_shear);
  CHECK(peak > 0.99 * tension);
  CHECK(peak < 1.2 * tension);
  CHECK(dissipated == Approx(1).epsilon(0.02));
  CHECK(balance(s) < 1e-3);
}

TEST_CASE("cohesive bodies: a free body with freed nodes spins on with its energy",
          "[cohesive][mesh][energy]") {
  System s(build({concrete_body(unstructured({0.4, 0.25, 0.25}, 0.12))}));
  free_some(s, 0.5);
  const Vec3 centre = centroid(s, 0), axis = Vec3(1, 2, -0.5).normalized();
  const double rate = 100;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node(rate * axis.cross(s.model.node_position[i] - centre));
  const double before = cdem::energy(s.model, s.state).total();
  const Vec3 momentum_before = momentum(s, Places::present).angular;
  cdem::RunOptions options;
  options.safety = 0.9;
  options.duration = 5 * 2 * pi / rate;
  options.breaking = false;
  s.run(options);
  CHECK(cdem::energy(s.model, s.state).total() == Approx(before).epsilon(1e-3));
  CHECK((momentum(s, Places::present).angular - momentum_before).norm() < 1e-4 * momentum_before.norm());
}

TEST_CASE(
    "cohesive bodies: the same bits for every number of threads, and when left in the middle of cracking",
    "[cohesive][checkpoint]") {
  const auto build_bar = [](int threads, std::shared_ptr<cdem::Observer> observer) {
    cdem::ModelSpec spec;
    spec.bodies = {concrete_body(unstructured({0.6, 0.25, 0.25}, 0.12), cdem::Softening::linear, 20)};
    cdem::Simulation s(spec, threads, std::move(observer));
    for (const char* side : {"x-", "x+"}) {
      cdem::Fix lead = fixed(cdem::Selection::side(side), "x");
      lead.velocity = Vec3(side[1] == '+' ? 0.1 : -0.1, 0, 0);
      s.fix(lead);
    }
    return s;
  };
  SECTION("in time") {
    const auto solve = [](cdem::Simulation& s, int done) {
      cdem::RunOptions options;
      options.duration = 0.0015;
      if (done == 0 || s.time() < options.duration)
        s.run(options);
      CHECK(s.counts().broken_tension > 0);
      return Figures{s.time(), s.energy().breaking};
    };
    check_going_on(build_bar, solve, {3, 15, 20});
  }
  SECTION("in a relaxation") {
    const auto build = [](int threads, std::shared_ptr<cdem::Observer> observer) {
      cdem::ModelSpec spec;
      spec.bodies = {concrete_body(unstructured({0.6, 0.25, 0.25}, 0.12), cdem::Softening::linear, 20)};
      cdem::Simulation s(spec, threads, std::move(observer));
      s.fix(fixed(cdem::Selection::side("x-"), "x"));
      cdem::Fix lead = fixed(cdem::Selection::side("x+"), "x");
      lead.displacement = Vec3(7e-5, 0, 0);
      s.fix(lead);
      return s;
    };
    const auto solve = [](cdem::Simulation& s, int) {
      cdem::RelaxOptions options;
      options.residual = 1e-3;
      s.relax(options);
      CHECK(s.counts().damaged + s.counts().broken_tension > 0);
      return Figures{s.energy().breaking, s.reaction(cdem::Selection::side("x+")).x()};
    };
    check_going_on(build, solve, {3, 9, 15});
  }
}

TEST_CASE("cohesive bodies: a bar drawn apart in small relaxed increments bears its strength and parts",
          "[cohesive][energy]") {
  const double length = 0.6, width = 0.25, area = width * width;
  cdem::ModelSpec spec;
  spec.bodies = {concrete_body(unstructured({length, width, width}, 0.12), cdem::Softening::linear, 20)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  s.fix(fixed(at_place(Vec3::Zero()), "yz"));
  s.fix(fixed(at_place({0, width, 0}), "z"));
  const double at_peak = length * tension / concrete().youngs_modulus, apart = 2 * energy_1 / tension; // m
  double peak = 0, last = 0;
  for (int i = 1; i <= 30; ++i) {
    cdem::Fix lead = fixed(cdem::Selection::side("x+"), "x");
    lead.displacement = Vec3(0.05 * i * (at_peak + 0.7 * apart), 0, 0);
    s.release(cdem::Selection::side("x+"), {true, false, false});
    s.fix(lead);
    cdem::RelaxOptions options;
    options.residual = 1e-3;
    s.relax(options);
    last = s.reaction(cdem::Selection::side("x+")).x() / area;
    peak = std::max(peak, last);
  }
  INFO("peak over strength " << peak / tension << ", left " << last / tension);
  CHECK(peak == Approx(tension).epsilon(0.05));
  CHECK(std::abs(last) < 0.01 * tension);
  const double dissipated = s.energy().breaking / (energy_1 * area);
  INFO("dissipated over G A " << dissipated);
  CHECK(dissipated > 0.85);
  CHECK(dissipated < 1.25);
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("cohesive bodies: wrong input is refused", "[cohesive][input]") {
  const auto refused = [](const auto& change, const char* says) {
    cdem::BodySpec body = concrete_body(unstructured({0.6, 0.25, 0.25}, 0.12));
    change(body);
    cdem::ModelSpec spec;
    spec.bodies = {body};
    CHECK_THROWS_WITH(cdem::Simulation(spec, 1, nullptr), Catch::Contains(says));
  };
  refused([](auto& body) { body.joint.fracture_energy_1 = 1e-3; }, "fracture_energy_1");
  refused([](auto& body) { body.joint.softening = cdem::Softening::none; }, "fracture_energy_1");
  refused([](auto& body) { body.bonding.kind = cdem::BondKind::springs; }, "bonds = ");
  refused(
      [](auto& body) {
        body.joint = concrete_joint(cdem::Softening::none);
        body.joint.tensile_strength = 0;
      },
      "tensile_strength");
}

TEST_CASE("cohesive: a body that turns while it is rigid goes on as it would have without",
          "[cohesive][rigid]") {
  const Vec3 turn = 90 * degree * Vec3(0.3, 0.4, std::sqrt(0.75));
  const auto ends = [](const Vec3& by) {
    System s(build({concrete_body(unstructured({0.4, 0.1, 0.1}, 0.05))}));
    // The wave of an impact frees nodes and hardly cracks faces.
    for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
      s.state.velocity[i].x = s.model.node_position[i].x() > 0.2 ? 1 : 0;
    cdem::RunOptions options;
    options.duration = 2e-5;
    s.run(options);
    std::int64_t preloaded = 0;
    each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
      preloaded += s.state.faces[batch].preloaded[lane];
    });
    CHECK(preloaded > 50);
    cdem::set_rigid(s.model, s.state, {0});
    cdem::RigidState& motion = s.state.rigid[0];
    motion.velocity = motion.angular_momentum = {};
    const Vec3 centroid = cdem::vec(motion.centroid);
    cdem::turn_by(motion, by);
    cdem::place_nodes(s.model, s.state, 0);
    cdem::set_deformable(s.model, s.state, {0});
    options.duration = 0;
    options.steps = 30;
    s.run(options);
    std::vector<Vec3> from_centroid;
    for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
      from_centroid.push_back(s.model.node_position[i] + vec(s.state.displacement[i]) - centroid);
    return from_centroid;
  };
  const std::vector<Vec3> straight = ends(Vec3::Zero()), turned = ends(turn);
  REQUIRE(turned.size() == straight.size());
  const Mat3 r = rotation(turn.normalized(), turn.norm());
  double most = 0; // m
  for (std::size_t i = 0; i < turned.size(); ++i)
    most = std::max(most, (turned[i] - r * straight[i]).norm());
  CHECK(most < 1e-12);
}
