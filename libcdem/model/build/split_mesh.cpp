#include "libcdem/model/build/split_mesh.hpp"

#include "libgeom/core/disjoint_sets.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace cdem {
namespace {

std::array<geom::Vec3, 3> corners_of(const geom::TetMesh& mesh, const geom::InnerFace& face) {
  return {mesh.nodes[face.nodes[0]], mesh.nodes[face.nodes[1]], mesh.nodes[face.nodes[2]]};
}

BondedFace bonded_face(const geom::TetMesh& mesh, const geom::InnerFace& face, const Body& body) {
  const auto [x0, x1, x2] = corners_of(mesh, face);
  const double area = 0.5 * (x1 - x0).cross(x2 - x0).norm();
  const double d = 3 * (tet_volume(mesh, face.tets[0]) + tet_volume(mesh, face.tets[1])) / (4 * area);
  return {face, body.bonding.stiffness_ratio * body.material.youngs_modulus * area / (3 * d), area / 3, {}};
}

} // namespace

double tet_volume(const geom::TetMesh& mesh, int t) {
  const geom::Tet& n = mesh.tets[t];
  const auto& x = mesh.nodes;
  return (x[n[1]] - x[n[0]]).dot((x[n[2]] - x[n[0]]).cross(x[n[3]] - x[n[0]])) / 6;
}

SplitMesh split_mesh(const geom::TetMesh& mesh, const std::vector<geom::InnerFace>& inner,
                     const Splitting& splitting) {
  geom::DisjointSets sets(4 * mesh.tets.size()); // of corners, 4 tet + corner
  std::vector<int> first(mesh.nodes.size(), -1);
  for (int i = 0; i < static_cast<int>(4 * mesh.tets.size()); ++i) {
    const int node = mesh.tets[i / 4][i % 4];
    if (!splitting.whole(node))
      continue;
    if (first[node] < 0)
      first[node] = i;
    sets.unite(first[node], i);
  }
  for (const geom::InnerFace& face : inner) {
    if (splitting.parts(face))
      continue;
    for (int i = 0; i < 3; ++i)
      sets.unite(4 * face.tets[0] + face.corners[0][i], 4 * face.tets[1] + face.corners[1][i]);
  }
  SplitMesh split;
  split.tets.reserve(mesh.tets.size());
  std::vector<int> copy(4 * mesh.tets.size(), -1);
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t) {
    geom::Tet tet{};
    for (int corner = 0; corner < 4; ++corner) {
      int& node = copy[sets.find(4 * t + corner)];
      if (node < 0) {
        node = static_cast<int>(split.original.size());
        split.original.push_back(mesh.tets[t][corner]);
      }
      tet[corner] = node;
    }
    split.tets.push_back(tet);
  }
  return split;
}

std::vector<BondedFace> bonded_faces(const geom::TetMesh& mesh, const std::vector<geom::InnerFace>& inner,
                                     const Body& body, const Splitting& splitting, bool with_strength) {
  std::vector<BondedFace> bonded;
  std::optional<FaceStrengths> strengths;
  if (with_strength)
    strengths.emplace(body, mesh, inner);
  for (const geom::InnerFace& face : inner)
    if (splitting.parts(face)) {
      bonded.push_back(bonded_face(mesh, face, body));
      if (strengths)
        bonded.back().strength = strengths->of(face.tets[0], face.tets[1]);
    }
  return bonded;
}

void require_fracture_energy(const geom::TetMesh& mesh, const std::vector<geom::InnerFace>& inner,
                             const Body& body) {
  if (!body.bonding.is_cohesive())
    return;
  const FaceStrengths strengths(body, mesh, inner);
  const auto require = [&](const char* field, double energy, double strength, double stored) {
    if (energy < stored)
      throw geom::InputError(
          field, fmt::format("{:g}", energy),
          fmt::format(
              "at least {:.3g} J/m2, what the largest face of the mesh stores at its strength of {:g} Pa",
              1.005 * stored, strength),
          "raise it, make the mesh of body \"" + body.name + "\" finer, or its stiffness_ratio larger");
  };
  struct Most {
    double stored = 0, strength = 0;
    void take(double s, double k) {
      if (s * s / (2 * k) > stored) {
        stored = s * s / (2 * k);
        strength = s;
      }
    }
  };
  for (int law = -1; law < static_cast<int>(body.region_laws.joints.size()); ++law) {
    const Joint& joint = body.joint_of(law);
    if (joint.softening == Softening::none)
      continue;
    Most opening, slip;
    for (const geom::InnerFace& face : inner) {
      const int a = mesh.region[face.tets[0]], b = mesh.region[face.tets[1]];
      if (!body.bonding.bonds(a, b) || body.region_laws.between(a, b) != law)
        continue;
      const BondedFace f = bonded_face(mesh, face, body);
      const FaceStrength own = strengths.of(face.tets[0], face.tets[1]);
      opening.take(own.tensile_strength, f.kn / f.area);
      slip.take(own.cohesion, f.kn / f.area);
    }
    require("fracture_energy_1", joint.fracture_energy_1, opening.strength, opening.stored);
    require("fracture_energy_2", joint.fracture_energy_2, slip.strength, slip.stored);
  }
}

std::vector<std::int64_t> inner_first(SplitMesh& split, const std::vector<BondedFace>& faces, int chunk_tets,
                                      bool both_sides) {
  const std::size_t copies = split.original.size();
  std::vector<int> owner(copies, -1), order; // as the tets come: so the nodes of a chunk follow each other
  std::vector<char> shared(copies, 0);
  order.reserve(copies);
  const auto touch = [&](int node, int tet) {
    const int chunk = tet / chunk_tets;
    if (owner[node] < 0) {
      owner[node] = chunk;
      order.push_back(node);
    }
    shared[node] |= static_cast<char>(owner[node] != chunk);
  };
  for (int t = 0; t < static_cast<int>(split.tets.size()); ++t)
    for (const int node : split.tets[t])
      touch(node, t);
  for (const BondedFace& f : faces) // their forces are summed where the tet of side a is
    for (int side = 1; side >= (both_sides ? 0 : 1); --side)
      for (const int corner : f.face.corners[side])
        touch(split.tets[f.face.tets[side]][corner], f.face.tets[1 - side]);

  std::vector<std::int64_t> inner;
  for (auto begin = order.begin(); begin != order.end();) {
    const int chunk = owner[*begin];
    const auto end = std::find_if(begin, order.end(), [&](int node) { return owner[node] != chunk; });
    const auto middle = std::stable_partition(begin, end, [&](int node) { return shared[node] == 0; });
    inner.resize(static_cast<std::size_t>(chunk)); // chunks between use no node first
    inner.push_back(middle - begin);
    begin = end;
  }
  inner.resize((split.tets.size() + chunk_tets - 1) / chunk_tets);
  std::vector<int> number(copies), original;
  original.reserve(order.size());
  for (const int node : order) {
    number[node] = static_cast<int>(original.size());
    original.push_back(split.original[node]);
  }
  split.original = std::move(original);
  for (geom::Tet& tet : split.tets)
    for (int& node : tet)
      node = number[node];
  return inner;
}

} // namespace cdem
