// A cube with bonds on every face that hits a rigid floor and shatters: how fast it steps before, while its bonds break,
// and after, once it is fragments that touch each other; where the time goes, and how far the energy balance is open.
#include "libcdem/first_model.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bench {
namespace {

using namespace cdem;

constexpr double side = 0.5, gap = 2e-3,
                 speed = 8;   // m, m, m/s: some 30 MPa at the impact, six times the strength
constexpr int ask_every = 20; // steps
// Of all bonds: the end of the first breaking, and that of breaking, if time does not end it.
constexpr double first_part = 0.3, most_part = 0.97;

Model build(int tets) {
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(tets / 6.0))));
  BodySpec cube, floor;
  cube.name = "cube";
  cube.material = {30e9, 0.2, 2400, 0};
  cube.joint.cohesion = 8e6;
  cube.joint.friction_angle = 0.5;
  cube.joint.tensile_strength = 5e6;
  cube.bonding.everywhere = true;
  cube.meshes = {geom::box_mesh({side, side, side}, {n, n, n}, 0.15)};
  cube.element = Element::finite_volume;
  floor.name = "floor";
  floor.material = cube.material;
  floor.meshes = {geom::box_mesh({3 * side, 3 * side, 0.2 * side}, {6, 6, 1})};
  for (geom::Vec3& x : floor.meshes[0].nodes)
    x -= geom::Vec3(side, side, 0.2 * side + gap);
  floor.element = Element::rigid;
  Joint friction;
  friction.bonded = false;
  friction.friction_angle = 0.5;
  return first_model({{cube, floor}, {{"cube", "cube", friction}, {"cube", "floor", friction}}});
}

struct LastProgress : Observer {
  std::string times;
  void progress(const Progress& p) override {
    if (p.last)
      times = p.times;
  }
};

} // namespace

void shatter(const Settings& settings) {
  std::printf("\na cube of bonded tetrahedra that hits a floor and shatters; one thread\n%8s %8s | %8s %8s "
              "%9s %10s %8s\n",
              "tets", "bonds", "", "steps", "broken", "steps/s", "contacts");
  for (const int size : settings.shatter) {
    const Model model = build(size);
    double bonds = 0;
    for (const MeshChunk& chunk : model.mesh.chunks)
      bonds += 3 * chunk.faces;
    State state = initial_state(model), last_good;
    for (Node& v : state.velocity)
      v.z = -speed;
    for (std::size_t b = 0; b < model.blocks.size(); ++b) // the floor stands
      if (model.blocks[b].rigid >= 0)
        std::fill(state.velocity.begin() + model.blocks[b].node_begin,
                  state.velocity.begin() + model.blocks[b].node_end, Node{});
    Conditions conditions;
    Fix held;
    held.on = Selection::of_body("floor");
    held.axes = {true, true, true};
    conditions.fixes = {held};
    RunLog log;
    double whole = 0;
    const double start = energy(model, state).total(); // J
    int stage = 0;
    const auto phase = [&](const char* name, double most_seconds, const auto& ends) {
      const std::size_t before = log.breaks.size();
      RunOptions options;
      options.steps = 1000000;
      options.callback_every = ask_every;
      options.callback = [] {};
      const Stopwatch watch(1);
      options.stop = [&] { return ends() || watch.seconds() > most_seconds; };
      LastProgress observer;
      const RunResult r = run({model, state, conditions, log, last_good, observer, 1, ++stage}, options);
      const double rate = static_cast<double>(r.steps) / watch.seconds();
      whole = whole > 0 ? whole : rate;
      std::printf("%8zu %8.0f | %8s %8lld %9zu %10.1f %8zu  %.3f of whole, energy open by %.0e; %s\n",
                  model.tets.size(), bonds, name, static_cast<long long>(r.steps), log.breaks.size() - before,
                  rate, state.contacts.size(), rate / whole, energy(model, state).total() / start - 1,
                  observer.times.c_str());
      std::fflush(stdout);
    };
    phase("whole", 1e9, [&] { return !log.breaks.empty(); });
    const auto broken = [&](double part) {
      return [&, part] { return static_cast<double>(log.breaks.size()) > part * bonds; };
    };
    phase("breaks", 20 * settings.seconds, broken(first_part));
    phase("shatters", 20 * settings.seconds, broken(most_part));
    phase("after", 10 * settings.seconds, [] { return false; });
  }
}

} // namespace bench
