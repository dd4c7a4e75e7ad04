// Saving a model and going on from it: the same bits as without, whenever it was left; and files that are refused
// when they are not whole.
#include "tests/libcdem/going_on.hpp"
#include "tests/libcdem/system.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include "libcdem/checkpoint/file.hpp"
#include "libcdem/checkpoint/model_archive.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>

using namespace testing;
using Catch::Matchers::Contains;
using cdem::SavedKind;

namespace {

cdem::BodySpec block_body(const std::string& name, double strength) {
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = strength;
  joint.cohesion = 3 * strength;
  return {name, geom::grid({1, 1, 0.25}, {4, 4, 1}), rock(), joint};
}

// A plate of blocks that is pulled until some of its bonds break.
cdem::Simulation plate(int threads, std::shared_ptr<cdem::Observer> observer = nullptr) {
  cdem::ModelSpec spec;
  spec.bodies = {block_body("plate", 2e5)};
  cdem::Simulation s(spec, threads, std::move(observer));
  s.fix(fixed(cdem::Selection::side("y-")));
  s.traction(traction(cdem::Selection::side("y+"), {2e5, 2.5e5, 0}));
  return s;
}

// A meshed column, bonded everywhere, that a flow bends and breaks at its foot.
cdem::Simulation column(int threads, std::shared_ptr<cdem::Observer> observer = nullptr) {
  cdem::Simulation s = bonded_column({3, 3, 8}, threads, std::move(observer));
  cdem::Flow flow;
  flow.direction = {1, 0.2, 0};
  flow.velocity = [](double time) { return 40 * std::min(1.0, 200 * time); };
  flow.new_faces = true;
  s.flow(flow);
  return s;
}

// Two blocks, one of them rigid, that fall onto a slope, hit each other and slide.
cdem::Simulation falling_blocks(int threads, std::shared_ptr<cdem::Observer> observer = nullptr) {
  const auto box = [](const geom::Vec3& size, const std::array<int, 3>& divisions, const geom::Mat3& turn,
                      const geom::Vec3& place) {
    geom::TetMesh mesh = geom::box_mesh(size, divisions);
    for (geom::Vec3& x : mesh.nodes)
      x = turn * (x - 0.5 * size) + place;
    return mesh;
  };
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 20 * degree;
  law.normal_stiffness = 2e9;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("slope", box({3, 2, 0.4}, {6, 4, 1}, geom::Mat3::Identity(), {0.5, 0, -0.2})),
                 meshed("soft", box({0.8, 0.8, 0.3}, {3, 3, 1}, rotation({1, 2, 3}, 0.2), {0, 0, 0.35})),
                 meshed("hard", box({0.5, 0.5, 0.3}, {2, 2, 1}, rotation({1, 0, 3}, 0.3), {0.1, 0.1, 0.8}))};
  spec.bodies[2].element = cdem::Element::rigid;
  spec.bodies[1].material.stiffness_damping = 1e-5;
  spec.pairs = {{"slope", "soft", law}, {"slope", "hard", law}, {"soft", "hard", law}};
  cdem::Simulation s(spec, threads, std::move(observer));
  s.fix(fixed(cdem::Selection::of_body("slope")));
  s.gravity(gravity({4, 0, -9}));
  s.initial_velocity(cdem::Selection::of_body("soft"), {0, 0, -3});
  s.initial_velocity(cdem::Selection::of_body("hard"), {0, 0, -8});
  return s;
}

void run(cdem::Simulation& s) {
  cdem::RunOptions options;
  options.steps = 1111;
  options.local_damping = 0.1;
  s.run(options);
}

void relax(cdem::Simulation& s) {
  cdem::RelaxOptions options;
  options.max_steps = 1111;
  s.relax(options);
}

std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_CASE("checkpoint: a run and a relaxation that were left go on to the same bits", "[checkpoint]") {
  const auto relax_then_run = [](cdem::Simulation& s, int done) {
    if (done < 1)
      relax(s);
    if (done < 2)
      run(s);
    if (done < 3)
      relax(s);
    return Figures();
  };
  SECTION("blocks") {
    cdem::Simulation probe = plate(1);
    relax_then_run(probe, 0);
    REQUIRE(probe.log().breaks.size() > 10);
    check_going_on(plate, relax_then_run);
  }
  SECTION("a mesh in a flow") {
    const auto solve = [&](cdem::Simulation& s, int done) {
      if (done < 1)
        run(s);
      if (done < 2)
        relax(s);
      return Figures();
    };
    cdem::Simulation probe = column(1);
    solve(probe, 0);
    REQUIRE(probe.log().breaks.size() > 10);
    check_going_on(column, solve);
  }
}

