#include "libgeom/core/random.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

using namespace geom;

TEST_CASE("philox gives the known answers of its authors") { // Random123, kat_vectors, philox4x32 10
  CHECK(philox({0, 0, 0, 0}, {0, 0}) ==
        std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("the library's numbers are those of version 0.1.0, which had a function of its own") {
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < 100000; ++i)
    for (const std::uint32_t word : philox({i, 7 * i, ~i, 3}, {31 * i, 0x9E3779B9u + i}))
      sum = sum * 6364136223846793005ull + word;
  CHECK(sum == 0x7628930fd511d7a7ull);
  CHECK(uniform(42, 7, 3) == 0.71097026495192117);
  CHECK(normal(42, 7, 3) == 0.24765911578459671);
}

TEST_CASE("uniform takes the top 53 bits of the first two words") {
  const std::uint64_t word = 0xe169c58d6627e8d5ull; // philox of zero counter and key
  CHECK(uniform(0, 0, 0) == std::ldexp(static_cast<double>(word >> 11), -53));
}

TEST_CASE("the normal quantile inverts the normal distribution") {
  for (double x = -8; x <= 0; x += 0.01)
    CHECK(normal_quantile(0.5 * std::erfc(-x / std::sqrt(2.0))) == Approx(x).epsilon(1e-14).margin(1e-15));
  CHECK(normal_quantile(0.975) == Approx(1.959963984540054).epsilon(1e-15));
  CHECK(normal_quantile(0.5) == 0);
}

TEST_CASE("uniform and normal numbers have their distributions' moments") {
  const int n = 200000;
  double u1 = 0, u2 = 0, z1 = 0, z2 = 0, z4 = 0, both = 0, neighbours = 0, above = 0;
  for (int i = 0; i < n; ++i) {
    const double u = uniform(5, i, 0), z = normal(5, i, 0);
    REQUIRE((u >= 0 && u < 1));
    u1 += u;
    u2 += (u - 0.5) * (u - 0.5);
    z1 += z;
    z2 += z * z;
    z4 += z * z * z * z;
    both += (u - 0.5) * z;
    neighbours += (u - 0.5) * (uniform(5, i, 1) - 0.5) + (u - 0.5) * (uniform(6, i, 0) - 0.5) +
                  (u - 0.5) * (uniform(5, i + 1, 0) - 0.5);
    above += z > 1.959963984540054;
  }
  const double five_sigma = 5 / std::sqrt(n); // of a mean of numbers with unit deviation
  CHECK(u1 / n == Approx(0.5).margin(five_sigma * std::sqrt(1.0 / 12)));
  CHECK(u2 / n == Approx(1.0 / 12).margin(five_sigma * std::sqrt(1.0 / 180)));
  CHECK(z1 / n == Approx(0).margin(five_sigma));
  CHECK(z2 / n == Approx(1).margin(five_sigma * std::sqrt(2.0)));
  CHECK(z4 / n == Approx(3).margin(five_sigma * std::sqrt(96.0)));
  CHECK(both / n == Approx(0).margin(five_sigma * std::sqrt(1.0 / 12)));
  CHECK(neighbours / n == Approx(0).margin(five_sigma * std::sqrt(3.0) / 12));
  CHECK(above / n == Approx(0.025).margin(five_sigma * std::sqrt(0.025 * 0.975)));
}

TEST_CASE("random numbers depend on their key alone, not on the order they are drawn in") {
  std::vector<double> forward, backward;
  for (int i = 0; i < 100; ++i)
    forward.push_back(uniform(1, i, 3) + normal(1, i, 3));
  for (int i = 99; i >= 0; --i)
    backward.insert(backward.begin(), uniform(1, i, 3) + normal(1, i, 3));
  CHECK(forward == backward);
  CHECK(uniform(1, 2, 3) != uniform(1, 3, 2));
  CHECK(uniform(1, 2, 3) != uniform(2, 1, 3));
}
