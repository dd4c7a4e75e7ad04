#include "libcdem/procedure/piece_balance.hpp"

#include "libcdem/bond/fragments.hpp"

#include <cmath>

namespace cdem {
namespace {

double norm(const Node& f) {
  return std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
}

double norm_at(const std::vector<Node>& force, std::int64_t node) {
  return force.empty() ? 0 : norm(force[node]);
}

struct Acting {
  double load = 0, contact = 0; // N
};

struct Forces {
  double load = 0, held = 0, out_of_balance = 0; // N, sums of sizes; held: of what is no load
};

// Of all ranks (n_nodes).
std::vector<Acting> acting_on_nodes(const Workspace& work, std::size_t nodes) {
  const ResolvedConditions& r = work.resolved;
  const StateShares& shares = work.shared->shares();
  std::vector<Acting> acting(nodes);
  for (std::int64_t i = shares.nodes().begin; i < shares.nodes().end; ++i)
    acting[i] = {norm_at(r.external, i) + norm_at(r.internal, i), norm_at(work.contact.loads.force, i)};
  shares.gather_nodes(acting);
  return acting;
}

} // namespace

LoosestPiece loosest_piece(const Model& model, const State& state, Workspace& work,
                           const std::vector<Node>& force) {
  const std::vector<int> pieces = fragments_of_nodes(model, state);
  const std::vector<Acting> acting = acting_on_nodes(work, pieces.size());
  std::vector<Forces> of_piece(pieces.size());
  const auto add = [&](std::int64_t node, const Node& free) {
    const Node& f = force[node];
    Forces& sums = of_piece[pieces[node]];
    sums.load += acting[node].load;
    sums.out_of_balance += norm({free.x * f.x, free.y * f.y, free.z * f.z, 0});
    sums.held += acting[node].contact + norm({(1 - free.x) * f.x, (1 - free.y) * f.y, (1 - free.z) * f.z, 0});
  };
  each_node(
      work.resolved, {0, static_cast<std::int64_t>(force.size())},
      [&](Range free) {
        for (std::int64_t i = free.begin; i < free.end; ++i)
          add(i, {1, 1, 1, 0});
      },
      [&](const HeldNode& h) { add(h.node, h.free); });
  work.shared->shares().gather_points(work.bond.spring_force);
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const int a = pieces[model.points[p].node_a[0]], b = pieces[model.points[p].node_b[0]];
    if (a == b)
      continue;
    const double spring = work.bond.spring_force[p].norm();
    of_piece[a].held += spring;
    of_piece[b].held += spring;
  }
  LoosestPiece loosest;
  for (int piece = 0; piece < static_cast<int>(of_piece.size()); ++piece)
    if (const Forces& f = of_piece[piece]; f.load > 0)
      if (const double part = f.out_of_balance / (f.load + f.held); part > loosest.out_of_balance)
        loosest = {part, piece};
  return loosest;
}

} // namespace cdem
