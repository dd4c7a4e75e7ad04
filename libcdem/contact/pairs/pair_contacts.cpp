#include "libcdem/contact/pairs/pair_contacts.hpp"

#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/pairs/pair_law.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/ranks/shared_state.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using geom::Vec3;

// Skin of a tetrahedron: so much of its size, or the way of so many steps, up to so much of the usual size.
constexpr double thin_skin = 0.05, steps_of_skin = 300, thickest_skin_of_tet = 0.25;
// Steps that an inner list is made for, and how much faster than now a tetrahedron may get until it is made anew.
constexpr double steps_of_inner = 20, faster = 1.3;
// Rings of tetrahedra around split nodes in which pairs that hang together are listed.
constexpr int rings = 3;
// Part of the distance phi from zero up to which motion of the corners cannot bring it there, and the part of a
// tetrahedron's size up to which that holds: a plane tilts as its corners move.
constexpr double part_of_phi = 0.4, part_of_size = 0.05;
constexpr float rounding = 1e-6F;
constexpr double least_jump = 5e-5; // of a depth in a step, over the size of a tetrahedron
constexpr std::int64_t tets_per_chunk = 512, pairs_per_chunk = 256;

// With several ranks, the one that computes a pair.
bool is_own(const ContactWork& work, int tet_a) {
  return !work.shared ||
         Partition::owner(work.shared->shares().tet_begin(), tet_a) == work.shared->part().rank;
}

// f(first, count, chunk) for the pairs of a list, some at a time.
template <class F>
void each_part(std::size_t count, int threads, const F& f) {
  const auto n = static_cast<std::int64_t>(count);
  for_chunks((n + pairs_per_chunk - 1) / pairs_per_chunk, threads, [&](std::int64_t chunk) {
    const std::int64_t first = chunk * pairs_per_chunk;
    f(first, std::min(pairs_per_chunk, n - first));
  });
}

PairsOfTets listed(const PairContacts& pairs, const std::vector<std::int32_t>& rows, std::int64_t first,
                   std::int64_t count) {
  return {pairs.place.data(), pairs.a.data(), pairs.b.data(), pairs.open.data(), rows.data() + first, count};
}

std::vector<double> gaps_of(const PairContacts& pairs, const std::vector<std::int32_t>& rows, int threads) {
  std::vector<double> gap(rows.size());
  each_part(rows.size(), threads, [&](std::int64_t first, std::int64_t count) {
    parted_by_planes(listed(pairs, rows, first, count), gap.data() + first);
  });
  return gap;
}

std::vector<double> depths_of(const PairContacts& pairs, const std::vector<std::int32_t>& rows,
                              const std::vector<double>& offset, int threads) {
  std::vector<double> phi(rows.size());
  each_part(rows.size(), threads, [&](std::int64_t first, std::int64_t count) {
    deepest_in_each_other(listed(pairs, rows, first, count), offset.data() + first, phi.data() + first);
  });
  return phi;
}

double offset_of(const PairContacts& pairs, std::int32_t row) {
  if (pairs.entry[row] >= 0)
    return pairs.known[pairs.entry[row]].offset;
  return first_offset(pairs, row);
}

float paths(const PairContacts& pairs, std::int32_t row) {
  return pairs.path[pairs.a[row]] + pairs.path[pairs.b[row]];
}

// It touches nothing until both have gone so far, m.
void sleep(PairContacts& pairs, std::int32_t row, double distance) {
  const float gone = paths(pairs, row);
  pairs.wake[row] = gone + rounded_down(0.999 * distance) - rounding * gone;
}

// What was known of it counts no more.
void wake_now(PairContacts& pairs, std::int32_t row) {
  pairs.inner_due = pairs.inner_due || pairs.wake[row] > paths(pairs, row);
  pairs.wake[row] = 0;
}

bool free_to_touch(const PairContacts& pairs, int tet_a, int tet_b) {
  return pairs.joints.open_planes(tet_a) != 0 && pairs.joints.open_planes(tet_b) != 0 &&
         pairs.joints.may_touch(tet_a, tet_b);
}

std::vector<char> paired_blocks(const Model& model, const ContactWork& work) {
  std::vector<char> paired(model.blocks.size(), 0);
  for (int b = 0; b < static_cast<int>(paired.size()); ++b)
    paired[b] = static_cast<char>(pairs_within(model, work, b));
  return paired;
}

