// From what a script writes after `on =` to libcdem's selections.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libcdem/model/selection.hpp"

namespace cdem::script {

struct ModelObject;

Selection predicate_selection(const std::shared_ptr<Reference>& function);

// A side, a name given by model:select, a body, a cdem.select.* value, a function(x, y, z), or a list of
// these: one Selection for each member. `key` is what the script calls it. Throws geom::InputError with the
// names there are.
std::vector<Selection> selections(const ModelObject&, const Value& place, const std::string& key);

// Where a single place is wanted: a measurement. A nil place is the whole model.
Selection one_selection(const ModelObject&, const Value& place, const std::string& key);

} // namespace cdem::script
