// Deviation of a state from small strain: the largest strain of any tet, the largest rotation of any block, and the
// largest displacement of a block relative to a neighbour whose broken interface still acts.
//
// Small strain drops terms of second order. A strain e is wrong by about e^2 / 2, and a block rotated by theta has a
// false strain of theta^2 / 2. At 1 degree this is 1.5e-4, or 4.6 MPa in rock of 30 GPa, which is about the tensile
// strength of the rock.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

struct Deformation {
  double strain = 0;                 // largest |principal strain| of any tet
  std::int64_t strain_block = -1;    // id
  double turn = 0;                   // rad, largest rotation of any block
  std::int64_t turn_block = -1;      // id
  double departure = 0;              // least opening of the springs of an interface over its size
  std::int64_t departure_block = -1; // id
};

Deformation largest_deformation(const Model&, const State&);

// How far the two sides of an interface between blocks of small strain, none of whose bonds is whole, have gone from
// each other at least: the least relative displacement of its springs over the root of its area. 0 for every other
// interface.
double departure(const Model&, const State&, const Interface&);
// At least as much: only these springs, those of one rank, are looked at.
double departure(const Model&, const State&, const Interface&, Range points);

} // namespace cdem
