#include "libcdem/results/deformation.hpp"

#include "libcdem/element/small_strain.hpp"

#include <Eigen/Eigenvalues>

namespace cdem {
namespace {

double largest_principal(const geom::Mat3& strain) {
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(strain, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

// Angle of the rotation whose first-order part is the skew part of the gradient.
double turn_of(const geom::Mat3& gradient) {
  const geom::Vec3 axial(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0),
                         gradient(1, 0) - gradient(0, 1));
  return 0.5 * axial.norm();
}

} // namespace

Deformation largest_deformation(const Model& model, const State& state) {
  Deformation found;
  for (const Block& block : model.blocks) {
    if (block.meshed)
      continue; // made for large motion
    const double turn = turn_of(block_gradient(model, state.displacement, block));
    if (turn > found.turn) {
      found.turn = turn;
      found.turn_block = block.id;
    }
    for (int t = block.tet_begin; t < block.tet_end; ++t) {
      const geom::Mat3 gradient = displacement_gradient(model, state.displacement, t);
      const geom::Mat3 strain = 0.5 * (gradient + gradient.transpose());
      if (strain.norm() <= found.strain) // the norm is never less than the largest principal strain
        continue;
      const double largest = largest_principal(strain);
      if (largest > found.strain) {
        found.strain = largest;
        found.strain_block = block.id;
      }
    }
  }
  return found;
}

} // namespace cdem
