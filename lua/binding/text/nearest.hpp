// Names in messages.
#pragma once

#include "libgeom/core/nearest.hpp"

namespace cdem::script {

using geom::did_you_mean;
using geom::nearest;

// "; did you mean x? There are: x, y", or ". There are: x, y" when none is near. For the end of a message.
std::string which_there_are(const std::string& wrong, const std::vector<std::string>& names,
                            const std::string& intro = "There are");

std::string joined(const std::vector<std::string>& names, const std::string& separator = ", ");

} // namespace cdem::script
