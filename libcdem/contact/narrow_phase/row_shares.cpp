#include "libcdem/contact/narrow_phase/row_shares.hpp"

#include "libcdem/ranks/bytes.hpp"
#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {
namespace {

void add_surface_nodes(const Model& model, const ContactWork& work, int block,
                       std::vector<std::int32_t>& nodes) {
  const ContactSurface& s = model.surface;
  for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
    if (work.active[t]) {
      nodes.insert(nodes.end(), s.triangles[t].nodes.begin(), s.triangles[t].nodes.end());
      const geom::Tet& tet = model.tets[s.triangles[t].tet];
      nodes.insert(nodes.end(), tet.begin(), tet.end());
    }
}

} // namespace

void begin_search(State& state, ContactWork& work) {
  if (work.shared)
    work.shared->gather_surfaces(state);
}

void read_nodes_of_rows(const Model& model, ContactWork& work) {
  if (!work.shared)
    return;
  std::vector<char> read(model.blocks.size(), 0);
  for (const std::vector<ContactRow>& rows : work.rows)
    for (const ContactRow& row : rows)
      read[work.movers.block[row.source_mover]] = read[work.movers.block[row.mover]] = 1;
  std::vector<std::int32_t> nodes;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    if (block.rigid >= 0 || !block.meshed) // rigid ones are moved by all
      continue;
    if (work.broken[b] || work.restitution)
      for (int node = block.node_begin; node < block.node_end; ++node)
        nodes.push_back(node);
    else if (read[b])
      add_surface_nodes(model, work, static_cast<int>(b), nodes);
  }
  work.shared->set_further_nodes(std::move(nodes));
}

void add_depths(const ContactSums& more, ContactSums& sums) {
  sums.depth = std::max(sums.depth, more.depth);
  sums.depth_over_height = std::max(sums.depth_over_height, more.depth_over_height);
  if (more.deepest > sums.deepest) {
    sums.deepest = more.deepest;
    sums.deepest_source = more.deepest_source;
    sums.deepest_target = more.deepest_target;
  }
}

void append(const ContactChunk& more, ContactChunk& sum) {
  sum.contacts.insert(sum.contacts.end(), more.contacts.begin(), more.contacts.end());
  sum.forces.insert(sum.forces.end(), more.forces.begin(), more.forces.end());
  add_depths(more.sums, sum.sums);
}

std::array<std::vector<ContactChunk>, 2> found_by_all(const std::array<ContactChunk, 2>& own) {
  Pack pack;
  for (const ContactChunk& chunk : own) {
    pack(chunk.sums);
    pack(chunk.contacts);
    pack(chunk.forces);
  }
  std::array<std::vector<ContactChunk>, 2> found;
  for (const std::string& heard : ranks().gather(pack.text(), Ranks::Subject::contacts)) {
    Unpack unpack(heard);
    for (std::vector<ContactChunk>& of_kind : found) {
      ContactChunk& of = of_kind.emplace_back();
      unpack(of.sums);
      unpack(of.contacts);
      unpack(of.forces);
    }
  }
  return found;
}

std::vector<double> of_finders(const ContactWork& work, const std::vector<std::size_t>& contacts,
                               const std::function<double(std::size_t)>& number) {
  std::vector<double> numbers(contacts.size(), 0.0);
  const bool by_all = !work.shared || work.shared->surfaces_whole();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (by_all || work.rank_of_contact[contacts[i]] == work.shared->part().rank)
      numbers[i] = number(contacts[i]);
  if (by_all || contacts.empty())
    return numbers;
  const std::vector<std::string> heard = ranks().gather(
      std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)));
  for (std::size_t i = 0; i < contacts.size(); ++i)
    std::memcpy(&numbers[i], heard[work.rank_of_contact[contacts[i]]].data() + i * sizeof(double),
                sizeof(double));
  return numbers;
}

} // namespace cdem
