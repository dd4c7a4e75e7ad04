#include "libcdem/results/crack_tip.hpp"

#include "libgeom/core/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace cdem {
namespace {

using geom::Vec3;

struct OnPath {
  double position = 0, distance = std::numeric_limits<double>::infinity(); // m
};

OnPath nearest(const std::vector<Vec3>& corners, const Vec3& x) {
  OnPath best;
  double before = 0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec3 along = corners[i + 1] - corners[i];
    const double length = along.norm();
    const double part = std::clamp((x - corners[i]).dot(along) / (length * length), 0.0, 1.0);
    const double distance = (x - corners[i] - part * along).norm();
    if (distance < best.distance)
      best = {before + part * length, distance};
    before += length;
  }
  return best;
}

// Points that hang together, found by cells as wide as the reach. Set 0 is the start.
class Chain {
public:
  Chain(const CrackLine& path, std::size_t points) : path_(path), sets_(points + 1) {
    place_.push_back(path.corners.front());
    farthest_.push_back(0);
    cells_[cell_of(place_[0])].push_back(0);
  }

  void add(const Vec3& x, double position) {
    const int i = static_cast<int>(place_.size());
    place_.push_back(x);
    farthest_.push_back(i);
    position_.push_back(position);
    const std::array<std::int64_t, 3> c = cell_of(x);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto near = cells_.find({c[0] + dx, c[1] + dy, c[2] + dz});
          if (near == cells_.end())
            continue;
          for (const int other : near->second)
            if ((place_[other] - x).norm() <= path_.reach)
              join(i, other);
        }
    cells_[c].push_back(i);
  }

  int tip() { return farthest_[sets_.find(0)]; } // 0: nothing hangs together with the start
  double position(int point) const { return point == 0 ? 0 : position_[point - 1]; }
  const Vec3& place(int point) const { return place_[point]; }

private:
  std::array<std::int64_t, 3> cell_of(const Vec3& x) const {
    std::array<std::int64_t, 3> cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<std::int64_t>(std::floor((x[axis] - path_.corners[0][axis]) / path_.reach));
    return cell;
  }
  void join(int i, int j) {
    const int a = farthest_[sets_.find(i)], b = farthest_[sets_.find(j)];
    sets_.unite(i, j);
    // Of two points at the same distance, take the one that broke first.
    const bool first =
        position(a) > position(b) || (position(a) == position(b) && a != 0 && (b == 0 || a < b));
    farthest_[sets_.find(i)] = first ? a : b;
  }

  const CrackLine& path_;
  geom::DisjointSets sets_;
  std::vector<Vec3> place_;
  std::vector<double> position_; // m, of points from 1
  std::vector<int> farthest_;    // by the member that stands for its set
  std::map<std::array<std::int64_t, 3>, std::vector<int>> cells_;
};

// Integral over [a, b] of (t - centre) s.
double moment(double a, double b, double centre, double s) {
  return 0.5 * s * ((b - centre) * (b - centre) - (a - centre) * (a - centre));
}

} // namespace

std::vector<CrackTipRow> crack_tip(const std::vector<BreakRow>& breaks, const CrackLine& path) {
  Chain chain(path, breaks.size());
  std::vector<CrackTipRow> rows;
  int last = 0;
  for (std::size_t i = 0; i < breaks.size(); ++i) {
    const BreakRow& row = breaks[i];
    const OnPath on = nearest(path.corners, row.place);
    if (on.distance <= path.width)
      chain.add(row.place, on.position);
    const bool step_ends =
        i + 1 == breaks.size() || breaks[i + 1].step != row.step || breaks[i + 1].stage != row.stage;
    const int tip = step_ends ? chain.tip() : last;
    if (tip == last || !(last == 0 || chain.position(tip) > chain.position(last)))
      continue;
    rows.push_back({row.stage, row.step, row.time, chain.position(tip), chain.place(tip),
                    std::numeric_limits<double>::quiet_NaN()});
    last = tip;
  }
  return rows;
}

void add_speeds(std::vector<CrackTipRow>& rows, double window) {
  if (rows.empty())
    return;
  const double begin = rows.front().time, end = rows.back().time;
  for (CrackTipRow& row : rows) {
    const double from = std::max(begin, row.time - 0.5 * window), to = std::min(end, row.time + 0.5 * window);
    const double length = to - from, centre = 0.5 * (from + to);
    if (!(length > 0))
      continue;
    auto i = std::upper_bound(rows.begin(), rows.end(), from,
                              [](double time, const CrackTipRow& r) { return time < r.time; });
    --i; // holds at `from`: begin <= from
    double sum = 0;
    for (double t = from; t < to; ++i) {
      const double until = i + 1 == rows.end() ? to : std::min(to, (i + 1)->time);
      sum += moment(t, until, centre, i->position - row.position);
      t = until;
    }
    row.speed = 12 * sum / (length * length * length);
  }
}

double usual_distance(const std::vector<BreakRow>& breaks, const std::vector<Vec3>& corners, double width) {
  double area = 0;
  std::int64_t count = 0;
  for (const BreakRow& row : breaks)
    if (nearest(corners, row.place).distance <= width) {
      area += row.area;
      ++count;
    }
  return count == 0 ? 0 : std::sqrt(3 * area / static_cast<double>(count));
}

} // namespace cdem
