// A Model, a State and a RunLog as bytes.
#pragma once

#include "libcdem/checkpoint/archive.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

CDEM_ARCHIVE(OuterFace, block, face, boundary, normal, area, node_area)

void write(Writer&, const Model&);
void read(Reader&, Model&);
std::uint64_t hash(const Model&); // XXH64 of every member

// Through the registry, field by field with its name.
void write(Writer&, const State&);
void read(Reader&, State&);

// Rows after `last_step` (over all stages) and breaks beyond the first `breaks` are left out: the log as it was then.
void write(Writer&, const RunLog&, std::int64_t last_step, std::size_t breaks, const OneWayEnergies&);
void read(Reader&, RunLog&);

} // namespace cdem
