// Names in messages.
#pragma once

#include "libgeom/core/nearest.hpp"

namespace cdem::script {

using geom::did_you_mean;
using geom::nearest;

std::string joined(const std::vector<std::string>& names, const std::string& separator = ", ");

} // namespace cdem::script
