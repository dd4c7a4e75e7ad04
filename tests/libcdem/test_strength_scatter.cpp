// Strength that scatters: Weibull's distribution and its size effect, the same draws whatever the numbering.
#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/joint/strength_scatter.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/going_on.hpp"

#include <map>
#include <numeric>
#include <random>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double mean_strength = 3e6; // T of concrete_joint

cdem::StrengthScatter scatter(double modulus, std::uint64_t seed = 1, double volume = 1e-3) {
  return {modulus, volume, seed};
}

cdem::Joint scattered(double modulus, std::uint64_t seed, cdem::Softening softening = cdem::Softening::none) {
  cdem::Joint joint = concrete_joint(softening);
  joint.scatter = scatter(modulus, seed);
  return joint;
}

cdem::Bonding face_springs() {
  cdem::Bonding bonding;
  bonding.everywhere = true;
  return bonding;
}

struct Moments {
  double mean = 0, variance = 0;
};

Moments moments(const std::vector<double>& x) {
  Moments m;
  m.mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  for (const double value : x)
    m.variance += (value - m.mean) * (value - m.mean) / static_cast<double>(x.size());
  return m;
}

// Of all bonded faces, ascending.
std::vector<double> face_strengths(const cdem::Model& model) {
  std::vector<double> all;
  cdem::each_face(model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    all.push_back(model.mesh.strength[static_cast<std::size_t>(batch)].tensile_strength[lane]);
  });
  std::sort(all.begin(), all.end());
  return all;
}

} // namespace

TEST_CASE("strength scatter: the gamma function is right to 1e-14", "[scatter]") {
  for (double x = 1; x <= 2; x += 1.0 / 64)
    CHECK(cdem::gamma_function(x) == Approx(std::tgamma(x)).epsilon(1e-14));
}

TEST_CASE("strength scatter: mean, variance and distribution of the factor are Weibull's", "[scatter]") {
  const double m = GENERATE(2.0, 8.0, 24.0), volume = GENERATE(1e-3, 2e-5);
  constexpr int n = 20000;
  std::vector<double> factors;
  for (std::uint64_t i = 0; i < n; ++i)
    factors.push_back(cdem::scatter_factor(scatter(m), volume, geom::uniform(7, i, 0)));
  const Moments found = moments(factors);
  const double g1 = std::tgamma(1 + 1 / m), g2 = std::tgamma(1 + 2 / m),
               size = std::pow(1e-3 / volume, 1 / m);
  const double variance = size * size * (g2 / (g1 * g1) - 1);
  CHECK(found.mean == Approx(size).margin(4 * std::sqrt(variance / n)));
  CHECK(found.variance == Approx(variance).epsilon(0.05));
  // Kolmogorov and Smirnov: D sqrt(n) is above 1.95 in one of a thousand draws.
  std::sort(factors.begin(), factors.end());
  double furthest = 0;
  for (int i = 0; i < n; ++i) {
    const double failed = 1 - std::exp(-volume / 1e-3 * std::pow(g1 * factors[i], m));
    furthest = std::max({furthest, std::abs(failed - i / double(n)), std::abs(failed - (i + 1) / double(n))});
  }
  CHECK(furthest * std::sqrt(double(n)) < 1.95);
}

TEST_CASE("strength scatter: no draw takes all strength away, none gives infinity", "[scatter]") {
  for (const double draw : {0.0, 1.0})
    for (const double m : {2.0, 1000.0}) {
      const double factor = cdem::scatter_factor(scatter(m), 1e-3, draw);
      CHECK((factor > 0 && std::isfinite(factor)));
    }
}

TEST_CASE("strength scatter: the weakest face of a body is weaker by V^(-1/m), whatever the mesh",
          "[scatter][mesh]") {
  struct Bar {
    Vec3 size;
    double edge;
  };
  const auto bar =
      GENERATE(Bar{{0.2, 0.1, 0.1}, 0.05}, Bar{{0.2, 0.1, 0.1}, 0.08}, Bar{{0.4, 0.2, 0.2}, 0.1});
  constexpr double m = 6;
  constexpr int n = 200;
  const geom::TetMesh mesh = unstructured(bar.size, bar.edge);
  std::vector<double> weakest;
  const double volume = bar.size.prod();
  for (int seed = 0; seed < n; ++seed) {
    const cdem::Model model = build({meshed("bar", mesh, face_springs(), concrete(), scattered(m, seed))});
    weakest.push_back(face_strengths(model).front());
  }
  const Moments found = moments(weakest);
  const double expected = mean_strength * std::pow(1e-3 / volume, 1 / m);
  const double g1 = std::tgamma(1 + 1 / m), spread = std::sqrt(std::tgamma(1 + 2 / m) / (g1 * g1) - 1);
  INFO("volume " << volume << ", " << found.mean / expected);
  CHECK(found.mean == Approx(expected).epsilon(4 * spread / std::sqrt(double(n))));
  CHECK(std::sqrt(found.variance) / found.mean == Approx(spread).epsilon(0.2));
}

