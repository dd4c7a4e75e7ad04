#include "libcdem/contact/broad_phase/tet_pairs.hpp"

#include "libcdem/contact/broad_phase/tet_paths.hpp"
#include "libcdem/contact/data/tet_contacts.hpp"
#include "libcdem/contact/response/tet_potential.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/disjoint_sets.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using TetPair = std::pair<int, int>;

// Skin of a tetrahedron, over the usual height of one at the surface of its block. When one has left its skin, the pairs of all that
// have gone this part of theirs are found anew.
constexpr double skin_ratio = 0.05, renewed_from = 0.4;
// Rings of tetrahedra below the surface for which pairs are found too: cracks will open some of them.
constexpr int rings_below = 2;
// Steps for which pairs are near.
constexpr double steps_near = 30;

using Joints = std::vector<std::array<int, 4>>;

Joints joints_of(const Model& model, const State& state, const ContactWork& work,
                 const std::vector<SurfaceTet>& tets) {
  geom::DisjointSets sets(model.node_position.size());
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!work.fragments.broken[chunk.block] || (state.faces[batch].told[lane] & ToldOfFace::left) != 0)
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    for (int k = 0; k < 3; ++k)
      sets.unite(nodes.a[k], nodes.b[k]);
  });
  Joints joints;
  joints.reserve(tets.size());
  for (const SurfaceTet& tet : tets)
    joints.push_back(
        {sets.find(tet.nodes[0]), sets.find(tet.nodes[1]), sets.find(tet.nodes[2]), sets.find(tet.nodes[3])});
  return joints;
}

bool may_touch(const TetContacts& of, int a, int b) {
  if (!of.tets[a].at_surface || !of.tets[b].at_surface)
    return false;
  for (const int m : of.joint[a])
    for (const int n : of.joint[b])
      if (m == n)
        return false;
  return true;
}

// The tets of the block that have a node on its surface, as it is now, by their places in Block.
std::vector<char> tets_at_surface(const Model& model, const ContactFragments& fragments, int block) {
  const ContactSurface& s = model.surface;
  const Block& b = model.blocks[block];
  std::vector<char> on_surface(s.original.size(), 0); // of the mesh before it was split
  for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
    if (fragments.active[t])
      for (const int node : s.triangles[t].nodes)
        on_surface[s.original[node]] = 1;
  std::vector<char> at_surface;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    const geom::Tet& n = model.tets[tet];
    at_surface.push_back(static_cast<char>(
        std::any_of(n.begin(), n.end(), [&](int node) { return on_surface[s.original[node]] != 0; })));
  }
  return at_surface;
}

// The tetrahedra at the surface and the next ones below it.
std::vector<char> with_rings(const Model& model, const Block& block, std::vector<char> some) {
  const std::vector<int>& original = model.surface.original;
  std::vector<char> reached(original.size(), 0);
  for (int ring = 0; ring < rings_below; ++ring) {
    for (std::size_t i = 0; i < some.size(); ++i)
      if (some[i])
        for (const int node : model.tets[block.tet_begin + i])
          reached[original[node]] = 1;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const geom::Tet& nodes = model.tets[block.tet_begin + i];
      some[i] = static_cast<char>(
          std::any_of(nodes.begin(), nodes.end(), [&](int node) { return reached[original[node]] != 0; }));
    }
  }
  return some;
}

void add_tets(const Model& model, const ContactWork& work, int block, TetContacts& to) {
  const Block& b = model.blocks[block];
  const std::vector<char> at_surface = tets_at_surface(model, work.fragments, block),
                          all = with_rings(model, b, at_surface);
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet)
    if (all[tet - b.tet_begin]) {
      to.number[tet] = static_cast<int>(to.tets.size());
      to.tets.push_back(
          {tet, block, model.tets[tet], tet_size(model, tet), at_surface[tet - b.tet_begin] != 0});
    }
  to.tets_begin.push_back(static_cast<int>(to.tets.size()));
}

