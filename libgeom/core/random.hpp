// Counter-based random numbers keyed by (seed, id, draw): the same numbers whatever the order or thread count.
#pragma once

#include <cstdint>

namespace geom {

double uniform(std::uint64_t seed, std::uint64_t id, std::uint64_t draw); // in [0, 1)
double normal(std::uint64_t seed, std::uint64_t id, std::uint64_t draw);  // mean 0, standard deviation 1

} // namespace geom
