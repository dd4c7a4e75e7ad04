#include "libcdem/contact/narrow_phase/row_shares.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/data/row_owner.hpp"
#include "libcdem/contact/narrow_phase/rows_asleep.hpp"
#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <utility>

namespace cdem {
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
  const ContactSurface& s = model.surface;
  std::vector<std::int32_t> nodes;
  const auto add_surface = [&](int block) { // of its active triangles, and of the tets behind them
    for (int t = s.block_begin[block]; t < s.block_begin[block + 1]; ++t)
      if (work.fragments.active[t]) {
        const geom::Triangle& corners = s.triangles[t].nodes;
        const geom::Tet& tet = model.tets[s.triangles[t].tet];
        nodes.insert(nodes.end(), corners.begin(), corners.end());
        nodes.insert(nodes.end(), tet.begin(), tet.end());
      }
  };
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
        touches_itself(model, work.fragments, b)) { // each rank finds all its pairs of tetrahedra
      for (int node = block.node_begin; node < block.node_end; ++node)
        nodes.push_back(node);
    } else if (read[b]) {
      add_surface(b);
    }
  }
  work.shared->set_further_nodes(std::move(nodes));
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