void set_nodes(const Model& model, TetContacts& of) {
  of.nodes.clear();
  of.nodes_begin.assign(1, 0);
  for (std::vector<int>& corner : of.corner)
    corner.resize(of.tets.size());
  std::vector<char> has(model.node_position.size(), 0);
  for (std::size_t block = 0; block + 1 < of.tets_begin.size(); ++block) {
    for (int t = of.tets_begin[block]; t < of.tets_begin[block + 1]; ++t) {
      const geom::Tet& nodes = of.tets[t].nodes = model.tets[of.tets[t].tet];
      for (int k = 0; k < 4; ++k) {
        of.corner[k][t] = nodes[k];
        has[nodes[k]] = 1;
      }
    }
    if (of.tets_begin[block] < of.tets_begin[block + 1]) {
      const Block& b = model.blocks[of.tets[of.tets_begin[block]].block];
      for (int node = b.node_begin; node < b.node_end; ++node)
        if (has[node] != 0)
          of.nodes.push_back(node);
    }
    of.nodes_begin.push_back(static_cast<int>(of.nodes.size()));
  }
  of.place.resize(model.node_position.size());
}

void set_places(const Model& model, const State& state, TetContacts& of) {
  for (const int node : of.nodes) {
    const geom::Vec3 x = place_of(model, state, node);
    of.place[node] = {x.x(), x.y(), x.z(), 0};
  }
}

// Marks the tetrahedra with a corner whose joint has become several, or one with others. was: number of each before, -1: it was
// not listed. Nodes may have other numbers than before.
void mark_other_joints(const Joints& before, const Joints& now, const std::vector<int>& was,
                       std::vector<char>& changed) {
  constexpr int none = -1, several = -2;
  std::array<std::vector<int>, 2> partner; // by the number of a joint before and now, that of the other
  const auto meet = [&](std::vector<int>& of, int joint, int other) {
    if (static_cast<std::size_t>(joint) >= of.size())
      of.resize(static_cast<std::size_t>(joint) + 1, none);
    of[joint] = of[joint] == none || of[joint] == other ? other : several;
  };
  const auto each = [&](const auto& visit) {
    for (std::size_t t = 0; t < now.size(); ++t)
      for (int k = 0; was[t] >= 0 && k < 4; ++k)
        visit(t, before[was[t]][k], now[t][k]);
  };
  each([&](std::size_t, int then, int is) {
    meet(partner[0], then, is);
    meet(partner[1], is, then);
  });
  each([&](std::size_t t, int then, int is) {
    if (partner[0][then] == several || partner[1][is] == several)
      changed[t] = 1;
  });
}

// Asks again what may touch of the pairs with a tetrahedron that has changed.
void ask_again(const std::vector<char>& changed, TetContacts& of) {
  for (std::size_t p = 0; p < of.pairs.count(); ++p) {
    const int a = of.pairs.a[p], b = of.pairs.b[p];
    if (!changed[a] && !changed[b])
      continue;
    const bool free = may_touch(of, a, b);
    if (free == (of.may_touch[p] != 0))
      continue;
    of.may_touch[p] = static_cast<char>(free);
    of.pairs.allowed[p] = 0;
    of.fresh = true;
  }
}

// Those of these pairs that no plane of one of them parts by more than their skins, in the same order.
TetContacts near_among(const std::vector<TetPair>& pairs, const TetContacts& of) {
  constexpr std::size_t at_a_time = 64 * lanes;
  TetContacts found; // its pairs alone
  std::vector<TetPairView> views(at_a_time / lanes);
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_a_time) {
    const std::size_t count = std::min(at_a_time, pairs.size() - begin), full = (count + lanes - 1) / lanes;
    for (std::size_t i = 0; i < lanes * full; ++i) {
      const auto& [a, b] = pairs[begin + std::min(i, count - 1)];
      views[i / lanes].set(static_cast<int>(i % lanes), of.tets[a].nodes, of.tets[b].nodes);
    }
    bound_deepest(of.place.data(), views.data(), static_cast<std::int64_t>(full));
    for (std::size_t i = 0; i < count; ++i) {
      const double apart = -views[i / lanes].deepest[i % lanes];
      if (apart > 2 * of.skin)
        continue;
      const auto& [a, b] = pairs[begin + i];
      WatchedPairs& near = found.pairs;
      near.a.push_back(a);
      near.b.push_back(b);
      near.allowed.push_back(0);
      for (std::vector<float>& then : near.then)
        then.push_back(0);
      near.set(near.count() - 1, of.paths, rounded_down(apart));
      found.may_touch.push_back(static_cast<char>(may_touch(of, a, b)));
    }
  }
  return found;
}

