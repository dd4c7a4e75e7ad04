// Piles of units as a script holds them, and their files.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libgeom/placement/pile.hpp"

namespace cdem::script {

struct PileObject final : Object {
  explicit PileObject(geom::Pile given) : pile(std::move(given)) {}

  geom::Pile pile;

  const char* class_name() const override { return "Pile"; }
};

// JSON: the unit's mesh about its centroid, its height, and for each unit its centroid and its rotation by
// rows; every number with all its digits.
std::string pile_text(const geom::Pile&);
// Throws geom::InputError, `source` first, for text that is no pile or one whose numbers cannot be.
geom::Pile pile_from(const std::string& text, const std::string& source);

} // namespace cdem::script
