#include "libcdem/contact/broad_phase/movers.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/broad_phase/renewed.hpp"
#include "libcdem/ranks/bytes.hpp"
#include "libcdem/ranks/shared_state.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdem {
namespace {

// As Movers::active, of a triangle of this face.
char activity(const State& state, int face) {
  if (face < 0)
    return 1;
  const std::uint8_t told = state.faces[face / lanes].told[face % lanes];
  if ((told & ToldOfFace::gone) != 0)
    return 2;
  return static_cast<char>((told & ToldOfFace::broken) != 0);
}

// Numbers the movers by the first of their triangles, and gives every triangle its own.
void number_movers(const Model& model, Movers& movers) {
  const ContactSurface& s = model.surface;
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
    if (!movers.broken[block])
      continue;
    int& known = of_fragment[movers.fragment_of_triangle[t]];
    if (known < 0) {
      known = movers.count();
      movers.block.push_back(block);
      movers.fragment.push_back(movers.fragment_of_triangle[t]);
    }
    mover = known;
  }
}

void find_nodes(const Model& model, Movers& movers) {
  const ContactSurface& s = model.surface;
  const auto blocks = static_cast<int>(model.blocks.size());
  std::vector<int> of_node(model.node_position.size(), -1);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (movers.active[t] && movers.of_triangle[t] >= blocks)
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
void find_pieces(const Model& model, Movers& movers) {
  const ContactSurface& s = model.surface;
  movers.one_piece.assign(movers.count(), 1);
  std::fill_n(movers.one_piece.begin(), model.blocks.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (s.triangles[t].face >= 0 &&
        movers.fragment_of_triangle[t] == movers.fragment_of_triangle[s.triangles[t].mate])
      movers.one_piece[movers.of_triangle[t]] = 0;
}

// Such a fragment is convex, and its four triangles are its surface.
void find_single_tets(const Model& model, Movers& movers) {
  const ContactSurface& s = model.surface;
  constexpr std::array<int, 4> none{-1, -1, -1, -1};
  movers.triangles_of_tet.assign(movers.count(), none);
  std::vector<int> tets(model.node_position.size(), 0); // per fragment
  for (const geom::Tet& tet : model.tets)
    ++tets[movers.fragment_of_node[tet[0]]];
  for (int t = 0; t < static_cast<int>(s.triangles.size()); ++t) {
    const int mover = movers.of_triangle[t];
    if (mover < static_cast<int>(model.blocks.size()) || !movers.active[t] ||
        tets[movers.fragment_of_triangle[t]] != 1)
      continue;
    std::array<int, 4>& triangles = movers.triangles_of_tet[mover];
    *std::find(triangles.begin(), triangles.end(), -1) = t;
  }
  for (std::array<int, 4>& triangles : movers.triangles_of_tet)
    if (triangles[3] < 0)
      triangles = none;
}

// Writes Movers::changed.
void find_changed(const Model& model, const Movers& before, Movers& movers) {
  movers.changed.assign(movers.fragment_of_triangle.size(), Change::none);
  if (before.fragment_of_triangle.empty())
    return;
  for (std::size_t t = 0; t < movers.fragment_of_triangle.size(); ++t) {
    if (!movers.broken[model.surface.triangles[t].block])
      continue;
    if (before.fragment_of_triangle[t] != movers.fragment_of_triangle[t] ||
        before.active[t] != movers.active[t])
      movers.changed[t] = Change::fragment;
    if (!before.active[t] && movers.active[t])
      movers.changed[t] = Change::surface;
  }
}

// Per mover, its number before; -1: it is a new one. A fragment is the same as long as its smallest node is, though pieces
// have fallen off it. One that is a single piece has nothing that is further away.
std::vector<int> numbers_before(const Model& model, const Movers& before, const Movers& movers) {
  std::vector<int> old(movers.count(), -1);
  if (before.fragment_of_triangle.empty())
    return old;
  const auto blocks = static_cast<int>(model.blocks.size());
  std::vector<char> any_changed(old.size(), 0);
  for (std::size_t t = 0; t < movers.fragment_of_triangle.size(); ++t) {
    const int mover = movers.of_triangle[t];
    old[mover] = before.of_triangle[t];
    any_changed[mover] = static_cast<char>(any_changed[mover] || movers.changed[t] != Change::none);
  }
  for (int m = blocks; m < movers.count(); ++m) {
    const int k = old[m];
    if (k < blocks || before.fragment[k] != movers.fragment[m] ||
        before.one_piece[k] != movers.one_piece[m] ||
        before.triangles_of_tet[k] != movers.triangles_of_tet[m] || (movers.one_piece[m] && any_changed[m]))
      old[m] = -1;
  }
  return old;
}

// New surface of fragments that go on: its nodes are where they would be had they moved as the fragment did.
void begin_new_nodes(const State& state, const Movers& before, const std::vector<int>& old,
                     const Movers& movers, MoverMotion& motion) {
  std::vector<char> known(state.displacement.size(), 0);
  for (const int node : before.nodes)
    known[node] = 1;
  const int blocks = movers.count() - static_cast<int>(movers.node_begin.size()) + 1;
  for (int m = blocks; m < movers.count(); ++m)
    for (int i = movers.node_begin[m - blocks]; old[m] >= 0 && i < movers.node_begin[m - blocks + 1]; ++i)
      if (const int node = movers.nodes[i]; !known[node])
        motion.at_search[node] = vec(state.displacement[node]) - motion.drift[m];
}

} // namespace

void find_fragments(const Model& model, const State& state, Movers& movers, MoverMotion& motion) {
  const ContactSurface& s = model.surface;
  const Movers before = std::exchange(movers, {});
  movers.fragment_of_node = fragments_of_nodes(model, state, Joins::told);
  movers.fragment_of_triangle.resize(s.triangles.size());
  movers.active.resize(s.triangles.size());
  movers.broken.assign(model.blocks.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    movers.fragment_of_triangle[t] = movers.fragment_of_node[s.triangles[t].nodes[0]];
    movers.active[t] = activity(state, s.triangles[t].face);
    if (s.triangles[t].face >= 0 && movers.active[t])
      movers.broken[s.triangles[t].block] = 1;
  }
  number_movers(model, movers);
  find_nodes(model, movers);
  find_pieces(model, movers);
  find_single_tets(model, movers);
  find_changed(model, before, movers);
  const std::vector<int> old = numbers_before(model, before, movers);
  const auto carry = [&](auto& of_movers, const auto& of_new) {
    std::vector now(old.size(), of_new);
    for (std::size_t m = 0; m < old.size(); ++m)
      if (old[m] >= 0 && old[m] < static_cast<int>(of_movers.size()))
        now[m] = of_movers[old[m]];
    of_movers = std::move(now);
  };
  carry(motion.travelled, 0.0);
  carry(motion.skin, 0.0);
  carry(motion.swing, 0.0);
  carry(motion.drift, geom::Vec3(0, 0, 0));
  begin_new_nodes(state, before, old, movers, motion);
}

std::vector<double> speeds_of_movers(const Model& model, const State& state, const ContactWork& work,
                                     int threads) {
  const Movers& movers = work.movers;
  const auto blocks = static_cast<std::int64_t>(model.blocks.size());
  std::vector<double> speeds(movers.count(), 0.0);
  const Range own = work.shared->part().nodes();
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
  if (!work.shared->alone())
    ranks().largest(speeds.data(), speeds.size());
  return speeds;
}

void set_displacements(const Model& model, const State& state, ContactWork& work, int threads) {
  work.motion.last_displacement = speeds_of_movers(model, state, work, threads);
  for (double& way : work.motion.last_displacement)
    way *= work.step;
}

namespace {

// The rank that follows a fragment. fragment: from the first mover after the blocks on.
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
      own(work.motion.drift[blocks + f]);
      own(work.motion.swing[blocks + f]);
    }
  const std::vector<std::string> told = ranks().gather(own.text(), Ranks::Subject::drifts);
  std::vector<Unpack> of_rank(told.begin(), told.end());
  for (std::int64_t f = 0; f < fragments; ++f) {
    Unpack& unpack = of_rank[rank_of_fragment(work, f)];
    unpack(work.motion.drift[blocks + f]);
    unpack(work.motion.swing[blocks + f]);
  }
}

} // namespace

