// Armour units of a few hundred tetrahedra laid on a slope as one armour layer between two walls and settled by the
// solver's own `settle`, rigid at first: what a pile costs until it is at rest, and what it holds there.
#include "apps/cdem/progress/run_observer.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/procedure/settle.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/solid/armour_units.hpp"
#include "tests/bench/laid_units.hpp"
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace bench {
namespace {

using namespace cdem;

constexpr double mass = 5000, density = 2500, water = 1025, gradient = 1 / 1.5,
                 friction_angle = 40; // kg .. degrees
constexpr double fineness = 3;        // of a unit: height over the edge length of its tets

PairSpec contact(const char* a, const char* b) {
  Joint law;
  law.bonded = false;
  law.friction_angle = friction_angle * M_PI / 180;
  return {a, b, law};
}

BodySpec rigid_body(const char* name, std::vector<geom::TetMesh> meshes, const Elastic& material) {
  BodySpec body;
  body.name = name;
  body.meshes = std::move(meshes);
  body.material = material;
  body.element = Element::rigid;
  return body;
}

// Upright along the slope where rows end, and clear of it.
std::vector<geom::TetMesh> walls_beside(const geom::Pile& pile, double length) {
  const geom::Box box = geom::bounding_box(pile);
  const double height = pile.height, clear = 0.05 * height, thick = height, toe = box.min.x() - clear;
  geom::MeshSize size;
  size.size = height;
  std::vector<geom::TetMesh> walls;
  for (const double y : {box.min.y() - thick, box.max.y()})
    walls.push_back(geom::mesh_solid(
        geom::box({length + height - toe, thick, gradient * length + 4 * height}, {toe, y, -height}), size));
  return walls;
}

geom::TetMesh slope_mesh(double length, double width, double height) {
  geom::MeshSize size;
  size.size = 3 * height;
  return geom::mesh_solid(geom::slope(gradient, length, width), size);
}

} // namespace

// Square bars, as the units of examples/armour_pile; the lowest row is held.
Laid laid_units(int count, bool rigid) {
  geom::AccropodeShape shape = geom::AccropodeShape::slender();
  shape.width = 0.40;
  shape.corner = 0;
  const double height =
      geom::height_of_volume(mass / density, [&](double h) { return geom::accropode(h, shape); });
  const int columns = std::max(2, static_cast<int>(std::lround(std::sqrt(count / 2.0))));
  const int rows = (count + columns - 1) / columns;
  geom::MeshSize size;
  size.size = height / fineness;
  const geom::TetMesh unit = geom::mesh_solid(geom::accropode(height, shape), size);
  const double length = (0.55 * rows + 2.5) * height;
  const geom::Ground bare(geom::surface_of(slope_mesh(length, (2 * columns + 3) * 0.62 * height, height)));
  geom::LayerOptions options;
  options.columns = columns;
  options.walls = true;
  const geom::Pile pile = geom::place_layer(unit, count, bare, options).pile;
  const geom::Box box = geom::bounding_box(pile);
  const double width = 2 * (std::min(-box.min.y(), box.max.y()) - 0.05 * height); // short of the walls

  Elastic concrete;
  concrete.youngs_modulus = 30e9;
  concrete.poissons_ratio = 0.2;
  concrete.density = density;
  BodySpec units;
  units.name = "units";
  units.meshes = geom::meshes(pile);
  units.material = concrete;
  units.element = rigid ? Element::rigid : Element::finite_volume;
  Laid made;
  made.tets_per_unit = unit.tets.size();
  made.spec = {{rigid_body("slope", {slope_mesh(length, width, height)}, concrete),
                rigid_body("walls", walls_beside(pile, length), concrete), units},
               {contact("units", "units"), contact("units", "slope"), contact("units", "walls")}};
  Fix fix;
  fix.axes = {true, true, true};
  for (const char* ground : {"slope", "walls"}) {
    fix.on = Selection::of_body(ground);
    made.conditions.fixes.push_back(fix);
  }
  std::vector<int> order(pile.poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return pile.poses[a].translation.z() < pile.poses[b].translation.z();
  });
  order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(columns)));
  for (int& number : order)
    ++number; // from 1
  std::sort(order.begin(), order.end());
  fix.on = Selection::of_units("units", order);
  made.conditions.fixes.push_back(fix);
  Gravity gravity;
  gravity.acceleration = {0, 0, -9.81};
  gravity.water_density = water;
  made.conditions.gravity = gravity;
  return made;
}

void piles(const Settings& settings) {
  for (const int count : settings.units) {
    const auto [spec, conditions, tets_per_unit] = laid_units(count, false);
    const double before = resident_bytes();
    Model model = first_model(spec);
    const auto n = static_cast<double>(count) * static_cast<double>(tets_per_unit);
    State state = initial_state(model), last_good;
    RunLog log;
    app::RunObserver told(app::ProgressStyle::automatic, nullptr);
    std::printf("\n%d units of %zu tets laid on a slope between walls\n", count, tets_per_unit);
    std::fflush(stdout);
    const int threads = *std::max_element(settings.threads.begin(), settings.threads.end());
    const SettleResult result =
        settle(model, {model, state, conditions, log, last_good, told, threads, 1}, {});
    std::printf("  %s: %lld steps of %.4g s of the model in %.0f s, %.0f steps a second, %d threads; kinetic "
                "energy %.2g of its peak\n",
                result.converged ? "at rest" : "not at rest", static_cast<long long>(result.steps),
                result.time, result.wall_time, static_cast<double>(result.steps) / result.wall_time, threads,
                result.kinetic_ratio);
    last_good = state;
    Workspace work(model, state, conditions);
    contact_forces(model, state, work.contact, threads);
    std::printf("  %zu contacts, %zu near pairs, deepest %.2g of a tet's height; %.0f bytes a tet\n",
                state.contacts.size(),
                work.contact.rows[Contact::spring].candidates.size() +
                    work.contact.rows[Contact::edge].candidates.size(),
                log.deepest_over_height, (resident_bytes() - before) / n);
  }
}

} // namespace bench
