// Straight bars of cubes along x for the tests with a formula in one dimension, and their long-wave moduli: a
// block and a joint in series give M / (1 + M / (kn h)).
#pragma once

#include "tests/libcdem/system.hpp"

namespace testing {

struct Bar {
  double length = 1; // m
  int blocks = 20;   // cubes along the length
  double poissons_ratio = 0;
  double thickness_ratio = 0.02;

  double h() const { return length / blocks; }
  double area() const { return h() * h(); }
  cdem::Elastic material() const;
  cdem::Joint joint() const;
  geom::Assembly shape() const;
  System system() const;

  double effective(double modulus) const; // with the joints in series
  double wave_modulus_confined() const { return effective(material().p_wave_modulus()); }
};

// All nodes with |x - place| < tolerance of a quarter block.
std::vector<int> nodes_at(const cdem::Model&, double x, double tolerance);
// Hz, of the first mode along a bar that is held at x = 0, from the zero crossings of its modal displacement.
double axial_frequency(System&, double length, const cdem::Elastic&);
double mean_velocity_x(const System&, const std::vector<int>& nodes); // m/s

} // namespace testing
