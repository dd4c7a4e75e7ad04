// What follows from a model alone is kept between stages, and found anew when the model has changed in any way.
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/model/known_of_model.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

using namespace testing;

TEST_CASE("what is known of a model is found once, and anew for one that differs in anything", "[stage]") {
  cdem::Model model = build({concrete_body(geom::box_mesh({1, 0.2, 0.2}, {5, 1, 1})),
                             body("blocks", geom::grid({1, 1, 1}, {2, 2, 2}, {0, 1, 0}), rock())},
                            {{"concrete", "concrete", friction(30)}});
  cdem::KnownOfModel<int> known;
  int found = 0;
  const auto ask = [&](const cdem::Model& of) { return *known.of(of, [&] { return ++found; }); };
  CHECK(ask(model) == 1);
  CHECK(ask(model) == 1);
  REQUIRE(!model.interfaces.empty());
  REQUIRE(!model.surface.triangles.empty());
  const auto differs = [&](const auto& change) {
    cdem::Model other = model;
    change(other);
    const int before = found;
    CHECK(ask(other) == before + 1);
    CHECK(ask(other) == before + 1);
    CHECK(ask(model) <= before); // the last two are kept
  };
  differs([](cdem::Model& m) { m.node_position[3].x() += 1e-15; });
  differs([](cdem::Model& m) { m.node_mass.back() *= 2; });
  differs([](cdem::Model& m) { m.bodies[0].material.youngs_modulus += 1; });
  differs([](cdem::Model& m) { m.interfaces[0].kn *= 2; });
  differs([](cdem::Model& m) { std::swap(m.tets[0][0], m.tets[0][1]); });
  differs([](cdem::Model& m) { m.mesh.region[0] += 1; });
  differs([](cdem::Model& m) { m.blocks.back().generation = 3; });
  differs([](cdem::Model& m) { m.surface.triangles.back().area *= 2; });
}

TEST_CASE("the stable step of a stage is that of the model as it is now", "[stage]") {
  // A thin slice of other stiffness sets the step; without it the step is longer, with it again the same.
  System s(build({body("rock", geom::grid({1, 1, 1}, {2, 2, 2}), rock())}));
  const std::vector<double> first = cdem::element_row_sums(s.model);
  cdem::Model stiff = s.model;
  stiff.bodies[0].material.youngs_modulus *= 4;
  const std::vector<double> second = cdem::element_row_sums(stiff), again = cdem::element_row_sums(s.model);
  REQUIRE(first.size() == second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(second[i] == Approx(4 * first[i]).epsilon(1e-12));
    CHECK(again[i] == first[i]);
  }
}
