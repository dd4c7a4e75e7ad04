#include "libcdem/load/conditions.hpp"

#include <algorithm>

namespace cdem {

void add_fix(std::vector<Fix>& fixes, const Fix& fix) {
  const auto overruled = [&](const Fix& earlier) {
    for (int axis = 0; axis < 3; ++axis)
      if (earlier.axes[axis] && !fix.axes[axis])
        return false;
    return selects_same(earlier.on, fix.on);
  };
  fixes.erase(std::remove_if(fixes.begin(), fixes.end(), overruled), fixes.end());
  fixes.push_back(fix);
}

std::string Flow::places() const {
  std::string text;
  for (const Selection& place : on)
    text += (text.empty() ? "" : ", ") + place.text;
  return text;
}

} // namespace cdem
