// Decides whether a relaxation comes to rest, that is, distinguishes a run-away from slow convergence.
//
// Every so many steps the watch is told the path D of the fastest node (the sum of the largest displacement between two
// looks), the residual R, the work W of the loads and the stored energy S. With the marks a, b, c at a half, three quarters
// and all of the n steps so far, the model is failing when at three looks in a row
//
//   D_c - D_b >= 0.8 (D_b - D_a)      it does not slow down,
//   D_c >= 1.5 D_a                    and this motion makes the displacement, not the first settlement;
//   from a to c the means of W over eighths of the steps take back at most 0.1 of what they gain from one to the next, and gain in
//   the last quarter at least 0.8 of what they gain in the third: no swing, and nothing that rattles as it slows down;
//   S_c - S_a <= 0.1 (W_c - W_a)      the loads drive it on, and their work is not stored: nothing holds against it,
//   mean R of (b, c] >= 0.5 mean R of (a, b]     the forces out of balance do not die away,
//   n >= 4 T  or  D_c - D_a >= L / 100     the slowest wave has crossed the model and come back, several times; or it has
//                                          moved further than rock and soil do before they fail. Only the second, for what
//                                          touches nothing: it may fall onto something.
//
// All that is of the pieces that are out of balance (piece_balance.hpp), or of the model where all are in balance: what the loads do
// on the rest counts neither to W nor to S.
//
// The last line is needed: in the first tenth of its first swing an elastic body does all the others. T is the period of
// a rod as long as the model L, held at one end, with the masses m of the relaxation (kg, for a unit step), volume V:
//
//   T = 4 L / c,   c^2 = E' V / sum m,   1/E' = mean of 1/E + sum of A / kn over the interfaces / 3 V
//
// A slender column bends up to 1.5 L/w times as slowly (w its width): four periods T and the stored tenth leave room for
// L/w up to some 28.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/step/options.hpp"

namespace cdem {

struct StabilityLook {
  std::int64_t step = 0;
  double path = 0;     // D, m
  double residual = 0; // R
  double work = 0;     // W, J
  double stored = 0;   // S, J
  bool falls = false;  // it touches nothing
};

// Looks are added at equal distances.
class StabilityWatch {
public:
  // length: L, m.
  StabilityWatch(double period, double length) : period_(period), length_(length) {}

  // Looks up to this step are not added: supports are still moved.
  void wait(std::int64_t step) { waiting_ = step; }
  void add(const StabilityLook&);
  void start_anew(); // something else moves
  bool failing() const { return suspicious_ >= 3; }
  // From the last look alone.
  bool suspicious() const { return suspicious_ > 0; }

  // For a stage that goes on: numbers that a later add_to gives again.
  void add_to(std::vector<double>& loop_state) const;
  void take(const std::vector<double>& loop_state, std::size_t from);

private:
  bool runs_away() const;

  double period_, length_;
  std::int64_t waiting_ = 0;
  int suspicious_ = 0; // looks in a row
  std::vector<StabilityLook> looks_;
};

// T above, steps; mass: kg for a unit step (n_nodes).
double slowest_period(const Model&, const std::vector<double>& mass);

// The node that has moved furthest between two places, and how far, m. of: the nodes that count (n_nodes); empty: all.
struct Fastest {
  int node = 0;
  double displacement = 0;
};
Fastest fastest(const std::vector<Node>& from, const std::vector<Node>& to, const std::vector<char>& of = {});

} // namespace cdem
