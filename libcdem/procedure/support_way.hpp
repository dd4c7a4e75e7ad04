// The way of supports with a given displacement in a relaxation. Bonds that break and joints that slip depend on the path, so
// it is one of static balance.
//
// The part s of the way that is done grows by the pace r in each step. The pace follows the residual R. It begins at 1e-6, once
// the residual of the model is at most 0.005, and then
//
//   r+ = r exp((1 - R / 0.005) / 40) below that, r 0.005 / R above,   1e-6 <= r <= (1 - s) / 40 + 1e-4
//
// So supports wait where bonds break, and arrive softly. What is out of balance counts where it moves, against the reactions of the
// supports that move. With the velocities v of the step and that of the fastest support, V,
//
//   R^2 = sum |F|^2 min(1, |v|^2 / V^2) / sum |reaction|^2 |v|^2 / V^2
//
// over free components and over those of moved supports. So a small part is led by its own forces, whatever the rest of the
// model weighs, and what comes to rest elsewhere delays no support. The lower sum is at least the square of goal times loads, since
// less counts as balance, and at most that of the loads. Supports that have torn their part off leave no reactions: then it is at
// least 1e-4 of the largest that it was (relax.cpp).
//
// Where the forces of contacts change by more than 0.05 of that reference, or of 0.01 of the loads if it is less, in a step, the
// motion of the step before is taken back, no bond breaks, and the pace falls to an eighth, at least 1e-9: so contacts close softly.
// After 40 slowest periods T supports are drawn along the rest of their way in as many again.
//
// Free nodes are led: else drag and inertia would strain the neighbours of supports alone. The velocity of a node is that of
// dynamic relaxation, w, and the lead r l. The displacement l per way is learned from what w adds to it:
//
//   dl = b w / r,   b = min(4 r / (s + s0), c / 4),   s0 = max(1e-5, 100 R_0)
//
// It is a mean over the last quarter of the way. R_0 is the residual at the start, whose motion is not of the way. What is in touch
// anew moves otherwise: then b = min(4 r / (s - s1 + 100 r1), c / 4), with s1 and r1 of that moment. The
// damping c is at least 4 pi / T: with b < c / 2 every mode that the lead drives is damped. The net force F on a node does the work
// F . r l, which is fictitious.
#pragma once

#include "libcdem/integrate/move_nodes.hpp"

#include <cstdint>
#include <vector>

namespace cdem {

class SupportWay {
public:
  SupportWay() = default; // nothing is moved
  // period: T, steps (stability.hpp); length: m, of the longest way; goal: of the residual.
  SupportWay(std::size_t nodes, double period, double length, double goal)
      : lead_(nodes), period_(period), length_(length), goal_(goal), way_(0) {}

  bool acts() const { return acts_; }                 // in the step to come
  bool takes_back() const { return pace_ < 0; }       // likewise
  bool stands() const { return way_ >= 1 && !acts_; } // supports have arrived, and nodes are led no more
  double left() const { // steps at this pace, below 0 while it takes back; 0: supports stand
    return way_ < 1 && pace_ != 0 ? (1 - way_) / pace_ : 0;
  }
  double done() const { return way_; }        // part of the way
  bool drawn() const { return drawn_; }       // along, in the step to come
  std::vector<Node>& lead() { return lead_; } // r l, m per step (n_nodes); empty: nothing is moved

  // Where nodes are led; else 0.
  double least_damping() const;
  // residual, sums: of the model, in the step that has been made.
  void choose_pace(double residual, double damping, const NodeSums&);
  void end_step();

  // change2: N2, squared norm, of the forces of contacts since the step before. Says whether the step to come takes back.
  bool see_contacts(double change2);

  // Before the step of dynamic relaxation, for which the velocity is w, and after it. first: the number of the first node;
  // free: 1 for the components that are not held; prescribed: of those that are; force: N, net, that acted in the step.
  void take_off(const MovingNodes& nodes, std::int64_t first) const;
  void put_on(const MovingNodes& nodes, std::int64_t first, const Node& free, const Node& prescribed,
              const Node* force, NodeSums&);

  // In place of a step of dynamic relaxation where the way takes back.
  void step_back(const MovingNodes& nodes, std::int64_t first, const Node& free, const Node& prescribed,
                 Node* previous_force, NodeSums&);

  // For a stage that goes on: numbers that a later add_to gives again. take returns the place behind them.
  void add_to(std::vector<double>& loop_state) const;
  std::size_t take(const std::vector<double>& loop_state, std::size_t from);

private:
  double late() const; // part of the time in which supports are drawn along

  std::vector<Node> lead_;
  double period_ = 0, length_ = 0, goal_ = 0;
  double way_ = 1, pace_ = 0;        // s, r
  double learned_from_ = 0;          // s
  double last_pace_ = 0;             // of the step before
  double reference2_ = 0;            // N2, for the forces of contacts
  double growth_ = 0, learning_ = 0; // r over that of the step before, b; 0: nodes are not led
  double steps_ = 0;                 // made
  bool acts_ = false, drawn_ = false;
};

} // namespace cdem