// Marks nodes of the undeformed mesh, and those of tetrahedra around them, so many times.
void spread(const PairContacts& pairs, const std::vector<int>& tets, int times, std::vector<char>& marked) {
  for (int ring = 0; ring < times; ++ring) {
    std::vector<char> more = marked;
    for (const int tet : tets) {
      bool any = false;
      for (int k = 0; k < 4; ++k)
        any = any || marked[pairs.joints.node(tet, k)];
      for (int k = 0; any && k < 4; ++k)
        more[pairs.joints.node(tet, k)] = 1;
    }
    marked = std::move(more);
  }
}

void set_shapes(const Model& model, PairContacts& pairs) {
  const std::size_t count = pairs.tets.size();
  pairs.node.resize(4 * count);
  pairs.undeformed.resize(4 * count);
  pairs.place.resize(4 * count);
  pairs.velocity.resize(4 * count);
  for (std::vector<double>* array : {&pairs.size, &pairs.area, &pairs.compliance, &pairs.mass})
    array->resize(count);
  pairs.open.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const geom::Tet& tet = model.tets[pairs.tets[i]];
    for (int k = 0; k < 4; ++k) {
      pairs.node[4 * i + k] = tet[k];
      pairs.undeformed[4 * i + k] = node(model.node_position[tet[k]]);
    }
    const TetSize size = size_of(model, pairs.tets[i]);
    pairs.open[i] = pairs.joints.open_planes(pairs.tets[i]);
    pairs.size[i] = size.height;
    pairs.area[i] = size.area;
    pairs.compliance[i] = size.compliance;
    pairs.mass[i] = size.mass;
  }
}

void set_places(const State& state, PairContacts& pairs, int threads) {
  const auto n = static_cast<std::int64_t>(pairs.place.size());
  for_chunks((n + tets_per_chunk - 1) / tets_per_chunk, threads, [&](std::int64_t chunk) {
    for (std::int64_t i = chunk * tets_per_chunk; i < std::min(n, (chunk + 1) * tets_per_chunk); ++i) {
      const Node &x = pairs.undeformed[i], &u = state.displacement[pairs.node[i]];
      pairs.place[i] = {x.x + u.x, x.y + u.y, x.z + u.z, 0};
    }
  });
}

// A contact of this rank; those of a body that keeps its shape or is whole are over.
bool counts(const Model& model, const ContactWork& work, const PairContacts& pairs, const TetContact& c) {
  return pairs.paired[model.tet_block[c.a]] && is_own(work, c.a);
}

// Tetrahedra of the lists: at the outside or a crack, around cracks, and those that have contacts.
void choose_tets(const Model& model, const State& state, PairContacts& pairs) {
  std::vector<char> touches(model.tets.size() - static_cast<std::size_t>(model.mesh.first_tet), 0);
  for (const TetContact& c : state.tet_contacts)
    touches[c.a - model.mesh.first_tet] = touches[c.b - model.mesh.first_tet] = 1;
  std::vector<int> all;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
    for (int tet = model.blocks[b].tet_begin; pairs.paired[b] && tet < model.blocks[b].tet_end; ++tet)
      all.push_back(tet);
  std::vector<char> around(static_cast<std::size_t>(pairs.joints.nodes()), 0);
  for (int n = 0; n < pairs.joints.nodes(); ++n)
    around[n] = static_cast<char>(pairs.joints.is_split(n));
  spread(pairs, all, rings, around);
  pairs.tets.clear();
  pairs.around_cracks.clear();
  pairs.number.assign(model.tets.size() - static_cast<std::size_t>(model.mesh.first_tet), -1);
  for (const int tet : all) {
    bool outside = false, near = false;
    for (int k = 0; k < 4; ++k) {
      const int node = pairs.joints.node(tet, k);
      outside = outside || pairs.joints.is_outside(node);
      near = near || around[node];
    }
    if (!outside && !near && !touches[tet - model.mesh.first_tet])
      continue;
    pairs.number[tet - model.mesh.first_tet] = static_cast<int>(pairs.tets.size());
    pairs.tets.push_back(tet);
    pairs.around_cracks.push_back(static_cast<char>(near));
  }
}

void choose_skins_of_tets(PairContacts& pairs) {
  if (pairs.tets.empty())
    return;
  std::vector<double> sizes = pairs.size;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  const double most = thickest_skin_of_tet * sizes[sizes.size() / 2];
  pairs.skin.resize(pairs.tets.size());
  for (std::size_t i = 0; i < pairs.tets.size(); ++i)
    pairs.skin[i] = static_cast<float>(
        std::max(thin_skin * pairs.size[i], std::min(steps_of_skin * pairs.step_path[i], most)));
}

