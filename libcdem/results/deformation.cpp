#include "libcdem/results/deformation.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/small_strain.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

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

double departure(const Model& model, const State& state, const Interface& interface) {
  return departure(model, state, interface, {interface.point_begin, interface.point_end});
}

double departure(const Model& model, const State& state, const Interface& interface, Range points) {
  if (interface.frame >= 0 || interface.point_begin == interface.point_end)
    return 0;
  double area = 0, least = std::numeric_limits<double>::infinity();
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    area += model.points[p].area;
  const auto begin = std::max<std::int64_t>(points.begin, interface.point_begin),
             end = std::min<std::int64_t>(points.end, interface.point_end);
  if (begin >= end)
    return 0;
  for (auto p = static_cast<int>(begin); p < end; ++p) {
    if (is_intact(state.bond_mode[p]))
      return 0;
    least = std::min(least, jump(model, state.displacement, p).norm());
  }
  return least / std::sqrt(area);
}

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
  for (const Interface& interface : model.interfaces)
    if (const double gone = departure(model, state, interface); gone > found.departure) {
      found.departure = gone;
      found.departure_block = model.blocks[interface.block_b].id;
    }
  return found;
}

} // namespace cdem
