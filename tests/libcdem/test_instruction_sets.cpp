// The same bits on every kind of processor: short runs in child processes, one for each instruction set that this
// machine has, and one whose C library is told that the processor has nothing beyond the baseline.
#include "libcdem/parallel/instruction_set.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/softening_joint.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <unistd.h>

using namespace testing;
using geom::Vec3;

namespace {

// A cube of bonded tetrahedra, a heap of bonded blocks and a rigid block that spins, thrown onto a floor.
System thrown() {
  cdem::Joint weak = rock_joint();
  weak.cohesion = weak.tensile_strength = 2e3;
  cdem::Bonding bonding;
  bonding.everywhere = true;
  bonding.shear_ratio = 0.4;
  cdem::Elastic damped = soft_rock();
  damped.stiffness_damping = 1e-5;
  damped.viscosity = 10;
  geom::VoronoiOptions cells;
  cells.count = 8;
  cells.origin = {1.2, 0, 0.01};
  cdem::BodySpec heap = body("heap", geom::voronoi(cells), soft_rock(), weak);
  cdem::BodySpec top = body("top", geom::grid({0.4, 0.4, 0.4}, {1, 1, 1}, {2.4, 0.3, 0.05}), soft_rock());
  cdem::BodySpec ground = body("floor", geom::grid({6, 4, 0.5}, {1, 1, 1}, {-1.5, -1.5, -0.5}));
  heap.element = cdem::Element::finite_volume;
  top.element = ground.element = cdem::Element::rigid;
  System s(
      build({ground,
             meshed("cube", box_at({0.6, 0.6, 0.6}, {4, 4, 4}, rotation({1, 2, 0.5}, 0.3), {0.3, 0.5, 0.55}),
                    bonding, damped, weak),
             heap, top},
            {{"floor", "cube", friction(30)},
             {"floor", "heap", friction(30)},
             {"floor", "top", friction(30)},
             {"heap", "top", friction(30)}}));
  s.hold(body_of("floor"), "xyz");
  s.conditions.gravity = gravity();
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b) {
    const cdem::Block& block = s.model.blocks[b];
    if (s.model.bodies[block.body].name == "floor")
      continue;
    for (int n = block.node_begin; n < block.node_end; ++n)
      s.state.velocity[n] = node({0.3, 0.1, -3});
    if (block.rigid >= 0) {
      s.state.rigid[block.rigid].velocity = {0.3, 0.1, -3};
      s.state.rigid[block.rigid].angular_momentum = {20, 30, -10};
    }
  }
  return s;
}

// Blocks of small strain that are sheared until bonds soften.
System sheared() {
  cdem::Joint joint = softening_joint(cdem::Softening::exponential);
  System s(build({body("wall", geom::grid({0.8, 0.8, 0.1}, {8, 8, 1}), rock(), joint)}));
  s.hold(cdem::Selection::side("y-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("y+"), {1.5e6, 0.3e6, 0})};
  return s;
}

// A bar of cohesive tetrahedra, in parts of other strength, that is torn and then pressed together.
System torn(cdem::Softening softening) {
  cdem::BodySpec bar = concrete_body(unstructured({0.4, 0.2, 0.2}, 0.07), softening);
  bar.joint.scatter.modulus = 6;
  bar.joint.scatter.reference_volume = 1e-4;
  System s(build({bar}, {{"concrete", "concrete", friction(30)}}));
  lead_apart(s.conditions.fixes, 4);
  return s;
}

std::string path_of_this_program() {
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  REQUIRE(length > 0);
  return {path, static_cast<std::size_t>(length)};
}

// What the hidden test below prints, with these settings of the environment in front.
std::string hashes_with(const std::string& environment) {
  const std::string command = environment + " '" + path_of_this_program() + "' '[.hashes]'";
  std::FILE* const child = popen(command.c_str(), "r");
  REQUIRE(child != nullptr);
  std::string hashes;
  for (char line[256]; std::fgets(line, sizeof line, child) != nullptr;)
    if (std::string(line).rfind("hash ", 0) == 0)
      hashes += line;
  INFO(command);
  REQUIRE(pclose(child) == 0);
  return hashes;
}

} // namespace

TEMPLATE_TEST_CASE("rows of vectors become columns", "[simd]", cdem::simd::Oct, cdem::simd::Quad) {
  constexpr int width = cdem::simd::width<TestType>;
  TestType rows[width];
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < width; ++j)
      rows[i][j] = 10 * i + j;
  cdem::simd::transpose(rows);
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < width; ++j)
      CHECK(rows[i][j] == 10 * j + i);
}

