// Checks of user input that every builder shares. `field` is the name as a script user writes it.
#pragma once

#include "libgeom/core/types.hpp"

#include <string>

namespace geom {

std::string text(double value);      // shortest decimal that reads back as the same number
std::string text(const Vec3& value); // {x, y, z}
std::string shown(const Vec3& x);    // (x, y, z) with six digits

// Each throws InputError naming the field, its value and what is allowed.
void require_finite(const std::string& field, const Vec3& value);
void require_positive(const std::string& field, double value, const std::string& unit = "m");
void require_positive(const std::string& field, const Vec3& value); // three lengths, m
void require_between(const std::string& field, double value, double low, double high,
                     const std::string& unit = {}); // low and high are allowed

// The same of options and laws, whose values are shown with six digits.
void require(bool holds, const std::string& field, double value, const std::string& allowed,
             const std::string& advice = {});
void require_above(const std::string& field, double value, double low, const std::string& unit = {},
                   const std::string& advice = {}); // "a finite number > low"
void require_at_least(const std::string& field, double value, double low, const std::string& unit = {},
                      const std::string& advice = {});                            // "a finite number >= low"
void require_in(const std::string& field, double value, const std::string& range, // "(0, 1]"
                const std::string& advice = {});

inline constexpr double max_blocks = 1e7; // more would not fit the memory of one machine

// Throws when `blocks` (an estimate will do) is above max_blocks; `advice` says which field to change.
void require_block_count(const std::string& field, const std::string& value, double blocks,
                         const std::string& advice);

} // namespace geom
