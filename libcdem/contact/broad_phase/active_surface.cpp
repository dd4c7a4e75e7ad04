#include "libcdem/contact/broad_phase/active_surface.hpp"

#include "libcdem/contact/broad_phase/block_travel.hpp"
#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Thinnest and thickest_skin skin of a block, over the usual height of a tet at the surface.
constexpr double thinnest_skin = 0.001, thickest_skin = 0.1;
// Steps that a block can go on at its pace before it leaves its skin, and what of the fastest block's pace the others
// are trusted to get to.
constexpr double skin_steps = 250, pace_of_others = 0.25;
// Searches that follow each other within fewer steps than this make skins twice as thick, those after more halve them.
constexpr std::int64_t early = 50, late = 150;
constexpr int most_widenings = 6;
// Pairs of boxes that may be compared to find how far off the others are.
constexpr std::size_t most_boxes_compared = 4000000;
double gap(const geom::Box& a, const geom::Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).maxCoeff();
}

// m, of blocks whose pace is greater, a quarter of what parts their boxes from all others: their boxes with three skins
// around them then meet none. 0 for the others, and for further ones when there are very many.
std::vector<double> clearance_of_fast_bodies(const Model& model, const State& state,
                                             const std::vector<double>& paces, double pace) {
  const ContactSurface& s = model.surface;
  std::vector<double> clearance(model.blocks.size(), 0.0);
  std::vector<int> fast;
  for (int b = 0; b < static_cast<int>(clearance.size()); ++b)
    if (paces[b] > pace)
      fast.push_back(b);
  fast.resize(std::min(fast.size(), most_boxes_compared / clearance.size()));
  if (fast.empty())
    return clearance;
  std::vector<geom::Box> boxes(clearance.size());
  for (const ContactTriangle& t : s.triangles)
    for (const int node : t.nodes)
      boxes[t.block].extend(place_of(model, state, node));
  for (const int b : fast) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int other = 0; other < static_cast<int>(boxes.size()); ++other)
      if (other != b)
        nearest = std::min(nearest, gap(boxes[b], boxes[other]));
    clearance[b] = std::max(0.0, 0.25 * nearest);
  }
  return clearance;
}

// m, height of a tet at the surface of its block.
double usual(const SurfaceSizes& sizes, const ContactTriangle& t) {
  return sizes.shallow[t.block] / shallow_ratio;
}

// pace: m in a step, per block.
void choose_skins_of_blocks(const Model& model, const State& state, const std::vector<double>& pace,
                            ContactWork& work) {
  Searches& search = work.search;
  BlockTravel& travel = work.travel;
  const auto blocks = static_cast<int>(model.blocks.size());
  const double most = thickest_skin * work.sizes.usual_height;
  bool too_thin = false;
  for (int b = 0; b < blocks; ++b)
    too_thin = too_thin || (travel.travelled[b] > travel.skin[b] && travel.skin[b] < most);
  if (search.count > 0 && search.steps_since < early && too_thin)
    search.skin_doublings = std::min(search.skin_doublings + 1, most_widenings);
  else if (search.steps_since > late)
    search.skin_doublings = std::max(search.skin_doublings - 1, 0);
  const std::vector<double> alone = clearance_of_fast_bodies(model, state, pace, most / skin_steps);
  double fastest = 0;
  for (int b = 0; b < blocks; ++b)
    if (alone[b] <= most)
      fastest = std::max(fastest, pace[b]);
  const double least =
      std::max(thinnest_skin * work.sizes.usual_height, pace_of_others * skin_steps * fastest) *
      static_cast<double>(1 << search.skin_doublings);
  for (int b = 0; b < blocks; ++b)
    travel.skin[b] = std::min(std::max(least, skin_steps * pace[b]), std::max(most, alone[b]));
}

} // namespace

std::vector<double> choose_skins(const Model& model, const State& state, ContactWork& work, bool all) {
  std::vector<double> pace = speeds_of_blocks(model, state, work, 1); // m/s, then m in a step
  for (double& of_block : pace)
    of_block *= work.travel.last_step;
  if (all)
    choose_skins_of_blocks(model, state, pace, work);
  return pace;
}

double depth_of(const SurfaceSizes& sizes, const ContactTriangle& t) {
  return depth_ratio * std::min(t.height, usual(sizes, t));
}

double far_at_first(const SurfaceSizes& sizes, const ContactTriangle& t) {
  return depth_of(sizes, t) + thickest_skin * usual(sizes, t);
}

SearchMargin::SearchMargin(const Model& model, const State& state, const ContactWork& work)
    : surface_(model.surface), work_(work), whole_(work.fragments.broken), deepest_(model.blocks.size(), 0.0),
      at_least_(model.blocks.size()) {
  if (!work.search.history_complete)
    std::fill(whole_.begin(), whole_.end(), 1);
  for (const Contact& c : state.contacts) {
    if (c.kind == Contact::tets) // found by lists of their own
      continue;
    const auto [a, b] = blocks_of(model, c);
    deepest_[a] = std::max(deepest_[a], c.depth);
    deepest_[b] = std::max(deepest_[b], c.depth);
  }
  for (std::size_t b = 0; b < at_least_.size(); ++b)
    at_least_[b] = std::max({deepest_[b], 0.5 * edge_depth(work.sizes, static_cast<int>(b)),
                             0.5 * meeting_ratio * model.blocks[b].size});
}

bool ActiveSurface::finite() const {
  return std::all_of(boxes.begin(), boxes.end(),
                     [](const geom::Box& box) { return box.min.allFinite() && box.max.allFinite(); });
}

ActiveSurface active_surface(const Model& model, const State& state, const ContactFragments& fragments,
                             const SearchMargin& margins, int threads) {
  const ContactSurface& s = model.surface;
  ActiveSurface part;
  part.block_begin.push_back(0);
  part.place.assign(s.triangles.size(), -1);
  for (std::size_t b = 0; b + 1 < s.block_begin.size(); ++b) {
    for (int t = s.block_begin[b]; t < s.block_begin[b + 1]; ++t)
      if (fragments.active[t]) {
        part.place[t] = static_cast<int>(part.triangles.size());
        part.triangles.push_back(t);
      }
    part.block_begin.push_back(static_cast<int>(part.triangles.size()));
  }
  part.facets.resize(part.triangles.size());
  part.boxes.resize(part.triangles.size());
  part.block_boxes.resize(part.block_begin.size() - 1);
  part.outlines.resize(part.block_boxes.size());
  for_chunks(static_cast<std::int64_t>(part.block_boxes.size()), threads, [&](std::int64_t b) {
    for (int i = part.block_begin[b]; i < part.block_begin[b + 1]; ++i) {
      const ContactTriangle& triangle = s.triangles[part.triangles[i]];
      Facet& facet = part.facets[i];
      facet.x = corners_of(model, state, triangle.nodes);
      facet.normal = unit_normal(facet.x);
      part.boxes[i] = box_of(facet.x, margins.margin(part.triangles[i]));
      part.block_boxes[b].extend(part.boxes[i].min);
      part.block_boxes[b].extend(part.boxes[i].max);
      for (const geom::Vec3& corner : facet.x)
        part.outlines[b].extend(corner);
    }
  });
  part.fragment_outlines.resize(fragments.one_piece.size());
  for (std::size_t i = 0; i < part.triangles.size(); ++i)
    if (const int fragment = fragments.number_of_triangle[part.triangles[i]]; fragment >= 0)
      for (const geom::Vec3& corner : part.facets[i].x)
        part.fragment_outlines[fragment].extend(corner);
  return part;
}

} // namespace cdem
