#include "libcdem/fracture/crack_path.hpp"

#include "libgeom/core/disjoint_sets.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>

namespace cdem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A path through intact rock counts this many times its length, a path along the crack once.
constexpr double bridge_cost = 5;
// Places of the front within this part of a block size of its farthest place are one tip.
constexpr double about_as_far = 0.5;

bool is(const State& state, int point, BondMode mode) {
  return state.bond_mode[point] == static_cast<std::uint8_t>(mode);
}

// Springs by place: those nearer than the tolerance are one.
class Places {
public:
  explicit Places(const Model& model) : tolerance_(10 * model.tolerance), order_(model.points.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    const auto& x = model.point_position;
    std::sort(order_.begin(), order_.end(),
              [&](int a, int b) { return x[a].x() < x[b].x() || (x[a].x() == x[b].x() && a < b); });
  }
  // Ascending.
  std::vector<int> at(const Model& model, const geom::Vec3& place) const {
    const auto& x = model.point_position;
    auto p = std::lower_bound(order_.begin(), order_.end(), place.x() - tolerance_,
                              [&](int point, double low) { return x[point].x() < low; });
    std::vector<int> found;
    for (; p != order_.end() && x[*p].x() <= place.x() + tolerance_; ++p)
      if ((x[*p] - place).squaredNorm() <= tolerance_ * tolerance_)
        found.push_back(*p);
    std::sort(found.begin(), found.end());
    return found;
  }

private:
  double tolerance_;
  std::vector<int> order_;
};

// The two sides of some crack spring at this place are held together by the intact ones there.
bool on_front(const Model& model, const State& state, const std::vector<int>& points) {
  std::vector<int> blocks;
  const auto interface = [&](int p) -> const Interface& {
    return model.interfaces[model.points[p].interface];
  };
  for (const int p : points)
    for (const int block : {interface(p).block_a, interface(p).block_b})
      if (std::find(blocks.begin(), blocks.end(), block) == blocks.end())
        blocks.push_back(block);
  const auto index = [&](int block) {
    return static_cast<int>(std::find(blocks.begin(), blocks.end(), block) - blocks.begin());
  };
  geom::DisjointSets pieces(blocks.size());
  for (const int p : points)
    if (is(state, p, BondMode::intact))
      pieces.unite(index(interface(p).block_a), index(interface(p).block_b));
  for (const int p : points)
    if (!is(state, p, BondMode::intact) &&
        pieces.find(index(interface(p).block_a)) == pieces.find(index(interface(p).block_b)))
      return true;
  return false;
}

// The crack as a graph over places.
struct Crack {
  std::vector<int> front_interfaces;
  std::vector<geom::Vec3> place;
  std::vector<std::vector<int>> next; // along triangles
  std::vector<char> notch, front;
  std::vector<double> size; // m, first size of the smaller block beside it
};

Crack crack_of(const Model& model, const State& state) {
  const Places places(model);
  Crack crack;
  std::vector<int> node(model.points.size(), -1);
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p) {
    const Interface& interface = model.interfaces[model.points[p].interface];
    const bool unbonded = is(state, p, BondMode::contact);
    if (node[p] >= 0 || is(state, p, BondMode::intact) || (unbonded && !model.joints[interface.joint].bonded))
      continue;
    const std::vector<int> here = places.at(model, model.point_position[p]);
    const int n = static_cast<int>(crack.place.size());
    crack.place.push_back(model.point_position[p]);
    crack.front.push_back(on_front(model, state, here));
    crack.size.push_back(
        std::min(model.blocks[interface.block_a].first_size, model.blocks[interface.block_b].first_size));
    crack.notch.push_back(0);
    for (const int q : here)
      if (is(state, q, BondMode::intact)) {
        if (crack.front.back())
          crack.front_interfaces.push_back(model.points[q].interface);
      } else {
        node[q] = n;
        crack.notch[n] |= is(state, q, BondMode::contact);
      }
  }
  auto& meeting = crack.front_interfaces;
  std::sort(meeting.begin(), meeting.end());
  meeting.erase(std::unique(meeting.begin(), meeting.end()), meeting.end());
  crack.next.resize(crack.place.size());
  for (const geom::Triangle& t : model.bond_triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = node[t[k]], b = node[t[(k + 1) % 3]];
      if (a >= 0 && b >= 0 && a != b) {
        crack.next[a].push_back(b);
        crack.next[b].push_back(a);
      }
    }
  return crack;
}

struct Distances {
  std::vector<double> length; // m, infinite where there is no way
  std::vector<int> from;      // the place before, -1 at the start
};

