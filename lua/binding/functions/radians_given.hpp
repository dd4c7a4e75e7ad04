// Angles of a script that look as if they were in radians.
#pragma once

#include "lua/binding/schema/schema.hpp"
#include "lua/binding/session/session.hpp"

#include <string>
#include <vector>

namespace cdem::script {

// Warns where no dip is steeper than pi/2 degrees, no dip direction beyond 2 pi, and some dip is no whole number. what: the
// function and its field.
void warn_of_radians(Session&, const std::string& what, const std::vector<double>& dips,
                     const std::vector<double>& dip_directions);
// The same of angles round a circle.
void warn_of_radians(Session&, const std::string& what, const std::vector<double>& angles);

} // namespace cdem::script
