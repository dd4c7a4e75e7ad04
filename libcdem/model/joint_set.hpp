// The joint set or named cut that an interface belongs to.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// The name whose law the interface has; else the name on the face of its first block, or of its second; "" where neither has
// one, and for glued faces.
std::string joint_set_of(const Model&, const Interface&);

// All names, in alphabetical order, without "".
std::vector<std::string> joint_sets(const Model&);

// Throws geom::InputError naming the sets there are when `name` is none of them.
void require_joint_set(const Model&, const std::string& field, const std::string& name);

} // namespace cdem
