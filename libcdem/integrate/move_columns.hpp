// One step of the columns of free fields by central differences (load/free_field_column.hpp), and the forces they put on
// the sides of the model.
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

struct ColumnStep {
  double time = 0;      // s, of the displacements
  double time_step = 0; // s
  double kick = 0;      // s, from the time of the velocities to half a step ahead
};

// Writes the forces on the sides at amplitude 1. Throws geom::InputError where the state has other columns.
void advance_columns(ResolvedConditions&, State&, const ColumnStep&);

// The same forces where columns and time stand still, from the velocities they have.
void find_side_forces(ResolvedConditions&, const State&);

double column_time_step(const ResolvedConditions&); // s, stable; infinite without columns

} // namespace cdem