// Finds anew the pairs of the tetrahedra that have gone a part of their skins; a new one counts as gone. All others keep theirs.
void find_anew(TetContacts& of) {
  std::vector<char> anew(of.tets.size());
  for (std::size_t t = 0; t < anew.size(); ++t) {
    anew[t] = static_cast<char>(of.paths.path[t] > renewed_from * of.skin);
    if (anew[t] == 0)
      continue;
    of.path_then[t] -= of.paths.path[t]; // what it has gone since then stays
    of.paths.clear(t);
    geom::Box& box = of.boxes[t];
    box = {};
    for (const int node : of.tets[t].nodes)
      box.extend(geom::Vec3(of.place[node].x, of.place[node].y, of.place[node].z) - of.way[of.tets[t].block]);
    box.min.array() -= of.skin;
    box.max.array() += of.skin;
  }
  std::vector<TetPair> pairs = geom::touching_pairs(of.boxes, anew);
  if (of.nodes_begin.size() > 2)
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](const TetPair& pair) {
                                 return of.tets[pair.first].block != of.tets[pair.second].block;
                               }),
                pairs.end());
  const TetContacts found = near_among(pairs, of);
  const WatchedPairs before = std::exchange(of.pairs, {});
  const std::vector<char> might = std::exchange(of.may_touch, {});
  std::size_t next = 0;
  const auto add_found_before = [&](const TetPair& pair) {
    for (; next < found.pairs.count() && TetPair(found.pairs.a[next], found.pairs.b[next]) < pair; ++next) {
      of.pairs.add(found.pairs, next, found.pairs.a[next], found.pairs.b[next]);
      of.may_touch.push_back(found.may_touch[next]);
    }
  };
  for (std::size_t p = 0; p < before.count(); ++p) {
    const int a = before.a[p], b = before.b[p];
    if (anew[a] || anew[b])
      continue;
    add_found_before({a, b});
    of.pairs.add(before, p, a, b);
    of.may_touch.push_back(might[p]);
  }
  add_found_before({std::numeric_limits<int>::max(), 0});
  of.fresh = true;
}

// The tetrahedra that may come to the surface before long. Those that were listed before go on, with the pairs between them.
void list_tets(const Model& model, const State& state, ContactWork& work) {
  auto listed = std::make_shared<TetContacts>();
  TetContacts& to = *listed;
  to.number.assign(model.tets.size(), -1);
  to.tets_begin.push_back(0);
  to.skin = std::numeric_limits<double>::infinity();
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block)
    if (touches_itself(model, work.fragments, block)) {
      add_tets(model, work, block, to);
      to.skin = std::min(to.skin, skin_ratio * model.surface.usual_height[block]);
    }
  set_nodes(model, to);
  set_places(model, state, to);
  to.paths.assign(to.tets.size());
  // One that was not listed before counts as gone, but not as fast.
  to.paths.path.assign(to.tets.size(), 2 * to.skin);
  to.path_then = to.paths.path;
  to.limit.assign(to.tets.size(), -1.0);
  to.boxes.resize(to.tets.size());
  to.way.assign(model.blocks.size(), geom::Vec3::Zero());
  to.joint = joints_of(model, state, work, to.tets);
  std::vector<char> changed(to.tets.size(), 0);
  if (const TetContacts* const before = work.tet_contacts.get(); before && before->skin == to.skin) {
    to.way = before->way;
    to.steps = before->steps;
    to.steps_then = before->steps_then;
    std::vector<int> now(before->tets.size(), -1), were(to.tets.size()); // of those listed before
    for (std::size_t t = 0; t < to.tets.size(); ++t) {
      const int was = were[t] = before->number[to.tets[t].tet];
      if (was < 0)
        continue;
      now[was] = static_cast<int>(t);
      to.paths.copy(was, before->paths, t);
      to.path_then[t] = before->path_then[was];
      to.boxes[t] = before->boxes[was];
      changed[t] = static_cast<char>(to.tets[t].at_surface != before->tets[was].at_surface);
    }
    mark_other_joints(before->joint, to.joint, were, changed);
    for (std::size_t p = 0; p < before->pairs.count(); ++p)
      if (const int a = now[before->pairs.a[p]], b = now[before->pairs.b[p]]; a >= 0 && b >= 0) {
        to.pairs.add(before->pairs, p, a, b);
        to.may_touch.push_back(before->may_touch[p]);
      }
    ask_again(changed, to);
  }
  work.tet_contacts = std::move(listed);
}

