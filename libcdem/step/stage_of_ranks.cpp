// A stage among several ranks: which chunks are whose, who keeps what of the State, when all of it is gathered.
#include "libcdem/parallel/residency.hpp"
#include "libcdem/ranks/parked_model.hpp"
#include "libcdem/results/earlier_log.hpp"
#include "libcdem/step/stage.hpp"

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

// Nodes that loads need of whichever rank.
std::vector<std::int32_t> nodes_of_bolts(const ResolvedConditions& r) {
  std::vector<std::int32_t> nodes;
  for (const ResolvedBolt& bolt : r.bolts)
    for (const RockPlace& at : bolt.at)
      if (at.inside)
        nodes.insert(nodes.end(), at.nodes.begin(), at.nodes.end());
  return nodes;
}

} // namespace

void Stage::share() {
  if (ranks().alone()) {
    work.share(std::make_shared<SharedState>(context_.model));
    return;
  }
  if (gave_back_) { // loads on nodes that others owned
    ResolvedConditions whole = resolve(context_.model, context_.state, context_.conditions);
    work.resolved.external = std::move(whole.external);
    work.resolved.constant = std::move(whole.constant);
    update_external(work.resolved, context_.state.time, moving());
    gave_back_ = false;
  }
  const Range all{0, static_cast<std::int64_t>(context_.model.chunks.size())};
  const std::vector<double> loads = chunk_loads(context_.model, context_.state, all);
  work.share(std::make_shared<SharedState>(context_.model, nodes_of_bolts(work.resolved), loads));
  loads_ = in_words(shares_of_load(loads, work.part().chunk_begin));
}

void Stage::warn_of_idle_ranks() const {
  static bool told = false; // once is enough
  const auto chunks = static_cast<int>(context_.model.chunks.size()), idle = ranks().size() - chunks;
  if (told || idle <= 0)
    return;
  told = true;
  context_.observer.warning_of_machine(
      fmt::format("warning: the model has {} chunk{} for {} ranks: {} of them {} no elements to compute",
                  chunks, chunks == 1 ? "" : "s", ranks().size(), idle, idle == 1 ? "has" : "have"));
}

// A body that breaks on one side costs more there. What is read of others is found anew with the contacts.
void Stage::share_anew() {
  if (ranks().alone())
    return;
  const Partition& part = work.part();
  const std::vector<double> own = chunk_loads(context_.model, context_.state, part.chunks());
  std::vector<double> loads(context_.model.chunks.size());
  std::copy(own.begin(), own.end(), loads.begin() + part.chunks().begin);
  std::vector<std::size_t> bytes;
  for (const std::int64_t chunk : part.chunk_begin)
    bytes.push_back(static_cast<std::size_t>(chunk) * sizeof(double));
  ranks().share(loads.data(), bytes);
  loads_ = in_words(shares_of_load(loads, part.chunk_begin));
  const double now = imbalance(loads, part.chunk_begin);
  if (now < uneven || imbalance(loads, even_shares(loads, part.size)) > 0.5 * (1 + now))
    return;
  const std::string before = loads_;
  see_whole();
  work.shared->shares().gather_points(work.bond.spring_force);
  work.shared->shares().gather_points(work.bond.stretch);
  work.shared->shares().gather_points(work.bond.viscous);
  if (carried)
    work.shared->shares().gather_nodes(*carried);
  share();
  work.contact.search.fragments_due = work.contact.search.all_due = true;
  ++shared_anew_;
  context_.observer.message(
      fmt::format("stage {} {}, step {}: chunks are shared anew, loads of the ranks {} before, {} now",
                  context_.number, kind_, step, before, loads_));
  keep_last_good(); // of the share that is this rank's now
}

void Stage::give_back() {
  if (ranks().alone() || gave_back_)
    return;
  gave_back_ = true;
  park(context_.model, work.shared->shares());
  for (std::vector<Node>* of_nodes : {&work.resolved.external, &work.resolved.constant})
    release_outside(*of_nodes, work.shared->shares().kept_nodes());
  release_zeros(work.partial);
  release_zeros(work.contact.loads.force);
  release_zeros(work.contact.loads.stiffness);
  trim_heap(); // what building and looking at the whole has left
}

void Stage::keep_last_good() {
  good_strain_step_ = work.strain_step;
  good_breaks_ = context_.log.breaks.size();
  good_one_way_ = context_.log.one_way;
  work.shared->keep(context_.state, context_.last_good);
}

void Stage::go_back() {
  context_.state = context_.last_good;
  see_whole();
  work.strain_step = good_strain_step_;
  cdem::go_back(context_.log, context_.state.step, good_breaks_, good_one_way_);
  work.near.forget();
  contacts_.start_anew(context_.model, work.contact, false);
}

void Stage::see_whole() {
  work.shared->gather(context_.state);
}

void Stage::see_surfaces(std::vector<Node>& by_node) {
  work.shared->gather_surfaces(context_.state);
  work.shared->shares().gather_nodes(by_node);
}

bool Stage::left_alone() const {
  return std::uncaught_exceptions() > exceptions_ && !ranks().all_fail(Ranks::patience);
}

} // namespace cdem
