// Counter-based random numbers keyed by (seed, id, draw): the same numbers whatever the order or thread
// count, and the same bits on every platform (integer arithmetic, and no function of the C library).
#pragma once

#include <array>
#include <cstdint>

namespace geom {

double uniform(std::uint64_t seed, std::uint64_t id, std::uint64_t draw); // in [0, 1)
double normal(std::uint64_t seed, std::uint64_t id, std::uint64_t draw);  // mean 0, standard deviation 1

// Philox 4x32 with 10 rounds (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3").
std::array<std::uint32_t, 4> philox(const std::array<std::uint32_t, 4>& counter,
                                    const std::array<std::uint32_t, 2>& key);

double normal_quantile(double probability); // in (0, 1)

} // namespace geom
