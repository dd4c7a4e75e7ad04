// model:picture, which films take too.
#pragma once

#include "lua/binding/session/model_object.hpp"

namespace cdem::script {

std::vector<Field> model_picture_fields();
Value model_picture(Session&, ModelObject&, const Arguments&);

} // namespace cdem::script
