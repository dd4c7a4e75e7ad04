// Whether a Model, a log and a restart point that were read are whole: every index within its array, every range within
// its bounds, every length as its partners ask. What is read may be forged, and its checksum with it; numbers that are
// wrong give wrong results, but no index may lead out of an array.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/step/restart_point.hpp"

namespace cdem {

// Each throws InputError that names the field.
void require_whole(const Model&);
void require_whole(const Model&, const RunLog&);
void require_whole(const Model&, const RunLog&, const RestartPoint&);

} // namespace cdem