TEST_CASE("checkpoint: a stage that goes on tells the time of all its steps", "[checkpoint]") {
  struct Told final : cdem::Observer {
    double first = -1, last = -1; // s
    int polls = 0, stop_at = 1 << 30;
    void progress(const cdem::Progress& p) override {
      first = first < 0 ? p.wall_time : first;
      last = p.wall_time;
    }
    bool stop_requested() override { return ++polls >= stop_at; }
  };
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const auto stopped = std::make_shared<Told>(), goes_on = std::make_shared<Told>();
  stopped->stop_at = 65;
  Saver saver;
  cdem::Simulation left = plate(1, stopped);
  saver.simulation = &left;
  left.set_checkpoint_writer(&saver);
  REQUIRE_THROWS_AS(run(left), cdem::Interrupted);
  REQUIRE(stopped->first > 0);
  cdem::Simulation next = plate(1, goes_on);
  next.restore(saver.saved);
  run(next);
  CHECK(goes_on->first > stopped->first);
  CHECK(goes_on->last > goes_on->first);
  CHECK(goes_on->last < elapsed());
}

TEST_CASE("checkpoint: bodies in contact go on to the same bits", "[checkpoint]") {
  const auto solve = [](cdem::Simulation& s, int) {
    cdem::RunOptions options;
    options.duration = 0.08;
    const cdem::RunResult r = s.run(options);
    return Figures{static_cast<double>(r.steps), r.time, r.time_step};
  };
  cdem::Simulation probe = falling_blocks(1);
  solve(probe, 0);
  REQUIRE(probe.steps() > 1700); // left before the last look
  REQUIRE(probe.energy().friction > 0);
  check_going_on(falling_blocks, solve);
}

TEST_CASE("checkpoint: after cutting, the cut model goes on to the same bits", "[checkpoint]") {
  const auto solve = [](cdem::Simulation& s, int done) {
    if (done < 1)
      relax(s);
    if (done < 2) {
      cdem::RefineOptions refine;
      refine.tension_threshold = 1e6;
      refine.planes = 1;
      REQUIRE_FALSE(s.refine(refine).empty());
    }
    if (done < 3)
      run(s);
  };
  cdem::Simulation whole = plate(1);
  solve(whole, 0);
  auto observer = std::make_shared<Stopper>();
  observer->stop_at = 100;
  cdem::Simulation left = plate(1, observer);
  Saver saver;
  saver.simulation = &left;
  left.set_checkpoint_writer(&saver);
  REQUIRE_THROWS_AS(solve(left, 0), cdem::Interrupted);
  REQUIRE(left.stage() == 3);
  cdem::Simulation next = plate(2);
  next.restore(saver.saved);
  CHECK(next.stage() == 2);
  CHECK(next.counts().blocks == left.counts().blocks);
  solve(next, 2);
  check_same(next, whole);
}

TEST_CASE("checkpoint: a model that is built the same has the same hash, another has another",
          "[checkpoint]") {
  const auto model = [](double cohesion, int divisions) {
    cdem::Joint joint = rock_joint();
    joint.cohesion = cohesion;
    return cdem::hash(build({body("rock", geom::grid({1, 1, 1}, {2, divisions, 1}), rock(), joint)}));
  };
  CHECK(model(1e6, 2) == model(1e6, 2));
  CHECK(model(1e6, 2) != model(std::nextafter(1e6, 2e6), 2));
  CHECK(model(1e6, 2) != model(1e6, 3));
}

TEST_CASE("checkpoint: another model refuses a saved one", "[checkpoint]") {
  const cdem::Simulation saved = plate(1);
  cdem::ModelSpec spec;
  spec.bodies = {block_body("plate", 3e5)};
  cdem::Simulation other(spec, 1, nullptr);
  CHECK_THROWS_WITH(other.restore(saved.save()), Contains("not the one that was saved"));
  CHECK_THROWS_WITH(other.restore_state(saved.save()), Contains("not the one that was saved"));
}

TEST_CASE("checkpoint: a saved state is loaded without the log, and once for many runs", "[checkpoint]") {
  cdem::Simulation first = plate(1);
  relax(first);
  const std::string saved = first.save();
  run(first);
  for (int i = 0; i < 2; ++i) {
    cdem::Simulation next = plate(1);
    next.restore_state(saved);
    CHECK(next.stage() == 0);
    CHECK(next.log().history.empty());
    run(next);
    CHECK(next.state_hash() == first.state_hash());
  }
}

