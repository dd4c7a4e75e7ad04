// Sums that keep every bit: those of whole numbers are known, and no order changes a bit of any.
#include "libcdem/parallel/exact_sum.hpp"
#include "libcdem/ranks/bytes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using cdem::ExactSums;

namespace {

double exact(const std::vector<double>& values) {
  ExactSums<1> sum;
  for (const double x : values)
    sum.add(0, x);
  return sum.value(0);
}

} // namespace

TEST_CASE("exact sum: what cancels leaves what was beside it") {
  CHECK(exact({}) == 0);
  CHECK(exact({1e300, 1, -1e300}) == 1);
  CHECK(exact({1, 1e-300, -1}) == 1e-300);
  CHECK(exact({-3.5}) == -3.5);
  CHECK(exact({std::numeric_limits<double>::denorm_min()}) == std::numeric_limits<double>::denorm_min());
  CHECK(exact({std::numeric_limits<double>::max(), -1}) == std::numeric_limits<double>::max());
  CHECK(exact(std::vector<double>(10, 0.1)) ==
        1); // 0.1 is a little more than a tenth: less than half a bit of 1 in all
}

TEST_CASE("exact sum: rounds to the nearest, and to the even one of two") {
  const double ulp = std::ldexp(1, -52);
  CHECK(exact({1, 0.5 * ulp}) == 1);
  CHECK(exact({1 + ulp, 0.5 * ulp}) == 1 + 2 * ulp);
  CHECK(exact({1, 0.5 * ulp, 1e-300}) == 1 + ulp);
  CHECK(exact({1, 0.5 * ulp, -1e-300}) == 1);
  CHECK(exact({-1, -0.5 * ulp, -1e-300}) == -1 - ulp);
}

TEST_CASE("exact sum: a value that is no number is not lost") {
  CHECK(std::isnan(exact({1, std::numeric_limits<double>::quiet_NaN(), 2})));
  CHECK(std::isnan(exact({std::numeric_limits<double>::infinity(), 1})));
}

TEST_CASE("exact sum: any order and any parts give the same bits, and whole numbers their sum") {
  std::mt19937 random(7);
  std::vector<double> values;
  std::int64_t whole = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto number = static_cast<std::int64_t>(random()) - (std::int64_t{1} << 31);
    whole += number;
    values.push_back(static_cast<double>(number));
  }
  CHECK(exact(values) == static_cast<double>(whole));
  for (double& x : values)
    x = std::ldexp(x, static_cast<int>(random() % 200) - 100);
  const double once = exact(values);
  for (int turn = 0; turn < 5; ++turn) {
    std::shuffle(values.begin(), values.end(), random);
    CHECK(exact(values) == once);
    ExactSums<1> all, part;
    const std::size_t cut = random() % values.size();
    for (std::size_t i = 0; i < values.size(); ++i)
      (i < cut ? all : part).add(0, values[i]);
    for (std::size_t i = 0; i < ExactSums<1>::size(); ++i)
      all.data()[i] += part.data()[i];
    CHECK(all.value(0) == once);
  }
}

TEST_CASE("exact sum: one that keeps to the digits it has touched is told in parts with the same bits") {
  std::mt19937 random(11);
  cdem::ExactSum used; // cleared, as in every step
  for (int turn = 0; turn < 50; ++turn) {
    used.clear();
    CHECK(used.value() == 0);
    std::vector<double> values;
    for (int i = 0; i < 40; ++i)
      values.push_back(std::ldexp(static_cast<double>(static_cast<std::int32_t>(random())),
                                  static_cast<int>(random() % 300) - 150 + 10 * turn));
    cdem::ExactSum part;
    for (std::size_t i = 0; i < values.size(); ++i)
      (i % 3 == 0 ? part : used).add(values[i]);
    cdem::Pack told;
    part.tell(told);
    cdem::Unpack heard(told.text());
    used.add_told(heard);
    CHECK(used.value() == exact(values));
  }
  used.add(std::numeric_limits<double>::quiet_NaN());
  CHECK(std::isnan(used.value()));
  used.clear();
  used.add(-2.5);
  CHECK(used.value() == -2.5);
}