// Boxes of tetrahedra with their skins; pairs that meet, of one block.
std::vector<std::pair<int, int>> meeting_pairs(const Model& model, const PairContacts& pairs) {
  std::vector<std::pair<int, int>> all;
  std::size_t first = 0;
  while (first < pairs.tets.size()) {
    const int block = model.tet_block[pairs.tets[first]];
    std::vector<geom::Box> boxes;
    std::size_t end = first;
    for (; end < pairs.tets.size() && model.tet_block[pairs.tets[end]] == block; ++end) {
      geom::Box box;
      for (int k = 0; k < 4; ++k)
        box.extend(vec(pairs.place[4 * end + k]));
      boxes.push_back(grown(box, pairs.skin[end]));
    }
    for (const auto& [i, k] : geom::touching_pairs(boxes))
      all.emplace_back(static_cast<int>(first) + i, static_cast<int>(first) + k);
    first = end;
  }
  return all;
}

void list_pairs(const Model& model, const State& state, ContactWork& work, PairContacts& pairs, int threads) {
  std::vector<std::int32_t> a, b, rows;
  std::vector<std::uint8_t> apart, in_place;
  const auto add = [&](int i, int k, bool may_touch, bool still) {
    a.push_back(i);
    b.push_back(k);
    apart.push_back(static_cast<std::uint8_t>(may_touch));
    in_place.push_back(static_cast<std::uint8_t>(still));
  };
  for (const auto& [i, k] : meeting_pairs(model, pairs)) {
    const int tet_a = pairs.tets[i], tet_b = pairs.tets[k];
    if (!is_own(work, tet_a))
      continue;
    const bool may_touch = free_to_touch(pairs, tet_a, tet_b);
    if (may_touch || (pairs.around_cracks[i] && pairs.around_cracks[k]))
      add(i, k, may_touch, pairs.joints.in_place(tet_a, tet_b));
  }
  pairs.a = std::move(a);
  pairs.b = std::move(b);
  rows.resize(pairs.a.size());
  std::iota(rows.begin(), rows.end(), 0);
  const std::vector<double> gap = gaps_of(pairs, rows, threads);
  // Contacts that are known stay, wherever they are.
  std::vector<std::pair<int, int>> known;
  for (const TetContact& c : state.tet_contacts)
    if (counts(model, work, pairs, c))
      known.emplace_back(pairs.number[c.a - model.mesh.first_tet], pairs.number[c.b - model.mesh.first_tet]);
  std::size_t next = 0;
  std::vector<float> wake;
  std::vector<std::uint8_t> apart_all, in_place_all;
  a.clear();
  b.clear();
  apart_all.swap(apart);
  in_place_all.swap(in_place);
  const auto add_known = [&](const std::pair<int, int>& until) {
    for (; next < known.size() && known[next] < until; ++next) {
      const int tet_a = pairs.tets[known[next].first], tet_b = pairs.tets[known[next].second];
      add(known[next].first, known[next].second, free_to_touch(pairs, tet_a, tet_b),
          pairs.joints.in_place(tet_a, tet_b));
      wake.push_back(0);
    }
  };
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::pair<int, int> here(pairs.a[r], pairs.b[r]);
    add_known(here);
    const bool is_known = next < known.size() && known[next] == here;
    next += is_known ? 1 : 0;
    if (!is_known && !(gap[r] < pairs.skin[here.first] + pairs.skin[here.second]))
      continue;
    add(here.first, here.second, apart_all[r] != 0, in_place_all[r] != 0);
    wake.push_back(rounded_down(0.999 * std::max(0.0, gap[r])));
  }
  add_known({std::numeric_limits<int>::max(), 0});
  pairs.a = std::move(a);
  pairs.b = std::move(b);
  pairs.wake = std::move(wake);
  pairs.apart = std::move(apart);
  pairs.in_place = std::move(in_place);
  pairs.entry.assign(pairs.a.size(), -1);
  pairs.known.clear();
  pairs.known_row.clear();
  pairs.path.assign(pairs.tets.size(), 0);
  pairs.outer_due = false;
  pairs.inner_due = true;
}

