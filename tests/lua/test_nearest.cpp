#include "libgeom/core/nearest.hpp"

#include <catch2/catch.hpp>

using namespace geom;

TEST_CASE("edit distance counts insertions, deletions, changes and swaps", "[lua]") {
  CHECK(edit_distance("cohesion", "cohesion") == 0);
  CHECK(edit_distance("cohesion", "cohesin") == 1);
  CHECK(edit_distance("cohesion", "cohession") == 1);
  CHECK(edit_distance("cohesion", "kohesion") == 1);
  CHECK(edit_distance("cohesion", "choesion") == 1);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("edit distance is symmetric and obeys the triangle inequality", "[lua]") {
  const std::vector<std::string> words{"size", "sides", "divisions", "division", "origin", "", "x"};
  for (const auto& a : words)
    for (const auto& b : words) {
      CHECK(edit_distance(a, b) == edit_distance(b, a));
      for (const auto& c : words)
        CHECK(edit_distance(a, c) <= edit_distance(a, b) + edit_distance(b, c));
    }
}

TEST_CASE("the nearest name is one that may have been meant", "[lua]") {
  const std::vector<std::string> names{"youngs_modulus", "poissons_ratio", "density", "viscosity"};
  CHECK(nearest("young_modulus", names) == "youngs_modulus");
  CHECK(nearest("poisson_ratio", names) == "poissons_ratio");
  CHECK(nearest("desnity", names) == "density");
  CHECK(nearest("temperature", names).empty());
  CHECK(nearest("x", {"z+"}).empty());
}