TEST_CASE("checkpoint: a state that is loaded has the bonds that were broken then, and no more",
          "[checkpoint]") {
  cdem::Simulation s = plate(1);
  const std::string saved = s.save();
  relax(s);
  const std::size_t broken = s.log().breaks.size();
  const std::array<double, 5> largest = s.log().one_way.largest;
  REQUIRE(broken > 0);
  s.restore_state(saved);
  CHECK(s.log().breaks.empty());
  CHECK(s.log().told_tension + s.log().told_shear == 0);
  relax(s);
  CHECK(s.log().breaks.size() == broken);
  CHECK(s.log().one_way.largest == largest); // what the first relaxation lost does not count in the second
}

TEST_CASE("checkpoint: the checksum is XXH64", "[checkpoint]") {
  // Test vectors of the specification.
  CHECK(cdem::xxh64("", 0) == 0xEF46DB3751D8E999ull);
  CHECK(cdem::xxh64("abc", 3) == 0x44BC2CF5AD770999ull);
  const std::string line = "Nobody inspects the spammish repetition";
  CHECK(cdem::xxh64(line.data(), line.size()) == 0xFBCEA83C8A378BF1ull);
  // What checkpoints of version 0.1.0 carry, which had a function of its own.
  std::string noise;
  for (std::uint32_t i = 0, x = 1; i < 100003; ++i) {
    x = x * 1664525u + 1013904223u;
    noise += static_cast<char>(x >> 24);
  }
  CHECK(cdem::xxh64(noise.data(), noise.size()) == 0x0cb79ec2c3b87809ull);
  // In pieces as at once.
  cdem::Xxh64 sum;
  for (const char c : line)
    sum.add(&c, 1);
  CHECK(sum.value() == cdem::xxh64(line.data(), line.size()));
}

TEST_CASE("checkpoint: a file comes back as it was written, and the old one stays until the new one is whole",
          "[checkpoint]") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.cdem", first = plate(1).save();
  cdem::write_saved(path, SavedKind::checkpoint, first);
  CHECK(cdem::read_saved(path, SavedKind::checkpoint) == first);
  std::ofstream(path + ".part") << "half"; // left by a run that was killed while it wrote
  CHECK(cdem::read_saved(path, SavedKind::checkpoint) == first);
  cdem::write_saved(path, SavedKind::checkpoint, "second");
  CHECK(cdem::read_saved(path, SavedKind::checkpoint) == "second");
  CHECK(folder.names() == std::vector<std::string>{"a.cdem"});
}

TEST_CASE("checkpoint: a file cut short at 64 places or with one of 1000 bits flipped is refused in one line",
          "[checkpoint]") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.cdem";
  cdem::write_saved(path, SavedKind::checkpoint, plate(1).save().substr(0, 50000));
  const std::string whole = file_text(path);
  const auto refused = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
    try {
      cdem::read_saved(path, SavedKind::checkpoint);
    } catch (const cdem::FileError& error) {
      return std::string(error.what()).find('\n') == std::string::npos;
    }
    return false;
  };
  for (std::size_t i = 0; i < 64; ++i) {
    INFO("cut at part " << i);
    CHECK(refused(whole.substr(0, i * (whole.size() - 1) / 63)));
  }
  for (std::uint64_t i = 0; i < 1000; ++i) {
    std::string flipped = whole;
    // The head, where the magic, format and length stand, more often than its share.
    const std::size_t range = i % 4 == 0 ? 28 : whole.size();
    const auto at = static_cast<std::size_t>(geom::uniform(7, 0, i) * static_cast<double>(range));
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (i % 8)));
    INFO("bit " << i % 8 << " of byte " << at);
    CHECK(refused(flipped));
  }
  std::ofstream(path, std::ios::binary | std::ios::trunc) << whole;
  CHECK_THROWS_WITH(cdem::read_saved(path, SavedKind::state), Contains("not a saved state"));
  CHECK_THROWS_WITH(cdem::read_saved(folder / "none.cdem", SavedKind::state), Contains("no such file"));
}

TEST_CASE("checkpoint: a file that cannot be written is told of", "[checkpoint]") {
  CHECK_THROWS_WITH(cdem::write_saved("/nowhere/a.cdem", SavedKind::checkpoint, "x"),
                    Contains("cannot be written"));
}