// Tetrahedra whose surroundings have changed: who of them may touch. False: some are not in the list.
bool refresh(const Model& model, const std::vector<int>& changed, PairContacts& pairs) {
  std::vector<char> is_changed(pairs.tets.size(), 0);
  for (const int tet : changed) {
    const int i = pairs.number[tet - model.mesh.first_tet];
    if (i < 0 || !pairs.around_cracks[i])
      return false;
    is_changed[i] = 1;
    pairs.open[i] = pairs.joints.open_planes(tet);
  }
  for (std::size_t r = 0; r < pairs.a.size(); ++r) {
    if (!is_changed[pairs.a[r]] && !is_changed[pairs.b[r]])
      continue;
    const int tet_a = pairs.tets[pairs.a[r]], tet_b = pairs.tets[pairs.b[r]];
    const auto apart = static_cast<std::uint8_t>(free_to_touch(pairs, tet_a, tet_b)),
               in_place = static_cast<std::uint8_t>(pairs.joints.in_place(tet_a, tet_b));
    if (apart == pairs.apart[r] && in_place == pairs.in_place[r])
      continue;
    pairs.apart[r] = apart;
    pairs.in_place[r] = in_place;
    pairs.wake[r] = 0;
    pairs.inner_due = true;
  }
  return true;
}

// Pairs that may wake before some tetrahedron has gone further than it will in the next steps.
void choose_inner(const ContactWork& work, PairContacts& pairs) {
  const std::size_t count = pairs.tets.size();
  double mean = 0;
  for (const float path : pairs.step_path)
    mean += path / static_cast<double>(count);
  pairs.until.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    pairs.until[i] = pairs.path[i] +
                     static_cast<float>(faster * steps_of_inner * std::max<double>(pairs.step_path[i], mean));
  pairs.inner.resize(pairs.a.size());
  std::size_t n = 0;
  for (std::size_t r = 0; r < pairs.a.size(); ++r) {
    pairs.inner[n] = static_cast<std::int32_t>(r);
    n += static_cast<std::size_t>(
        pairs.apart[r] != 0 &&
        (work.looks_at_all || pairs.wake[r] <= pairs.until[pairs.a[r]] + pairs.until[pairs.b[r]]));
  }
  pairs.inner.resize(n);
  pairs.inner_due = false;
}

// Those of this rank, with their pairs.
void take_known(const Model& model, const State& state, const ContactWork& work, PairContacts& pairs) {
  for (const std::int32_t row : pairs.known_row)
    pairs.entry[row] = -1;
  const std::vector<std::int32_t> hint = std::move(pairs.known_row);
  pairs.known.clear();
  pairs.known_row.clear();
  std::size_t next = 0;
  for (const TetContact& c : state.tet_contacts) {
    if (!counts(model, work, pairs, c))
      continue;
    const int a = pairs.number[c.a - model.mesh.first_tet], b = pairs.number[c.b - model.mesh.first_tet];
    const auto is_row = [&](std::int32_t row) { return pairs.a[row] == a && pairs.b[row] == b; };
    while (next < hint.size() &&
           (pairs.a[hint[next]] < a || (pairs.a[hint[next]] == a && pairs.b[hint[next]] < b)))
      ++next;
    std::int32_t row = next < hint.size() && is_row(hint[next]) ? hint[next] : -1;
    if (row < 0) {
      auto begin = std::lower_bound(pairs.a.begin(), pairs.a.end(), a) - pairs.a.begin();
      const auto end = std::upper_bound(pairs.a.begin(), pairs.a.end(), a) - pairs.a.begin();
      row = static_cast<std::int32_t>(std::lower_bound(pairs.b.begin() + begin, pairs.b.begin() + end, b) -
                                      pairs.b.begin());
    }
    pairs.entry[row] = static_cast<std::int32_t>(pairs.known.size());
    pairs.known.push_back(c);
    pairs.known_row.push_back(row);
  }
}

void set_velocities(const State& state, const std::vector<std::int32_t>& rows, PairContacts& pairs) {
  for (const std::int32_t row : rows)
    for (const std::int32_t tet : {pairs.a[row], pairs.b[row]})
      for (int k = 0; k < 4; ++k)
        pairs.velocity[4 * tet + k] = state.velocity[pairs.node[4 * tet + k]];
}

