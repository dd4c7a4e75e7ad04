// Search for the flow at which a held solid breaks (Feng 2014 section 3).
//
//   ramp  the pressure rises at a constant rate: inertia sets part of the result
//   hold  it rises at that rate only while no bond broke for a hold time: near the static strength
//
// Both end at the first of: a piece of at least `fragment_fraction` of the volume hangs on no held node any more; the
// compliance, displacement under the flow's own pattern over pressure, is `compliance_ratio` times that of the unbroken
// solid at rest. Before it starts a relaxation at a small pressure gives that compliance and, by Rayleigh's quotient
// omega^2 = F . u / u . M u, the period of the first mode, in which the hold time is measured.
#pragma once

#include "libcdem/procedure/critical_flow_options.hpp"
#include "libcdem/step/stage.hpp"

namespace cdem {

// The context's conditions are those without the flow. Throws geom::InputError when nothing is held, or when the flow
// meets no face that looks towards it.
CriticalFlowResult critical_flow(const StageContext&, const CriticalFlowOptions&);

} // namespace cdem
