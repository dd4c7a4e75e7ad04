#include "libcdem/contact/broad_phase/movers.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/broad_phase/renewed.hpp"
#include "libcdem/contact/broad_phase/tets_beyond.hpp"
#include "libcdem/ranks/bytes.hpp"
#include "libcdem/ranks/shared_state.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// As ContactWork::active, of a triangle of this face.
char activity(const State& state, int face) {
  if (face < 0)
    return 1;
  const std::uint8_t told = state.faces[face / lanes].told[face % lanes];
  if ((told & ToldOfFace::gone) != 0)
    return 2;
  return static_cast<char>((told & ToldOfFace::broken) != 0);
}

// Numbers the movers by the first of their triangles, and gives every triangle its own.
void number_movers(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  Movers& movers = work.movers;
  movers.block.resize(model.blocks.size());
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    movers.block[b] = static_cast<int>(b);
  movers.fragment.assign(model.blocks.size(), -1);
  movers.of_triangle.resize(s.triangles.size());
  std::vector<int> of_fragment(model.node_position.size(), -1); // by its smallest node
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const int block = s.triangles[t].block;
    int& mover = movers.of_triangle[t];
    mover = block;
    if (!work.broken[block])
      continue;
    int& known = of_fragment[work.fragment[t]];
    if (known < 0) {
      known = movers.count();
      movers.block.push_back(block);
      movers.fragment.push_back(work.fragment[t]);
    }
    mover = known;
  }
}

void find_nodes(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  Movers& movers = work.movers;
  const auto blocks = static_cast<int>(model.blocks.size());
  std::vector<int> of_node(model.node_position.size(), -1);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (work.active[t] && movers.of_triangle[t] >= blocks)
      for (const int node : s.triangles[t].nodes)
        of_node[node] = movers.of_triangle[t] - blocks;
  movers.node_begin.assign(static_cast<std::size_t>(movers.count() - blocks) + 1, 0);
  for (const int fragment : of_node)
    if (fragment >= 0)
      ++movers.node_begin[fragment + 1];
  for (std::size_t i = 1; i < movers.node_begin.size(); ++i)
    movers.node_begin[i] += movers.node_begin[i - 1];
  movers.nodes.resize(movers.node_begin.back());
  std::vector<int> next(movers.node_begin.begin(), movers.node_begin.end() - 1);
  for (int node = 0; node < static_cast<int>(of_node.size()); ++node)
    if (of_node[node] >= 0)
      movers.nodes[next[of_node[node]]++] = node;
}

