#include "libcdem/load/bolts.hpp"

#include "libcdem/state/places.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double inside = -1e-6; // no barycentric weight below this
// Stiffness of a plate over the steel's own: it does not give.
constexpr double plate_stiffness = 1e3;

double axial(const ResolvedBolt& bolt, const RockPlace& at, const State& state) {
  double u = 0;
  for (int k = 0; k < 4; ++k)
    u += at.weights[k] * bolt.direction.dot(vec(state.displacement[at.nodes[k]]));
  return u;
}

// Without the state.
ResolvedBolt resolve_bolt(const Model& model, const Bolt& bolt) {
  ResolvedBolt r;
  const int n = bolt.segments + 1;
  const double l = bolt.length() / bolt.segments;
  r.direction = (bolt.to - bolt.from) / bolt.length();
  r.chain.steel = bolt.youngs_modulus * bolt.area / l;
  r.chain.yield = bolt.yield_force;
  for (int i = 0; i < n; ++i) {
    const double along = i * l;
    r.at.push_back(rock_place(model, bolt.from + along * r.direction));
    // The part of the half segments on both sides that is grouted.
    const double begin = std::max(bolt.free_length, along - 0.5 * l),
                 end = std::min(bolt.length(), along + 0.5 * l), grouted = std::max(0.0, end - begin);
    const bool plate = bolt.plate && i == 0;
    r.chain.grout.push_back(!r.at.back().inside ? 0
                            : plate             ? plate_stiffness * r.chain.steel
                                                : bolt.grout_stiffness * grouted);
    r.chain.strength.push_back(plate         ? std::numeric_limits<double>::infinity()
                               : grouted > 0 ? bolt.grout_strength * grouted
                                             : 0);
  }
  return r;
}

} // namespace

RockPlace rock_place(const Model& model, const geom::Vec3& place) {
  RockPlace found;
  double best = inside;
  for (const geom::Tet& t : model.tets) {
    const auto& x = model.node_position;
    bool near = true;
    for (int axis = 0; axis < 3 && near; ++axis) {
      const auto [low, high] = std::minmax({x[t[0]][axis], x[t[1]][axis], x[t[2]][axis], x[t[3]][axis]});
      near = place[axis] >= low - model.tolerance && place[axis] <= high + model.tolerance;
    }
    if (!near)
      continue;
    geom::Mat3 edges;
    edges << x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]];
    const geom::Vec3 w = edges.inverse() * (place - x[t[0]]);
    const std::array<double, 4> weights{1 - w.sum(), w[0], w[1], w[2]};
    if (const double least = *std::min_element(weights.begin(), weights.end()); least > best)
      found = {t, weights, true}, best = least;
  }
  return found;
}

std::vector<ResolvedBolt> resolve_bolts(const Model& model, const State& state,
                                        const std::vector<Bolt>& bolts) {
  std::vector<ResolvedBolt> resolved;
  std::size_t first = 0;
  for (const Bolt& bolt : bolts) {
    resolved.push_back(resolve_bolt(model, bolt));
    resolved.back().first = first;
    first += resolved.back().at.size();
  }
  if (!bolts.empty() && first != state.bolts.size())
    throw geom::InputError(
        fmt::format("bolts: the state has {} nodes of bolts, the script set {}; it was saved by "
                    "a script with other bolts",
                    state.bolts.size(), first));
  return resolved;
}

