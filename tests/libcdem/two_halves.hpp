// A box of two halves with bonds on the plane between them, led apart, onto each other or along.
#pragma once

#include "tests/libcdem/system.hpp"

namespace testing {

constexpr double side = 0.6, half = 0.3; // m
constexpr double beta = 10, shear_ratio = 0.4;
constexpr double area = side * side;
constexpr int springs = 6; // two triangles

// A box whose upper half is region 1: n cells along each axis in each half.
geom::TetMesh two_halves(int n);
cdem::Bonding between_halves(double ratio = shear_ratio);
cdem::Joint halves_joint(bool bonded = true);

// Leads the upper half by a given gap, everything turned by `turn`, and asks for the force.
class Halves {
public:
  explicit Halves(const cdem::Joint&, geom::Mat3 turn = geom::Mat3::Identity(), double ratio = shear_ratio);

  void turn(const geom::Mat3& to) { turn_ = to; }
  // To where an elastic bond would carry this traction, Pa; what the upper half feels of the lower one, Pa.
  geom::Vec3 go(const geom::Vec3& traction);
  geom::Vec3 lead(const geom::Vec3& gap); // m
  int with_mode(cdem::BondMode) const;
  int handed_over() const; // faces
  const std::vector<cdem::FaceBreak>& breaks() const { return breaks_; }

  System system;

private:
  geom::Mat3 turn_;
  std::vector<char> upper_; // node is of the upper half
  double ratio_;            // Ks / Kn
  double kn_ = 0;           // Pa/m
  std::vector<cdem::FaceBreak> breaks_;
};

std::vector<char> upper_nodes(const cdem::Model&);

} // namespace testing