TEST_CASE("strength scatter: draws follow the seed and the place of a face, not its number",
          "[scatter][mesh]") {
  const geom::TetMesh mesh = unstructured({0.3, 0.2, 0.2}, 0.1);
  const auto strengths = [&](const geom::TetMesh& of, std::uint64_t seed) {
    return face_strengths(build({meshed("bar", of, face_springs(), concrete(), scattered(8, seed))}));
  };
  const std::vector<double> before = strengths(mesh, 3);
  CHECK(strengths(mesh, 3) == before);
  CHECK(strengths(mesh, 4) != before);
  geom::TetMesh shuffled = mesh;
  std::mt19937 draw(5);
  std::vector<int> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), draw);
  for (std::size_t i = 0; i < number.size(); ++i)
    shuffled.nodes[number[i]] = mesh.nodes[i];
  for (geom::Tet& tet : shuffled.tets)
    tet = {number[tet[1]], number[tet[2]], number[tet[0]], number[tet[3]]};
  std::shuffle(shuffled.tets.begin(), shuffled.tets.end(), draw);
  const std::vector<double> after = strengths(shuffled, 3);
  REQUIRE(after.size() == before.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    CHECK(after[i] == Approx(before[i]).epsilon(1e-12)); // volumes to rounding
}

TEST_CASE("strength scatter: freeing nodes changes no face's strength, cohesion goes with tension",
          "[scatter][cohesive]") {
  System s(build({meshed("bar", unstructured({0.3, 0.2, 0.2}, 0.1), cohesive(), concrete(),
                         scattered(8, 3, cdem::Softening::linear))}));
  std::map<std::pair<int, int>, double> before;
  const auto each = [&](const auto& visit) {
    cdem::each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
      const cdem::FaceTets& tets =
          s.model.mesh.face_tets[static_cast<std::size_t>(batch * cdem::lanes + lane)];
      const cdem::FaceStrengthBatch& own = s.model.mesh.strength[static_cast<std::size_t>(batch)];
      CHECK(own.cohesion[lane] / own.tensile_strength[lane] == Approx(2).epsilon(1e-12));
      visit(std::pair(tets.tet_a, tets.tet_b), own.tensile_strength[lane]);
    });
  };
  std::size_t faces = 0;
  for (const double part : {0.3, 0.6, 1.0}) {
    std::vector<char> nodes(s.model.node_position.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = static_cast<char>(s.model.node_position[i].x() <= part * 0.3);
    cdem::Freed freed = cdem::split_nodes(s.model, s.state, nodes);
    s.adopt(std::move(freed.model), std::move(freed.state));
    each([&](const auto& tets, double own) {
      const auto [found, fresh] = before.emplace(tets, own);
      CHECK(found->second == own);
      faces += fresh ? 1 : 0;
    });
  }
  CHECK(faces == before.size());
  CHECK(before.size() > 100);
}

TEST_CASE("strength scatter: a row of blocks parts at its weakest face, at that face's strength",
          "[scatter][bonds]") {
  cdem::Joint joint = scattered(5, GENERATE(1, 2, 3));
  joint.scatter.reference_volume = 0.1 * 0.1 * 0.1 / 3;
  System s(build({body("row", geom::grid({0.8, 0.1, 0.1}, {8, 1, 1}), concrete(), joint)}));
  const auto weakest = std::min_element(s.model.interfaces.begin(), s.model.interfaces.end(),
                                        [](const auto& a, const auto& b) { return a.strength < b.strength; });
  lead_apart(s.conditions.fixes, 0.02);
  cdem::RunOptions options;
  options.steps = 1 << 30;
  options.callback_every = 1;
  options.stop = [&] { return s.log.broken_tension > 0; };
  s.run(options);
  const cdem::BreakRow& first = s.log.breaks.front();
  CHECK(first.normal_traction == Approx(weakest->strength * mean_strength).epsilon(0.01));
  CHECK(first.block_a == s.model.blocks[weakest->block_a].id);
  CHECK(first.block_b == s.model.blocks[weakest->block_b].id);
}

