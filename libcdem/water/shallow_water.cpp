#include "libcdem/water/shallow_water.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

struct Side { // water at one side of a cell's face
  double h = 0, u = 0, z = 0;
};

struct Flux {
  double mass = 0, momentum = 0;
};

double minmod(double a, double b) {
  if (a * b <= 0)
    return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

Flux hll(const Side& l, const Side& r, double g) {
  if (l.h <= 0 && r.h <= 0)
    return {};
  const double cl = std::sqrt(g * l.h), cr = std::sqrt(g * r.h);
  const double middle = std::max(0.0, 0.5 * (cl + cr) + 0.25 * (l.u - r.u)); // two rarefactions (Toro 2001)
  const double u = 0.5 * (l.u + r.u) + cl - cr;
  const double sl = l.h <= 0 ? r.u - 2 * cr : std::min(l.u - cl, u - middle);
  const double sr = r.h <= 0 ? l.u + 2 * cl : std::max(r.u + cr, u + middle);
  const Flux fl{l.h * l.u, l.h * l.u * l.u + 0.5 * g * l.h * l.h};
  const Flux fr{r.h * r.u, r.h * r.u * r.u + 0.5 * g * r.h * r.h};
  if (sl >= 0)
    return fl;
  if (sr <= 0)
    return fr;
  const double over = 1 / (sr - sl);
  return {(sr * fl.mass - sl * fr.mass + sl * sr * (r.h - l.h)) * over,
          (sr * fl.momentum - sl * fr.momentum + sl * sr * (r.h * r.u - l.h * l.u)) * over};
}

// The water outside the open end: the characteristic that leaves comes from inside, the one that enters is the wave's.
Side outside(const ShallowWater& w, double time) {
  Side first{w.h[0], w.velocity(0), w.bed[0]};
  if (!w.entering) {
    first.u = -first.u;
    return first;
  }
  const double g = w.gravity, still = std::sqrt(g * w.still_depth);
  const double crest = std::sqrt(g * std::max(0.0, w.still_depth + w.entering(time)));
  const double in = 4 * crest - 2 * still, out = first.u - 2 * std::sqrt(g * first.h);
  const double c = std::max(0.0, 0.25 * (in - out));
  return {c * c / g, 0.5 * (in + out), w.bed[0]};
}

// Rates of h and q.
void rates(const ShallowWater& w, double time, std::vector<double>& dh, std::vector<double>& dq) {
  const std::size_t n = w.h.size();
  const double g = w.gravity, dx = w.cell;
  std::vector<Side> left(n), right(n); // inside each cell, at its faces
  const Side before = outside(w, time);
  const auto cell = [&](std::size_t i) { return Side{w.h[i], w.velocity(i), w.bed[i]}; };
  Side a = before, b = cell(0);
  for (std::size_t i = 0; i < n; ++i) {
    Side c = b;
    if (i + 1 < n)
      c = cell(i + 1);
    else
      c.u = -c.u;
    const double level = b.h + b.z;
    const double sh = minmod(b.h - a.h, c.h - b.h), su = minmod(b.u - a.u, c.u - b.u),
                 se = minmod(level - (a.h + a.z), c.h + c.z - level);
    const auto side = [&](double sign) {
      const double h = std::max(0.0, b.h + sign * 0.5 * sh);
      return Side{h, b.u + sign * 0.5 * su, level + sign * 0.5 * se - h};
    };
    left[i] = side(-1);
    right[i] = side(1);
    a = b;
    b = c;
  }
  std::fill(dh.begin(), dh.end(), 0.0);
  std::fill(dq.begin(), dq.end(), 0.0);
  for (std::size_t f = 0; f <= n; ++f) {
    Side l = f > 0 ? right[f - 1] : before, r = f < n ? left[f] : right[n - 1];
    if (f == 0)
      l.z = r.z;
    if (f == n)
      r.u = -r.u;
    const double top = std::max(l.z, r.z);
    const Side ls{std::max(0.0, l.h + l.z - top), l.u, top}, rs{std::max(0.0, r.h + r.z - top), r.u, top};
    const Flux flux = hll(ls, rs, g);
    if (f > 0) {
      dh[f - 1] -= flux.mass / dx;
      dq[f - 1] -= (flux.momentum + 0.5 * g * (l.h * l.h - ls.h * ls.h)) / dx;
    }
    if (f < n) {
      dh[f] += flux.mass / dx;
      dq[f] += (flux.momentum + 0.5 * g * (r.h * r.h - rs.h * rs.h)) / dx;
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    dq[i] += 0.5 * g * (left[i].h + right[i].h) * (left[i].z - right[i].z) / dx;
}

} // namespace

double ShallowWater::velocity(std::size_t i) const {
  return h[i] > dry_depth() ? q[i] / h[i] : 0;
}

double ShallowWater::longest_step() const {
  double fastest = std::sqrt(gravity * still_depth);
  for (std::size_t i = 0; i < h.size(); ++i)
    fastest = std::max(fastest, std::abs(velocity(i)) + std::sqrt(gravity * h[i]));
  return 0.4 * cell / fastest;
}

void ShallowWater::step(double time, double dt) {
  const std::size_t n = h.size();
  const std::vector<double> h0 = h, q0 = q;
  std::vector<double> dh(n), dq(n);
  for (int stage = 0; stage < 2; ++stage) {
    rates(*this, time + stage * dt, dh, dq);
    for (std::size_t i = 0; i < n; ++i) {
      h[i] = std::max(0.0, h[i] + dt * dh[i]);
      q[i] = h[i] > dry_depth() ? q[i] + dt * dq[i] : 0;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    h[i] = 0.5 * (h0[i] + h[i]);
    q[i] = 0.5 * (q0[i] + q[i]);
    if (h[i] <= dry_depth())
      q[i] = 0;
    else if (friction > 0) // implicit
      q[i] /= 1 + dt * friction * std::abs(q[i]) / (h[i] * h[i]);
  }
}

} // namespace cdem
