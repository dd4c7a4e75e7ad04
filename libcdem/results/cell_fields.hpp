// Fields of tetrahedra for files and pictures.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

#include <functional>

namespace cdem {

// What a field is made from: the model alone; the state of its tet; or bonds and joints around it, which other ranks may
// keep.
enum class FieldSource { model, tet, around };

// Values of these tets, of the fields that are wanted; the others are named only. In the order of files.
using WantedField = std::function<bool(const std::string& name, FieldSource)>;
std::vector<SnapshotField> cell_fields(const Model&, const State&, const std::vector<int>& tets,
                                       const WantedField&);

} // namespace cdem
