// Estimates of the memory that building and cutting a model take, and when it is too much.
#include "libcdem/memory_needed.hpp"
#include "libcdem/simulation.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

cdem::ModelSpec spec_of(cdem::BodySpec body) {
  cdem::ModelSpec spec;
  spec.bodies.push_back(std::move(body));
  return spec;
}

} // namespace

TEST_CASE("memory: what building takes goes by the tets that the model will have") {
  const auto bytes = [](int n) {
    return cdem::memory_to_build(spec_of(body("blocks", geom::grid({1, 1, 1}, {n, n, n}))));
  };
  CHECK(bytes(4) == Approx(8 * bytes(2)));
  // Cutting holds the old blocks and the new ones.
  const cdem::Simulation built = simulation(geom::grid({1, 1, 1}, {3, 3, 3}));
  CHECK(cdem::memory_to_cut(built.counts().tets) > 1.2 * bytes(3));
  CHECK(cdem::memory_to_cut(built.counts().tets) < 2 * bytes(3));
  // Bonded everywhere, every tet has nodes of its own.
  cdem::Bonding springs;
  springs.everywhere = true;
  cdem::Bonding cohesive = springs;
  cohesive.kind = cdem::BondKind::cohesive;
  const geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {5, 5, 5}, 0);
  const double shared = cdem::memory_to_build(spec_of(meshed("mesh", mesh)));
  CHECK(cdem::memory_to_build(spec_of(meshed("mesh", mesh, springs))) > 4 * shared);
  CHECK(cdem::memory_to_build(spec_of(meshed("mesh", mesh, cohesive))) == shared);
}

TEST_CASE("memory: one line where it is not enough, with what to do") {
  CHECK(cdem::memory_warning("building this model", 1e9, 2e9, 8).empty());
  CHECK_THAT(
      cdem::memory_warning("building this model", 52e9, 16e9, 8),
      Contains("building this model takes some 52 GB of memory in each of 8 ranks, which may take 16 GB") &&
          Contains("--memory") && Contains("start fewer ranks on a machine"));
  CHECK_THAT(cdem::memory_warning("cutting this model", 400e6, 64e6, 1),
             Contains("400 MB of memory in this process, which may take 64 MB") && Contains("coarser"));
}
