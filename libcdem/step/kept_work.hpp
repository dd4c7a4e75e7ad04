// What a stage knows of bonds and contacts where it ends, for the next stage. All of it could be found again in the model and
// the state, as a resumed stage does, and changes no bit; so it is not saved.
#pragma once

#include "libcdem/results/tet_at_place.hpp"
#include "libcdem/step/contact_update.hpp"

#include <optional>

namespace cdem {

struct KeptWork {
  // The end of a run, for one that goes on from it.
  struct End {
    BondWork bond;
    ContactWork contact;
    ContactUpdate contacts;
    double stable = 0;                                // s, Stage::stable
    std::shared_ptr<const TetsByPlace> tets_by_place; // for probes; null: unknown
  };
  std::optional<End> end;
  // For any stage of a model with this fingerprint: which of its tetrahedra are near each other; null: none are known.
  std::uint64_t model = 0;
  std::shared_ptr<TetContacts> tet_contacts;
};

} // namespace cdem