TEMPLATE_TEST_CASE("comparisons of vectors are those of their numbers", "[simd]", cdem::simd::Oct,
                   cdem::simd::Quad) {
  using Limits = std::numeric_limits<double>;
  const std::vector<double> numbers{-Limits::max(), -1, -Limits::min(),        -Limits::denorm_min(),
                                    -0.0,           0,  Limits::denorm_min(),  Limits::min(),
                                    1e-300,         1,  1 + Limits::epsilon(), Limits::max()};
  constexpr int width = cdem::simd::width<TestType>;
  for (const double a : numbers)
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      TestType left = a - TestType{}, right;
      for (int lane = 0; lane < width; ++lane)
        right[lane] = numbers[(i + static_cast<std::size_t>(lane)) % numbers.size()];
      const auto below = cdem::simd::below(left, right), at_most = cdem::simd::at_most(left, right),
                 equal = cdem::simd::equal(left, right);
      for (int lane = 0; lane < width; ++lane) {
        CAPTURE(a, right[lane]);
        REQUIRE((below[lane] != 0) == (a < right[lane]));
        REQUIRE((at_most[lane] != 0) == (a <= right[lane]));
        REQUIRE((equal[lane] != 0) == (a == right[lane]));
      }
    }
}

TEST_CASE("a bit for each of eight bytes with a value", "[simd]") {
  for (unsigned wanted = 0; wanted < 256; ++wanted)
    for (const int value : {0, 1, 2, 127, 128, 255}) {
      std::uint8_t bytes[cdem::lanes];
      for (int lane = 0; lane < cdem::lanes; ++lane)
        bytes[lane] = static_cast<std::uint8_t>((wanted >> lane & 1u) != 0 ? value : value ^ (1 << lane));
      REQUIRE(cdem::simd::bits_with(bytes, static_cast<std::uint8_t>(value)) == wanted);
    }
}

TEST_CASE("prints the hashes of short runs", "[.hashes]") {
  System s = thrown();
  cdem::RunOptions run;
  run.steps = 300;
  run.local_damping = 0.02;
  s.run(run);
  const auto breaks = s.log.breaks.size();
  REQUIRE(breaks > 50);
  REQUIRE(s.state.contacts.size() > 20);
  std::printf("hash %016llx of the run\n", static_cast<unsigned long long>(cdem::hash(s.state)));

  System wall = sheared();
  cdem::RelaxOptions relax;
  relax.max_steps = 400;
  cdem::relax({wall.model, wall.state, wall.conditions, wall.log, wall.last_good, wall.observer, 1, 1},
              relax);
  double softened = 0;
  for (const double damage : wall.state.bond_damage)
    softened = std::max(softened, damage);
  REQUIRE(softened > 0.1);
  std::printf("hash %016llx of the relaxation\n", static_cast<unsigned long long>(cdem::hash(wall.state)));

  for (const cdem::Softening softening : {cdem::Softening::linear, cdem::Softening::exponential}) {
    System bar = torn(softening);
    cdem::RunOptions options;
    options.steps = 150;
    bar.run(options);
    for (cdem::Fix& fix : bar.conditions.fixes)
      fix.velocity = -*fix.velocity;
    bar.run(options);
    REQUIRE(bar.log.broken_tension > 10);
    std::printf("hash %016llx of the bar\n", static_cast<unsigned long long>(cdem::hash(bar.state)));
  }
}

TEST_CASE("every instruction set ends in the same bits", "[hash]") {
  const std::string baseline = hashes_with("CDEM_INSTRUCTION_SET=baseline");
  REQUIRE(std::count(baseline.begin(), baseline.end(), '\n') == 4);
  for (const cdem::InstructionSet set : cdem::instruction_sets()) {
    INFO(cdem::name(set));
    CHECK(hashes_with("CDEM_INSTRUCTION_SET=" + cdem::name(set)) == baseline);
  }
  // The C library takes its own versions of exp, sin and others by what it believes the processor to have.
  CHECK(hashes_with("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX,-AVX512F,-AVX2_Usable,-FMA_Usable "
                    "CDEM_INSTRUCTION_SET=baseline") == baseline);
}
