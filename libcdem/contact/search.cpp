#include "libcdem/contact/search.hpp"

#include "libcdem/contact/build_surface.hpp"
#include "libcdem/contact/places.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/results/fragments.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace cdem {
namespace {

// Of the usual height of a tet at the surface: how far things may move before the next search, and how deep a contact
// may be before the pairs around it are all looked at in every step.
constexpr double skin_ratio = 0.2, shallow_ratio = 0.01;
// Of the height of a tet: how deep a contact may get.
constexpr double depth_ratio = 0.25;
// Of the smaller block's size: bodies without a law that come nearer than this meet.
constexpr double meeting_ratio = 1e-3;
// Lists of triangles with more pairs than this go through a grid.
constexpr std::size_t most_pairs_by_hand = 40000;

double depth_of(const ContactWork& work, const ContactTriangle& t) {
  return depth_ratio * std::min(t.height, work.usual_height);
}

double margin(const ContactWork& work, const ContactTriangle& t) {
  return 0.5 * work.skin + depth_of(work, t);
}

bool apart(const geom::Box& a, const geom::Box& b) {
  return (a.min.array() > b.max.array()).any() || (b.min.array() > a.max.array()).any();
}

bool open(const State& state, int face) {
  for (const auto& point : state.faces[face / lanes].mode)
    if (point[face % lanes] == static_cast<std::uint8_t>(BondMode::intact))
      return false;
  return true;
}

// Triangles that take part, with their boxes, of all blocks.
struct Active {
  std::vector<int> triangles, block_begin;
  std::vector<geom::Box> boxes;       // per active triangle
  std::vector<geom::Box> block_boxes; // per block
};

Active active_triangles(const Model& model, const State& state, const ContactWork& work) {
  const ContactSurface& s = model.surface;
  Active active;
  active.block_begin.push_back(0);
  for (std::size_t b = 0; b + 1 < s.block_begin.size(); ++b) {
    geom::Box box;
    for (int t = s.block_begin[b]; t < s.block_begin[b + 1]; ++t) {
      const ContactTriangle& triangle = s.triangles[t];
      if (!work.active[t])
        continue;
      active.triangles.push_back(t);
      active.boxes.push_back(box_of(corners_of(model, state, triangle.nodes), margin(work, triangle)));
      box.extend(active.boxes.back().min);
      box.extend(active.boxes.back().max);
    }
    active.block_boxes.push_back(box);
    active.block_begin.push_back(static_cast<int>(active.triangles.size()));
  }
  return active;
}

using Pairs = std::vector<std::pair<int, int>>; // of triangles

// Whether the plane of one of two triangles, whose boxes meet, parts them by more than both margins. A box says little
// of a large triangle that lies askew, as those of a slope do.
class Parted {
public:
  Parted(const Model& model, const State& state, const ContactWork& work)
      : model_(model), state_(state), work_(work) {}

  bool operator()(int a, int b) const {
    const ContactTriangle &one = model_.surface.triangles[a], &other = model_.surface.triangles[b];
    const Corners x = corners_of(model_, state_, one.nodes), y = corners_of(model_, state_, other.nodes);
    const double reach = margin(work_, one) + margin(work_, other);
    return beside(x, y, reach) || beside(y, x, reach);
  }

private:
  static bool beside(const Corners& x, const Corners& plane, double reach) {
    const geom::Vec3 normal = unit_normal(plane);
    const geom::Vec3 height((x[0] - plane[0]).dot(normal), (x[1] - plane[0]).dot(normal),
                            (x[2] - plane[0]).dot(normal));
    return height.minCoeff() > reach || height.maxCoeff() < -reach;
  }

  const Model& model_;
  const State& state_;
  const ContactWork& work_;
};

// Those of two blocks whose boxes meet, the first block's first.
Pairs pairs_of_blocks(const Active& active, const Parted& parted, int a, int b) {
  const geom::Box region{active.block_boxes[a].min.cwiseMax(active.block_boxes[b].min),
                         active.block_boxes[a].max.cwiseMin(active.block_boxes[b].max)};
  const auto inside = [&](int block) {
    std::vector<int> list;
    for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i)
      if (!apart(active.boxes[i], region))
        list.push_back(i);
    return list;
  };
  const std::vector<int> one = inside(a), other = inside(b);
  Pairs pairs;
  const auto take = [&](int i, int j) {
    if (!parted(active.triangles[i], active.triangles[j]))
      pairs.emplace_back(active.triangles[i], active.triangles[j]);
  };
  if (one.size() * other.size() <= most_pairs_by_hand) {
    for (const int i : one)
      for (const int j : other)
        if (!apart(active.boxes[i], active.boxes[j]))
          take(i, j);
    return pairs;
  }
  std::vector<geom::Box> boxes;
  boxes.reserve(one.size() + other.size());
  for (const int i : one)
    boxes.push_back(active.boxes[i]);
  for (const int j : other)
    boxes.push_back(active.boxes[j]);
  const auto n = static_cast<int>(one.size());
  for (const auto& [i, j] : geom::touching_pairs(boxes))
    if (i < n && j >= n)
      take(one[i], other[j - n]);
  return pairs;
}

