#include "libcdem/contact/broad_phase/rigid_pairs.hpp"

#include "libcdem/contact/broad_phase/contact_fragments.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/element/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {
namespace {

using Quaternion = std::array<double, 4>;

// Rounding error of a position, over the size of the body.
constexpr double rounding = 1e-12;
// The thinnest skin of a pair and the thickest, over the usual height of a tet. Steps that a pair can go on at its pace.
constexpr double thinnest = 0.01, thickest = 0.2, steps_ahead = 250;
// Share of a skin: a pair with less left is searched with the first that leaves its own.
constexpr double searched_with_others = 0.6;
// A pair that leaves its skin within fewer steps than this gets one twice as thick, after more one half as thick.
constexpr std::int64_t few_steps = 50, many_steps = 150;
constexpr int most_doublings = 5;

// conj(q) p
Quaternion conjugate_times(const Quaternion& q, const Quaternion& p) {
  return {q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3],
          q[0] * p[1] - q[1] * p[0] - q[2] * p[3] + q[3] * p[2],
          q[0] * p[2] + q[1] * p[3] - q[2] * p[0] - q[3] * p[1],
          q[0] * p[3] - q[1] * p[2] + q[2] * p[1] - q[3] * p[0]};
}

// R^T v
geom::Vec3 turned_back(const Quaternion& q, const geom::Vec3& v) {
  const geom::Vec3 u(q[1], q[2], q[3]), t = 2 * v.cross(u);
  return v + q[0] * t + t.cross(u);
}

// The norm of the difference of two rotations: 2 sin(angle / 2).
double difference(const Quaternion& q, const Quaternion& p) {
  double minus = 0, plus = 0;
  for (int i = 0; i < 4; ++i) {
    minus += (q[i] - p[i]) * (q[i] - p[i]);
    plus += (q[i] + p[i]) * (q[i] + p[i]);
  }
  return 2 * std::sqrt(std::min(minus, plus));
}

// Planes that have no node of the block beyond them: of each face the largest triangle's.
std::vector<int> planes_of(const Model& model, const State& state, int b) {
  constexpr double flat = 1e-9, same_direction = 1e-8; // of the block's size; of the cosine of an angle
  const ContactSurface& s = model.surface;
  const Block& block = model.blocks[b];
  std::vector<int> triangles(static_cast<std::size_t>(s.block_begin[b + 1] - s.block_begin[b])), planes;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = s.block_begin[b] + static_cast<int>(i);
  std::sort(triangles.begin(), triangles.end(), [&](int one, int other) {
    return std::pair(-s.triangles[one].area, one) < std::pair(-s.triangles[other].area, other);
  });
  std::vector<geom::Vec3> normals;
  constexpr std::size_t most = std::numeric_limits<std::uint8_t>::max(); // ContactRow::plane
  for (std::size_t i = 0; i < triangles.size() && planes.size() < most; ++i) {
    const Corners x = corners_of(model, state, s.triangles[triangles[i]].nodes);
    const geom::Vec3 normal = unit_normal(x);
    if (std::any_of(normals.begin(), normals.end(),
                    [&](const geom::Vec3& known) { return known.dot(normal) > 1 - same_direction; }))
      continue;
    double beyond = 0;
    for (int node = block.node_begin; node < block.node_end; ++node)
      beyond = std::max(beyond, (place_of(model, state, node) - x[0]).dot(normal));
    if (beyond > flat * block.size)
      continue;
    normals.push_back(normal);
    planes.push_back(triangles[i]);
  }
  return planes;
}

double radius_of(const Model& model, const State& state, int b) {
  const Block& block = model.blocks[b];
  const geom::Vec3 centre = vec(state.rigid[block.rigid].centroid);
  double radius2 = 0;
  for (int node = block.node_begin; node < block.node_end; ++node)
    radius2 = std::max(radius2, (place_of(model, state, node) - centre).squaredNorm());
  return std::sqrt(radius2) * (1 + rounding);
}

double inner_radius_of(const Model& model, const State& state, int b) {
  const ContactSurface& s = model.surface;
  const geom::Vec3 centre = vec(state.rigid[model.blocks[b].rigid].centroid);
  double radius = std::numeric_limits<double>::infinity();
  for (int t = s.block_begin[b]; t < s.block_begin[b + 1]; ++t) {
    const Corners x = corners_of(model, state, s.triangles[t].nodes);
    radius = std::min(radius, (x[0] - centre).dot(unit_normal(x)));
  }
  return std::max(0.0, radius) * (1 - rounding);
}

