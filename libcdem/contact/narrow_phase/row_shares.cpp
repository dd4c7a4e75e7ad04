#include "libcdem/contact/narrow_phase/row_shares.hpp"

#include "libcdem/contact/broad_phase/movers.hpp"
#include "libcdem/ranks/bytes.hpp"
#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {
namespace {

// What a rank reads of surfaces: nodes of triangles and of the tets behind them.
class NodesRead {
public:
  NodesRead(const Model& model, const ContactWork& work) : model_(model), work_(work), s_(model.surface) {}

  void add_block(int block) {
    for (int node = model_.blocks[block].node_begin; node < model_.blocks[block].node_end; ++node)
      nodes_.push_back(node);
  }
  void add_surface(int block) {
    for (int t = s_.block_begin[block]; t < s_.block_begin[block + 1]; ++t)
      if (work_.active[t])
        add_triangle(t);
  }
  // Adds the nodes of the block's movers for which `read` holds, and of the edges on them: an edge may separate two
  // movers.
  template <class Read>
  void add_movers(int block, const Read& read) {
    const auto reads = [&](int t) { return read(work_.movers.of_triangle[t]); };
    for (int t = s_.block_begin[block]; t < s_.block_begin[block + 1]; ++t) {
      if (work_.active[t] && reads(t))
        add_triangle(t);
      for (int e = work_.edge_begin[t]; e < work_.edge_begin[t + 1]; ++e)
        if (const auto& sides = work_.edges[e].triangles; reads(sides[0]) || reads(sides[1])) {
          add_triangle(sides[0]);
          add_triangle(sides[1]);
        }
    }
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
  const ContactWork& work_;
  const ContactSurface& s_;
  std::vector<std::int32_t> nodes_;
};

} // namespace

void begin_search(State& state, ContactWork& work) {
  if (work.shared)
    work.shared->gather_surfaces(state);
}

void read_nodes_of_rows(const Model& model, ContactWork& work) {
  if (!work.shared)
    return;
  const auto blocks = static_cast<int>(model.blocks.size());
  std::vector<char> read(model.blocks.size(), 0), mover_read(work.movers.count(), 0);
  for (const std::vector<ContactRow>& rows : work.rows)
    for (const ContactRow& row : rows)
      for (const int mover : {row.source_mover, row.mover})
        read[work.movers.block[mover]] = mover_read[mover] = 1;
  for (int m = blocks; m < work.movers.count(); ++m)
    if (rank_of_fragment(work, m - blocks) == work.shared->part().rank)
      mover_read[m] = 1;
  NodesRead nodes(model, work);
  for (int b = 0; b < blocks; ++b) {
    const Block& block = model.blocks[b];
    if (block.rigid >= 0 || !block.meshed) // rigid ones are moved by all
      continue;
    if (work.restitution)
      nodes.add_block(b);
    else if (work.broken[b])
      nodes.add_movers(b, [&](int mover) { return mover_read[mover] != 0; });
    else if (read[b])
      nodes.add_surface(b);
  }
  work.shared->set_further_nodes(nodes.take());
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