// What pairs may touch, after contact has been told of bonds. False where a tetrahedron has come to the surface that is not listed.
bool told_anew(const Model& model, const State& state, ContactWork& work) {
  TetContacts& of = *work.tet_contacts;
  std::vector<char> at_surface(of.tets.size(), 0);
  std::size_t blocks = 0;
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block) {
    if (!touches_itself(model, work.fragments, block))
      continue;
    ++blocks;
    const std::vector<char> of_block = tets_at_surface(model, work.fragments, block);
    for (std::size_t i = 0; i < of_block.size(); ++i) {
      const int t = of.number[model.blocks[block].tet_begin + i];
      if (t < 0 && of_block[i])
        return false;
      if (t >= 0)
        at_surface[t] = of_block[i];
    }
  }
  if (blocks + 1 != of.nodes_begin.size())
    return false;
  std::vector<char> changed(of.tets.size(), 0);
  for (std::size_t t = 0; t < changed.size(); ++t) {
    const bool now = at_surface[t] != 0;
    changed[t] = static_cast<char>(std::exchange(of.tets[t].at_surface, now) != now);
  }
  const Joints before = std::exchange(of.joint, joints_of(model, state, work, of.tets));
  std::vector<int> same(of.tets.size());
  std::iota(same.begin(), same.end(), 0);
  mark_other_joints(before, of.joint, same, changed);
  ask_again(changed, of);
  std::fill(of.limit.begin(), of.limit.end(), -1.0);
  return true;
}

// m, that a pair may still go, at least, by the paths of both.
double left_by_paths(const TetContacts& of, std::size_t p) {
  const int a = of.pairs.a[p], b = of.pairs.b[p];
  double past2 = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double past = of.paths.drift[axis][b] - of.paths.drift[axis][a] - of.pairs.then[axis][p];
    past2 += past * past;
  }
  return of.pairs.allowed[p] - std::sqrt(past2) -
         (of.paths.swing[a] + of.paths.swing[b] - of.pairs.then[3][p]);
}

void find_near(const ContactWork& work, TetContacts& of) {
  const double steps = static_cast<double>(std::max<std::int64_t>(1, of.steps - of.steps_then));
  const auto way = [&](std::size_t t) { return (of.paths.path[t] - of.path_then[t]) / steps; }; // m in a step
  double mean = 0;
  for (std::size_t t = 0; t < of.tets.size(); ++t)
    mean += way(t) / static_cast<double>(of.tets.size());
  mean = std::max(mean, 1e-4 * of.skin);
  std::vector<double> margin(of.tets.size()); // m
  for (std::size_t t = 0; t < of.tets.size(); ++t) {
    margin[t] = steps_near * std::max(mean, way(t));
    of.limit[t] = of.paths.path[t] + margin[t];
  }
  of.path_then = of.paths.path;
  of.steps_then = of.steps;
  of.near.clear();
  of.place_of_near.clear();
  of.tets_of_near.clear();
  constexpr double twice = 2; // the middle and the corners of a tetrahedron go no further than its path, each
  for (std::size_t p = 0; p < of.pairs.count(); ++p) {
    const int a = of.pairs.a[p], b = of.pairs.b[p];
    if (!of.may_touch[p] ||
        (!work.options.looks_at_all && left_by_paths(of, p) > 2 * twice * (margin[a] + margin[b])))
      continue;
    of.place_of_near.push_back(static_cast<int>(p));
    of.tets_of_near.emplace_back(of.tets[a].tet, of.tets[b].tet);
    of.near.a.push_back(a);
    of.near.b.push_back(b);
    for (int i = 0; i < 4; ++i)
      of.near.then[i].push_back(of.pairs.then[i][p]);
    of.near.allowed.push_back(of.pairs.allowed[p]);
  }
}