Distances distances(const Crack& crack, const std::vector<int>& start, bool bridges) {
  const int n = static_cast<int>(crack.place.size());
  Distances d{std::vector<double>(n, infinity), std::vector<int>(n, -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int s : start) {
    d.length[s] = 0;
    queue.push({0, s});
  }
  while (!queue.empty()) {
    const auto [length, i] = queue.top();
    queue.pop();
    if (length > d.length[i])
      continue;
    const auto offer = [&, at = i, so_far = length](int j, double cost) {
      const double candidate = so_far + cost * (crack.place[j] - crack.place[at]).norm();
      if (candidate < d.length[j]) {
        d.length[j] = candidate;
        d.from[j] = at;
        queue.push({candidate, j});
      }
    };
    for (const int j : crack.next[i])
      offer(j, 1);
    if (bridges)
      for (int j = 0; j < n; ++j)
        offer(j, bridge_cost);
  }
  return d;
}

std::vector<geom::Vec3> way_back(const Crack& crack, const Distances& d, int end) {
  std::vector<geom::Vec3> line;
  for (int i = end; i >= 0; i = d.from[i])
    line.push_back(crack.place[i]);
  return line;
}

int farthest(const std::vector<double>& length, const std::vector<char>* only) {
  int best = -1;
  for (int i = 0; i < static_cast<int>(length.size()); ++i)
    if (length[i] < infinity && (!only || (*only)[i]) && (best < 0 || length[i] > length[best]))
      best = i;
  return best;
}

int nearest(const Crack& crack, const geom::Vec3& place) {
  int best = 0;
  for (int i = 1; i < static_cast<int>(crack.place.size()); ++i)
    if ((crack.place[i] - place).squaredNorm() < (crack.place[best] - place).squaredNorm())
      best = i;
  return best;
}

// Middle of the stretch of front through `from` that is about as far from the start: a tip that runs through
// the thickness.
geom::Vec3 middle_of_front(const Crack& crack, const std::vector<double>& length, int from) {
  std::vector<char> seen(crack.place.size(), 0);
  std::vector<int> left{from};
  seen[from] = 1;
  geom::Box around;
  while (!left.empty()) {
    const int i = left.back();
    left.pop_back();
    around.extend(crack.place[i]);
    for (const int j : crack.next[i])
      if (crack.front[j] && !seen[j] && length[j] >= length[from] - about_as_far * crack.size[from]) {
        seen[j] = 1;
        left.push_back(j);
      }
  }
  return around.centre();
}

} // namespace

CrackPath crack_path(const Model& model, const State& state, const std::optional<geom::Vec3>& first_break) {
  Crack crack = crack_of(model, state);
  CrackPath path;
  path.front_interfaces = std::move(crack.front_interfaces);
  if (crack.place.empty())
    return path;
  std::vector<int> start;
  for (int i = 0; i < static_cast<int>(crack.place.size()); ++i)
    if (crack.notch[i])
      start.push_back(i);
  if (start.empty())
    start.push_back(first_break ? nearest(crack, *first_break) : 0);

  const Distances d = distances(crack, start, true);
  const int front = farthest(d.length, &crack.front);
  path.has_front = front >= 0;
  const int end = path.has_front ? front : farthest(d.length, nullptr);
  path.line = way_back(crack, d, end);
  // The start is a whole notch: go on to its far end, the mouth.
  const int entry = nearest(crack, path.line.back());
  const Distances inside = distances(crack, {entry}, false);
  std::vector<double> in_notch = inside.length;
  for (std::size_t i = 0; i < in_notch.size(); ++i)
    if (!crack.notch[i])
      in_notch[i] = infinity;
  const int mouth = farthest(in_notch, nullptr);
  std::reverse(path.line.begin(), path.line.end());
  if (mouth >= 0 && mouth != entry) {
    std::vector<geom::Vec3> line = way_back(crack, inside, mouth);
    line.insert(line.end(), path.line.begin() + 1, path.line.end());
    path.line = std::move(line);
  }

  path.tip = path.has_front ? middle_of_front(crack, d.length, end) : crack.place[end];
  if (path.line.size() > 1)
    path.ahead = path.line.back() - path.line[path.line.size() - 2];
  return path;
}

std::vector<double> piece_volumes(const Model& model, const State& state) {
  geom::DisjointSets pieces(model.blocks.size());
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p)
    if (is(state, p, BondMode::intact)) {
      const Interface& interface = model.interfaces[model.points[p].interface];
      pieces.unite(interface.block_a, interface.block_b);
    }
  std::vector<double> volume(model.blocks.size(), 0.0);
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
    volume[pieces.find(b)] += model.blocks[b].mass.volume;
  volume.erase(std::remove(volume.begin(), volume.end(), 0.0), volume.end());
  std::sort(volume.rbegin(), volume.rend());
  return volume;
}

} // namespace cdem