// Of one block: triangles of different pieces, and those of one that were far from each other at first.
Pairs pairs_within(const Model& model, const ContactWork& work, const Active& active, const Parted& parted,
                   int block) {
  const ContactSurface& s = model.surface;
  const int begin = active.block_begin[block];
  const std::vector<geom::Box> boxes(active.boxes.begin() + begin,
                                     active.boxes.begin() + active.block_begin[block + 1]);
  const auto box_at_first = [&](int t) {
    const geom::Triangle& n = s.triangles[t].nodes;
    return box_of({model.node_position[n[0]], model.node_position[n[1]], model.node_position[n[2]]},
                  margin(work, s.triangles[t]));
  };
  Pairs pairs;
  for (const auto& [i, j] : geom::touching_pairs(boxes)) {
    const int a = active.triangles[begin + i], b = active.triangles[begin + j];
    if ((work.piece[a] != work.piece[b] || apart(box_at_first(a), box_at_first(b))) && !parted(a, b))
      pairs.emplace_back(a, b);
  }
  return pairs;
}

void find_pieces(const Model& model, const State& state, ContactWork& work) {
  const ContactSurface& s = model.surface;
  const std::vector<int> pieces = pieces_of_nodes(model, state);
  work.piece.resize(s.triangles.size());
  work.active.resize(s.triangles.size());
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    work.piece[t] = pieces[s.triangles[t].nodes[0]];
    work.active[t] = static_cast<char>(s.triangles[t].face < 0 || open(state, s.triangles[t].face));
  }
}

// Rows by source with their targets by piece and number, from unordered pairs both ways (springs) or one way (edges).
void make_rows(const Pairs& pairs, std::size_t sources, bool both_ways, const std::vector<int>& piece,
               std::vector<ContactRow>& rows, std::vector<ContactCandidate>& candidates) {
  std::vector<std::int64_t> begin(sources + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++begin[a + 1];
    if (both_ways)
      ++begin[b + 1];
  }
  for (std::size_t i = 1; i <= sources; ++i)
    begin[i] += begin[i - 1];
  candidates.assign(static_cast<std::size_t>(begin.back()), {});
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  for (const auto& [a, b] : pairs) {
    candidates[next[a]++].target = b;
    if (both_ways)
      candidates[next[b]++].target = a;
  }
  rows.clear();
  for (std::size_t i = 0; i < sources; ++i) {
    if (begin[i] == begin[i + 1])
      continue;
    std::sort(candidates.begin() + begin[i], candidates.begin() + begin[i + 1],
              [&](const ContactCandidate& a, const ContactCandidate& b) {
                if (!both_ways || piece[a.target] == piece[b.target])
                  return a.target < b.target;
                return piece[a.target] < piece[b.target];
              });
    rows.push_back({static_cast<int>(i), 0, 0, begin[i], begin[i + 1]});
  }
}

Pairs edge_pairs(const Model& model, const State& state, const ContactWork& work, const Pairs& triangles) {
  const ContactSurface& s = model.surface;
  Pairs pairs;
  const auto box = [&](int edge) {
    const ContactEdge& e = s.edges[edge];
    const geom::Vec3 a = place_of(model, state, e.nodes[0]), b = place_of(model, state, e.nodes[1]);
    return box_of({a, b, b}, margin(work, s.triangles[e.triangles[0]]));
  };
  for (const auto& [a, b] : triangles) {
    const ContactTriangle &one = s.triangles[a], &other = s.triangles[b];
    for (int e = one.edge_begin; e < one.edge_end; ++e)
      for (int f = other.edge_begin; f < other.edge_end; ++f)
        if (!apart(box(e), box(f)))
          pairs.emplace_back(std::min(e, f), std::max(e, f));
  }
  return pairs;
}

