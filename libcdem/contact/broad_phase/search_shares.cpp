#include "libcdem/contact/broad_phase/search_shares.hpp"

#include "libcdem/contact/data/row_owner.hpp"
#include "libcdem/ranks/bytes.hpp"
#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>

namespace cdem {
namespace {

// Work of a row over that of a candidate.
constexpr std::int64_t row_load = 4;
// Triangles whose loads are counted together.
constexpr std::int64_t triangles_per_count = 16;

int triangle_of(const SurfaceEdges& edges, Contact::Kind kind, int source) {
  return kind == Contact::spring ? source : edges.all[source].triangles[0];
}

template <class Visit>
void each_near(const FoundNear& found, const Visit& visit) {
  for (const Contact::Kind kind : {Contact::spring, Contact::edge})
    for (const std::vector<Near>& part : kind == Contact::spring ? found.springs : found.edges)
      for (const Near& near : part)
        visit(kind, near);
}

void cut_sources(const Model& model, ContactWork& work, const FoundNear& found) {
  const auto triangles = static_cast<std::int64_t>(model.surface.triangles.size());
  std::vector<std::int64_t> counts(
      static_cast<std::size_t>((triangles + triangles_per_count - 1) / triangles_per_count), 0);
  int source = -1, fragment = -1;
  each_near(found, [&](Contact::Kind kind, const Near& near) {
    const int from = triangle_of(work.edges, kind, near.source),
              to = triangle_of(work.edges, kind, static_cast<int>(near.target)),
              of = work.fragments.of_triangle[to];
    const bool of_row = near.source == source && of == fragment;
    counts[triangle_of_row(model, from, to) / triangles_per_count] += of_row ? 1 : 1 + row_load;
    source = near.source;
    fragment = of;
  });
  ranks().sum(counts.data(), counts.size());
  work.triangle_begin =
      even_shares(std::vector<double>(counts.begin(), counts.end()), work.shared->part().size);
  for (std::int64_t& begin : work.triangle_begin)
    begin = std::min(begin * triangles_per_count, triangles);
}

} // namespace

std::vector<std::int64_t> own_share(const ContactWork& work, const std::vector<double>& load) {
  std::vector<std::int64_t> items(load.size());
  std::iota(items.begin(), items.end(), std::int64_t{0});
  std::stable_sort(items.begin(), items.end(),
                   [&](std::int64_t a, std::int64_t b) { return load[a] > load[b]; });
  const Partition& part = work.shared->part();
  using Laden = std::pair<double, int>; // load, rank
  std::priority_queue<Laden, std::vector<Laden>, std::greater<>> least;
  for (int rank = 0; rank < part.size; ++rank)
    least.emplace(0, rank);
  std::vector<std::int64_t> own;
  for (const std::int64_t item : items) {
    const auto [before, rank] = least.top();
    least.pop();
    least.emplace(before + load[item], rank);
    if (rank == part.rank)
      own.push_back(item);
  }
  std::sort(own.begin(), own.end());
  return own;
}

double near_triangles_of(const ActiveSurface& active, int a, int b) {
  const geom::Box &one = active.block_boxes[a], &other = active.block_boxes[b];
  const auto triangles_in = [&](int block, const geom::Box& box) {
    double part = active.block_begin[block + 1] - active.block_begin[block];
    for (int axis = 0; axis < 3; ++axis)
      if (const double size = box.max[axis] - box.min[axis]; size > 0)
        part *= std::clamp(
            (std::min(one.max[axis], other.max[axis]) - std::max(one.min[axis], other.min[axis])) / size, 0.0,
            1.0);
    return part;
  };
  return triangles_in(a, one) + triangles_in(b, other);
}

void share_found(const Model& model, ContactWork& work, bool all, FoundNear& found) {
  if (work.shared->alone())
    return;
  if (all)
    cut_sources(model, work, found);
  const Partition& part = work.shared->part();
  std::vector<std::array<std::vector<Near>, 2>> to(static_cast<std::size_t>(part.size));
  each_near(found, [&](Contact::Kind kind, const Near& near) {
    to[owner_of_row(model, work, triangle_of(work.edges, kind, near.source),
                    triangle_of(work.edges, kind, static_cast<int>(near.target)))][kind]
        .push_back(near);
  });
  std::vector<std::string> told;
  for (const auto& kinds : to) {
    Pack pack;
    pack(kinds[Contact::spring]);
    pack(kinds[Contact::edge]);
    told.push_back(pack.text());
  }
  found.springs.clear();
  found.edges.clear();
  for (const std::string& heard : ranks().deal(told)) {
    Unpack unpack(heard);
    unpack(found.springs.emplace_back());
    unpack(found.edges.emplace_back());
  }
  double nearest = -found.may_go;
  ranks().largest(&nearest, 1);
  found.may_go = -nearest;
  Pack pack;
  pack(std::vector<char>(found.wrong.begin(), found.wrong.end()));
  found.wrong.clear();
  for (const std::string& heard : ranks().gather(pack.text())) {
    Unpack unpack(heard);
    std::vector<char> wrong_there;
    unpack(wrong_there);
    if (found.wrong.empty())
      found.wrong.assign(wrong_there.begin(), wrong_there.end());
  }
}

} // namespace cdem
