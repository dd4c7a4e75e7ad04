// mass_scaling of the stages that run in real time: what a script gives, is given back and is warned of.
#pragma once

#include "lua/binding/schema/schema.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libcdem/step/options.hpp"

namespace cdem::script {

Field mass_scaling_field();        // of the call
Field mass_scaling_result_field(); // of its result

MassScaling mass_scaling_of(const Arguments&);

// Adds what the scaling came to, to the result of a stage; to the log too, with a warning where it is more than a
// quasi-static stage bears.
void add_mass_scaling(Session&, const char* kind, const MassScaling&, double time_step, const ScaledMasses&,
                      Value& result);

} // namespace cdem::script