TEST_CASE("strength scatter: interfaces that a cut divides keep their strength, cut faces draw their own",
          "[scatter][refine]") {
  cdem::Joint joint = rock_joint();
  joint.scatter = scatter(6);
  const cdem::Model before = build({body("column", geom::grid({1, 1, 2}, {1, 1, 2}), rock(), joint)});
  REQUIRE(before.interfaces.size() == 1);
  std::vector<cdem::Successor> cut;
  for (int b = 0; b < 2; ++b) {
    const auto parts = geom::cut(before.blocks[b].shape, geom::Plane::through({0.5, 0.5, 1}, {1, 0, 0}));
    for (const auto* part : {&*parts.below, &*parts.above})
      cut.push_back({b, part->shape, part->parent_face, false});
  }
  const cdem::Rebuilt after =
      cdem::rebuild(before, cdem::initial_state(before), cut, {}, cdem::MayBreak::all);
  int kept = 0, fresh = 0;
  for (const cdem::Interface& i : after.model.interfaces) {
    const bool is_cut = i.origin == cdem::InterfaceOrigin::cut;
    CHECK((i.strength == before.interfaces[0].strength) == !is_cut);
    ++(is_cut ? fresh : kept);
  }
  CHECK(kept == 2);
  CHECK(fresh == 2);
}

TEST_CASE("strength scatter: with next to no scatter a cohesive bar bears what it does without",
          "[scatter][cohesive]") {
  const Vec3 size(0.6, 0.25, 0.25);
  const auto peak = [&](const cdem::Joint& joint) {
    System s(build({meshed("bar", unstructured(size, 0.12), cohesive(), concrete(), joint)}));
    lead_apart(s.conditions.fixes, 0.1);
    cdem::RunOptions options;
    options.duration = 0.9e-3;
    double most = 0;
    options.callback_every = 5;
    options.callback = [&] { most = std::max(most, end_traction(s, size.y() * size.z())); };
    s.run(options);
    return most;
  };
  const cdem::Joint plain = concrete_joint(cdem::Softening::linear, 20);
  cdem::Joint narrow = plain, wide = plain;
  narrow.scatter = scatter(1000, 1, 5e-5);
  wide.scatter = scatter(6, 1, 5e-5);
  const double without = peak(plain);
  CHECK(peak(narrow) == Approx(without).epsilon(0.01));
  CHECK(peak(wide) < 0.95 * without);
}

TEST_CASE(
    "strength scatter: the same bits for every number of threads, and when left in the middle of cracking",
    "[scatter][cohesive][resume]") {
  const auto build_bar = [](int threads, std::shared_ptr<cdem::Observer> observer) {
    cdem::ModelSpec spec;
    spec.bodies = {meshed("bar", unstructured({0.6, 0.25, 0.25}, 0.12), cohesive(), concrete(),
                          scattered(10, 2, cdem::Softening::exponential))};
    spec.bodies[0].joint.fracture_energy_1 = 60;
    spec.bodies[0].joint.rate = {1e-3, 0.05};
    cdem::Simulation s(spec, threads, std::move(observer));
    std::vector<cdem::Fix> leads;
    lead_apart(leads, 0.2);
    for (const cdem::Fix& lead : leads)
      s.fix(lead);
    return s;
  };
  const auto solve = [](cdem::Simulation& s, int done) {
    cdem::RunOptions options;
    options.duration = 1.5e-3;
    if (done == 0)
      s.run(options);
    CHECK(s.counts().broken_tension > 0);
    return Figures{s.time(), s.energy().breaking};
  };
  check_going_on(build_bar, solve, {3, 15});
}

TEST_CASE("strength scatter: wrong input is refused", "[scatter][input]") {
  const auto refused = [](const cdem::StrengthScatter& scatter, bool bonded, const char* says) {
    cdem::Joint joint = concrete_joint(cdem::Softening::none);
    joint.scatter = scatter;
    joint.bonded = bonded;
    CHECK_THROWS_WITH(cdem::validate(joint), Catch::Contains(says));
  };
  refused({1, 1e-3, 0}, true, "weibull.modulus = 1");
  refused({8, 0, 0}, true, "weibull.reference_volume = 0");
  refused({8, 1e-3, 0}, false, "weibull = of a contact");
}
