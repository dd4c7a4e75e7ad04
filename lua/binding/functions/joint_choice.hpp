// Which joints a result is about.
#pragma once

#include "lua/binding/objects/model_object.hpp"
#include "lua/binding/schema/schema.hpp"

namespace cdem::script {

std::vector<Field> joint_choice_fields();
JointChoice joint_choice(const ModelObject&, const Arguments&);

} // namespace cdem::script