// m in a step, of b's fastest place seen from a.
double relative_pace(const Model& model, const State& state, const ContactWork& work, int a, int b,
                     const std::vector<double>& pace) {
  if (work.rigid_pairs.radius[a] < work.rigid_pairs.radius[b])
    std::swap(a, b);
  const int rigid_a = model.blocks[a].rigid, rigid_b = model.blocks[b].rigid;
  const RigidState &one = state.rigid[rigid_a], &other = state.rigid[rigid_b];
  const geom::Vec3 spin_a = spin(model.rigid[rigid_a], one, 0), spin_b = spin(model.rigid[rigid_b], other, 0),
                   arm = vec(other.centroid) - vec(one.centroid);
  const double relative =
      work.travel.last_step * ((vec(other.velocity) - vec(one.velocity) - spin_a.cross(arm)).norm() +
                               (spin_b - spin_a).norm() * work.rigid_pairs.radius[b]);
  const double sum = pace[a] + pace[b];
  return std::isfinite(relative) ? std::min(relative, sum) : sum;
}

// m, by how much the plane of a triangle parts its block from another; below 0: that reaches so far behind the plane.
double gap_before(const Model& model, const State& state, int triangle, int other) {
  const Corners x = corners_of(model, state, model.surface.triangles[triangle].nodes);
  const geom::Vec3 normal = unit_normal(x);
  double least = std::numeric_limits<double>::infinity();
  for (int node = model.blocks[other].node_begin; node < model.blocks[other].node_end; ++node)
    least = std::min(least, (place_of(model, state, node) - x[0]).dot(normal));
  return least;
}

// m, by how much a plane of a face of one of the two parts them; 0: none does.
double distance_apart(const Model& model, const State& state, const RigidPairs& pairs, int a, int b) {
  double best = 0;
  for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)})
    for (const int triangle : pairs.planes[one])
      best = std::max(best, gap_before(model, state, triangle, other));
  return best * (1 - rounding);
}

bool before(const RigidPair& x, const RigidPair& y) {
  return std::minmax(x.a, x.b) < std::minmax(y.a, y.b);
}

// m, at most, of the motion since it was searched.
double used_of_skin(const RigidPairs& pairs, const RigidPair& pair) {
  return std::min(
      path_of(pairs, pair) - pair.path_at_search,
      motion_between(seen_from(pairs.pose[pair.a], pairs.pose[pair.b]), pair.at_search, pair.radius_b));
}

// Whether a search may pass a pair over: it has used little of its skin. A search that broken bonds ask for passes over more of
// them, since it comes again soon: those within their skin for twice as many steps as since the last search, at their pace.
bool may_wait(const ContactWork& work, const RigidPair& pair, std::int64_t since_last_search) {
  const RigidPairs& pairs = work.rigid_pairs;
  const double used = used_of_skin(pairs, pair);
  if (used <= (1 - searched_with_others) * pair.skin)
    return true;
  const auto age = static_cast<double>(std::max<std::int64_t>(1, pairs.steps - pair.at));
  return !work.search.pairs_due && used * (1 + 2 * static_cast<double>(since_last_search) / age) < pair.skin;
}

} // namespace

void find_pairwise(const Model& model, const State& state, const ContactFragments& fragments,
                   RigidPairs& pairs) {
  const auto blocks = static_cast<int>(model.blocks.size());
  const ContactSurface& s = model.surface;
  const bool first = pairs.pose.empty();
  if (first) {
    pairs.pose.resize(model.blocks.size());
    pairs.radius.resize(model.blocks.size(), 0.0);
    pairs.inner_radius.resize(model.blocks.size(), 0.0);
    pairs.planes.resize(model.blocks.size());
  }
  pairs.pairwise.assign(model.blocks.size(), 0);
  std::vector<int> known;
  const auto fragment = [&](int b) { return fragments.of_triangle[s.block_begin[b]]; };
  for (int b = 0; b < blocks; ++b) {
    const Block& block = model.blocks[b];
    pairs.pairwise[b] = static_cast<char>(block.rigid >= 0 && block.convex() && block.meshed &&
                                          !fragments.broken[b] && s.block_begin[b] < s.block_begin[b + 1]);
    if (s.block_begin[b] < s.block_begin[b + 1])
      known.push_back(fragment(b));
  }
  std::sort(known.begin(), known.end());
  for (int b = 0; b < blocks; ++b) {
    if (!pairs.pairwise[b])
      continue;
    const auto [begin, end] = std::equal_range(known.begin(), known.end(), fragment(b));
    pairs.pairwise[b] = static_cast<char>(end - begin == 1); // else its bonds hold others
    if (pairs.radius[b] == 0) {
      pairs.radius[b] = radius_of(model, state, b);
      pairs.inner_radius[b] = inner_radius_of(model, state, b);
      pairs.planes[b] = planes_of(model, state, b);
    }
  }
  set_poses(model, state, pairs);
}

