#include "libcdem/procedure/piece_balance.hpp"

#include "libcdem/bond/fragments.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

double norm(const Node& f) {
  return std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
}

Node at(const std::vector<Node>& force, std::int64_t node) {
  return force.empty() ? Node{} : force[node];
}

struct Acting {
  Node load;
  double initial_stress = 0, contact = 0; // N
};

struct Forces {
  double load = 0, held = 0, out_of_balance = 0; // N, sums of sizes; held: of what is no load
  double out_of_balance2 = 0;                    // N2, sum of squares
  bool is_out(double goal) const { return load > 0 && !(out_of_balance <= goal * (load + held)); }
};

// Of all ranks (n_nodes).
std::vector<Acting> acting_on_nodes(const Workspace& work, std::size_t nodes) {
  const ResolvedConditions& r = work.resolved;
  const StateShares& shares = work.shared->shares();
  std::vector<Acting> acting(nodes);
  for (std::int64_t i = shares.nodes().begin; i < shares.nodes().end; ++i)
    acting[i] = {at(r.external, i), norm(at(r.internal, i)), norm(at(work.contact.loads.force, i))};
  shares.gather_nodes(acting);
  return acting;
}

std::vector<Forces> forces_on(const std::vector<int>& pieces, const std::vector<Acting>& acting,
                              const Model& model, Workspace& work, const std::vector<Node>& force) {
  std::vector<Forces> of_piece(pieces.size());
  const auto add = [&](std::int64_t node, const Node& free) {
    const Node &f = force[node], out{free.x * f.x, free.y * f.y, free.z * f.z, 0};
    Forces& sums = of_piece[pieces[node]];
    sums.load += norm(acting[node].load) + acting[node].initial_stress;
    sums.out_of_balance += norm(out);
    sums.out_of_balance2 += out.x * out.x + out.y * out.y + out.z * out.z;
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
  return of_piece;
}

} // namespace

LoosePieces loose_pieces(const Model& model, const State& state, Workspace& work,
                         const std::vector<Node>& force, double goal) {
  goal = std::max(goal, 0.001);
  const std::vector<int> pieces = fragments_of_nodes(model, state);
  const std::vector<Acting> acting = acting_on_nodes(work, pieces.size());
  const std::vector<Forces> of_piece = forces_on(pieces, acting, model, work, force);
  const auto any = [&](const auto& is) { return std::any_of(of_piece.begin(), of_piece.end(), is); };
  LoosePieces loose;
  if (!any([&](const Forces& f) { return f.is_out(goal); }))
    return loose;
  loose.fall = !any([&](const Forces& f) { return f.is_out(goal) && f.held > 0; });
  double theirs2 = 0, all2 = 0;
  std::vector<char> is_loose(pieces.size());
  for (std::size_t i = 0; i < of_piece.size(); ++i) {
    const Forces& f = of_piece[i];
    is_loose[i] = f.is_out(goal) && (loose.fall || f.held > 0);
    theirs2 += is_loose[i] ? f.out_of_balance2 : 0;
    all2 += f.out_of_balance2;
  }
  loose.of_residual = std::sqrt(theirs2 / all2);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    loose.nodes.push_back(is_loose[pieces[i]]);
    loose.load.push_back(acting[i].load);
  }
  return loose;
}

} // namespace cdem
