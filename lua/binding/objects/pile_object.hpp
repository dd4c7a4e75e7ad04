// Piles of units as a script holds them, and their files.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libgeom/placement/pile.hpp"

namespace cdem::script {

// What has become of a unit of a model's body.
struct UnitNow {
  int number = 0; // in its body, from 1
  int pieces = 1;
  double largest_piece = 1; // part of its volume
  // No piece has more than nine tenths of it.
  bool broken() const { return largest_piece <= 0.9; }
};

struct PileObject final : Object {
  explicit PileObject(geom::Pile given); // whole units, numbered in their order
  PileObject(geom::Pile given, std::vector<UnitNow> given_units)
      : pile(std::move(given)), units(std::move(given_units)) {}

  geom::Pile pile;
  std::vector<UnitNow> units; // one for each pose

  const char* class_name() const override { return "Pile"; }
};

// JSON: the unit's mesh about its centroid, its height, and for each unit its centroid, its rotation by rows, its number and
// into what it has broken; every number with all its digits.
std::string pile_text(const PileObject&);
// Throws geom::InputError, `source` first, for text that is no pile or one whose numbers cannot be.
std::shared_ptr<PileObject> pile_from(const std::string& text, const std::string& source);

} // namespace cdem::script
