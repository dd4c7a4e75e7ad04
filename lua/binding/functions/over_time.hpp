// A factor over time as a script gives it: a table, or a function of its own.
#pragma once

#include "lua/binding/schema/schema.hpp"

#include "libcdem/load/conditions.hpp"

namespace cdem::script {

// "amplitude": factor over time (s), 1 when left out.
Field amplitude_field();
// "since": when its times begin (s), beside every amplitude.
Field since_field();
// A function is tried at the model's time `now`, s, so that a slip in it is an error of the line that gave it.
Amplitude amplitude_of(const Arguments&, double now);

// A vector that a function of time gives, asked once at the time `now` so that a slip in it is an error of the line that gave it.
std::function<geom::Vec3(double)> vector_over_time(const std::shared_ptr<Reference>&,
                                                   const std::string& field, double now);

} // namespace cdem::script
