// The same bits for every number of threads and every repetition; the registry of State fields is complete.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// A wall large enough for four threads, sheared until its weak bonds break: some steps of relaxing, then of
// running.
System sheared_wall(int threads) {
  cdem::Joint joint = rock_joint();
  joint.cohesion = 3e4;
  joint.tensile_strength = 1e4;
  System s(build({body("wall", geom::grid({4.6, 4.6, 0.1}, {46, 46, 1}), rock(), joint)}));
  s.threads = threads;
  s.hold(cdem::Selection::side("y-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("y+"), {1e6, -3e5, 0})};
  cdem::RelaxOptions relax;
  relax.max_steps = 30;
  cdem::relax({s.model, s.state, s.conditions, s.log, s.last_good, s.observer, threads, 1}, relax);
  cdem::RunOptions run;
  run.steps = 30;
  s.run(run);
  return s;
}

} // namespace

TEST_CASE("relaxing and running with breaking gives the same bits on 1 and 2 and 4 threads", "[hash]") {
  const System one = sheared_wall(1);
  REQUIRE(cdem::useful_threads(one.model, 4) == 4);
  REQUIRE(one.log.breaks.size() > 100);
  for (const int threads : {1, 2, 4}) {
    const System other = sheared_wall(threads);
    INFO(threads << " threads");
    CHECK(cdem::hash(other.state) == cdem::hash(one.state));
    CHECK(other.log.breaks.size() == one.log.breaks.size());
    bool same = true;
    for (std::size_t i = 0; i < one.log.breaks.size(); ++i)
      same = same && other.log.breaks[i].step == one.log.breaks[i].step &&
             other.log.breaks[i].place == one.log.breaks[i].place;
    CHECK(same);
  }
}

TEST_CASE("the table holds every field of the state with its full size", "[hash]") {
  System s(build({body("rock", geom::grid({1, 1, 1}, {2, 2, 1}))}));
  std::size_t registered = 0;
  for (const cdem::StateField& field : cdem::fields(s.state)) {
    INFO(field.row.name);
    registered += field.row.place == cdem::FieldPlace::model ? field.bytes : sizeof(std::vector<int>);
    if (const auto count = cdem::entries_of(field.row, s.model); count && *count > 0)
      CHECK(field.bytes % *count == 0); // empty where a model does not need it
    CHECK(std::string(field.row.unit) != "");
    CHECK(std::string(field.row.writer) != "");
  }
  // A member that were not registered would make the state larger than the sum. `parted` says which share of the fields a
  // rank holds, and is none of them.
  CHECK(registered + sizeof s.state.parted == sizeof(cdem::State));
}

TEST_CASE("one changed bit in any field changes the state hash", "[hash]") {
  System s(build({body("rock", geom::grid({1, 1, 1}, {2, 1, 1}))}));
  const std::uint64_t before = cdem::hash(s.state);
  for (const cdem::StateField& field : cdem::fields(s.state)) {
    if (field.bytes == 0)
      continue;
    INFO(field.row.name);
    auto* last = static_cast<unsigned char*>(field.data) + field.bytes - 1;
    *last ^= 1;
    CHECK(cdem::hash(s.state) != before);
    *last ^= 1;
  }
  CHECK(cdem::hash(s.state) == before);
}
