#include "libgeom/core/nearest.hpp"

#include <algorithm>

namespace geom {

int edit_distance(const std::string& a, const std::string& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1, 0));
  for (std::size_t i = 0; i <= n; ++i)
    d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= m; ++j)
    d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i) {
    for (std::size_t j = 1; j <= m; ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[n][m];
}

std::string nearest(const std::string& wrong, const std::vector<std::string>& names) {
  std::string best;
  int best_distance = 0;
  for (const std::string& name : names) {
    int distance = edit_distance(wrong, name);
    // A name cut short or written longer ("poisson" for "poissons_ratio") is near whatever its length.
    const std::size_t shorter = std::min(wrong.size(), name.size());
    if (shorter >= 4 && name.compare(0, shorter, wrong, 0, shorter) == 0)
      distance = std::min(distance, 2);
    if (best.empty() || distance < best_distance) {
      best = name;
      best_distance = distance;
    }
  }
  const int allowed = std::max(2, static_cast<int>(std::max(wrong.size(), best.size())) / 3);
  const bool all_changed = best_distance >= static_cast<int>(std::max(wrong.size(), best.size()));
  return best_distance <= allowed && !all_changed ? best : std::string();
}

std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& names) {
  const std::string name = nearest(wrong, names);
  return name.empty() ? std::string() : "; did you mean " + name + "?";
}

} // namespace geom