void set_poses(const Model& model, const State& state, RigidPairs& pairs) {
  for (std::size_t i = 0; i < model.rigid.size(); ++i)
    if (pairs.pairwise[model.rigid[i].block])
      pairs.pose[model.rigid[i].block] = {vec(state.rigid[i].centroid), state.rigid[i].rotation};
}

BodyPose seen_from(const BodyPose& a, const BodyPose& b) {
  return {turned_back(a.rotation, b.centre - a.centre), conjugate_times(a.rotation, b.rotation)};
}

double motion_between(const BodyPose& x, const BodyPose& y, double radius) {
  return (x.centre - y.centre).norm() + difference(x.rotation, y.rotation) * radius +
         rounding * (radius + x.centre.norm());
}

RigidPair pair_of(const SurfaceSizes& sizes, const RigidPairs& pairs, int a, int b, double skin) {
  if (pairs.radius[a] < pairs.radius[b])
    std::swap(a, b);
  RigidPair pair;
  pair.a = a;
  pair.b = b;
  pair.radius_b = pairs.radius[b];
  pair.turns = 1 / std::min(pairs.inner_radius[a], pairs.inner_radius[b]);
  pair.skin = skin;
  pair.at = pairs.steps;
  pair.at_search = pair.at_look = seen_from(pairs.pose[a], pairs.pose[b]);
  pair.path_at_search = pair.path_at_look = path_of(pairs, pair);
  pair.threshold = 0.25 * std::min(sizes.shallow[a], sizes.shallow[b]);
  return pair;
}

void update_motion(const RigidPairs& pairs, RigidPair& pair) {
  const BodyPose now = seen_from(pairs.pose[pair.a], pairs.pose[pair.b]);
  const double path = path_of(pairs, pair);
  double since = std::min(path - pair.path_at_look, motion_between(now, pair.at_look, pair.radius_b));
  if (since > pair.threshold) {
    pair.base += since;
    pair.at_look = now;
    pair.path_at_look = path;
    since = 0;
  }
  pair.moved = pair.base + since;
  pair.from = pair.base - since;
}

bool any_left_skin(RigidPairs& pairs) {
  bool left = false;
  for (RigidPair& pair : pairs.all) {
    const double path = path_of(pairs, pair);
    if (path < pair.leaves_at)
      continue;
    const double rest = pair.skin - used_of_skin(pairs, pair);
    left = left || rest <= 0;
    pair.leaves_at = path + std::max(0.0, rest);
  }
  return left;
}

double slack_of(const Model& model, const ContactWork& work, int block) {
  return 4 * gives_of(model, work, block, -1) * model.blocks[block].size;
}

// Those that parted them best are tried first. The others are not, until the two have moved so far that one of them may:
// a guess for the planes of large blocks, which only makes it find less.
double parted_by(const Model& model, const State& state, const ContactWork& work, RigidPair& pair) {
  const std::vector<int>&of_a = work.rigid_pairs.planes[pair.a], &of_b = work.rigid_pairs.planes[pair.b];
  const auto first = static_cast<int>(of_a.size()), count = first + static_cast<int>(of_b.size());
  const double slack = std::max(slack_of(model, work, pair.a), slack_of(model, work, pair.b));
  const auto gap_of = [&](int plane) {
    return (plane < first ? gap_before(model, state, of_a[plane], pair.b)
                          : gap_before(model, state, of_b[plane - first], pair.a)) -
           slack;
  };
  for (const int plane : pair.planes)
    if (plane >= 0)
      if (const double gap = gap_of(plane); gap > 0)
        return gap;
  if (pair.moved < pair.others_until)
    return 0;
  using Gap = std::pair<double, int>;
  std::array<Gap, 5> largest; // the last one: of those that are not kept
  largest.fill({-std::numeric_limits<double>::infinity(), -1});
  for (int plane = 0; plane < count; ++plane) {
    Gap gap(gap_of(plane), plane);
    for (Gap& known : largest)
      if (gap.first > known.first)
        std::swap(gap, known);
  }
  for (std::size_t i = 0; i < pair.planes.size(); ++i)
    pair.planes[i] = largest[i].second;
  pair.others_until = pair.from - largest.back().first;
  return std::max(0.0, largest[0].first);
}

