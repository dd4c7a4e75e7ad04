// Discs as scripts give them.
#pragma once

#include "lua/binding/schema/schema.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/assembly/discs.hpp"

namespace cdem::script {

struct Session;

std::vector<Field> disc_fields();
std::vector<geom::Disc> discs_of(Session&, const Arguments&); // of the list "discs"

} // namespace cdem::script
