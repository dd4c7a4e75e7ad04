#include "libcdem/water/wave_theories.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double pi = 3.141592653589793;

// The equations, in lengths of d and velocities of sqrt(g d). Unknowns: heights over the bed at N + 1 points from crest to
// trough; B_1 .. B_N; U; Q, the flow; R; k.
class StreamFunction {
public:
  StreamFunction(const WaveGiven& given, int order)
      : n_(order), speed_(std::sqrt(given.gravity * given.depth)), given_(given), x_(2 * order + 5) {
    for (int m = 0; m <= n_; ++m)
      for (int j = 0; j <= n_; ++j) {
        const double angle = pi * ((m * j) % (2 * n_)) / n_;
        cosine_.push_back(geom::portable::cos(angle));
        sine_.push_back(geom::portable::sin(angle));
      }
    start(given.height / given.depth);
  }

  // Heights grow in steps of a twentieth of the depth at most.
  static int steps_of(double height) { return std::max(1, static_cast<int>(std::ceil(20 * height))); }

  void solve(double height) {
    for (int turn = 0; turn < 60; ++turn) {
      Eigen::VectorXd residual(x_.size());
      Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(x_.size(), x_.size());
      equations(height, residual, jacobian);
      const Eigen::VectorXd change = jacobian.partialPivLu().solve(residual);
      if (!change.allFinite())
        break;
      x_ -= change;
      if (change.cwiseAbs().maxCoeff() < 1e-12 * std::max(1.0, x_.cwiseAbs().maxCoeff()))
        return;
    }
    throw geom::InputError("height", fmt::format("{:g}", height * given_.depth),
                           "one whose steady wave exists and is found",
                           "Newton's method did not converge: a lower wave, or another order");
  }

  SteadyWave wave() const {
    SteadyWave wave;
    const double d = given_.depth;
    wave.wave_number = x_[k_()] / d;
    wave.depth = d;
    wave.gravity = given_.gravity;
    wave.mean = x_[u_()] * speed_;
    wave.bernoulli = x_[r_()] * speed_ * speed_;
    for (int j = 1; j <= n_; ++j) {
      wave.potential.push_back(x_[b_(j)] * speed_ * d);
      double e = 0; // cosine transform of the heights, trapezoidal
      for (int m = 0; m <= n_; ++m)
        e += (m == 0 || m == n_ ? 0.5 : 1) * x_[m] * cosine(m, j);
      wave.surface.push_back((j == n_ ? 1.0 : 2.0) / n_ * e * d);
    }
    return wave;
  }

private:
  int b_(int j) const { return n_ + j; }
  int u_() const { return 2 * n_ + 1; }
  int q_() const { return 2 * n_ + 2; }
  int r_() const { return 2 * n_ + 3; }
  int k_() const { return 2 * n_ + 4; }
  double cosine(int m, int j) const { return cosine_[m * (n_ + 1) + j]; }
  double sine(int m, int j) const { return sine_[m * (n_ + 1) + j]; }

  void start(double height) { // a small wave
    const double k = given_.length ? 2 * pi * given_.depth / *given_.length
                                   : given_.depth * linear_wave_number(*given_.period, given_.depth,
                                                                       given_.gravity, given_.current);
    const double c = std::sqrt(tanh(k) / k);
    x_.setZero();
    for (int m = 0; m <= n_; ++m)
      x_[m] = 1 + 0.5 * height / steps_of(height) * cosine(m, 1);
    x_[b_(1)] = 0.5 * height / steps_of(height) / (c * k);
    x_[u_()] = c;
    x_[q_()] = c;
    x_[r_()] = 1 + 0.5 * c * c;
    x_[k_()] = k;
  }

  void equations(double height, Eigen::VectorXd& f, Eigen::MatrixXd& a) const {
    const double k = x_[k_()], mean = x_[u_()];
    std::vector<double> along(n_ + 1), up(n_ + 1); // derivatives of u and w by B_j
    for (int m = 0; m <= n_; ++m) {
      const double z = x_[m];
      double psi = -mean * z, u = -mean, w = 0, uz = 0, wz = 0, psi_k = 0, u_k = 0, w_k = 0;
      const int row = m, other = n_ + 1 + m;
      for (int j = 1; j <= n_; ++j) {
        const double jk = j * k, b = x_[b_(j)];
        // cosh(jkz) / cosh(jk) and sinh(jkz) / cosh(jk) without overflow
        const double rise = geom::portable::exp(jk * (z - 1)), under = geom::portable::exp(-2 * jk * z),
                     bed = geom::portable::exp(-2 * jk);
        const double ch = rise * (1 + under) / (1 + bed), sh = rise * (1 - under) / (1 + bed);
        const double th = (1 - bed) / (1 + bed), c = cosine(m, j), s = sine(m, j);
        const double ch_k = j * (z * sh - th * ch), sh_k = j * (z * ch - th * sh);
        psi += b * sh * c;
        u += jk * b * ch * c;
        w += jk * b * sh * s;
        uz += jk * jk * b * sh * c;
        wz += jk * jk * b * ch * s;
        psi_k += b * sh_k * c;
        u_k += (j * ch + jk * ch_k) * b * c;
        w_k += (j * sh + jk * sh_k) * b * s;
        a(row, b_(j)) = sh * c;
        along[j] = jk * ch * c;
        up[j] = jk * sh * s;
      }
      for (int j = 1; j <= n_; ++j)
        a(other, b_(j)) = u * along[j] + w * up[j];
      f[row] = psi + x_[q_()];
      a(row, m) = u;
      a(row, u_()) = -z;
      a(row, q_()) = 1;
      a(row, k_()) = psi_k;
      f[other] = 0.5 * (u * u + w * w) + z - x_[r_()];
      a(other, m) = u * uz + w * wz + 1;
      a(other, u_()) = -u;
      a(other, r_()) = -1;
      a(other, k_()) = u * u_k + w * w_k;
    }
    const int mean_row = 2 * n_ + 2, height_row = 2 * n_ + 3, length_row = 2 * n_ + 4;
    f[mean_row] = -n_;
    for (int m = 0; m <= n_; ++m) {
      const double weight = m == 0 || m == n_ ? 0.5 : 1;
      f[mean_row] += weight * x_[m];
      a(mean_row, m) = weight;
    }
    f[height_row] = x_[0] - x_[n_] - height;
    a(height_row, 0) = 1;
    a(height_row, n_) = -1;
    if (given_.length) {
      f[length_row] = k - 2 * pi * given_.depth / *given_.length;
      a(length_row, k_()) = 1;
    } else {
      const double current = given_.current / speed_;
      f[length_row] = k * (mean + current) - 2 * pi * given_.depth / (speed_ * *given_.period);
      a(length_row, k_()) = mean + current;
      a(length_row, u_()) = k;
    }
  }

  static double tanh(double x) {
    const double e = geom::portable::exp(-2 * x);
    return (1 - e) / (1 + e);
  }

  int n_;
  double speed_;
  WaveGiven given_;
  Eigen::VectorXd x_;
  std::vector<double> cosine_, sine_; // of pi m j / N
};

} // namespace

SteadyWave stream_function_wave(const WaveGiven& given) {
  StreamFunction equations(given, given.order);
  const double height = given.height / given.depth;
  const int steps = StreamFunction::steps_of(height);
  for (int i = 1; i <= steps; ++i)
    equations.solve(height * i / steps);
  return equations.wave();
}

} // namespace cdem
