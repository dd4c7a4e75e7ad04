#include "libcdem/step/escape.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace cdem {
namespace {

// What of a piece is needed to judge it.
struct Piece {
  geom::Vec3 place = geom::Vec3::Zero(), velocity = geom::Vec3::Zero(); // sums over the nodes, then means
  int nodes = 0;
  bool supported = false; // a support holds or moves it
};

double distance(const geom::Box& box, const geom::Vec3& x) {
  return (box.min - x).cwiseMax(x - box.max).cwiseMax(geom::Vec3::Zero()).norm();
}

Escaped status(const State& state, int node) {
  return state.escaped.empty() ? Escaped::inside : static_cast<Escaped>(state.escaped[node]);
}

Escaped next_status(Escaped now, double away, const EscapeLimits& limits) {
  if (now == Escaped::held || away > limits.held_beyond)
    return Escaped::held;
  return away > limits.told_beyond ? Escaped::told : now;
}

std::string name_of(const Model& model, const std::vector<int>& pieces, int first) {
  const int block = block_of(model, first);
  const Block& b = model.blocks[block];
  const bool part = std::any_of(pieces.begin() + b.node_begin, pieces.begin() + b.node_end,
                                [&](int piece) { return piece != first; });
  return (part ? "a fragment of " : "") + block_name(model, block);
}

} // namespace

bool any_is_out(const Model& model, const State& state, const EscapeLimits& limits, Range nodes) {
  for (auto node = static_cast<int>(nodes.begin); node < nodes.end; ++node) {
    const Escaped now = status(state, node);
    if (next_status(now, distance(model.box, place_of(model, state, node)), limits) != now)
      return true;
  }
  return false;
}

std::vector<Escape> find_escapes(const Model& model, State& state, const ResolvedConditions& conditions,
                                 const EscapeLimits& limits) {
  std::vector<Escape> found;
  const std::vector<int> pieces = fragments_of_nodes(model, state);
  std::map<int, Piece> by_first; // by the smallest node of the piece
  for (int node = 0; node < static_cast<int>(pieces.size()); ++node) {
    Piece& piece = by_first[pieces[node]];
    piece.place += place_of(model, state, node);
    piece.velocity += vec(state.velocity[node]);
    ++piece.nodes;
  }
  for (const HeldNode& h : conditions.held)
    by_first[pieces[h.node]].supported = true;
  std::map<int, Escaped> changed;
  bool some_stay = false;
  for (auto& [first, piece] : by_first) {
    piece.place /= piece.nodes;
    piece.velocity /= piece.nodes;
    const Escaped now = status(state, first),
                  next = piece.supported ? now : next_status(now, distance(model.box, piece.place), limits);
    some_stay = some_stay || next == Escaped::inside;
    if (next != now)
      changed[first] = next;
  }
  if (!some_stay)
    return found;
  state.escaped.resize(model.node_position.size(), 0);
  for (const auto& [first, next] : changed) {
    const Piece& piece = by_first[first];
    found.push_back(
        {name_of(model, pieces, first), piece.place, piece.velocity.norm(), next == Escaped::held});
  }
  for (std::size_t node = 0; node < pieces.size(); ++node)
    if (const auto next = changed.find(pieces[node]); next != changed.end())
      state.escaped[node] = static_cast<std::uint8_t>(next->second);
  return found;
}

} // namespace cdem
