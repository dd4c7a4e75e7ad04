// Columns of free fields (load/free_field_column.hpp): made of the sides they stand at. integrate/move_columns.hpp steps them.
#pragma once

#include "libcdem/load/quiet.hpp"

namespace cdem {

// Throws geom::InputError where the side is none of x-, x+, y-, y+, and where the model has no foot to it.
Column free_field_column(const Model&, const Conditions&, const FreeField&, const std::vector<int>& faces);

std::size_t column_levels(const ResolvedConditions&); // of all columns

} // namespace cdem
