#include "libcdem/contact/broad_phase/near_triangles.hpp"

#include "libcdem/contact/broad_phase/box_lists.hpp"
#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>

namespace cdem {
namespace {

bool beside(const Corners& x, const Facet& plane, double reach) {
  const geom::Vec3 &foot = plane.x[0], &normal = plane.normal;
  const geom::Vec3 height((x[0] - foot).dot(normal), (x[1] - foot).dot(normal), (x[2] - foot).dot(normal));
  return height.minCoeff() > reach || height.maxCoeff() < -reach;
}

// Whether the plane of one of two triangles parts them by more than both margins.
bool parted(const SearchMargin& margins, const ActiveSurface& active, int i, int j) {
  const auto margin = [&](int k) { return margins.margin(active.triangles[k]); };
  const Facet &one = active.facets[i], &other = active.facets[j];
  const double reach = margin(i) + margin(j);
  return beside(one.x, other, reach) || beside(other.x, one, reach);
}

// Triangles of a block whose boxes, grown by `by`, meet the region. The region shrinks to the part that these boxes cover.
std::vector<int> inside(const ActiveSurface& active, int block, double by, geom::Box& region) {
  std::vector<int> list;
  geom::Box box;
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i)
    if (const geom::Box own = grown(active.boxes[i], by); !apart(own, region)) {
      list.push_back(i);
      box.extend(own.min);
      box.extend(own.max);
    }
  region = {region.min.cwiseMax(box.min), region.max.cwiseMin(box.max)};
  return list;
}

std::vector<geom::Box> boxes_of(const ActiveSurface& active, const std::vector<int>& places, double by = 0) {
  std::vector<geom::Box> boxes;
  boxes.reserve(places.size());
  for (const int i : places)
    boxes.push_back(grown(active.boxes[i], by));
  return boxes;
}

// Triangles of one block. Most fragments are a few tetrahedra, and most sources are outside of their outlines: those are asked
// for first.
struct TargetsByFragment {
  std::vector<int> of_large,
      of_small; // of whole blocks and large fragments, and of others, fragment by fragment
  std::vector<int> small, begin{0};      // the small fragments, and where theirs begin; the last is the end
  std::vector<geom::Box> small_outlines; // of each
};

TargetsByFragment by_fragment(const ContactWork& work, const ActiveSurface& active,
                              std::vector<int> targets) {
  constexpr std::ptrdiff_t few = 32;
  const auto fragment = [&](int target) {
    return work.fragments.number_of_triangle[active.triangles[target]];
  };
  std::stable_sort(targets.begin(), targets.end(), [&](int a, int b) { return fragment(a) < fragment(b); });
  TargetsByFragment sorted;
  for (auto first = targets.begin(), last = first; first != targets.end(); first = last) {
    const int here = fragment(*first);
    last = std::find_if(first, targets.end(), [&](int target) { return fragment(target) != here; });
    if (here < 0 || last - first > few) {
      sorted.of_large.insert(sorted.of_large.end(), first, last);
      continue;
    }
    sorted.of_small.insert(sorted.of_small.end(), first, last);
    sorted.small.push_back(here);
    sorted.begin.push_back(static_cast<int>(sorted.of_small.size()));
    sorted.small_outlines.push_back(active.fragment_outlines[here]);
  }
  return sorted;
}

// Those of one block's triangles that may get into another block, with what of it is near them.
void look(const Model& model, const ContactWork& work, const ActiveSurface& active,
          const std::vector<int>& of_one, int one, int other, const Skins& skins, Pairs& pairs) {
  const double by_one = skins.beyond_own(one), by_other = skins.beyond_own(other);
  std::vector<int> sources;
  std::vector<Corners> springs;
  geom::Box around;
  for (const int i : of_one) {
    Corners spring;
    bool gets_in = false;
    for (int corner = 0; corner < 3; ++corner) {
      spring[corner] = weighted(active.facets[i].x, spring_weights(corner));
      gets_in = gets_in || may_get_into(model, work, active, spring[corner], one, other, skins);
    }
    if (!gets_in)
      continue;
    sources.push_back(i);
    springs.push_back(spring);
    const geom::Box box = grown(active.boxes[i], by_one);
    around.extend(box.min);
    around.extend(box.max);
  }
  if (sources.empty())
    return;
  const double both = skins.between(one, other), further = 2 * both;
  around = grown(around, further);
  const std::vector<geom::Box> source_boxes = boxes_of(active, sources, by_one);
  const auto may_hold = [&](int fragment, std::size_t i) { // the source's springs
    return std::any_of(springs[i].begin(), springs[i].end(),
                       [&](const geom::Vec3& spring) { return active.in_outline(fragment, spring, both); });
  };
  const TargetsByFragment targets = by_fragment(work, active, inside(active, other, by_other, around));
  each_meeting(source_boxes, further, boxes_of(active, targets.of_large, by_other),
               [&](std::size_t i, std::size_t j) {
                 const int target = targets.of_large[j];
                 if (may_hold(work.fragments.number_of_triangle[active.triangles[target]], i))
                   pairs.emplace_back(sources[i], target);
               });
  each_meeting(source_boxes, both, targets.small_outlines, [&](std::size_t i, std::size_t k) {
    if (!may_hold(targets.small[k], i))
      return;
    const geom::Box box = grown(source_boxes[i], further);
    for (int j = targets.begin[k]; j < targets.begin[k + 1]; ++j)
      if (!apart(box, grown(active.boxes[targets.of_small[j]], by_other)))
        pairs.emplace_back(sources[i], targets.of_small[j]);
  });
}

} // namespace

