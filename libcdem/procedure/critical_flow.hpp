// Search for the flow at which a held solid breaks (Feng 2014 section 3).
//
//   ramp  the pressure rises at a constant rate: inertia sets part of the result
//   hold  it rises at that rate only while no bond broke for a hold time: near the static strength
//
// Both end at the first of two events. (1) A piece of at least `fragment_fraction` of the volume is connected to no
// held node. (2) The compliance is `compliance_ratio` times that of the unbroken solid at rest; compliance is the
// displacement, weighted by the nodal forces of the flow, over the pressure. Before the search a relaxation at a small
// pressure gives the compliance of the unbroken solid. Rayleigh's quotient omega^2 = F . u / u . M u of this state
// gives the period of the first mode, the unit of the hold time.
#pragma once

#include "libcdem/procedure/critical_flow_options.hpp"
#include "libcdem/step/stage.hpp"

namespace cdem {

// The context's conditions are those without the flow. Throws geom::InputError when nothing is held, or when the flow
// meets no face that looks towards it.
CriticalFlowResult critical_flow(const StageContext&, const CriticalFlowOptions&);

} // namespace cdem
