#include "libcdem/contact/field/field_search.hpp"

#include "libcdem/contact/field/field_places.hpp"

#include <algorithm>
#include <tuple>

namespace cdem::field {
namespace {

struct Boxed {
  geom::Box box;
  Contact::Kind kind = Contact::spring;
  int index = 0;
};

bool by_left_side(const Boxed& a, const Boxed& b) {
  return std::tuple(a.box.min.x(), a.kind, a.index) < std::tuple(b.box.min.x(), b.kind, b.index);
}

std::vector<Boxed> sources_in(const Model& model, const State& state, const ContactWork& work,
                              const TakingPart& active, int block, const geom::Box& shared) {
  std::vector<Boxed> found;
  const auto add = [&](const geom::Box& bare, Contact::Kind kind, int index) {
    const geom::Box box = grown(bare, work.skin[block]);
    if (!apart(box, shared))
      found.push_back({box, kind, index});
  };
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i)
    add(box_of(active.facets[i].x, 0), Contact::spring, active.triangles[i]);
  const std::vector<ContactEdge>& edges = model.surface.edges;
  const auto of_block = [&](const ContactEdge& e) { return model.surface.triangles[e.triangles[0]].block; };
  auto edge = std::partition_point(edges.begin(), edges.end(),
                                   [&](const ContactEdge& e) { return of_block(e) < block; });
  for (; edge != edges.end() && of_block(*edge) == block; ++edge) {
    geom::Box box;
    for (const int node : edge->nodes)
      box.extend(place_of(model, state, node));
    add(box, Contact::edge, static_cast<int>(edge - edges.begin()));
  }
  return found;
}

std::vector<Boxed> cells_in(const Model& model, const State& state, const ContactWork& work, int block,
                            const geom::Box& shared) {
  std::vector<Boxed> found;
  for (int c = model.field.cell_begin[block]; c < model.field.cell_begin[block + 1]; ++c) {
    geom::Box box;
    for (const int node : model.field.cells[c].nodes)
      box.extend(field_place(model, state, node));
    box = grown(box, work.skin[block]);
    if (!apart(box, shared))
      found.push_back({box, Contact::spring, c});
  }
  return found;
}

} // namespace

std::vector<NearCell> near_cells(const Model& model, const State& state, const ContactWork& work,
                                 const TakingPart& active, int block_a, int block_b) {
  std::vector<NearCell> near;
  geom::Box shared;
  shared.min = grown(active.outlines[block_a], work.skin[block_a])
                   .min.cwiseMax(grown(active.outlines[block_b], work.skin[block_b]).min);
  shared.max = grown(active.outlines[block_a], work.skin[block_a])
                   .max.cwiseMin(grown(active.outlines[block_b], work.skin[block_b]).max);
  if ((shared.min.array() > shared.max.array()).any())
    return near;
  for (const auto& [from, to] : {std::pair(block_a, block_b), std::pair(block_b, block_a)}) {
    std::vector<Boxed> sources = sources_in(model, state, work, active, from, shared),
                       cells = cells_in(model, state, work, to, shared);
    std::sort(sources.begin(), sources.end(), by_left_side);
    std::sort(cells.begin(), cells.end(), by_left_side);
    // Both lists are swept from left to right; what has ended to the left of all that follow is dropped.
    std::vector<std::size_t> open;
    std::size_t next = 0;
    for (const Boxed& source : sources) {
      for (; next < cells.size() && cells[next].box.min.x() <= source.box.max.x(); ++next)
        open.push_back(next);
      open.erase(std::remove_if(open.begin(), open.end(),
                                [&](std::size_t c) { return cells[c].box.max.x() < source.box.min.x(); }),
                 open.end());
      for (const std::size_t c : open)
        if (!apart(source.box, cells[c].box))
          near.push_back({source.kind, source.index, to, cells[c].index});
    }
  }
  return near;
}

void make_field_rows(const Model& model, const std::vector<std::vector<NearCell>>& parts, ContactWork& work) {
  std::vector<NearCell> all;
  std::size_t count = 0;
  for (const std::vector<NearCell>& part : parts)
    count += part.size();
  all.reserve(count);
  for (const std::vector<NearCell>& part : parts)
    all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const NearCell& a, const NearCell& b) {
    return std::tuple(a.kind, a.source, a.block, a.cell) < std::tuple(b.kind, b.source, b.block, b.cell);
  });
  work.field_rows.clear();
  work.field_candidates.clear();
  work.field_near.assign(model.blocks.size(), 0);
  for (const NearCell& near : all) {
    FieldRow* row = work.field_rows.empty() ? nullptr : &work.field_rows.back();
    if (!row || row->kind != near.kind || row->source != near.source || row->block != near.block) {
      work.field_rows.push_back({near.kind, near.source, near.block,
                                 static_cast<std::uint32_t>(work.field_candidates.size()), 0, 0});
      row = &work.field_rows.back();
      const int triangle =
          near.kind == Contact::edge ? model.surface.edges[near.source].triangles[0] : near.source;
      work.field_near[near.block] = work.field_near[model.surface.triangles[triangle].block] = 1;
    }
    work.field_candidates.push_back({near.cell, 0});
    ++row->count;
  }
}

} // namespace cdem::field
