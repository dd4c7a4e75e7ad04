// Which inner faces of a meshed body may break, and what holds them until then.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace cdem {

// springs: the two sides of every such face have nodes of their own and three springs between them (Feng 2014 section
// 2.3, bond/face_bonds.hpp). cohesive: the body is continuous, with shared nodes, until a face nears its strength; then
// its nodes are freed and a cohesive law holds it (bond/cohesive_faces.hpp).
enum class BondKind : std::uint8_t { springs, cohesive };

struct Bonding {
  BondKind kind = BondKind::springs;
  bool everywhere = false;      // every inner face
  bool between_regions = false; // faces between two different regions of the mesh
  std::vector<int> regions;     // every face of a tet of these regions (from 0)

  // Kn = beta E A / (3 d). In a cohesive body it is the penalty on relative displacements across freed faces, which
  // does not change the stiffness of the body (a beta of about 1 is enough). Springs are in series with the tets: a
  // body bonded everywhere has a modulus of about E / (1 + 1/beta), and its stable step is proportional to 1 /
  // sqrt(beta).
  double stiffness_ratio = 10; // beta, > 0
  double shear_ratio = 1;      // Ks / Kn, > 0

  bool is_cohesive() const { return kind == BondKind::cohesive && !none(); }
  bool none() const { return !everywhere && !between_regions && regions.empty(); }
  bool bonds(int region_a, int region_b) const {
    const auto listed = [&](int region) {
      return std::find(regions.begin(), regions.end(), region) != regions.end();
    };
    return everywhere || (between_regions && region_a != region_b) || listed(region_a) || listed(region_b);
  }
};

} // namespace cdem
