// Gives points nearer than a tolerance one number, that of the first of them, in the order they are met.
#pragma once

#include "libgeom/core/types.hpp"

#include <cmath>
#include <map>

namespace geom {

class Welder {
public:
  explicit Welder(double tolerance) : tolerance_(tolerance) {} // m

  // A new point is added to `points`.
  int number(const Vec3& x, std::vector<Vec3>& points) {
    const Cell home = cell(x);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto at = cells_.find({home[0] + i, home[1] + j, home[2] + k});
          if (at == cells_.end())
            continue;
          for (const int v : at->second)
            if ((points[v] - x).norm() <= tolerance_)
              return v;
        }
    points.push_back(x);
    const int added = static_cast<int>(points.size()) - 1;
    cells_[home].push_back(added);
    return added;
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const Vec3& x) const {
    return {static_cast<std::int64_t>(std::floor(x[0] / tolerance_)),
            static_cast<std::int64_t>(std::floor(x[1] / tolerance_)),
            static_cast<std::int64_t>(std::floor(x[2] / tolerance_))};
  }
  double tolerance_;
  std::map<Cell, std::vector<int>> cells_;
};

} // namespace geom
