#include "libcdem/contact/broad_phase/tet_pairs.hpp"

#include "libcdem/contact/data/row_owner.hpp"

#include <algorithm>
#include <limits>

namespace cdem {
namespace {

TetShape shape_of(const Model& model, const std::array<int, 4>& triangles) {
  const ContactSurface& s = model.surface;
  TetShape shape;
  shape.triangles = triangles;
  shape.nodes = model.tets[s.triangles[triangles[0]].tet];
  for (int k = 0; k < 4; ++k) {
    const ContactTriangle& triangle = s.triangles[triangles[k]];
    shape.mates[k] = triangle.mate;
    shape.height = std::max(shape.height, triangle.height);
    for (int corner = 0; corner < 3; ++corner)
      shape.corners[k][corner] = static_cast<std::uint8_t>(
          std::find(shape.nodes.begin(), shape.nodes.end(), triangle.nodes[corner]) - shape.nodes.begin());
  }
  return shape;
}

// One pair and what is known of it, from one list to another.
void add(const TetPairs& from, std::size_t p, TetPairs& to) {
  to.a.push_back(from.a[p]);
  to.b.push_back(from.b[p]);
  to.until.push_back(from.until[p]);
  to.motion.push_back(from.motion[p]);
}

void add_new(int a, int b, bool own, TetPairs& to) {
  to.a.push_back(a);
  to.b.push_back(b);
  to.until.push_back(own ? 0 : std::numeric_limits<float>::infinity());
  to.motion.emplace_back();
}

void take_lists(TetPairs& from, TetPairs& to) {
  to.a = std::move(from.a);
  to.b = std::move(from.b);
  to.until = std::move(from.until);
  to.motion = std::move(from.motion);
}

} // namespace

void renumber_tet_pairs(const std::vector<int>& now_of, ContactWork& work) {
  if (!work.tet_pairs)
    return;
  TetPairs &pairs = *work.tet_pairs, kept;
  for (std::size_t p = 0; p < pairs.count(); ++p) {
    pairs.a[p] = now_of[pairs.a[p]];
    pairs.b[p] = now_of[pairs.b[p]];
    if (pairs.a[p] >= 0 && pairs.b[p] >= 0)
      add(pairs, p, kept);
  }
  take_lists(kept, pairs);
}

void keep_tet_pairs(const Model& model, const std::vector<char>& searched, Pairs& pairs, ContactWork& work) {
  const auto of_tets =
      std::stable_partition(pairs.begin(), pairs.end(), [&](const std::pair<int, int>& pair) {
        return !is_single_tet(model, work, pair.first) || !is_single_tet(model, work, pair.second);
      });
  Pairs found;
  std::copy_if(of_tets, pairs.end(), std::back_inserter(found), [&](const std::pair<int, int>& pair) {
    return searched[pair.first] || searched[pair.second]; // others are known
  });
  if (!std::is_sorted(found.begin(), found.end()))
    std::sort(found.begin(), found.end());
  pairs.erase(of_tets, pairs.end());
  if (!work.tet_pairs && found.empty())
    return;
  if (!work.tet_pairs)
    work.tet_pairs = std::make_shared<TetPairs>();
  TetPairs &before = *work.tet_pairs, now;
  before.shape.assign(work.movers.count(), {});
  const std::array<int, 2> own = own_triangles(work);
  std::vector<char> keeps(work.movers.count(), 0); // this rank a triangle of it
  for (int m = 0; m < work.movers.count(); ++m)
    if (is_single_tet(model, work, m)) {
      before.shape[m] = shape_of(model, work.movers.triangles_of_tet[m]);
      for (const int triangle : before.shape[m].triangles)
        keeps[m] = static_cast<char>(keeps[m] || keeps_tet_triangle(own, triangle));
    }
  const std::size_t most = before.count() + found.size();
  now.a.reserve(most);
  now.b.reserve(most);
  now.until.reserve(most);
  now.motion.reserve(most);
  auto next = found.begin();
  const auto add_found = [&](const std::pair<int, int>& until) {
    for (; next != found.end() && *next < until; ++next)
      add_new(next->first, next->second, keeps[next->first] || keeps[next->second], now);
  };
  for (std::size_t p = 0; p < before.count(); ++p) {
    if (searched[before.a[p]] || searched[before.b[p]])
      continue;
    add_found({before.a[p], before.b[p]});
    add(before, p, now);
  }
  add_found({std::numeric_limits<int>::max(), 0});
  take_lists(now, before);
  before.awake.assign((before.count() + contact_rows_per_chunk - 1) / contact_rows_per_chunk, 0);
  before.movers_awake.clear();
  before.in_awake.assign(work.movers.count(), 0);
  before.now.resize(work.movers.count());
}

void let_tet_pairs_wake(ContactWork& work) {
  if (!work.tet_pairs)
    return;
  for (float& until : work.tet_pairs->until)
    if (until < std::numeric_limits<float>::infinity())
      until = 0;
  for (PairMotion& motion : work.tet_pairs->motion)
    motion.allowed = 0;
}

std::array<int, 2> own_triangles(const ContactWork& work) {
  if (!work.shared)
    return {0, std::numeric_limits<int>::max()};
  const auto rank = static_cast<std::size_t>(work.shared->part().rank);
  return {static_cast<int>(work.triangle_begin[rank]), static_cast<int>(work.triangle_begin[rank + 1])};
}

} // namespace cdem