PairsSearched pairs_to_search(const Model& model, const State& state, const ContactWork& work,
                              const SearchMargin& margins, const std::vector<double>& pace,
                              const Pairs* near) {
  PairsSearched found;
  found.now.assign(work.rigid_pairs.all.size(), -1);
  std::int64_t last_search = 0; // in which one of them was searched
  for (const RigidPair& pair : work.rigid_pairs.all)
    last_search = std::max(last_search, pair.at);
  const auto add = [&](int a, int b) {
    const int known = number_of(work.rigid_pairs.all, a, b);
    const RigidPair* const old = known < 0 ? nullptr : &work.rigid_pairs.all[known];
    if (old && !work.search.all_due && !work.options.looks_at_all &&
        may_wait(work, *old, work.rigid_pairs.steps - last_search)) {
      found.now[known] = static_cast<int>(found.pairs.size());
      found.kept = true;
      found.pairs.push_back(*old);
      return;
    }
    int doublings = old ? old->doublings : 0;
    if (old && work.rigid_pairs.steps - old->at < few_steps)
      doublings = std::min(doublings + 1, most_doublings);
    else if (old && work.rigid_pairs.steps - old->at > many_steps)
      doublings = std::max(doublings - 1, 0);
    const double least = thinnest * work.sizes.usual_height * static_cast<double>(1 << doublings);
    const double skin = std::min(std::max(least, steps_ahead * relative_pace(model, state, work, a, b, pace)),
                                 thickest * work.sizes.usual_height);
    // Two blocks that a plane parts have no rows, and need none until they have moved as far as it parts them: edges touch
    // by their fans, which may be by as much as their depth before a plane tells.
    const double depth = std::max(std::min(edge_depth(work.sizes, a), edge_depth(work.sizes, b)),
                                  margins.known(a, b)),
                 apart = distance_apart(model, state, work.rigid_pairs, a, b) - depth -
                         slack_of(model, work, a) - slack_of(model, work, b);
    const bool rows = apart <= skin;
    if (rows)
      found.searched.push_back(static_cast<int>(found.pairs.size()));
    found.pairs.push_back(pair_of(work.sizes, work.rigid_pairs, a, b, rows ? skin : apart));
    found.pairs.back().doublings = rows ? doublings : 0;
  };
  if (near) {
    Pairs sorted;
    for (const auto& [a, b] : *near)
      sorted.push_back(std::minmax(a, b));
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [a, b] : sorted)
      add(a, b);
  } else {
    for (const RigidPair& pair : work.rigid_pairs.all)
      add(std::min(pair.a, pair.b), std::max(pair.a, pair.b));
  }
  return found;
}

void keep_rigid_pairs(ContactWork& before, ContactWork& work) {
  if (before.due || !before.shared->alone() || before.rigid_pairs.all.empty())
    return;
  for (std::size_t kind = 0; kind < work.rows.size(); ++kind) {
    std::vector<ContactRow>& rows = before.rows[kind].all;
    rows.erase(std::remove_if(rows.begin(), rows.end(), [](const ContactRow& row) { return row.pair < 0; }),
               rows.end());
    work.rows[kind].all = std::move(rows);
    work.rows[kind].candidates = std::move(before.rows[kind].candidates);
  }
  work.edges.begin = std::move(before.edges.begin); // of the numbers that rows have
  work.rigid_pairs = std::move(before.rigid_pairs);
}

int number_of(const std::vector<RigidPair>& pairs, int a, int b) {
  RigidPair like;
  like.a = a;
  like.b = b;
  const auto at = std::lower_bound(pairs.begin(), pairs.end(), like, before);
  return at == pairs.end() || before(like, *at) ? -1 : static_cast<int>(at - pairs.begin());
}

} // namespace cdem
