// Cubes of six tets a cell in a lattice, each pressed a little into its neighbours and turned a little: what a search and a
// step of contact cost, beside the step of the tets. Every cube has its own nodes; nothing holds it.
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/model/build/build_model.hpp"
#include "libcdem/step/workspace.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/bench/measure.hpp"

#include <cmath>
#include <cstdio>

namespace bench {
namespace {

using namespace cdem;

Model lattice(int bodies, int divisions, bool touching) {
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(bodies))));
  Model frame;
  Body body;
  body.name = "cubes";
  body.material = {30e9, 0.2, 2400, 0};
  body.element = Element::finite_volume;
  frame.bodies.push_back(body);
  frame.pair_joint[{0, 0}] = 0;
  frame.joints.resize(1);
  if (touching) {
    Joint law;
    law.bonded = false;
    law.friction_angle = 0.5;
    frame.surface.joint[{0, 0}] = 1;
    frame.joints.push_back(law);
  }
  const geom::TetMesh cube = geom::box_mesh({1, 1, 1}, {divisions, divisions, divisions});
  std::vector<MeshSeed> seeds;
  for (int i = 0; i < n * n * n; ++i) {
    const int row = i / n % n, layer = i / (n * n);
    const geom::Vec3 cell(i % n, row, layer);
    const double spacing = touching ? 0.999 : 2;
    geom::TetMesh mesh = cube;
    for (std::size_t k = 0; k < mesh.nodes.size(); ++k) {
      const auto draw = [&](std::uint64_t axis) {
        return 1e-3 * (geom::uniform(1, mesh.nodes.size() * static_cast<std::uint64_t>(i) + k, axis) - 0.5);
      };
      mesh.nodes[k] += spacing * cell + geom::Vec3(draw(0), draw(1), draw(2));
    }
    seeds.push_back({0, 0, 0, std::move(mesh)});
  }
  return build_model(frame, {}, default_traits, std::move(seeds));
}

} // namespace

void contacts(const Settings& settings) {
  std::printf("\ncubes that touch, full step; millions a second"
              "\n%8s %9s %9s %9s %7s | %9s %10s %7s %9s | %10s\n",
              "bodies", "tets", "pairs", "contacts", "threads", "search, s", "contacts/s", "tets/s",
              "no contact", "bytes per");
  std::printf("%8s %9s %9s %9s %7s | %9s %10s %7s %9s | %10s\n", "", "", "", "", "", "", "", "", "tets/s",
              "tet");
  for (const int size : settings.bodies) {
    const double before = resident_bytes();
    const Model model = lattice(size, settings.body_divisions, true);
    const auto n = static_cast<double>(model.tets.size());
    for (const int threads : settings.threads) {
      State state = initial_state(model);
      Workspace work(model, state, {});
      const Stopwatch watch(threads);
      search_contacts(model, state, work.contact, threads);
      const double search = watch.seconds();
      // Twice: from then on the contacts of the step before stand beside the new ones.
      for (int k = 0; k < 2; ++k) {
        work.contact.due = true;
        contact_forces(model, state, work.contact, threads);
      }
      const double held = resident_bytes() - before;
      const double steps = step_rate(model, threads, settings.seconds);
      const double alone =
          step_rate(lattice(size, settings.body_divisions, false), threads, settings.seconds);
      const auto active = static_cast<double>(state.contacts.size());
      std::printf("%8zu %9.0f %9zu %9.0f %7d | %9.3f %10.2f %7.2f %9.2f | %10.0f\n", model.blocks.size(), n,
                  work.contact.rows[Contact::spring].candidates.size() +
                      work.contact.rows[Contact::edge].candidates.size(),
                  active, threads, search, steps * active / 1e6, steps * n / 1e6, alone * n / 1e6, held / n);
      std::fflush(stdout);
    }
  }
}

} // namespace bench
