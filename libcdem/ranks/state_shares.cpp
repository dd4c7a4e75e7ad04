#include "libcdem/ranks/state_shares.hpp"

#include "libcdem/parallel/residency.hpp"
#include "libcdem/ranks/looks.hpp"
#include "libcdem/ranks/ranks.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace cdem {
namespace {

std::vector<std::size_t> in_bytes(const std::vector<std::int64_t>& begin, std::size_t entry) {
  std::vector<std::size_t> bytes;
  bytes.reserve(begin.size());
  for (const std::int64_t item : begin)
    bytes.push_back(static_cast<std::size_t>(item) * entry);
  return bytes;
}

// Own nodes and those of rigid bodies, as ascending runs.
std::vector<Range> nodes_kept(const Model& model, Range own) {
  std::vector<Range> all{own};
  for (const RigidBody& body : model.rigid)
    all.push_back({model.blocks[body.block].node_begin, model.blocks[body.block].node_end});
  std::sort(all.begin(), all.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  std::vector<Range> runs;
  for (const Range& run : all)
    if (!runs.empty() && run.begin <= runs.back().end)
      runs.back().end = std::max(runs.back().end, run.end);
    else
      runs.push_back(run);
  return runs;
}

// The first tet of each rank's chunks, and the end of the last one's.
std::vector<std::int64_t> first_tets(const Model& model, const Partition& part) {
  std::vector<std::int64_t> tets =
      along_mesh_chunks(model, part, static_cast<std::int64_t>(model.tets.size()),
                        [](const MeshChunk& chunk) { return chunk.tets.begin; });
  for (std::size_t rank = 0; rank < tets.size(); ++rank)
    if (const std::int64_t chunk = part.chunk_begin[rank]; chunk < part.stars)
      tets[rank] = model.blocks[model.chunks[chunk].blocks.begin].tet_begin;
  return tets;
}

} // namespace

const std::vector<std::int64_t>& StateShares::begin_of(FieldPlace place) const {
  switch (place) {
  case FieldPlace::node:
    return nodes_;
  case FieldPlace::bond:
    return points_;
  case FieldPlace::tet_batch:
    return batches_;
  default:
    assert(place == FieldPlace::face_batch || place == FieldPlace::face);
    return faces_;
  }
}

// visit(first entry of each rank, numbers of the array for each of those, the array in each state): the fields of which
// the table says so.
template <class Visit, class... S>
void StateShares::each_shared(std::initializer_list<FieldShared> as, const Visit& visit, S&... s) const {
  each_field(
      [&](const FieldRow& row, auto&... field) {
        if constexpr ((is_array<decltype(field)> && ...))
          if (std::find(as.begin(), as.end(), row.shared) != as.end())
            visit(begin_of(row.place), row.place == FieldPlace::face ? lanes : 1, field...);
      },
      s...);
}

template <class Visit, class... S>
void StateShares::each_motion(const Visit& visit, S&... s) const {
  each_shared({FieldShared::motion}, visit, s...);
}
template <class Visit, class... S>
void StateShares::each_large(const Visit& visit, S&... s) const {
  each_shared({FieldShared::motion, FieldShared::large}, visit, s...);
}
template <class Visit, class... S>
void StateShares::each_small(const Visit& visit, S&... s) const {
  each_shared({FieldShared::small}, visit, s...);
}

StateShares::StateShares(const Model& model, const Partition& part)
    : rank_(part.rank), size_(part.size), nodes_(part.node_begin) {
  for (const std::int64_t chunk : part.point_begin)
    points_.push_back(chunk < static_cast<std::int64_t>(model.point_chunks.size())
                          ? model.point_chunks[chunk].begin
                          : static_cast<std::int64_t>(model.points.size()));
  const MeshData& mesh = model.mesh;
  tets_ = first_tets(model, part);
  batches_ = along_mesh_chunks(model, part, static_cast<std::int64_t>(mesh.batches.size()),
                               [](const MeshChunk& chunk) { return chunk.batches.begin; });
  faces_ = along_mesh_chunks(model, part, static_cast<std::int64_t>(mesh.faces.size()),
                             [](const MeshChunk& chunk) { return chunk.face_batches.begin; });
  kept_nodes_ = nodes_kept(model, nodes());
  if (!model.rigid.empty())
    for (const ContactTriangle& triangle : model.surface.triangles)
      is_rigid_.push_back(static_cast<char>(model.blocks[triangle.block].rigid >= 0));
}

void StateShares::gather(void* data, const std::vector<std::int64_t>& begin, std::size_t bytes,
                         std::size_t entry) const {
  if (bytes > 0)
    ranks().share(data, in_bytes(begin, entry));
}

void StateShares::gather_on_lead(void* data, const std::vector<std::int64_t>& begin, std::size_t bytes,
                                 std::size_t entry) const {
  if (bytes == 0)
    return;
  const std::vector<std::size_t> at = in_bytes(begin, entry);
  const auto part_of = [&](int rank, int other) {
    return Ranks::Parcel{other, static_cast<char*>(data) + at[rank], at[rank + 1] - at[rank]};
  };
  std::vector<Ranks::Parcel> send, receive;
  if (rank_ > 0)
    send.push_back(part_of(rank_, 0));
  else
    for (int r = 1; r < size_; ++r)
      receive.push_back(part_of(r, r));
  ranks().exchange(send, receive);
}

void StateShares::gather(State& state) const {
  filled_ = true;
  const auto visit = [&](const std::vector<std::int64_t>& begin, std::size_t entries, auto& values) {
    gather(values, begin, entries);
  };
  each_large(visit, state);
  each_small(visit, state);
  gather_slips(state);
}

bool StateShares::is_told(const Contact& c) const {
  if (c.kind == Contact::tets)
    return false;
  const auto [source, target] = triangles_of(c);
  return is_rigid_[source] && is_rigid_[target];
}

std::string StateShares::own_contacts(const State& state) const {
  std::string text;
  for (const Contact& c : state.contacts)
    if (is_told(c))
      text.append(reinterpret_cast<const char*>(&c), sizeof c);
  return text;
}

// All others have been there all the time, in the order of one process: where nodes have just been freed, several may have
// one key until a search tells the pieces apart.
void StateShares::add_contacts(const std::vector<std::string>& told, State& state) const {
  std::vector<Contact>& all = state.contacts;
  for (const std::string& text : told) {
    const std::size_t before = all.size();
    all.resize(before + text.size() / sizeof(Contact));
    std::memcpy(static_cast<void*>(all.data() + before), text.data(), text.size());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  all.erase(std::unique(all.begin(), all.end(),
                        [&](const Contact& a, const Contact& b) { return is_told(a) && key(a) == key(b); }),
            all.end());
}

void StateShares::gather_contacts(State& state) const {
  if (!is_rigid_.empty())
    add_contacts(ranks().gather(own_contacts(state)), state);
}

void StateShares::gather_on_lead(State& state) const {
  if (size_ == 1)
    return;
  filled_ = true;
  const auto visit = [&](const std::vector<std::int64_t>& begin, std::size_t entries, auto& values) {
    gather_on_lead(values.data(), begin, values.size() * sizeof values[0], entries * sizeof values[0]);
  };
  each_large(visit, state);
  each_small(visit, state);
  gather_slips(state);
  if (is_rigid_.empty())
    return;
  std::vector<std::string> to(static_cast<std::size_t>(size_));
  to[0] = own_contacts(state);
  if (const std::vector<std::string> told = ranks().deal(to); rank_ == 0)
    add_contacts(told, state);
}

// They stand in the order in which faces broke, the same for all; their faces say whose they are.
void StateShares::gather_slips(State& state) const {
  if (state.face_slip.empty())
    return;
  constexpr std::size_t bytes = sizeof(FaceSlipBatch);
  const auto each = [&](int rank, const auto& visit) {
    for (std::int64_t b = faces_[rank]; b < faces_[rank + 1]; ++b)
      if (const std::int32_t place = state.faces[b].slip; place >= 0)
        visit(&state.face_slip[place]);
  };
  std::string own;
  each(rank_, [&](const FaceSlipBatch* slips) { own.append(reinterpret_cast<const char*>(slips), bytes); });
  const std::vector<std::string> all = ranks().gather(own);
  for (int r = 0; r < size_; ++r) {
    if (r == rank_)
      continue;
    const char* from = all[r].data();
    each(r, [&](FaceSlipBatch* slips) {
      std::memcpy(reinterpret_cast<char*>(slips), from, bytes);
      from += bytes;
    });
  }
}

void StateShares::gather_surfaces(State& state) const {
  const auto visit = [&](const std::vector<std::int64_t>& begin, int, auto& values) {
    gather(values, begin);
  };
  each_motion(visit, state);
  each_small(visit, state);
}

void StateShares::release(State& state) const {
  release_motion(state);
  each_large(
      [&](const std::vector<std::int64_t>& begin, std::int64_t entries, auto& values) {
        const Range mine = own(begin);
        if (&begin != &nodes_)
          release_outside(values, {{mine.begin * entries, mine.end * entries}});
      },
      state);
}

void StateShares::release_motion(State& state) const {
  each_motion([&](const auto&, int, auto& values) { release_outside(values, kept_nodes_); }, state);
}

void StateShares::copy(State& from, State& to) const {
  // The large arrays stand aside while the rest is copied.
  struct Aside {
    const StateShares& shares;
    State &state, arrays;
    void swap() {
      shares.each_large([](const auto&, int, auto& a, auto& b) { std::swap(a, b); }, state, arrays);
    }
    Aside(const StateShares& of, State& s) : shares(of), state(s) { swap(); }
    ~Aside() { swap(); }
    Aside(const Aside&) = delete;
    Aside& operator=(const Aside&) = delete;
  };
  {
    const Aside of_from(*this, from), of_to(*this, to);
    to = from;
  }
  each_large(
      [&](const std::vector<std::int64_t>& begin, std::int64_t entries, auto& a, auto& b) {
        const Range mine = own(begin);
        copy(a, b, {mine.begin * entries, mine.end * entries});
      },
      from, to);
  release(to); // it may have been whole
}

void make_whole(State& state) {
  const std::shared_ptr<const StateShares> shares = state.parted;
  if (!shares)
    return;
  agree_on_look(Look::state);
  shares->gather(state);
  shares->gather_contacts(state);
  state.parted.reset();
}

} // namespace cdem