void set_drifts(const Model& model, const State& state, ContactWork& work, int threads) {
  const Movers& movers = work.movers;
  MoverMotion& motion = work.motion;
  const auto blocks = static_cast<std::int64_t>(model.blocks.size());
  motion.drift.resize(movers.count(), geom::Vec3::Zero());
  motion.swing.resize(movers.count());
  for_chunks(movers.count() - blocks, threads, [&](std::int64_t fragment) {
    if (rank_of_fragment(work, fragment) != work.shared->part().rank)
      return;
    const int begin = movers.node_begin[fragment], end = movers.node_begin[fragment + 1];
    const auto gone = [&](int i) -> geom::Vec3 {
      return vec(state.displacement[movers.nodes[i]]) - motion.at_search[movers.nodes[i]];
    };
    geom::Vec3 mean = geom::Vec3::Zero();
    for (int i = begin; i < end; ++i)
      mean += gone(i);
    mean /= end - begin;
    double swing2 = 0;
    for (int i = begin; i < end; ++i)
      swing2 = std::max(swing2, (gone(i) - mean).squaredNorm());
    motion.drift[blocks + fragment] = mean;
    motion.swing[blocks + fragment] = std::sqrt(swing2);
  });
  if (!work.shared->alone())
    share_drifts(blocks, work);
}

void begin_drifts(const Model& model, const State& state, const Movers& movers, const Renewed& renewed,
                  MoverMotion& motion) {
  const auto blocks = static_cast<int>(model.blocks.size());
  if (movers.count() > blocks)
    motion.at_search.resize(model.node_position.size(), geom::Vec3::Zero());
  for (int m = blocks; m < movers.count(); ++m) {
    if (!renewed.movers[m])
      continue;
    for (int i = movers.node_begin[m - blocks]; i < movers.node_begin[m - blocks + 1]; ++i)
      motion.at_search[movers.nodes[i]] = vec(state.displacement[movers.nodes[i]]);
  }
}

double gone_since(const MoverMotion& motion, int a, int b, const std::array<float, 3>& drifts, float swings) {
  constexpr double rounding = 1e-6; // of lengths kept as floats
  const geom::Vec3 then(drifts[0], drifts[1], drifts[2]), now = motion.drift[b] - motion.drift[a];
  return (now - then).norm() + motion.swing[a] + motion.swing[b] + swings +
         rounding * (now.norm() + then.norm());
}

} // namespace cdem