// Two blocks without a law: nothing may come of it unless they meet.
void require_apart(const Model& model, const State& state, const Pairs& pairs) {
  const ContactSurface& s = model.surface;
  for (const auto& [a, b] : pairs)
    for (const auto& [source, target] : {std::pair(b, a), std::pair(a, b)}) {
      const ContactTriangle &from = s.triangles[source], &to = s.triangles[target];
      const double near =
          meeting_ratio * std::min(model.blocks[from.block].size, model.blocks[to.block].size);
      const Corners x = corners_of(model, state, to.nodes);
      for (const geom::Vec3& corner : corners_of(model, state, from.nodes))
        if ((corner - weighted(x, geom::nearest_on_triangle(corner, x[0], x[1], x[2]).weights)).norm() <
            near) {
          const auto [first, second] = std::minmax(from.block, to.block);
          const std::string &one = model.bodies[model.blocks[first].body].name,
                            &other = model.bodies[model.blocks[second].body].name;
          throw SolutionError(fmt::format(
              "{} and {} meet near ({:.6g}, {:.6g}, {:.6g}) m and no contact between them is given; add "
              "{{\"{}\", \"{}\", cdem.coulomb{{ friction_angle = ... }}}} to contacts",
              block_name(model, first), block_name(model, second), corner.x(), corner.y(), corner.z(), one,
              other));
        }
    }
}

} // namespace

double depth_limit(const ContactWork& work, const ContactTriangle& a, const ContactTriangle& b) {
  return std::min(depth_of(work, a), depth_of(work, b));
}

void start_contact(const Model& model, ContactWork& work) {
  const ContactSurface& s = model.surface;
  if (s.empty())
    return;
  std::vector<double> heights;
  for (const ContactTriangle& t : s.triangles)
    if (t.face < 0)
      heights.push_back(t.height);
  std::nth_element(heights.begin(), heights.begin() + heights.size() / 2, heights.end());
  work.usual_height = heights[heights.size() / 2];
  work.skin = skin_ratio * work.usual_height;
  work.shallow = shallow_ratio * work.usual_height;
  work.travelled.assign(model.blocks.size(), 0.0);
  work.last_way.assign(model.blocks.size(), 0.0);
  work.stiffness.assign(model.node_position.size(), 0.0);
}

bool search_contacts(const Model& model, const State& state, ContactWork& work, int threads) {
  const ContactSurface& s = model.surface;
  if (work.search_due)
    find_pieces(model, state, work);
  const Active active = active_triangles(model, state, work);
  for (const geom::Box& box : active.boxes)
    if (!box.min.allFinite() || !box.max.allFinite())
      return false;
  std::vector<char> has_surface;
  for (std::size_t b = 0; b + 1 < active.block_begin.size(); ++b)
    has_surface.push_back(static_cast<char>(active.block_begin[b] < active.block_begin[b + 1]));
  const Pairs blocks = geom::touching_pairs(active.block_boxes, has_surface);
  std::vector<int> alone; // blocks that may touch themselves
  for (int b = 0; b + 1 < static_cast<int>(s.block_begin.size()); ++b)
    if (model.blocks[b].meshed && contact_joint(model, b, b))
      alone.push_back(b);
  const Parted parted(model, state, work);
  const auto n_pairs = static_cast<std::int64_t>(blocks.size());
  std::vector<Pairs> springs(blocks.size() + alone.size()), edges(springs.size());
  std::vector<std::string> wrong(springs.size()); // nothing may be thrown out of a parallel loop
  for_chunks(static_cast<std::int64_t>(springs.size()), threads, [&](std::int64_t i) {
    if (i >= n_pairs) {
      springs[i] = pairs_within(model, work, active, parted, alone[i - n_pairs]);
    } else {
      const auto [a, b] = blocks[i];
      if (!model.blocks[a].meshed || !model.blocks[b].meshed)
        return;
      springs[i] = pairs_of_blocks(active, parted, a, b);
      if (!contact_joint(model, a, b)) {
        try {
          require_apart(model, state, springs[i]);
        } catch (const SolutionError& error) {
          wrong[i] = error.what();
        }
        springs[i].clear();
      }
    }
    edges[i] = edge_pairs(model, state, work, springs[i]);
  });
  for (const std::string& message : wrong)
    if (!message.empty())
      throw SolutionError(message);
  const auto gathered = [](const std::vector<Pairs>& parts) {
    Pairs all;
    for (const Pairs& part : parts)
      all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  const Pairs all_springs = gathered(springs);
  make_rows(all_springs, s.triangles.size(), true, work.piece, work.rows[Contact::spring],
            work.candidates[Contact::spring]);
  make_rows(gathered(edges), s.edges.size(), false, work.piece, work.rows[Contact::edge],
            work.candidates[Contact::edge]);
  work.chunks.resize(split(static_cast<std::int64_t>(work.rows[0].size()), contact_rows_per_chunk).size() +
                     split(static_cast<std::int64_t>(work.rows[1].size()), contact_rows_per_chunk).size());
  std::fill(work.travelled.begin(), work.travelled.end(), 0.0);
  work.furthest = 0;
  work.search_due = false;
  ++work.searches;
  work.pairs = static_cast<std::int64_t>(all_springs.size());
  return true;
}

} // namespace cdem
