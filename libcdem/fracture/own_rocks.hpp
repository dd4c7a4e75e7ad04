// Strengths of the faces of a chunk where they have their own, and the least that any stress must use before
// one of them can be at its strength: a bound for each law of the body, by the weakest face that has it.
#pragma once

#include "libcdem/fracture/critical_plane.hpp"
#include "libcdem/model/model.hpp"

namespace cdem {

class OwnRocks {
public:
  explicit OwnRocks(const Body& body) {
    for (int law = -1; law < static_cast<int>(body.region_laws.joints.size()); ++law)
      of_law_.push_back(rock_strength(body.joint_of(law)));
    weakest_.assign(of_law_.size(), {});
  }
  // law: into the body's region_laws; -1: the body's joint. Pa.
  RockStrength of(int law, double tensile_strength, double cohesion) const {
    RockStrength rock = of_law_[law + 1];
    rock.tensile_strength = tensile_strength;
    rock.cohesion = cohesion;
    return rock;
  }
  void take(int law, const RockStrength& rock) {
    RockStrength& weakest = weakest_[law + 1];
    const bool first = weakest.tensile_strength == 0;
    const RockStrength before = weakest;
    weakest = rock;
    if (!first) {
      weakest.tensile_strength = std::min(before.tensile_strength, rock.tensile_strength);
      weakest.cohesion = std::min(before.cohesion, rock.cohesion);
    }
  }
  // Bounds of the laws that some face has.
  std::vector<UtilisationBound> bounds(double utilisation) const {
    std::vector<UtilisationBound> all;
    for (const RockStrength& rock : weakest_)
      if (rock.tensile_strength > 0)
        for (const UtilisationBound& bound : utilisation_bounds(rock, utilisation))
          all.push_back(bound);
    return all;
  }

private:
  std::vector<RockStrength> of_law_,
      weakest_; // that of the body's joint first; weakest_ without strength: no face
};

} // namespace cdem
