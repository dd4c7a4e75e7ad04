#include "libcdem/contact/narrow_phase/row_shares.hpp"

#include "libcdem/ranks/shared_state.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {
namespace {

// Work of a row over that of a candidate.
constexpr double row_load = 4;

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

template <class T>
void write(const std::vector<T>& values, std::string& to) {
  const std::size_t count = values.size();
  to.append(reinterpret_cast<const char*>(&count), sizeof count);
  to.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
}

template <class T>
const char* read(const char* from, const T& like, std::vector<T>& values) {
  std::size_t count = 0;
  std::memcpy(&count, from, sizeof count);
  from += sizeof count;
  values.assign(count, like);
  std::memcpy(reinterpret_cast<char*>(values.data()), from, count * sizeof(T));
  return from + count * sizeof(T);
}

} // namespace

void begin_search(State& state, ContactWork& work) {
  if (work.shared)
    work.shared->gather(state);
}

void share_rows(const Model& model, ContactWork& work) {
  if (!work.shared)
    return;
  std::vector<double> loads;
  for (const std::vector<ContactRow>& rows : work.rows)
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (r % contact_rows_per_chunk == 0)
        loads.push_back(0);
      loads.back() += row_load + rows[r].count;
    }
  const Partition& part = work.shared->part();
  work.chunk_begin = even_shares(loads, part.size);
  std::vector<char> read(model.blocks.size(), 0);
  std::int64_t chunk = -1;
  for (std::size_t kind = 0; kind < work.rows.size(); ++kind)
    for (std::size_t r = 0; r < work.rows[kind].size(); ++r) {
      if (r % contact_rows_per_chunk == 0)
        ++chunk;
      ContactRow& row = work.rows[kind][r];
      const int rank = Partition::owner(work.chunk_begin, chunk);
      if (row.rank != rank) {
        if (kind == Contact::spring)
          row.reach = 0;
        row.recheck_distance = row.allowed = 0;
        work.asleep[kind].recheck_distance[r] = 0;
      }
      row.rank = rank;
      if (rank == part.rank)
        read[work.movers.block[row.source_mover]] = read[work.movers.block[row.mover]] = 1;
    }
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

Range own_chunks_of_rows(const ContactWork& work, std::int64_t chunks) {
  if (!work.shared)
    return {0, chunks};
  const int rank = work.shared->part().rank;
  return {work.chunk_begin[rank], work.chunk_begin[rank + 1]};
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

std::vector<ContactChunk> found_by_all(const ContactChunk& own) {
  std::string told(reinterpret_cast<const char*>(&own.sums), sizeof own.sums);
  write(own.contacts, told);
  write(own.forces, told);
  std::vector<ContactChunk> found;
  for (const std::string& heard : ranks().gather(told, Ranks::Subject::contacts)) {
    ContactChunk& of = found.emplace_back();
    std::memcpy(&of.sums, heard.data(), sizeof of.sums);
    read(read(heard.data() + sizeof of.sums, Contact(), of.contacts), ContactForce(), of.forces);
  }
  return found;
}

std::vector<double> of_finders(const ContactWork& work, const std::vector<std::size_t>& contacts,
                               const std::function<double(std::size_t)>& number) {
  std::vector<double> numbers(contacts.size(), 0.0);
  const bool by_all = !work.shared || work.shared->whole();
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
