// Random discs of a fracture network, and the statistics of a network.
//
// Orientation after Fisher (1953, Proc. R. Soc. A 217): poles around the mean, at the angle t from it with the probability
// density kappa sin t exp(kappa cos t) / (2 sinh kappa). Radii after one of four laws, with the mean square that links the
// intensities
//
//   P32 = P30 pi <r^2>,   P10 = P32 <|cos|>
//
// P30: discs per volume, P32: area per volume, P21: trace length per area of a plane, P10: crossings per length of a line; cos:
// between line and pole.
#pragma once

#include "libgeom/assembly/discs.hpp"

#include <optional>

namespace geom {

enum class RadiusLaw { constant, exponential, lognormal, power };

struct RadiusOptions {
  RadiusLaw law = RadiusLaw::constant;
  double mean = 0;      // m, of constant, exponential and lognormal
  double deviation = 0; // m, standard deviation of lognormal
  // For `power`: density ~ r^-(exponent + 1) between smallest and largest, m.
  double exponent = 0, smallest = 0, largest = 0;
};
double mean_square(const RadiusOptions&);         // m2
double radius_at(const RadiusOptions&, double u); // m, u in (0, 1): the quantile

struct RandomDiscs {
  std::string set;
  double dip = 0, dip_direction = 0; // rad, of the mean plane
  std::optional<double> kappa;       // of Fisher; none: all planes are parallel
  RadiusOptions radius;
  double p30 = 0; // 1/m3
};
// Centres evenly at random in the box, round(p30 volume) of each set. Draws depend on the seed, the number of the set and that of
// the disc in it. ids from 1. Throws InputError naming the set.
std::vector<Disc> random_discs(const std::vector<RandomDiscs>&, const Box& box, std::uint64_t seed);

struct DiscWindow {
  Box box;                                 // m, the volume of P30 and P32, and what bounds the plane
  std::optional<Plane> plane;              // of P21, within the box
  std::optional<std::array<Vec3, 2>> line; // of P10, its ends
};

struct DiscStatistics { // of one set
  std::string set;
  std::int64_t count = 0; // discs in all
  double mean_radius = 0; // m
  double dip = 0,
         dip_direction = 0; // rad, mean plane: pole of the largest eigenvalue of the orientation tensor
  std::optional<double>
      kappa; // (n - 1) / (n - R), R the length of the sum of the poles; none for fewer than three
  double p30 = 0, p32 = 0;        // 1/m3: centres in the box; 1/m: area in the box
  std::optional<double> p21, p10; // 1/m
};
// By set, in the order of the alphabet.
std::vector<DiscStatistics> disc_statistics(const std::vector<Disc>&, const DiscWindow&);

} // namespace geom