// Writes where the nodes are and how far the tetrahedra have gone in the step.
void move(const Model& model, const State& state, const ContactWork& work, TetContacts& of) {
  set_places(model, state, of);
  for (std::size_t block = 0; block + 1 < of.nodes_begin.size(); ++block) {
    simd::Quad sums[4] = {}; // m/s; several: an addition waits for the one before
    for (int i = of.nodes_begin[block]; i < of.nodes_begin[block + 1]; ++i)
      sums[i % 4] += simd::load(state.velocity[of.nodes[i]]);
    const simd::Quad mean = ((sums[0] + sums[1]) + (sums[2] + sums[3])) /
                            std::max(1, of.nodes_begin[block + 1] - of.nodes_begin[block]);
    if (of.tets_begin[block] < of.tets_begin[block + 1])
      of.way[of.tets[of.tets_begin[block]].block] += work.step * geom::Vec3(mean[0], mean[1], mean[2]);
    add_step(state.velocity.data(), {mean[0], mean[1], mean[2], 0}, work.step, of.corner,
             of.tets_begin[block], of.tets_begin[block + 1], of.paths);
  }
  ++of.steps;
}

bool any_beyond(const std::vector<double>& path, const std::vector<double>& limit) {
  for (std::size_t t = 0; t < path.size(); ++t)
    if (path[t] > limit[t])
      return true;
  return false;
}

// All pairs with a contact are looked at in this step.
void wake_contacts(const State& state, TetContacts& of) {
  const auto begin = std::partition_point(state.contacts.begin(), state.contacts.end(),
                                          [](const Contact& c) { return c.kind != Contact::tets; });
  for (auto c = begin; c != state.contacts.end(); ++c)
    if (const int p = of.pair_of(static_cast<int>(c->source), c->target); p >= 0)
      of.pairs.allowed[p] = 0;
  std::fill(of.limit.begin(), of.limit.end(), -1.0);
}

} // namespace

int TetContacts::pair_of(int tet, int other) const {
  const int one = number[tet], two = number[other];
  const auto begin = std::lower_bound(pairs.a.begin(), pairs.a.end(), one) - pairs.a.begin(),
             end = std::upper_bound(pairs.a.begin() + begin, pairs.a.end(), one) - pairs.a.begin();
  const auto found = std::lower_bound(pairs.b.begin() + begin, pairs.b.begin() + end, two);
  return one >= 0 && two >= 0 && found != pairs.b.begin() + end && *found == two
             ? static_cast<int>(found - pairs.b.begin())
             : -1;
}

bool touches_itself(const Model& model, const ContactFragments& fragments, int block) {
  const Block& b = model.blocks[block];
  return fragments.broken[block] && b.meshed && !b.star() && b.rigid < 0 &&
         contact_joint(model, block, block);
}

void find_tet_pairs(const Model& model, const State& state, ContactWork& work, bool told) {
  bool anew = false;
  if (told) {
    bool any = false;
    for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block)
      any = any || touches_itself(model, work.fragments, block);
    if (!any)
      work.tet_contacts = nullptr;
    else if (work.tet_contacts)
      move(model, state, work, *work.tet_contacts);
    if (any && (!work.tet_contacts || !told_anew(model, state, work))) {
      list_tets(model, state, work);
      anew = true;
    }
  } else if (work.tet_contacts) {
    move(model, state, work, *work.tet_contacts);
  }
  if (!work.tet_contacts)
    return;
  TetContacts& of = *work.tet_contacts;
  anew = anew ||
         std::any_of(of.paths.path.begin(), of.paths.path.end(), [&](double path) { return path > of.skin; });
  if (anew)
    find_anew(of);
  if (anew || forgets_overlaps(state, work)) // a pair that has just parted has a contact that must end
    wake_contacts(state, of);
  if (any_beyond(of.paths.path, of.limit))
    find_near(work, of);
}

void take_tet_pairs(const Model& model, const State& state, std::shared_ptr<TetContacts> before,
                    ContactWork& work) {
  if (!before || before->number.size() != model.tets.size())
    return;
  TetContacts& of = *before;
  constexpr double rounding = 1 + 1e-6;
  for (std::size_t t = 0; t < of.tets.size(); ++t) {
    double moved = 0; // m
    for (int k = 0; k < 4; ++k) {
      const Node& was = of.place[of.corner[k][t]];
      const geom::Vec3 now = place_of(model, state, model.tets[of.tets[t].tet][k]);
      moved = std::max(moved, (now - geom::Vec3(was.x, was.y, was.z)).norm());
    }
    of.paths.path[t] += rounding * moved;
    of.paths.now[3][t] = static_cast<float>(of.paths.swing[t] += rounding * moved);
  }
  set_nodes(model, of);
  of.fresh = true;
  wake_contacts(state, of);
  work.tet_contacts = std::move(before);
}

} // namespace cdem