// m, at most, by which the two came nearer to each other in the step.
double motion_in_step(const State& state, const PairContacts& pairs, std::int32_t row, double step) {
  Vec3 mean = Vec3::Zero();
  const std::array<std::int32_t, 2> both{pairs.a[row], pairs.b[row]};
  for (const std::int32_t tet : both)
    for (int k = 0; k < 4; ++k)
      mean += vec(state.velocity[pairs.node[4 * tet + k]]) / 8;
  double sum = 0;
  for (const std::int32_t tet : both) {
    double most = 0;
    for (int k = 0; k < 4; ++k)
      most = std::max(most, (vec(state.velocity[pairs.node[4 * tet + k]]) - mean).norm());
    sum += most;
  }
  return step * sum;
}

} // namespace

bool advance_pairs(const State& state, ContactWork& work, int threads) {
  if (!work.pairs)
    return false; // a search finds that a body has broken
  PairContacts& pairs = *work.pairs;
  const auto n = static_cast<std::int64_t>(pairs.tets.size());
  const std::int64_t chunks = (n + tets_per_chunk - 1) / tets_per_chunk;
  struct Gone {
    Vec3 sum = Vec3::Zero();
    bool outer = false, inner = false;
  };
  std::vector<Gone> gone(static_cast<std::size_t>(chunks));
  for_chunks(chunks, threads, [&](std::int64_t chunk) {
    Gone& here = gone[chunk];
    for (std::int64_t i = chunk * tets_per_chunk; i < std::min(n, (chunk + 1) * tets_per_chunk); ++i) {
      double furthest2 = 0;
      Vec3 sum = Vec3::Zero();
      for (int k = 0; k < 4; ++k) {
        const Node &x = pairs.undeformed[4 * i + k], &u = state.displacement[pairs.node[4 * i + k]];
        Node& place = pairs.place[4 * i + k];
        const Node now{x.x + u.x, x.y + u.y, x.z + u.z, 0};
        const Vec3 moved(now.x - place.x, now.y - place.y, now.z - place.z);
        sum += moved;
        furthest2 = std::max(furthest2, (moved - pairs.shift).squaredNorm());
        place = now;
      }
      here.sum += sum;
      const float way = static_cast<float>(std::sqrt(furthest2)) * (1 + rounding);
      pairs.step_path[i] = way;
      pairs.path[i] = (pairs.path[i] + way) * (1 + rounding);
      here.outer = here.outer || pairs.path[i] > pairs.skin[i];
      here.inner = here.inner || pairs.path[i] > pairs.until[i];
    }
  });
  Vec3 sum = Vec3::Zero();
  for (const Gone& of : gone) {
    sum += of.sum;
    pairs.outer_due = pairs.outer_due || of.outer;
    pairs.inner_due = pairs.inner_due || of.inner;
  }
  if (!work.shared && n > 0) // a frame that all ranks know
    pairs.shift = sum / (4.0 * static_cast<double>(n));
  if (work.shared)
    pairs.outer_due = ranks().any(pairs.outer_due);
  return pairs.outer_due || work.faces_changed || work.looks_at_all;
}

void renew_pairs(const Model& model, const State& state, ContactWork& work, int threads) {
  const std::vector<char> paired = paired_blocks(model, work);
  if (std::find(paired.begin(), paired.end(), 1) == paired.end()) {
    work.pairs.reset();
    work.faces_changed = false;
    return;
  }
  const bool anew = !work.pairs || work.pairs->paired != paired;
  if (anew) {
    work.pairs = std::make_shared<PairContacts>();
    work.pairs->paired = paired;
    work.pairs->joints = TetJoints(model, state, paired);
  }
  PairContacts& pairs = *work.pairs;
  if (!anew && work.faces_changed)
    pairs.outer_due = !refresh(model, pairs.joints.update(model, state), pairs) || pairs.outer_due;
  work.faces_changed = false;
  if (!pairs.outer_due && !work.looks_at_all)
    return;
  std::vector<float> pace(pairs.number.size(), 0); // by tet
  for (std::size_t i = 0; i < pairs.step_path.size(); ++i)
    pace[pairs.tets[i] - model.mesh.first_tet] = pairs.step_path[i];
  choose_tets(model, state, pairs);
  pace.resize(pairs.number.size(), 0);
  pairs.step_path.resize(pairs.tets.size());
  for (std::size_t i = 0; i < pairs.tets.size(); ++i)
    pairs.step_path[i] = pace[pairs.tets[i] - model.mesh.first_tet];
  set_shapes(model, pairs);
  set_places(state, pairs, threads);
  choose_skins_of_tets(pairs);
  list_pairs(model, state, work, pairs, threads);
}