// A fragment is one piece when no bond is inside it.
void find_pieces(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  work.movers.one_piece.assign(work.movers.count(), 1);
  std::fill_n(work.movers.one_piece.begin(), model.blocks.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (s.triangles[t].face >= 0 && work.fragment[t] == work.fragment[s.triangles[t].mate])
      work.movers.one_piece[work.movers.of_triangle[t]] = 0;
}

// Such a fragment is convex, and its four triangles are its surface.
void find_single_tets(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  Movers& movers = work.movers;
  constexpr std::array<int, 4> none{-1, -1, -1, -1};
  movers.triangles_of_tet.assign(movers.count(), none);
  std::vector<int> tets(model.node_position.size(), 0); // per fragment
  for (const geom::Tet& tet : model.tets)
    ++tets[work.fragment_of_node[tet[0]]];
  for (int t = 0; t < static_cast<int>(s.triangles.size()); ++t) {
    const int mover = movers.of_triangle[t];
    if (mover < static_cast<int>(model.blocks.size()) || !work.active[t] || tets[work.fragment[t]] != 1)
      continue;
    std::array<int, 4>& triangles = movers.triangles_of_tet[mover];
    *std::find(triangles.begin(), triangles.end(), -1) = t;
  }
  for (std::array<int, 4>& triangles : movers.triangles_of_tet)
    if (triangles[3] < 0)
      triangles = none;
}

// Writes ContactWork::changed.
void find_changed(const Model& model, const ContactWork& before, ContactWork& work) {
  work.changed.assign(work.fragment.size(), Change::none);
  if (before.fragment.empty())
    return;
  for (std::size_t t = 0; t < work.fragment.size(); ++t) {
    if (!work.broken[model.surface.triangles[t].block])
      continue;
    if (before.fragment[t] != work.fragment[t] || before.active[t] != work.active[t])
      work.changed[t] = Change::fragment;
    if (!before.active[t] && work.active[t])
      work.changed[t] = Change::surface;
  }
}

// Per mover, its number before; -1: it is a new one. A fragment is the same as long as its smallest node is, though pieces
// have fallen off it. One that is a single piece has nothing that is further away.
std::vector<int> numbers_before(const Model& model, const ContactWork& before, const ContactWork& work) {
  std::vector<int> old(work.movers.count(), -1);
  if (before.fragment.empty())
    return old;
  const auto blocks = static_cast<int>(model.blocks.size());
  std::vector<char> any_changed(old.size(), 0);
  for (std::size_t t = 0; t < work.fragment.size(); ++t) {
    const int mover = work.movers.of_triangle[t];
    old[mover] = before.movers.of_triangle[t];
    any_changed[mover] = static_cast<char>(any_changed[mover] || work.changed[t] != Change::none);
  }
  const Movers &now = work.movers, &then = before.movers;
  for (int m = blocks; m < now.count(); ++m) {
    const int k = old[m];
    if (k < blocks || then.fragment[k] != now.fragment[m] || then.one_piece[k] != now.one_piece[m] ||
        then.triangles_of_tet[k] != now.triangles_of_tet[m] || (now.one_piece[m] && any_changed[m]))
      old[m] = -1;
  }
  return old;
}

// New surface of fragments that go on: its nodes are where they would be had they moved as the fragment did.
void begin_new_nodes(const State& state, const Movers& before, const std::vector<int>& old,
                     ContactWork& work) {
  std::vector<char> known(state.displacement.size(), 0);
  for (const int node : before.nodes)
    known[node] = 1;
  const int blocks = work.movers.count() - static_cast<int>(work.movers.node_begin.size()) + 1;
  for (int m = blocks; m < work.movers.count(); ++m)
    for (int i = work.movers.node_begin[m - blocks];
         old[m] >= 0 && i < work.movers.node_begin[m - blocks + 1]; ++i)
      if (const int node = work.movers.nodes[i]; !known[node])
        work.at_search[node] = vec(state.displacement[node]) - work.drift[m];
}

// What was known of the movers before they were told apart anew goes on for those that are the same.
void carry_over(const Model& model, const State& state, ContactWork& before, ContactWork& work) {
  find_changed(model, before, work);
  const std::vector<int> old = numbers_before(model, before, work);
  const auto carry = [&](auto ContactWork::*field) {
    auto& now = work.*field;
    auto& then = before.*field;
    now.clear();
    now.resize(work.movers.count());
    for (int m = 0; m < work.movers.count(); ++m)
      if (old[m] >= 0 && old[m] < static_cast<int>(then.size()))
        now[m] = std::move(then[old[m]]);
  };
  carry(&ContactWork::travelled);
  carry(&ContactWork::skin);
  carry(&ContactWork::swing);
  work.drift.assign(work.movers.count(), geom::Vec3::Zero());
  for (int m = 0; m < work.movers.count(); ++m)
    if (old[m] >= 0 && old[m] < static_cast<int>(before.drift.size()))
      work.drift[m] = before.drift[old[m]];
  begin_new_nodes(state, before.movers, old, work);
}

} // namespace

void find_fragments(const Model& model, const State& state, ContactWork& work) {
  const ContactSurface& s = model.surface;
  ContactWork before; // of the movers alone
  std::swap(before.fragment, work.fragment);
  std::swap(before.active, work.active);
  std::swap(before.movers, work.movers);
  std::swap(before.travelled, work.travelled);
  std::swap(before.skin, work.skin);
  std::swap(before.swing, work.swing);
  std::swap(before.drift, work.drift);
  work.fragment_of_node = fragments_of_nodes(model, state, Joins::told);
  work.fragment.resize(s.triangles.size());
  work.active.resize(s.triangles.size());
  work.broken.assign(model.blocks.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    work.fragment[t] = work.fragment_of_node[s.triangles[t].nodes[0]];
    work.active[t] = activity(state, s.triangles[t].face);
    if (s.triangles[t].face >= 0 && work.active[t])
      work.broken[s.triangles[t].block] = 1;
  }
  number_movers(model, work);
  find_nodes(model, work);
  find_pieces(model, work);
  find_single_tets(model, work);
  find_tets_beyond(model, work);
  carry_over(model, state, before, work);
}

