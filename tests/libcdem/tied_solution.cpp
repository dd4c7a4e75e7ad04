#include "tests/libcdem/tied_solution.hpp"

#include <Eigen/Sparse>
#include <map>

namespace testing {
namespace {

// One number for all nodes in one place.
std::vector<int> merged(const cdem::Model& model, int& count) {
  std::map<std::array<long, 3>, int> found;
  std::vector<int> number;
  for (const geom::Vec3& x : model.node_position) {
    std::array<long, 3> key{};
    for (int axis = 0; axis < 3; ++axis)
      key[axis] = std::lround((x[axis] - model.box.min[axis]) / (1e-6 * model.length));
    number.push_back(found.emplace(key, static_cast<int>(found.size())).first->second);
  }
  count = static_cast<int>(found.size());
  return number;
}

} // namespace

std::vector<geom::Vec3> tied_solution(const cdem::Model& model, const TiedProblem& problem) {
  int count = 0;
  const std::vector<int> number = merged(model, count);
  std::vector<char> held(3 * count, 0);
  for (std::size_t i = 0; i < number.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (problem.held(model.node_position[i])[axis])
        held[3 * number[i] + axis] = 1;

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * count);
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const geom::Tet& tet = model.tets[t];
    const cdem::Elastic& m = model.bodies[model.blocks[model.tet_block[t]].body].material;
    // Shape functions are linear: their coefficients are the inverse of the matrix of (1, x).
    Eigen::Matrix4d corners;
    for (int a = 0; a < 4; ++a)
      corners.row(a) << 1, model.node_position[tet[a]].transpose();
    const Eigen::Matrix4d coefficients = corners.inverse();
    Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
    for (int a = 0; a < 4; ++a) {
      const double x = coefficients(1, a), y = coefficients(2, a), z = coefficients(3, a);
      b.block<6, 3>(0, 3 * a) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
    }
    Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
    const double nu = m.poissons_ratio, factor = m.youngs_modulus / ((1 + nu) * (1 - 2 * nu));
    c.topLeftCorner<3, 3>().setConstant(factor * nu);
    c.topLeftCorner<3, 3>().diagonal().setConstant(factor * (1 - nu));
    c.bottomRightCorner<3, 3>().diagonal().setConstant(factor * (1 - 2 * nu) / 2);
    const Eigen::Matrix<double, 12, 12> k = corners.determinant() / 6 * b.transpose() * c * b;
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) {
        const int row = 3 * number[tet[i / 3]] + i % 3, column = 3 * number[tet[j / 3]] + j % 3;
        if (!held[row] && !held[column] && row >= column)
          entries.emplace_back(row, column, k(i, j));
      }
    // Corners 1, 2, 3 make the triangle on the block's face.
    const geom::Vec3 &x1 = model.node_position[tet[1]], &x2 = model.node_position[tet[2]],
                     &x3 = model.node_position[tet[3]];
    const geom::Vec3 area = 0.5 * (x2 - x1).cross(x3 - x1);
    const geom::Vec3 force = problem.traction(x1, area.normalized()) * area.norm() / 3;
    for (int a = 1; a < 4; ++a)
      load.segment<3>(3 * number[tet[a]]) += force;
  }
  for (int i = 0; i < 3 * count; ++i)
    if (held[i]) {
      entries.emplace_back(i, i, 1.0);
      load[i] = 0;
    }
  Eigen::SparseMatrix<double> stiffness(3 * count, 3 * count);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(stiffness);
  const Eigen::VectorXd u = solver.solve(load);

  std::vector<geom::Vec3> displacement;
  for (const int n : number)
    displacement.emplace_back(u.segment<3>(3 * n));
  return displacement;
}

} // namespace testing
