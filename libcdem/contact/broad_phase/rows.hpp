// From pairs that are near each other to rows: all targets near one source, of one fragment.
#pragma once

#include "libcdem/contact/broad_phase/candidates.hpp"
#include "libcdem/contact/broad_phase/renewed.hpp"

namespace cdem {

// Writes ContactWork::rows of one kind: those that stay, and those of `parts`.
void make_rows(const Model&, ContactWork&, const SearchMargin&, const std::vector<std::vector<Near>>& parts,
               Contact::Kind, const Renewed&);

} // namespace cdem
