#include "libcdem/contact/narrow_phase/row_shares.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/data/row_owner.hpp"
#include "libcdem/contact/narrow_phase/rows_asleep.hpp"
#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <utility>

namespace cdem {
namespace {

// What a rank reads of surfaces: nodes of triangles and of the tets behind them.
class NodesRead {
public:
  NodesRead(const Model& model, const ContactFragments& fragments)
      : model_(model), fragments_(fragments), s_(model.surface) {}

  void add_block(int block) {
    for (int node = model_.blocks[block].node_begin; node < model_.blocks[block].node_end; ++node)
      nodes_.push_back(node);
  }
  void add_surface(int block) {
    for (int t = s_.block_begin[block]; t < s_.block_begin[block + 1]; ++t)
      if (fragments_.active[t])
        add_triangle(t);
  }
  std::vector<std::int32_t> take() { return std::move(nodes_); }

private:
  void add_triangle(int t) {
    const geom::Triangle& corners = s_.triangles[t].nodes;
    nodes_.insert(nodes_.end(), corners.begin(), corners.end());
    const geom::Tet& tet = model_.tets[s_.triangles[t].tet];
    nodes_.insert(nodes_.end(), tet.begin(), tet.end());
  }

  const Model& model_;
  const ContactFragments& fragments_;
  const ContactSurface& s_;
  std::vector<std::int32_t> nodes_;
};

} // namespace

void begin_search(State& state, ContactWork& work) {
  work.shared->gather_surfaces(state);
  work.shared->gather_contacts(state);
}

void read_nodes_of_rows(const Model& model, ContactWork& work) {
  if (work.shared->alone())
    return;
  const auto blocks = static_cast<int>(model.blocks.size());
  std::vector<char> read(model.blocks.size(), 0);
  for (const ContactRows& rows : work.rows)
    for (const ContactRow& row : rows.all) {
      read[row.source_block] = 1;
      each_target_block(model, work, row, [&](int block) { read[block] = 1; });
    }
  NodesRead nodes(model, work.fragments);
  std::vector<int> rigid;
  for (int b = 0; b < blocks; ++b) {
    const Block& block = model.blocks[b];
    if (!block.meshed)
      continue;
    if (block.rigid >= 0) { // placed here
      if (read[b])
        rigid.push_back(block.rigid);
      continue;
    }
    if (work.knows_motions ||
        touches_itself(model, work.fragments, b)) // each rank finds all its pairs of tetrahedra
      nodes.add_block(b);
    else if (read[b])
      nodes.add_surface(b);
  }
  work.shared->set_further_nodes(nodes.take());
  work.shared->set_further_bodies(std::move(rigid));
}

void keep_own_contacts(const Model& model, State& state, ContactWork& work) {
  if (work.shared->alone() || !work.shared->contacts_whole())
    return;
  const auto of_others = [&](const Contact& c) {
    return is_told_by_sums(model, c) && !keeps(model, work, c);
  };
  std::vector<Contact>& all = state.contacts;
  all.erase(std::remove_if(all.begin(), all.end(), of_others), all.end());
}

} // namespace cdem