SharedPart shared_part(const ActiveSurface& active, int a, int b, const Skins& skins) {
  SharedPart part;
  part.block_a = a;
  part.block_b = b;
  const double by_a = skins.beyond_own(a), by_b = skins.beyond_own(b);
  const geom::Box one = grown(active.block_boxes[a], by_a), other = grown(active.block_boxes[b], by_b);
  geom::Box region{one.min.cwiseMax(other.min), one.max.cwiseMin(other.max)};
  for (int round = 0; round < 3; ++round) { // what is left of one leaves less of the other
    part.of_a = inside(active, a, by_a, region);
    part.of_b = inside(active, b, by_b, region);
  }
  return part;
}

Pairs meeting(const SearchMargin& margins, const ActiveSurface& active, const SharedPart& part) {
  Pairs pairs;
  each_meeting(boxes_of(active, part.of_a), 0, boxes_of(active, part.of_b),
               [&](std::size_t i, std::size_t j) {
                 if (!parted(margins, active, part.of_a[i], part.of_b[j]))
                   pairs.emplace_back(part.of_a[i], part.of_b[j]);
               });
  return pairs;
}

Pairs looked_at(const Model& model, const ContactWork& work, const ActiveSurface& active,
                const SharedPart& part, const Skins& skins) {
  Pairs pairs;
  look(model, work, active, part.of_a, part.block_a, part.block_b, skins, pairs);
  look(model, work, active, part.of_b, part.block_b, part.block_a, skins, pairs);
  return pairs;
}

bool may_get_into(const Model& model, const ContactWork& work, const ActiveSurface& active,
                  const geom::Vec3& x, int source_block, int block, const Skins& skins) {
  const double both = skins.between(source_block, block);
  if (!active.outlines[block].contains(x, both))
    return false;
  if (!skins.of_pair())
    return true;
  const double far = both + slack_of(model, work, block);
  for (const int t : work.rigid_pairs.planes[block]) {
    const Facet& plane = active.facets[active.place[t]];
    if ((x - plane.x[0]).dot(plane.normal) > far)
      return false;
  }
  return true;
}

namespace {

geom::Box box_at_first(const Model& model, const SurfaceSizes& sizes, int t) {
  const ContactTriangle& triangle = model.surface.triangles[t];
  const geom::Triangle& n = triangle.nodes;
  return box_of({model.node_position[n[0]], model.node_position[n[1]], model.node_position[n[2]]},
                far_at_first(sizes, triangle));
}

// Whether two triangles of what hangs together were so far from each other at first that they may meet.
bool apart_at_first(const Model& model, const SurfaceSizes& sizes, int triangle_a, int triangle_b) {
  return apart(box_at_first(model, sizes, triangle_a), box_at_first(model, sizes, triangle_b));
}

} // namespace

NearWithin near_within(const Model& model, const ContactWork& work, const SearchMargin& margins,
                       const ActiveSurface& active, int block) {
  const int begin = active.block_begin[block];
  std::vector<geom::Box> boxes(active.boxes.begin() + begin,
                               active.boxes.begin() + active.block_begin[block + 1]);
  const auto strangers = [&](int i, int j) { // by their boxes
    const int a = active.triangles[begin + i], b = active.triangles[begin + j];
    return work.fragments.of_triangle[a] != work.fragments.of_triangle[b] ||
           apart_at_first(model, work.sizes, a, b);
  };
  NearWithin near;
  std::vector<char> meets(boxes.size(), 0);
  const auto may_meet = [&](int i, int j) {
    return strangers(i, j) && !parted(margins, active, begin + i, begin + j);
  };
  for (const auto& [i, j] : geom::touching_pairs(boxes, {}, may_meet)) {
    near.meeting.emplace_back(begin + i, begin + j);
    meets[i] = meets[j] = 1;
  }
  if (near.meeting.empty())
    return near;
  for (geom::Box& box : boxes)
    box = grown(box, 2 * work.travel.skin[block]);
  for (const auto& [i, j] : geom::touching_pairs(boxes, meets, strangers)) {
    const int a = begin + i, b = begin + j;
    if (meets[i])
      near.looked_at.emplace_back(a, b);
    if (meets[j])
      near.looked_at.emplace_back(b, a);
  }
  return near;
}

} // namespace cdem
