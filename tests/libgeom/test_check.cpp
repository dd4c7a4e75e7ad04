// Checks of user input: what holds, and what a refusal says.
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using testing::refusal;

TEST_CASE("a refusal names the field, its value, the range and the advice") {
  CHECK(refusal([] { require_above("time", 0, 0, "s", "give one"); }) ==
        "time = 0: must be a finite number > 0 s; give one");
  CHECK(refusal([] { require_at_least("k0", -1.5, 0); }) == "k0 = -1.5: must be a finite number >= 0");
  CHECK(refusal([] { require_above("area", std::nan(""), 0, "m2"); }) ==
        "area = nan: must be a finite number > 0 m2");
  CHECK(refusal([] { require_in("ratio", 0.5, "(-1, 0.5)"); }) == "ratio = 0.5: must be in (-1, 0.5)");
  CHECK(refusal([] { require_in("safety", 0, "(0, 1]"); }) == "safety = 0: must be in (0, 1]");
  CHECK(shown(Vec3(1, -0.25, 1e7)) == "(1, -0.25, 1e+07)");
}

TEST_CASE("an end in brackets belongs to a range, one in parentheses does not") {
  CHECK_NOTHROW(require_in("safety", 1, "(0, 1]"));
  CHECK_NOTHROW(require_in("damping", 0, "[0, 1)"));
  CHECK_THROWS(require_in("damping", 1, "[0, 1)"));
  CHECK_THROWS(require_in("damping", std::nan(""), "[0, 1)"));
  CHECK_THROWS(require_at_least("over", INFINITY, 0));
}

TEST_CASE("things are counted in the singular and the plural") {
  CHECK(counted(1, "block") == "1 block");
  CHECK(counted(0, "block") == "0 blocks");
  CHECK(counted(2, "body", "bodies") == "2 bodies");
}
