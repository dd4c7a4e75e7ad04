// Units fall and come to rest, in visible phases of one stage:
//   rigid fall    free units as rigid bodies, ballistic until they touch something, then with local damping
//   deformable    the same units deform again; they take up their weight, with local damping
// Without rigid units the whole stage is deformable, after an undamped free fall until the first contact. A phase ends
// when the kinetic energy has stayed below the given fraction of its peak in the stage for some steps; where units
// deform, the out-of-balance forces must also be at most a hundredth of the loads. It also ends when the time is over.
// With reduced friction, units slide until they lean on more bodies; a unit at rest with reduced friction is at rest
// with the full friction too. Rigid units, reduced friction and damping are only for the deposition: all are off
// afterwards.
#pragma once

#include "libcdem/procedure/settle_options.hpp"
#include "libcdem/step/stage.hpp"

namespace cdem {

// model: the context's.
SettleResult settle(Model& model, const StageContext&, const SettleOptions&);

} // namespace cdem
