// Which inner faces of a meshed body carry bonds, and how stiff those are (Feng 2014 section 2.3).
#pragma once

#include <algorithm>
#include <vector>

namespace cdem {

struct Bonding {
  bool everywhere = false;      // every inner face
  bool between_regions = false; // faces between two different regions of the mesh
  std::vector<int> regions;     // every face of a tet of these regions (from 0)

  // Kn = beta E A / (3 d). Springs in series with the tets: a body bonded everywhere has about E / (1 + 1/beta) left,
  // while its stable step shrinks like 1 / sqrt(beta).
  double stiffness_ratio = 10; // beta, > 0
  double shear_ratio = 1;      // Ks / Kn, > 0

  bool none() const { return !everywhere && !between_regions && regions.empty(); }
  bool bonds(int region_a, int region_b) const {
    const auto listed = [&](int region) {
      return std::find(regions.begin(), regions.end(), region) != regions.end();
    };
    return everywhere || (between_regions && region_a != region_b) || listed(region_a) || listed(region_b);
  }
};

} // namespace cdem