std::vector<std::int32_t> nodes_of_pairs(const ContactWork& work) {
  std::vector<std::int32_t> nodes;
  if (!work.pairs)
    return nodes;
  std::vector<char> read(work.pairs->tets.size(), 0);
  for (std::size_t r = 0; r < work.pairs->a.size(); ++r)
    read[work.pairs->a[r]] = read[work.pairs->b[r]] = 1;
  for (std::size_t i = 0; i < read.size(); ++i)
    if (read[i] || is_own(work, work.pairs->tets[i]))
      nodes.insert(nodes.end(), work.pairs->node.begin() + static_cast<std::ptrdiff_t>(4 * i),
                   work.pairs->node.begin() + static_cast<std::ptrdiff_t>(4 * i + 4));
  return nodes;
}

namespace {

// Those of the inner list whose tetrahedra have gone so far, and that did not press before the step: apart from each other
// they sleep on; returned are those that touch, ascending, with the largest phi of each.
struct Touching {
  std::vector<std::int32_t> rows;
  std::vector<double> phi;
};

Touching find_touching(PairContacts& pairs, bool looks_at_all, int threads) {
  std::vector<std::int32_t> awake(pairs.inner.size());
  std::size_t n = 0;
  for (const std::int32_t row : pairs.inner) {
    awake[n] = row;
    n += static_cast<std::size_t>(pairs.wake[row] <= paths(pairs, row) || looks_at_all);
  }
  awake.resize(n);
  awake.erase(std::remove_if(awake.begin(), awake.end(),
                             [&](std::int32_t row) {
                               return pairs.entry[row] >= 0 && pairs.known[pairs.entry[row]].normal > 0;
                             }),
              awake.end());
  const std::vector<double> gap = gaps_of(pairs, awake, threads);
  std::vector<std::int32_t> near;
  std::vector<double> offset;
  for (std::size_t i = 0; i < awake.size(); ++i) {
    const double here = offset_of(pairs, awake[i]);
    if (gap[i] + here > 0 && !looks_at_all) {
      sleep(pairs, awake[i], gap[i] + here);
      continue;
    }
    near.push_back(awake[i]);
    offset.push_back(here);
  }
  const std::vector<double> phi = depths_of(pairs, near, offset, threads);
  Touching touching;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!(phi[i] > 0)) {
      const double small = std::min(pairs.size[pairs.a[near[i]]], pairs.size[pairs.b[near[i]]]);
      sleep(pairs, near[i], part_of_phi * std::min(-phi[i], part_of_size * small));
      continue;
    }
    touching.rows.push_back(near[i]);
    touching.phi.push_back(phi[i]);
  }
  return touching;
}

// Contacts that carry nothing come up with the surface of the other one as it leaves. At times that follow from the State
// alone.
void let_offsets_fall(const State& state, PairContacts& pairs, int threads) {
  constexpr std::int64_t fall_every = 20; // steps
  if (state.step % fall_every != 0)
    return;
  std::vector<std::int32_t> rows;
  for (std::size_t i = 0; i < pairs.known.size(); ++i)
    if (!(pairs.known[i].normal > 0) && pairs.known[i].taken_over < 0)
      rows.push_back(pairs.known_row[i]);
  const std::vector<double> depth = depths_of(pairs, rows, std::vector<double>(rows.size(), 0.0), threads);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TetContact& c = pairs.known[pairs.entry[rows[i]]];
    const double falls_to = std::max(depth[i], first_offset(pairs, rows[i]));
    if (falls_to < c.offset)
      wake_now(pairs, rows[i]);
    c.offset = std::min(c.offset, falls_to);
  }
}

// Depths of the pairs that press on a tetrahedron, at most, m, before the step.
std::vector<double> depths_before(const PairContacts& pairs) {
  std::vector<double> deepest(pairs.tets.size(), 0);
  for (std::size_t i = 0; i < pairs.known.size(); ++i)
    for (const std::int32_t tet : {pairs.a[pairs.known_row[i]], pairs.b[pairs.known_row[i]]})
      if (pairs.known[i].normal > 0)
        deepest[tet] = std::max(deepest[tet], pairs.known[i].depth);
  return deepest;
}

