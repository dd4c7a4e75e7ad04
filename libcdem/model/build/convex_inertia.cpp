#include "libcdem/model/build/convex_inertia.hpp"

#include "libcdem/model/build/second_moments.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cdem {
namespace {

using Ten = Eigen::Matrix<double, 10, 1>;
using TenByTen = Eigen::Matrix<double, 10, 10>;

constexpr double least_part = 0.7; // of the mass that step 1 gives a node
constexpr double on_face = 1e-6;   // of the size of the block
constexpr double rounding = 1e-10; // of the sums of a block of size 1 and mass 1

// 1, r and r r^T, whose sums over the nodes are mass, first and second moments.
Ten powers(const geom::Vec3& r) {
  Ten p;
  p << 1, r, r.cwiseProduct(r), r.y() * r.z(), r.z() * r.x(), r.x() * r.y();
  return p;
}

// Shares of the block's mass at its nodes, by place in units of its size.
struct Masses {
  std::vector<geom::Vec3> place;
  std::vector<char> outside; // on a face of the block
  std::vector<double> share;
  Ten solid = Ten::Zero(); // what the sums are to be

  Ten missing() const {
    Ten sum = solid;
    for (std::size_t i = 0; i < share.size(); ++i)
      sum -= share[i] * powers(place[i]);
    return sum;
  }
};

Masses masses_of(const Model& model, int block) {
  const Block& b = model.blocks[block];
  const double mass = model.bodies[b.body].material.density * b.mass.volume;
  const auto arm = [&](int node) -> geom::Vec3 {
    return (model.node_position[node] - b.mass.centroid) / b.size;
  };
  Masses m;
  for (int node = b.node_begin; node < b.node_end; ++node) {
    m.place.push_back(arm(node));
    m.share.push_back(model.node_mass[node] / mass);
  }
  const geom::Mat3 s = second_moments(model, block, arm) / mass;
  m.solid << 1, 0, 0, 0, s.diagonal(), s(1, 2), s(2, 0), s(0, 1);
  m.outside.assign(m.place.size(), 0);
  for (std::size_t f = 0; f < b.shape.faces.size(); ++f) {
    const geom::Vec3 normal = geom::face_normal(b.shape, static_cast<int>(f)),
                     on = (b.shape.vertices[b.shape.faces[f].loop[0]] - b.mass.centroid) / b.size;
    for (std::size_t i = 0; i < m.place.size(); ++i)
      if (std::abs(normal.dot(m.place[i] - on)) < on_face)
        m.outside[i] = 1;
  }
  return m;
}

// Step 1.
void match_trace(Masses& m) {
  std::array<double, 2> share{}, trace{}; // inside, outside
  for (std::size_t i = 0; i < m.share.size(); ++i) {
    share[m.outside[i]] += m.share[i];
    trace[m.outside[i]] += m.share[i] * m.place[i].squaredNorm();
  }
  const double solid = m.solid.segment<3>(4).sum(), apart = share[0] * trace[1] - share[1] * trace[0];
  if (share[0] == 0 || !(apart > 0))
    return;
  const double s = (share[0] * solid - trace[0]) / apart, t = (trace[1] - share[1] * solid) / apart;
  if (!(s > 0 && t > 0))
    return;
  for (std::size_t i = 0; i < m.share.size(); ++i)
    m.share[i] *= m.outside[i] ? s : t;
}

// Step 2.
void match_all(Masses& m) {
  const std::vector<double> first = m.share;
  std::vector<char> least(first.size(), 0);
  std::vector<double> wanted;
  for (bool again = true; again;) {
    again = false;
    Masses left = m;
    TenByTen gram = TenByTen::Zero();
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (least[i] != 0)
        left.share[i] = least_part * first[i];
      else
        gram += first[i] * powers(m.place[i]) * powers(m.place[i]).transpose();
    }
    const Ten missing = left.missing();
    const Eigen::SelfAdjointEigenSolver<TenByTen> solver(gram);
    Ten factor = Ten::Zero();
    for (int i = 0; i < 10; ++i)
      if (const double value = solver.eigenvalues()[i]; value > rounding * solver.eigenvalues()[9])
        factor += solver.eigenvectors().col(i).dot(missing) / value * solver.eigenvectors().col(i);
    if ((gram * factor - missing).norm() > rounding)
      break; // these nodes cannot
    wanted = left.share;
    for (std::size_t i = 0; i < first.size(); ++i)
      if (least[i] == 0) {
        wanted[i] += first[i] * powers(m.place[i]).dot(factor);
        if (wanted[i] < least_part * first[i])
          least[i] = again = true;
      }
  }
  if (wanted.empty())
    return;
  double way = 1;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (const double loss = first[i] - wanted[i]; loss > 0)
      way = std::min(way, (1 - least_part) * first[i] / loss);
  for (std::size_t i = 0; i < first.size(); ++i)
    m.share[i] += way * (wanted[i] - first[i]);
}

} // namespace

void match_convex_inertia(Model& model, int block) {
  const Block& b = model.blocks[block];
  const double mass = model.bodies[b.body].material.density * b.mass.volume;
  Masses m = masses_of(model, block);
  match_trace(m);
  match_all(m);
  for (int node = b.node_begin; node < b.node_end; ++node)
    model.node_mass[node] = mass * m.share[node - b.node_begin];
}

} // namespace cdem
