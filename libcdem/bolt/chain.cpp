#include "libcdem/bolt/chain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

constexpr int most_iterations = 100;
// Share of the stiffness that remains above the limits: the balance is always one.
constexpr double hardening = 1e-6;
// Stiffness of a node that nothing holds, over the steel's: it goes with its neighbours.
constexpr double barely = 1e-9;

struct Response {
  double force, tangent;
};

Response limited(double stiffness, double most, double stretch) {
  const double trial = stiffness * stretch;
  if (std::abs(trial) <= most)
    return {trial, stiffness};
  return {std::copysign(most + hardening * (std::abs(trial) - most), trial), hardening * stiffness};
}

// The tridiagonal system of a Newton step, by Gauss without pivoting: it is positive definite.
void solve(std::vector<double>& diagonal, const std::vector<double>& beside, std::vector<double>& right) {
  const std::size_t n = right.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = beside[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * beside[i - 1];
    right[i] -= factor * right[i - 1];
  }
  right[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;)
    right[i] = (right[i] - beside[i] * right[i + 1]) / diagonal[i];
}

} // namespace

ChainLoss advance(const BoltChain& chain, const std::vector<double>& rock, BoltNode* nodes) {
  const std::size_t n = rock.size();
  std::vector<double> a(rock), step(n), diagonal(n), beside(n), residual(n);
  const auto grout_at = [&](std::size_t i) {
    return limited(chain.grout[i], chain.strength[i], rock[i] - a[i] - nodes[i].slip);
  };
  const auto steel_at = [&](std::size_t i) {
    return limited(chain.steel, chain.yield, a[i + 1] - a[i] - nodes[i].stretch);
  };
  // Net force on the steel where it is a + part x step; with the largest of its parts.
  const auto net = [&](double part, std::vector<double>& force) {
    std::vector<double> at(a);
    for (std::size_t i = 0; i < n; ++i)
      at[i] += part * step[i];
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      force[i] = limited(chain.grout[i], chain.strength[i], rock[i] - at[i] - nodes[i].slip).force;
      largest = std::max(largest, std::abs(force[i]));
    }
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double tension = limited(chain.steel, chain.yield, at[i + 1] - at[i] - nodes[i].stretch).force;
      force[i] += tension;
      force[i + 1] -= tension;
      largest = std::max(largest, std::abs(tension));
    }
    return largest;
  };
  const auto along = [&](double part) { // the energy falls that way while this is above zero
    net(part, residual);
    return std::inner_product(residual.begin(), residual.end(), step.begin(), 0.0);
  };
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    std::fill(step.begin(), step.end(), 0.0);
    const double scale = net(0, residual);
    double off = 0;
    for (const double r : residual)
      off = std::max(off, std::abs(r));
    if (off <= 1e-12 * scale)
      break;
    for (std::size_t i = 0; i < n; ++i)
      diagonal[i] = grout_at(i).tangent + barely * chain.steel;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double tangent = steel_at(i).tangent;
      diagonal[i] += tangent;
      diagonal[i + 1] += tangent;
      beside[i] = -tangent;
    }
    step = residual;
    solve(diagonal, beside, step);
    double part = 1;
    if (const double start = along(0), end = along(1); end < -1e-12 * start) {
      double low = 0, high = 1; // to the least energy on the way, which is convex
      for (int halving = 0; halving < 50; ++halving) {
        part = 0.5 * (low + high);
        (along(part) > 0 ? low : high) = part;
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      a[i] += part * step[i];
  }
  ChainLoss loss;
  for (std::size_t i = 0; i < n; ++i) {
    BoltNode& node = nodes[i];
    const double g = grout_at(i).force, grout_before = node.grout;
    if (std::abs(g) > chain.strength[i]) {
      const double slipped = rock[i] - a[i] - node.slip - g / chain.grout[i];
      loss.slip += 0.5 * (g + grout_before) * slipped;
      node.slip += slipped;
    }
    node.grout = g;
    node.rock = rock[i];
    if (i + 1 == n)
      continue;
    const double tension = steel_at(i).force, tension_before = node.tension;
    if (std::abs(tension) > chain.yield) {
      const double yielded = a[i + 1] - a[i] - node.stretch - tension / chain.steel;
      loss.yield += 0.5 * (tension + tension_before) * yielded;
      node.stretch += yielded;
    }
    node.tension = tension;
  }
  return loss;
}

double stored_energy(const BoltChain& chain, const BoltNode* nodes, std::size_t count) {
  double energy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (chain.grout[i] > 0)
      energy += 0.5 * nodes[i].grout * nodes[i].grout / chain.grout[i];
    if (i + 1 < count)
      energy += 0.5 * nodes[i].tension * nodes[i].tension / chain.steel;
  }
  return energy;
}

} // namespace cdem
