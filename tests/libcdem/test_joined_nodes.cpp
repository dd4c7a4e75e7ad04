// Freed nodes of cohesive bodies are joined again where nothing has cracked and the body has come to rest.
#include "libcdem/procedure/run.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

const double wave_speed = std::sqrt(concrete().youngs_modulus / concrete().density); // m/s, in a bar

std::int64_t freed_nodes(const System& s) {
  return std::count(s.model.mesh.freed.begin(), s.model.mesh.freed.end(), 1);
}

// A free bar of 1 m that swings in its first mode, to this part of its tensile strength.
System swinging_bar(cdem::BodySpec body, double part) {
  System s(build({std::move(body)}));
  const double speed = part * tension * wave_speed / concrete().youngs_modulus;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node({-speed * std::cos(M_PI * s.model.node_position[i].x()), 0, 0});
  return s;
}

geom::TetMesh ragged_bar() {
  return unstructured({1, 0.2, 0.2}, 0.09);
}

void slow_down(System& s, double part) {
  for (cdem::Node& v : s.state.velocity)
    v = node(part * vec(v));
}

void run_for(System& s, double duration, std::int64_t callback_every = 0) {
  cdem::RunOptions options;
  options.duration = duration;
  options.callback_every = callback_every;
  options.callback = [] {};
  s.run(options);
}

double end_displacement(const System& s) { // m, mean at x+
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (s.model.node_position[i].x() > 1 - 1e-9) {
      sum += s.state.displacement[i].x;
      ++count;
    }
  return sum / count;
}

constexpr double half_period = 0.283e-3, long_after = 6e-3; // s

} // namespace

TEST_CASE(
    "joined nodes: a bar that swings below its strength again has shared nodes, and swings on as before",
    "[cohesive][breaking][energy]") {
  System s = swinging_bar(concrete_body(ragged_bar()), 0.95),
         elastic = swinging_bar(meshed("elastic", ragged_bar(), {}, concrete()), 0.95);
  for (System* each : {&s, &elastic}) {
    run_for(*each, half_period);
    if (each == &s) {
      CHECK(5 * freed_nodes(s) > static_cast<std::int64_t>(s.model.node_position.size()));
      CHECK(s.log.broken_tension == 0);
    }
    slow_down(*each, 0.4);
  }
  const double before = cdem::energy(s.model, s.state).total();
  double short_step = 0;
  for (System* each : {&s, &elastic}) {
    run_for(*each, 0.2e-3);
    short_step = each == &s ? cdem::stable_time_step(s.model) : short_step;
    run_for(*each, long_after);
  }
  CHECK(freed_nodes(s) == 0);
  CHECK(s.model.node_position.size() == elastic.model.node_position.size());
  CHECK(cdem::stable_time_step(s.model) > 1.5 * short_step);
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  const double swings = before - e.breaking;
  INFO("energy " << swings << " J, now " << e.kinetic + e.elastic << ", open by " << e.total() - before
                 << ", lost as nodes were joined " << e.cutting);
  CHECK(std::abs(e.total() - before) < 1e-3 * swings);
  CHECK(e.cutting > 0);
  CHECK(e.cutting < 0.01 * swings);
  const double amplitude = 0.4 * 0.95 * tension / concrete().youngs_modulus / M_PI; // m
  CHECK(std::abs(end_displacement(s) - end_displacement(elastic)) < 0.1 * amplitude);
}

TEST_CASE("joined nodes: nothing is left of a stress that has gone", "[cohesive][breaking]") {
  System s = swinging_bar(concrete_body(ragged_bar()), 0.95);
  run_for(s, half_period);
  REQUIRE(freed_nodes(s) > 0);
  cdem::RunOptions options;
  options.duration = 20e-3;
  options.local_damping = 0.3;
  s.run(options);
  REQUIRE(freed_nodes(s) == 0);
  double largest = 0;
  for (int tet = 0; tet < static_cast<int>(s.model.tets.size()); ++tet)
    largest = std::max(largest, tet_stress(s, tet).norm());
  CHECK(largest < 1e-3 * tension);
}

TEST_CASE("joined nodes: looking at a run changes no bit", "[cohesive][breaking]") {
  std::vector<std::uint64_t> hashes;
  for (const std::int64_t every : {0, 7}) {
    System s = swinging_bar(concrete_body(ragged_bar()), 0.95);
    run_for(s, half_period, every);
    slow_down(s, 0.4);
    run_for(s, long_after, every);
    CHECK(freed_nodes(s) == 0);
    hashes.push_back(cdem::hash(s.state));
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("joined nodes: a bar whose end was torn off shares nodes but at the crack",
          "[cohesive][breaking][energy]") {
  System s(
      build({concrete_body(unstructured({2, 0.2, 0.2}, 0.09))}, {{"concrete", "concrete", friction(30)}}));
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    if (s.model.node_position[i].x() > 1.7)
      s.state.velocity[i] = node({3, 0, 0});
  run_for(s, 1e-3);
  const std::int64_t broken = s.log.broken_tension, freed = freed_nodes(s);
  REQUIRE(broken > 20);
  cdem::RunOptions options;
  options.duration = 20e-3;
  options.local_damping = 0.3;
  s.run(options);
  std::int64_t cracked = 0;
  cdem::each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    cracked += s.state.faces[batch].stage[lane] != cdem::FaceStage::holding ? 1 : 0;
  });
  INFO("broken " << broken << ", cracked faces " << cracked << ", freed " << freed << ", now "
                 << freed_nodes(s));
  CHECK(s.log.broken_tension >= broken);
  CHECK(3 * cracked >= broken);
  CHECK(freed_nodes(s) > 0);
  CHECK(10 * freed_nodes(s) < 7 * freed);
}

TEST_CASE("joined nodes: a run of two stages joins them at the steps of one", "[cohesive][breaking]") {
  constexpr int every = 200; // steps between looks at what may be joined
  int joined = 0;
  for (const std::int64_t first : {std::int64_t{0}, std::int64_t{130}}) {
    System s = swinging_bar(concrete_body(ragged_bar()), 0.95);
    run_for(s, half_period);
    slow_down(s, 0.4);
    std::int64_t freed = freed_nodes(s);
    REQUIRE(freed > 0);
    cdem::RunOptions options;
    options.callback_every = 1;
    options.callback = [&] {
      const std::int64_t now = freed_nodes(s);
      if (now < freed) { // at the head of the step that has just been made
        ++joined;
        CHECK((s.state.step - 1) % every == 0);
      }
      freed = now;
    };
    if (first > 0) {
      options.steps = first;
      s.run(options);
      options.steps = 0;
    }
    options.duration = long_after;
    s.run(options);
    CHECK(freed_nodes(s) == 0);
  }
  CHECK(joined >= 2);
}
