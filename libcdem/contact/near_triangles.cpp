#include "libcdem/contact/near_triangles.hpp"

#include "libcdem/contact/places.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Lists of triangles with more pairs than this go through a grid.
constexpr std::size_t most_pairs_by_hand = 40000;

geom::Box grown(geom::Box box, double by) {
  box.min.array() -= by;
  box.max.array() += by;
  return box;
}

bool beside(const Corners& x, const Corners& plane, double reach) {
  const geom::Vec3 normal = unit_normal(plane);
  const geom::Vec3 height((x[0] - plane[0]).dot(normal), (x[1] - plane[0]).dot(normal),
                          (x[2] - plane[0]).dot(normal));
  return height.minCoeff() > reach || height.maxCoeff() < -reach;
}

// Whether the plane of one of two triangles parts them by more than both margins.
bool parted(const Model& model, const State& state, const Cover& cover, int a, int b) {
  const ContactTriangle &one = model.surface.triangles[a], &other = model.surface.triangles[b];
  const Corners x = corners_of(model, state, one.nodes), y = corners_of(model, state, other.nodes);
  const double reach = cover.margin(one) + cover.margin(other);
  return beside(x, y, reach) || beside(y, x, reach);
}

// take(i, j) for those of two lists of triangles that take part whose boxes meet, those of the first grown.
template <class Take>
void each_overlap(const TakingPart& active, const std::vector<int>& one, double by,
                  const std::vector<int>& other, const Take& take) {
  if (one.size() * other.size() <= most_pairs_by_hand) {
    for (const int i : one) {
      const geom::Box box = grown(active.boxes[i], by);
      for (const int j : other)
        if (!apart(box, active.boxes[j]))
          take(i, j);
    }
    return;
  }
  std::vector<geom::Box> boxes;
  boxes.reserve(one.size() + other.size());
  for (const int i : one)
    boxes.push_back(grown(active.boxes[i], by));
  for (const int j : other)
    boxes.push_back(active.boxes[j]);
  const auto n = static_cast<int>(one.size());
  for (const auto& [i, j] : geom::touching_pairs(boxes))
    if (i < n && j >= n)
      take(one[i], other[j - n]);
}

// Of a block's triangles those whose boxes meet the region; it shrinks to what of it they hold.
std::vector<int> inside(const TakingPart& active, int block, geom::Box& region) {
  std::vector<int> list;
  geom::Box box;
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i)
    if (!apart(active.boxes[i], region)) {
      list.push_back(i);
      box.extend(active.boxes[i].min);
      box.extend(active.boxes[i].max);
    }
  region = {region.min.cwiseMax(box.min), region.max.cwiseMin(box.max)};
  return list;
}

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

} // namespace

NearTriangles near_triangles(const Model& model, const State& state, const ContactWork& work,
                             const Cover& cover, const TakingPart& active, int a, int b) {
  NearTriangles near;
  geom::Box region{active.block_boxes[a].min.cwiseMax(active.block_boxes[b].min),
                   active.block_boxes[a].max.cwiseMin(active.block_boxes[b].max)};
  std::vector<int> one, other;
  for (int round = 0; round < 3; ++round) { // what is left of one leaves less of the other
    one = inside(active, a, region);
    other = inside(active, b, region);
  }
  std::vector<int> of_a, of_b; // that meet
  each_overlap(active, one, 0, other, [&](int i, int j) {
    if (parted(model, state, cover, active.triangles[i], active.triangles[j]))
      return;
    near.meeting.emplace_back(active.triangles[i], active.triangles[j]);
    of_a.push_back(i);
    of_b.push_back(j);
  });
  if (near.meeting.empty())
    return near;
  const double further = 2 * (work.skin[a] + work.skin[b]);
  const auto look = [&](std::vector<int>& sources, int block) {
    sort_unique(sources);
    geom::Box around;
    for (const int i : sources) {
      around.extend(active.boxes[i].min);
      around.extend(active.boxes[i].max);
    }
    around = grown(around, further);
    each_overlap(active, sources, further, inside(active, block, around), [&](int i, int j) {
      near.looked_at.emplace_back(active.triangles[i], active.triangles[j]);
    });
  };
  look(of_a, b);
  look(of_b, a);
  return near;
}

NearTriangles near_triangles_within(const Model& model, const State& state, const ContactWork& work,
                                    const Cover& cover, const TakingPart& active, int block) {
  const ContactSurface& s = model.surface;
  const int begin = active.block_begin[block];
  std::vector<geom::Box> boxes(active.boxes.begin() + begin,
                               active.boxes.begin() + active.block_begin[block + 1]);
  const auto box_at_first = [&](int t) {
    const geom::Triangle& n = s.triangles[t].nodes;
    return box_of({model.node_position[n[0]], model.node_position[n[1]], model.node_position[n[2]]},
                  far_at_first(work, s.triangles[t]));
  };
  const auto strangers = [&](int a, int b) {
    return work.piece[a] != work.piece[b] || apart(box_at_first(a), box_at_first(b));
  };
  NearTriangles near;
  std::vector<char> meets(boxes.size(), 0);
  for (const auto& [i, j] : geom::touching_pairs(boxes)) {
    const int a = active.triangles[begin + i], b = active.triangles[begin + j];
    if (!strangers(a, b) || parted(model, state, cover, a, b))
      continue;
    near.meeting.emplace_back(a, b);
    meets[i] = meets[j] = 1;
  }
  if (near.meeting.empty())
    return near;
  for (geom::Box& box : boxes)
    box = grown(box, 2 * work.skin[block]);
  for (const auto& [i, j] : geom::touching_pairs(boxes, meets)) {
    const int a = active.triangles[begin + i], b = active.triangles[begin + j];
    if (!strangers(a, b))
      continue;
    if (meets[i])
      near.looked_at.emplace_back(a, b);
    if (meets[j])
      near.looked_at.emplace_back(b, a);
  }
  return near;
}

} // namespace cdem
