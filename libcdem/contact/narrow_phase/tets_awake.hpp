// Which pairs of single tetrahedra are computed in a step, and where their planes are.
#pragma once

#include "libcdem/contact/data/tet_pairs.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes TetPairs::awake, now and contact_begin. State::contacts are those before the step.
void find_tets_awake(const Model&, const State&, ContactWork&, int threads);

// A pair that has been computed is skipped until its movers have moved by `until` (m) relative to each other.
void fall_asleep(const ContactWork&, TetPairs&, std::size_t pair, double until);

// Writes TetPairs::ordered.
void order_found(std::size_t n_triangles, TetPairs&);

// The order in which forces of contacts of semi-springs are added: by triangle, fragment and corner.
inline std::tuple<int, int, int> order_of(const Contact& c) {
  return {static_cast<int>(c.source) / 3, c.fragment, static_cast<int>(c.source) % 3};
}

} // namespace cdem
