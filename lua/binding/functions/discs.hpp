// Discs as scripts give them.
#pragma once

#include "lua/binding/module/record.hpp"
#include "lua/binding/session/session.hpp"

#include "libgeom/assembly/discs.hpp"

namespace cdem::script {

struct Session;

const Record<geom::Disc>& disc_record();
std::vector<geom::Disc> discs_of(Session&, const Arguments&); // of the list "discs"

} // namespace cdem::script
