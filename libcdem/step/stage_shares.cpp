#include "libcdem/step/stage_shares.hpp"

#include "libcdem/parallel/residency.hpp"
#include "libcdem/ranks/parked_model.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace cdem {
namespace {

// The largest load of a rank over the mean from which on chunks are shared anew.
constexpr double uneven = 1.1;

// Per rank, in parts of all.
std::vector<double> shares_of_load(const std::vector<double>& load, const std::vector<std::int64_t>& begin) {
  const double all = std::accumulate(load.begin(), load.end(), 0.0);
  std::vector<double> shares;
  for (std::size_t rank = 0; rank + 1 < begin.size(); ++rank) {
    const double own = std::accumulate(load.begin() + begin[rank], load.begin() + begin[rank + 1], 0.0);
    shares.push_back(all > 0 ? own / all : 1.0 / static_cast<double>(begin.size() - 1));
  }
  return shares;
}

// "61, 39 %"; of many ranks "64 ranks, the largest 1.08 of the mean".
std::string in_words(const std::vector<double>& shares) {
  constexpr std::size_t most_named = 8;
  const double most = *std::max_element(shares.begin(), shares.end());
  if (shares.size() > most_named)
    return fmt::format("{} ranks, the largest {:.2f} of the mean", shares.size(),
                       most * static_cast<double>(shares.size()));
  std::string text;
  for (const double share : shares)
    text += fmt::format("{}{:.0f}", text.empty() ? "" : ", ", 100 * share);
  return text + " %";
}

// Corners of faces in water that belong to several chunks: whoever owns one reads all.
void add_nodes_in_water(const Model& model, const ResolvedFlow& flow, std::vector<std::int32_t>& nodes) {
  const auto chunk_of = [&](int node) {
    return std::upper_bound(model.chunks.begin(), model.chunks.end(), node,
                            [](int n, const BlockChunk& chunk) { return n < chunk.nodes.begin; });
  };
  const auto add = [&](const geom::Triangle& corners) {
    if (chunk_of(corners[0]) != chunk_of(corners[1]) || chunk_of(corners[0]) != chunk_of(corners[2]))
      nodes.insert(nodes.end(), corners.begin(), corners.end());
  };
  std::vector<char> meets(model.blocks.size(), 0);
  for (const BlockInWater& in_water : flow.in_water)
    meets[in_water.asked.block] = 1;
  for (const BlockInWater& in_water : flow.in_water) { // wet volumes around nodes
    const Block& block = model.blocks[in_water.asked.block];
    for (int t = block.tet_begin; in_water.inertia && t < block.tet_end; ++t) {
      const geom::Tet& tet = model.tets[t];
      add({tet[0], tet[1], tet[2]});
      add({tet[0], tet[1], tet[3]});
      add({tet[2], tet[3], tet[0]});
    }
    for (const std::vector<geom::Triangle>& cavity : in_water.cavities)
      for (const geom::Triangle& corners : cavity)
        nodes.insert(nodes.end(), corners.begin(), corners.end());
  }
  for (const int f : flow.faces)
    if (const int boundary = model.outer_faces[f].boundary; boundary >= 0)
      add(model.mesh.boundary[boundary].nodes);
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!meets[chunk.block] || chunk.stars)
      return;
    const FaceNodes pair = face_nodes(model.mesh, chunk, batch, lane);
    add(pair.a);
    add(pair.b);
  });
}

// Nodes that loads need of whichever rank.
std::vector<std::int32_t> nodes_of_loads(const Model& model, const ResolvedConditions& r) {
  std::vector<std::int32_t> nodes;
  for (const ResolvedFlow& flow : r.flows)
    if (flow.water)
      add_nodes_in_water(model, flow, nodes);
  for (const ResolvedBolt& bolt : r.bolts)
    for (const RockPlace& at : bolt.at)
      if (at.inside)
        nodes.insert(nodes.end(), at.nodes.begin(), at.nodes.end());
  return nodes;
}

} // namespace

