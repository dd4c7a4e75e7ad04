// Units fall and come to rest, in visible phases of one stage:
//   rigid fall    free units as rigid bodies, ballistic until they touch something, then with local damping
//   deformable    the same units deform again; they take up their weight, with local damping
// Without rigid units all of it is deformable, after a free fall until the first touch that nothing damps.
// Each ends when the kinetic energy has stayed under the asked part of the largest of the stage for some steps, and
// where units deform the forces out of balance are a hundredth of the loads, or when the time is up. With less friction,
// if asked, units slide until they lean on more things; what rests so does with all of it. Rigid units, less friction
// and damping are for the deposition alone: all are off afterwards.
#pragma once

#include "libcdem/procedure/settle_options.hpp"
#include "libcdem/step/stage.hpp"

namespace cdem {

// model: the context's.
SettleResult settle(Model& model, const StageContext&, const SettleOptions&);

} // namespace cdem
