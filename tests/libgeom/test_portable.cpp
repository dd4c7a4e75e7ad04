// The functions that are the same on every processor against those of the C library in long double.
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace geom;

namespace {

// Deviation in units of the last place of `right`.
double ulps(double found, long double right) {
  const double nearest = static_cast<double>(right);
  const double unit = std::nextafter(std::abs(nearest), INFINITY) - std::abs(nearest);
  return static_cast<double>(std::abs(found - right) / unit);
}

// Largest deviation over random arguments in [-range, range].
template <class Found, class Right>
double worst(double range, const Found& found, const Right& right) {
  double largest = 0;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    const double x = range * (2 * uniform(7, 1, i) - 1);
    largest = std::max(largest, ulps(found(x), right(static_cast<long double>(x))));
  }
  return largest;
}

constexpr double most = 2; // units of the last place

} // namespace

TEST_CASE("the portable exponential, sine, cosine and tangent are right to a few units", "[portable]") {
  for (const double range : {1e-6, 0.1, 1., 10., 700.})
    CHECK(worst(range, portable::exp, [](long double x) { return std::exp(x); }) < most);
  for (const double range : {1e-6, 0.1, 1., 10., 1e5}) {
    const double far = range > 10 ? 1.5 : 1; // the rest of many turns is rounded once more
    CHECK(worst(range, portable::sin, [](long double x) { return std::sin(x); }) < far * most);
    CHECK(worst(range, portable::cos, [](long double x) { return std::cos(x); }) < far * most);
    CHECK(worst(range, portable::tan, [](long double x) { return std::tan(x); }) < 2 * far * most);
  }
}

TEST_CASE("the portable arcs are right to two units in every quarter", "[portable]") {
  double largest = 0;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    const double size = std::pow(10., 20 * uniform(7, 2, 3 * i) - 10);
    const double y = size * (2 * uniform(7, 2, 3 * i + 1) - 1), x = 2 * uniform(7, 2, 3 * i + 2) - 1;
    largest = std::max(largest, ulps(portable::atan2(y, x), std::atan2((long double)y, (long double)x)));
  }
  CHECK(largest < most);
  CHECK(worst(1, portable::acos, [](long double x) { return std::acos(x); }) < 1.5 * most);
}

TEST_CASE("the portable functions meet their special values", "[portable]") {
  const double inf = std::numeric_limits<double>::infinity(), pi = 3.14159265358979323846;
  CHECK(portable::exp(0) == 1);
  CHECK(portable::exp(1e4) == inf);
  CHECK(portable::exp(-1e4) == 0);
  CHECK(portable::exp(-740) == Approx(std::exp(-740.)).epsilon(1e-3)); // subnormal
  CHECK(portable::sin(0) == 0);
  CHECK(portable::cos(0) == 1);
  CHECK(portable::acos(1) == 0);
  CHECK(portable::acos(-1) == pi);
  for (const double y : {0., -0., 1., -1., inf, -inf})
    for (const double x : {0., -0., 1., -1., inf, -inf}) {
      INFO(y << " over " << x);
      CHECK(portable::atan2(y, x) == std::atan2(y, x));
      CHECK(std::signbit(portable::atan2(y, x)) == std::signbit(std::atan2(y, x)));
    }
  for (const double bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(std::isnan(portable::sin(bad)));
    CHECK(std::isnan(portable::cos(bad)));
    CHECK(std::isnan(portable::tan(bad)));
  }
  CHECK(std::isnan(portable::exp(std::numeric_limits<double>::quiet_NaN())));
  CHECK(std::isnan(portable::atan2(std::numeric_limits<double>::quiet_NaN(), 1)));
  CHECK(std::isnan(portable::acos(1.5)));
}
