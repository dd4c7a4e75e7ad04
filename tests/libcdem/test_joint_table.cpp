// A joint law given by tables.
#include "libcdem/joint/joint_law.hpp"

#include <catch2/catch.hpp>

using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

const cdem::JointSpring spring{1e10, 1e10, 0};

cdem::JointTable table() {
  cdem::JointTable law;
  law.closing = {{-1e-4, -2e4}, {0, 0}, {1e-3, 1e6}, {2e-3, 5e6}};
  law.shear = {{0, 1e5}, {1e6, 8e5}, {4e6, 2e6}};
  return law;
}

} // namespace

TEST_CASE("a table is straight between its rows and beyond the last", "[joint_law][joint_table]") {
  const cdem::JointTable law = table();
  CHECK(law.pressure(spring, 0.5e-3) == Approx(0.5e6));
  CHECK(law.pressure(spring, 1.5e-3) == Approx(3e6));
  CHECK(law.pressure(spring, 3e-3) == Approx(9e6));
  CHECK(law.strength(spring, 0.5e6, 0) == Approx(4.5e5));
  CHECK(law.strength(spring, 6e6, 0) == Approx(2.8e6));
  for (const double v : {0.3e-3, 1.7e-3, 4e-3}) {
    CHECK(law.closure(spring, law.pressure(spring, v)) == Approx(v));
    const double h = 1e-8;
    CHECK((law.stored(spring, v + h) - law.stored(spring, v - h)) / (2 * h) ==
          Approx(law.pressure(spring, v)).epsilon(1e-4));
  }
  CHECK(law.stored(spring, 2e-3) == Approx(0.5e3 + 3e3)); // two trapezia
  CHECK(law.pull(spring, 0.5e-4, 0.5e-4) == Approx(1e4));
  CHECK(law.stored_pull(spring, 1e-4, 1e-4) == Approx(0.5 * 2e4 * 1e-4));
}

TEST_CASE("a joint opened beyond its table has parted and pulls no more", "[joint_law][joint_table]") {
  const cdem::JointTable law = table();
  const Vec3 normal(0, 0, 1);
  const auto at = [&](double open, const cdem::JointHistory& h) {
    return cdem::joint_response(law, spring, normal, {0, 0, open}, Vec3::Zero(), h);
  };
  cdem::JointResponse r = at(0.9e-4, {});
  CHECK(r.traction.z() == Approx(1.8e4));
  r = at(1.1e-4, r.history);
  CHECK(r.traction.z() == 0);
  r = at(0.9e-4, r.history);
  CHECK(r.traction.z() == 0);
  r = at(-1e-3, r.history);
  CHECK(r.traction.z() == Approx(-1e6));
}

TEST_CASE("without rows for closure a table is linear", "[joint_law][joint_table]") {
  cdem::JointTable law = table();
  law.closing.clear();
  CHECK(law.pressure(spring, 1e-4) == Approx(1e6));
  CHECK(law.closure(spring, 1e6) == Approx(1e-4));
  CHECK(law.pull(spring, 1e-5, 0) == 0);
}

TEST_CASE("tables that are no law are refused", "[joint_law][joint_table]") {
  const auto refusal = [](const cdem::JointTable& law) {
    try {
      law.validate();
      law.validate(spring);
    } catch (const geom::InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(refusal(table()).empty());
  cdem::JointTable law = table();
  law.closing[3][1] = 0.9e6;
  CHECK_THAT(refusal(law), Contains("normal[4] = 900000") && Contains("above the 1e+06 of the row before"));
  law = table();
  law.closing[2][0] = -1e-5;
  CHECK_THAT(refusal(law), Contains("normal[3] = -1e-05") && Contains("above the 0"));
  law = table();
  law.closing.erase(law.closing.begin() + 1);
  CHECK_THAT(refusal(law), Contains("{0, 0}"));
  law = table();
  law.shear[2][1] = 7e5;
  CHECK_THAT(refusal(law), Contains("shear[3] = 700000") && Contains("at least the 800000"));
  law = table();
  law.shear[0][0] = 10;
  CHECK_THAT(refusal(law), Contains("shear[1] = 10"));
  law = table();
  law.shear = {{0, 1}};
  CHECK_THAT(refusal(law), Contains("at least two rows"));
  law = table();
  law.closing[3][1] = 5e8;
  CHECK_THAT(refusal(law), Contains("normal[4]: slope") && Contains("the stiffness of the spring"));
}
