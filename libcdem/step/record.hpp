// What a step leaves in the log and the ledger.
#pragma once

#include "libcdem/fracture/begin_cracks.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/results/tet_at_place.hpp"
#include "libcdem/step/stage_context.hpp"
#include "libcdem/step/workspace.hpp"

namespace cdem {

// Bonds that broke in this step, and what friction and breaking took there. Returns how many.
std::int64_t record_bond_breaks(const Model&, State&, const Workspace&, RunLog&, int stage,
                                std::int64_t step);
// The same of the bonded faces of meshes; contacts are told of those that are handed over to them.
std::int64_t record_face_breaks(const Model&, State&, Workspace&, RunLog&, int stage, std::int64_t step);

// The same of faces of cohesive bodies that broke as soon as they cracked.
std::int64_t record_begun_cracks(const Model&, State&, const BegunCracks&, RunLog&, int stage,
                                 std::int64_t step);

// kinetic: J. Probes read stresses: they have to be caught up. tets: of the model, found here when it is null.
void record_history(const StageContext&, double residual, double kinetic,
                    std::shared_ptr<const TetsByPlace>& tets);

// Bodies that touch now are taken out of RunLog::unmet.
void strike_out_met(const Model&, const State&, RunLog&);

// Which watched units have left.
void look_at_units(const Model&, const State&, const Conditions&, RunLog&);

} // namespace cdem