void set_bolt(const Model& model, State& state, const Bolt& bolt) {
  validate(bolt);
  ResolvedBolt r = resolve_bolt(model, bolt);
  const auto require_inside = [&](const RockPlace& at, const char* end, const geom::Vec3& x) {
    if (!at.inside)
      throw geom::InputError(
          end, geom::shown(x), "a place in the rock, or on its surface",
          "this end of the bolt hangs in the air; move it, or set the bolt before the rock "
          "around it is taken out");
  };
  require_inside(r.at.front(), "from", bolt.from);
  require_inside(r.at.back(), "to", bolt.to);
  r.first = state.bolts.size();
  std::vector<BoltNode> nodes(r.at.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i].origin = r.at[i].inside ? axial(r, r.at[i], state) : 0;
  const std::vector<double> still(nodes.size(), 0.0);
  if (bolt.pretension > 0) {
    // The plate is drawn up until it carries the pretension: the response to a stretch is elastic at first, and a few
    // secants take slipping grout along.
    double shortened = bolt.pretension / r.chain.steel;
    std::vector<BoltNode> tight;
    ChainLoss loss;
    for (int attempt = 0; attempt < 20; ++attempt) {
      tight = nodes;
      tight[0].slip = shortened; // by so much the nut has been turned
      loss = advance(r.chain, still, tight.data());
      const double carried = std::abs(tight[0].grout);
      if (std::abs(carried - bolt.pretension) <= 1e-9 * bolt.pretension)
        break;
      shortened *= bolt.pretension / carried;
    }
    if (std::abs(std::abs(tight[0].grout) - bolt.pretension) > 0.01 * bolt.pretension)
      throw geom::InputError("pretension", fmt::format("{:g}", bolt.pretension),
                             fmt::format("what the grout holds, {:.3g} N here", std::abs(tight[0].grout)),
                             "lengthen the grouted part, or raise grout_strength");
    nodes = tight;
    const double stored = stored_energy(r.chain, nodes.data(), nodes.size());
    state.spent.bolts += stored;
    state.spent.friction += loss.slip;
    state.spent.external += stored + loss.slip; // the jack's work
    state.spent.external_peak = std::max(state.spent.external_peak, std::abs(state.spent.external));
  }
  state.bolts.insert(state.bolts.end(), nodes.begin(), nodes.end());
}

void bolt_forces(const std::vector<ResolvedBolt>& bolts, const State& state,
                 std::vector<std::pair<int, geom::Vec3>>& forces) {
  forces.clear();
  for (const ResolvedBolt& bolt : bolts)
    for (std::size_t i = 0; i < bolt.at.size(); ++i)
      if (bolt.at[i].inside)
        for (int k = 0; k < 4; ++k)
          forces.emplace_back(bolt.at[i].nodes[k],
                              -state.bolts[bolt.first + i].grout * bolt.at[i].weights[k] * bolt.direction);
}

void advance_bolts(const std::vector<ResolvedBolt>& bolts, State& state,
                   std::vector<std::pair<int, geom::Vec3>>& forces) {
  std::vector<double> rock;
  state.spent.bolts = 0;
  for (const ResolvedBolt& bolt : bolts) {
    BoltNode* const nodes = state.bolts.data() + bolt.first;
    const std::size_t n = bolt.at.size();
    rock.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      rock[i] = bolt.at[i].inside ? axial(bolt, bolt.at[i], state) - nodes[i].origin : nodes[i].rock;
    std::vector<std::pair<double, double>> before; // force, displacement
    for (std::size_t i = 0; i < n; ++i)
      before.emplace_back(nodes[i].grout, nodes[i].rock);
    const ChainLoss loss = advance(bolt.chain, rock, nodes);
    state.spent.friction += loss.slip;
    state.spent.yielding += loss.yield;
    state.spent.bolts += stored_energy(bolt.chain, nodes, n);
    for (std::size_t i = 0; i < n; ++i) {
      if (!bolt.at[i].inside)
        continue;
      // The work of the rock on the bolt is no work of a load.
      state.spent.external += 0.5 * (before[i].first + nodes[i].grout) * (rock[i] - before[i].second);
    }
  }
  bolt_forces(bolts, state, forces);
}

void add_bolt_row_sums(const std::vector<ResolvedBolt>& bolts, std::vector<double>& sums) {
  // Grout and steel in series; |d_a| times the sum of |d_b| is at most sqrt(3).
  for (const ResolvedBolt& bolt : bolts)
    for (std::size_t i = 0; i < bolt.at.size(); ++i)
      if (bolt.at[i].inside)
        for (int k = 0; k < 4; ++k)
          sums[bolt.at[i].nodes[k]] += std::sqrt(3.0) * std::max(0.0, bolt.at[i].weights[k]) *
                                       std::min(bolt.chain.grout[i], 4 * bolt.chain.steel);
}

} // namespace cdem
