// Random discs: their laws, and the intensities that they come to.
#include "libgeom/assembly/random_discs.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "tests/libgeom/degree.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

using namespace geom;
using Catch::Matchers::Contains;
using testing::degree;
using testing::pi;
using testing::refusal;

namespace {

RandomDiscs set_of(const RadiusOptions& radius, double p32, double kappa = 30) {
  RandomDiscs set;
  set.set = "a";
  set.dip = 40 * degree;
  set.dip_direction = 120 * degree;
  set.kappa = kappa;
  set.radius = radius;
  set.p30 = p32 / (pi * mean_square(radius));
  return set;
}

RadiusOptions law(RadiusLaw kind, double mean, double deviation = 0) {
  RadiusOptions r;
  r.law = kind;
  r.mean = mean;
  r.deviation = deviation;
  return r;
}

RadiusOptions power_law(double exponent, double smallest, double largest) {
  RadiusOptions r;
  r.law = RadiusLaw::power;
  r.exponent = exponent;
  r.smallest = smallest;
  r.largest = largest;
  return r;
}

} // namespace

TEST_CASE("the quantiles of radius laws have their mean square", "[discs]") {
  const double r = GENERATE(1.0, 3.0);
  for (const RadiusOptions& radius :
       {law(RadiusLaw::constant, r), law(RadiusLaw::exponential, r), law(RadiusLaw::lognormal, r, 0.5 * r),
        power_law(2.5, r, 10 * r), power_law(2, r, 5 * r)}) {
    const int n = 200000; // midpoint rule
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double x = radius_at(radius, (i + 0.5) / n);
      sum += x * x / n;
    }
    CHECK(sum == Approx(mean_square(radius)).epsilon(2e-3));
  }
}

TEST_CASE("P32 = N <pi r^2> / V, P10 = P32 <|cos|>, P21 = P32 <sin>, and the mean plane and kappa come back",
          "[discs]") {
  // Discs in a box that is larger than the window by the largest radius: the window sees no edge.
  const Box box{{-4, -4, -4}, {24, 24, 24}}, inner{{0, 0, 0}, {20, 20, 20}};
  const double p32 = 1.5, kappa = 30;
  const std::vector<Disc> discs = random_discs({set_of(power_law(2.6, 0.5, 4), p32, kappa)}, box, 5);
  double cosine = 0, sine = 0; // with x; of the poles with the plane z
  for (const Disc& disc : discs) {
    const Vec3 pole = normal_of_dip(disc.dip, disc.dip_direction);
    cosine += std::abs(pole.x()) / static_cast<double>(discs.size());
    sine += std::hypot(pole.x(), pole.y()) / static_cast<double>(discs.size());
  }
  double p10 = 0, p21 = 0;
  std::vector<DiscStatistics> found;
  const int n = 12; // lines and planes
  for (int i = 0; i < n; ++i) {
    const double at = 20 * (i + 0.5) / n;
    found = disc_statistics(discs, {inner, Plane{Vec3::UnitZ(), at},
                                    std::array<Vec3, 2>{Vec3(0, at, 20 - at), Vec3(20, at, 20 - at)}});
    p10 += *found[0].p10 / n;
    p21 += *found[0].p21 / n;
  }
  REQUIRE(found.size() == 1);
  CHECK(found[0].count == static_cast<std::int64_t>(discs.size()));
  // A draw scatters by 2.6 %, sqrt(<r^4> / n) / <r^2>: the mean of eight by 0.9 %.
  double mean = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    mean += disc_statistics(random_discs({set_of(power_law(2.6, 0.5, 4), p32, kappa)}, box, seed),
                            {inner, {}, {}})[0]
                .p32 /
            8;
  CHECK(mean == Approx(p32).epsilon(0.027));
  CHECK(found[0].p30 == Approx(p32 / (pi * mean_square(power_law(2.6, 0.5, 4)))).epsilon(0.05));
  CHECK(p21 == Approx(found[0].p32 * sine).epsilon(0.05));
  CHECK(p10 == Approx(found[0].p32 * cosine).epsilon(0.12)); // some 240 crossings
  CHECK(found[0].dip == Approx(40 * degree).margin(1 * degree));
  CHECK(found[0].dip_direction == Approx(120 * degree).margin(1.5 * degree));
  CHECK(*found[0].kappa == Approx(kappa).epsilon(0.05));
}

TEST_CASE("one disc's area, trace and crossing in a window are those of the circle", "[discs]") {
  Disc disc;
  disc.id = 1;
  disc.radius = 1;
  disc.set = "a";
  const Box whole{{-2, -2, -2}, {2, 2, 2}}, half{{0, -2, -2}, {2, 2, 2}}, corner{{0.5, 0.5, -1}, {3, 3, 1}};
  const auto p32 = [&](const Box& box) {
    return disc_statistics({disc}, {box, {}, {}})[0].p32 * box.size().prod();
  };
  CHECK(p32(whole) == Approx(pi));
  CHECK(p32(half) == Approx(pi / 2));
  // Beyond x = y = 1/2: pi/12 - (sqrt(3) - 1) / 4 by integration of sqrt(1 - x^2) - 1/2 from 1/2 to sqrt(3)/2.
  CHECK(p32(corner) == Approx(pi / 12 - (std::sqrt(3.0) - 1) / 4));
  const DiscStatistics s =
      disc_statistics({disc}, {whole, Plane{Vec3::UnitX(), 0.6},
                               std::array<Vec3, 2>{Vec3(0.3, 0, -1), Vec3(0.3, 0.2, 1)}})[0];
  CHECK(*s.p21 * 16 == Approx(2 * 0.8));
  CHECK(*s.p10 == Approx(1 / std::sqrt(4.04)));
  disc.dip = 30 * degree;
  disc.dip_direction = 90 * degree;
  CHECK(*disc_statistics({disc}, {whole, Plane{Vec3::UnitZ(), 0.3}, {}})[0].p21 * 16 ==
        Approx(2 * 0.8)); // 0.3 / sin 30
  CHECK(*disc_statistics({disc}, {whole, Plane{Vec3::UnitZ(), -0.3}, {}})[0].p21 * 16 == Approx(2 * 0.8));
}

TEST_CASE("the same seed gives the same discs, whatever other sets there are", "[discs]") {
  const Box box{{0, 0, 0}, {10, 10, 10}};
  const RandomDiscs one = set_of(law(RadiusLaw::lognormal, 1, 0.4), 0.5);
  const auto alone = random_discs({one}, box, 3), both = random_discs({one, one}, box, 3);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    CHECK(alone[i].centre == both[i].centre);
    CHECK(alone[i].radius == both[i].radius);
    CHECK(alone[i].dip == both[i].dip);
  }
  CHECK(random_discs({one}, box, 4)[0].centre != alone[0].centre);
}

TEST_CASE("laws that make no sense are refused with their set", "[discs]") {
  const Box box{{0, 0, 0}, {10, 10, 10}};
  RandomDiscs set = set_of(law(RadiusLaw::constant, 1), 0.5);
  set.kappa = -1;
  CHECK_THAT(refusal([&] { random_discs({set}, box, 1); }), Contains("set \"a\": kappa"));
  set = set_of(power_law(2.5, 1, 2), 0.5);
  set.radius.largest = 0.5;
  CHECK_THAT(refusal([&] { random_discs({set}, box, 1); }), Contains("above smallest"));
  set = set_of(law(RadiusLaw::constant, 1), 0.5);
  set.p30 = 1e6;
  CHECK_THAT(refusal([&] { random_discs({set}, box, 1); }), Contains("at most 100000 discs"));
}