StageShares::StageShares(const StageContext& context, Workspace& work) : context_(context), work_(work) {
  warn_of_idle();
}

void StageShares::share(const std::vector<Node>* moving) {
  if (ranks().alone()) {
    work_.share(std::make_shared<SharedState>(context_.model));
    return;
  }
  if (gave_back_) { // loads on nodes that others owned
    ResolvedConditions whole = resolve(context_.model, context_.state, context_.conditions);
    work_.resolved.external = std::move(whole.external);
    work_.resolved.constant = std::move(whole.constant);
    update_external(work_.resolved, context_.state.time, moving);
    gave_back_ = false;
  }
  const Range all{0, static_cast<std::int64_t>(context_.model.chunks.size())};
  const std::vector<double> loads = chunk_loads(context_.model, context_.state, all);
  work_.share(
      std::make_shared<SharedState>(context_.model, nodes_of_loads(context_.model, work_.resolved), loads));
  loads_ = in_words(shares_of_load(loads, work_.part().chunk_begin));
}

void StageShares::warn_of_idle() const {
  static bool told = false; // once is enough
  const auto chunks = static_cast<int>(context_.model.chunks.size()), idle = ranks().size() - chunks;
  if (told || idle <= 0)
    return;
  told = true;
  context_.observer.warning_of_machine(
      fmt::format("warning: the model has {} chunk{} for {} ranks: {} of them {} no elements to compute",
                  chunks, chunks == 1 ? "" : "s", ranks().size(), idle, idle == 1 ? "has" : "have"));
}

// A body that breaks on one side costs more there.
bool StageShares::count_loads() {
  if (ranks().alone())
    return false;
  const Partition& part = work_.part();
  const std::vector<double> own = chunk_loads(context_.model, context_.state, part.chunks());
  std::vector<double> loads(context_.model.chunks.size());
  std::copy(own.begin(), own.end(), loads.begin() + part.chunks().begin);
  std::vector<std::size_t> bytes;
  for (const std::int64_t chunk : part.chunk_begin)
    bytes.push_back(static_cast<std::size_t>(chunk) * sizeof(double));
  ranks().share(loads.data(), bytes);
  loads_ = in_words(shares_of_load(loads, part.chunk_begin));
  const double now = imbalance(loads, part.chunk_begin);
  return now >= uneven && imbalance(loads, even_shares(loads, part.size)) <= 0.5 * (1 + now);
}

// The shares of others that it reads are found anew with the contacts.
void StageShares::share_anew(const std::vector<Node>* moving, const StageStep& here) {
  const std::string before = loads_;
  share(moving);
  work_.contact.search.fragments_due = work_.contact.search.all_due = true;
  ++shared_anew_;
  context_.observer.message(
      fmt::format("stage {} {}, step {}: chunks are shared anew, loads of the ranks {} before, {} now",
                  here.stage, here.kind, here.step, before, loads_));
}

void StageShares::give_back() {
  if (ranks().alone() || gave_back_)
    return;
  gave_back_ = true;
  park(context_.model, work_.shared->shares());
  for (std::vector<Node>* of_nodes : {&work_.resolved.external, &work_.resolved.constant})
    release_outside(*of_nodes, work_.shared->shares().kept_nodes());
  release_zeros(work_.partial);
  release_zeros(work_.contact.loads.force);
  release_zeros(work_.contact.loads.stiffness);
  trim_heap(); // what building and looking at the whole has left
}

void StageShares::gather(BondWork& bond) const {
  for (std::vector<geom::Vec3>* of_points : {&bond.spring_force, &bond.stretch, &bond.viscous})
    work_.shared->shares().gather_points(*of_points);
}

void StageShares::add_to(Progress& progress) const {
  if (shared_anew_ > 0)
    progress.times = fmt::format("; chunks shared anew: {}", shared_anew_);
  if (!loads_.empty())
    progress.note += (progress.note.empty() ? "" : ", ") + ("loads of the ranks " + loads_);
}

} // namespace cdem
