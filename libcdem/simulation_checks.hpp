// What Simulation refuses before it starts: each throws geom::InputError naming field, value and allowed range.
#pragma once

#include "libcdem/simulation.hpp"

namespace cdem {

std::string number(double x); // as messages print it
void require_finite(const char* field, const geom::Vec3&);
void validate_meshed(const BodySpec&); // a body of meshes
// between: what the joint holds.
void require_spring_strength(const Joint&, const std::string& between);
void check(const RelaxOptions&);
void check(const MassScaling&);
void check(const RunOptions&);
void check(const SettleOptions&);
void check(const Flow&);
void check(const CriticalFlowOptions&);

} // namespace cdem
