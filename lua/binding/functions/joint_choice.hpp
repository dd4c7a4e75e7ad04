// Which joints a result is about.
#pragma once

#include "lua/binding/schema/schema.hpp"
#include "lua/binding/session/model_object.hpp"

namespace cdem::script {

std::vector<Field> joint_choice_fields();
JointChoice joint_choice(const ModelObject&, const Arguments&);

} // namespace cdem::script