// Where a field ends at a plane that is not open, or another plane begins to count, what has a depth there comes in, or goes,
// at once. Nothing comes in deeper than the two have moved and their tetrahedra have pressed on others before: the rest of the
// depth counts as found. What a contact stores more or less by it is booked as
// friction.
void tame_jumps(const Model& model, const State& state, const ContactWork& work, PairContacts& pairs,
                const std::vector<std::int32_t>& rows, const std::vector<std::int32_t>& which, int threads) {
  std::vector<std::int32_t> again, which_again;
  std::vector<double> deepest;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    FoundPair& found = pairs.found[which[i]];
    TetContact& c = found.contact;
    const double change = found.pressure.depth - c.depth;
    const double small = std::min(pairs.size[pairs.a[rows[i]]], pairs.size[pairs.b[rows[i]]]);
    if (!(change > least_jump * small))
      continue;
    const double motion = 1.5 * motion_in_step(state, pairs, rows[i], work.step);
    if (!(change > motion))
      continue;
    if (deepest.empty())
      deepest = depths_before(pairs);
    const double before = std::max({c.depth, deepest[pairs.a[rows[i]]], deepest[pairs.b[rows[i]]]}),
                 too_deep = found.pressure.depth - (before + motion);
    if (too_deep > 0) {
      c.offset += too_deep;
      again.push_back(rows[i]);
      which_again.push_back(which[i]);
    }
  }
  press_pairs(model, work, again, which_again, threads, pairs.found);
  for (const std::int32_t place : which) {
    FoundPair& found = pairs.found[place];
    const double jump = found.contact.stored - found.pressure.stored - found.pressure.work;
    if (std::abs(jump) > found.pressure.tolerance)
      found.pressure.friction += jump;
  }
}

} // namespace

void evaluate_pairs(const Model& model, const State& state, ContactWork& work, int threads) {
  PairContacts& pairs = *work.pairs;
  take_known(model, state, work, pairs);
  let_offsets_fall(state, pairs, threads);
  if (pairs.inner_due || work.looks_at_all)
    choose_inner(work, pairs);
  const Touching touching = find_touching(pairs, work.looks_at_all, threads);
  // Those that press, or did before the step, or take over a force; and those found deeper in each other than they can have
  // got in a step.
  std::vector<FoundPair>& found = pairs.found;
  found.clear();
  found.reserve(pairs.known.size() + touching.rows.size());
  std::vector<std::int32_t> row_of, pressed, which;
  const auto add = [&](std::int32_t row, const TetContact& c, bool presses) {
    if (presses) {
      pressed.push_back(row);
      which.push_back(static_cast<std::int32_t>(found.size()));
    }
    row_of.push_back(row);
    found.emplace_back().contact = c;
  };
  std::size_t next = 0;
  const auto add_known_before = [&](std::int32_t row) {
    for (; next < pairs.known.size() && pairs.known_row[next] < row; ++next)
      add(pairs.known_row[next], pairs.known[next],
          pairs.known[next].normal > 0 || pairs.known[next].taken_over >= 0);
  };
  for (std::size_t i = 0; i < touching.rows.size(); ++i) {
    const std::int32_t row = touching.rows[i];
    add_known_before(row);
    if (pairs.entry[row] >= 0) {
      add(row, pairs.known[next++], true);
      continue;
    }
    TetContact c;
    c.a = pairs.tets[pairs.a[row]];
    c.b = pairs.tets[pairs.b[row]];
    c.offset = first_offset(pairs, row);
    const bool came_here = touching.phi[i] <= 1.5 * motion_in_step(state, pairs, row, work.step);
    if (!came_here)
      c.offset += touching.phi[i] * (1 + 1e-9);
    add(row, c, came_here);
  }
  add_known_before(std::numeric_limits<std::int32_t>::max());
  set_velocities(state, pressed, pairs);
  press_pairs(model, work, pressed, which, threads, found);
  tame_jumps(model, state, work, pairs, pressed, which, threads);
  for (std::size_t i = 0; i < found.size(); ++i) {
    TetContact& c = found[i].contact;
    const TetPressure& p = found[i].pressure;
    if (c.normal > 0 && !(p.pressing > 0))
      wake_now(pairs, row_of[i]);
    c.normal = p.pressing;
    c.depth = p.depth;
    c.stored = p.stored;
    c.shear = Vec3(p.shear[0], p.shear[1], p.shear[2]);
    found[i].stays = c.normal > 0 || c.offset > first_offset(pairs, row_of[i]);
  }
}

} // namespace cdem