std::vector<double> speeds_of_movers(const Model& model, const State& state, const ContactWork& work,
                                     int threads) {
  const Movers& movers = work.movers;
  const auto blocks = static_cast<std::int64_t>(model.blocks.size());
  std::vector<double> speeds(movers.count(), 0.0);
  const Range own = work.shared ? work.shared->part().nodes()
                                : Range{0, static_cast<std::int64_t>(model.node_position.size())};
  for_chunks(movers.count(), threads, [&](std::int64_t m) {
    double speed2 = 0;
    if (m < blocks) {
      const Block& block = model.blocks[m];
      const auto begin = std::max<std::int64_t>(block.node_begin, own.begin),
                 end = std::min<std::int64_t>(block.node_end, own.end);
      if (block.meshed)
        for (auto node = static_cast<int>(begin); node < end; ++node)
          speed2 = std::max(speed2, velocity_of(state, node).squaredNorm());
    } else {
      const auto nodes = movers.nodes.begin();
      const auto begin = nodes + movers.node_begin[m - blocks],
                 end = nodes + movers.node_begin[m - blocks + 1];
      for (auto node = std::lower_bound(begin, end, own.begin); node != end && *node < own.end; ++node)
        speed2 = std::max(speed2, velocity_of(state, *node).squaredNorm());
    }
    speeds[m] = std::sqrt(speed2);
  });
  if (work.shared)
    ranks().largest(speeds.data(), speeds.size());
  return speeds;
}

void set_displacements(const Model& model, const State& state, ContactWork& work, int threads) {
  work.last_displacement = speeds_of_movers(model, state, work, threads);
  for (double& way : work.last_displacement)
    way *= work.step;
}

namespace {

// With several ranks, the one that follows a fragment. fragment: from the first mover after the blocks on.
int rank_of_fragment(const ContactWork& work, std::int64_t fragment) {
  const Movers& movers = work.movers;
  const int begin = movers.node_begin[fragment];
  return begin < movers.node_begin[fragment + 1] ? work.shared->part().owner_of_node(movers.nodes[begin]) : 0;
}

void share_drifts(std::int64_t blocks, ContactWork& work) {
  const std::int64_t fragments = work.movers.count() - blocks;
  if (fragments == 0)
    return;
  Pack own;
  for (std::int64_t f = 0; f < fragments; ++f)
    if (rank_of_fragment(work, f) == work.shared->part().rank) {
      own(work.drift[blocks + f]);
      own(work.swing[blocks + f]);
    }
  const std::vector<std::string> told = ranks().gather(own.text(), Ranks::Subject::drifts);
  std::vector<Unpack> of_rank(told.begin(), told.end());
  for (std::int64_t f = 0; f < fragments; ++f) {
    Unpack& unpack = of_rank[rank_of_fragment(work, f)];
    unpack(work.drift[blocks + f]);
    unpack(work.swing[blocks + f]);
  }
}

} // namespace

void set_drifts(const Model& model, const State& state, ContactWork& work, int threads) {
  const Movers& movers = work.movers;
  const auto blocks = static_cast<std::int64_t>(model.blocks.size());
  work.drift.resize(movers.count(), geom::Vec3::Zero());
  work.swing.resize(movers.count());
  for_chunks(movers.count() - blocks, threads, [&](std::int64_t fragment) {
    if (work.shared && rank_of_fragment(work, fragment) != work.shared->part().rank)
      return;
    const int begin = movers.node_begin[fragment], end = movers.node_begin[fragment + 1];
    const auto gone = [&](int i) -> geom::Vec3 {
      return vec(state.displacement[movers.nodes[i]]) - work.at_search[movers.nodes[i]];
    };
    geom::Vec3 mean = geom::Vec3::Zero();
    for (int i = begin; i < end; ++i)
      mean += gone(i);
    mean /= end - begin;
    double swing2 = 0;
    for (int i = begin; i < end; ++i)
      swing2 = std::max(swing2, (gone(i) - mean).squaredNorm());
    work.drift[blocks + fragment] = mean;
    work.swing[blocks + fragment] = std::sqrt(swing2);
  });
  if (work.shared)
    share_drifts(blocks, work);
}

void begin_drifts(const Model& model, const State& state, const Renewed& renewed, ContactWork& work) {
  const Movers& movers = work.movers;
  const auto blocks = static_cast<int>(model.blocks.size());
  if (movers.count() > blocks)
    work.at_search.resize(model.node_position.size(), geom::Vec3::Zero());
  for (int m = blocks; m < movers.count(); ++m) {
    if (!renewed.movers[m])
      continue;
    for (int i = movers.node_begin[m - blocks]; i < movers.node_begin[m - blocks + 1]; ++i)
      work.at_search[movers.nodes[i]] = vec(state.displacement[movers.nodes[i]]);
  }
}

double gone_since(const ContactWork& work, int a, int b, const std::array<float, 3>& drifts, float swings) {
  constexpr double rounding = 1e-6; // of lengths kept as floats
  const geom::Vec3 then(drifts[0], drifts[1], drifts[2]), now = work.drift[b] - work.drift[a];
  return (now - then).norm() + work.swing[a] + work.swing[b] + swings + rounding * (now.norm() + then.norm());
}

} // namespace cdem
