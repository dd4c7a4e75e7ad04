// The right name nearest to a wrong one, for messages.
#pragma once

#include <string>
#include <vector>

namespace geom {

// Edit distance with insertions, deletions, changes and swaps of neighbours (Damerau 1964, restricted).
int edit_distance(const std::string& a, const std::string& b);

// The nearest of `names`, or "" when none is near enough to have been meant (more than a third of it wrong).
std::string nearest(const std::string& wrong, const std::vector<std::string>& names);

// "; did you mean youngs_modulus?" or "".
std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& names);

} // namespace geom
