#include "libcdem/model/build/face_strength.hpp"

#include "libcdem/model/build/split_mesh.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

namespace cdem {
namespace {

// The same for points in any order.
template <std::size_t n>
std::uint64_t id_of(std::array<geom::Vec3, n> points) {
  std::sort(points.begin(), points.end(), [](const geom::Vec3& a, const geom::Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  std::uint64_t id = 14695981039346656037ull;
  for (const geom::Vec3& point : points)
    for (int axis = 0; axis < 3; ++axis) {
      const double x = point[axis] + 0.0; // -0 and 0 are one place
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      id = (id ^ (bits ^ (bits >> 32))) * 1099511628211ull;
    }
  return id;
}

} // namespace

bool has_own_strengths(const Body& body) {
  return !body.bonding.none() && (!body.region_laws.empty() || body.joint.scatter.on());
}

bool has_own_strengths(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return has_own_strengths(body); });
}

FaceStrengths::FaceStrengths(const Body& body, const geom::TetMesh& mesh,
                             const std::vector<geom::InnerFace>& inner)
    : body_(body), mesh_(mesh) {
  for (int law = -1; law < static_cast<int>(body.region_laws.joints.size()); ++law) {
    const Joint& joint = body.joint_of(law);
    tan_friction_.push_back(geom::portable::tan(joint.friction_angle));
    factor_.emplace_back();
    if (!joint.scatter.on())
      continue;
    factor_.back() = draws(law, inner);
    spread(factor_.back(), correlation_length(law));
  }
}

FaceStrengths::FaceStrengths(const Body& body, const geom::TetMesh& mesh)
    : FaceStrengths(body, mesh, scatter(body) ? geom::inner_faces(mesh) : std::vector<geom::InnerFace>{}) {}

bool FaceStrengths::scatter(const Body& body) {
  return body.joint.scatter.on() ||
         std::any_of(body.region_laws.joints.begin(), body.region_laws.joints.end(),
                     [](const Joint& joint) { return joint.scatter.on(); });
}

FaceStrength FaceStrengths::of(int tet_a, int tet_b) const {
  FaceStrength face;
  face.joint = body_.region_laws.between(mesh_.region[tet_a], mesh_.region[tet_b]);
  const std::size_t law = static_cast<std::size_t>(face.joint) + 1; // -1: the body's own
  const std::vector<double>& factors = factor_[law];
  const double factor = factors.empty() ? 1 : std::min(factors[tet_a], factors[tet_b]);
  const Joint& joint = body_.joint_of(face.joint);
  face.tensile_strength = factor * joint.tensile_strength;
  face.cohesion = factor * joint.cohesion;
  face.tan_friction = tan_friction_[law];
  return face;
}

// As a power of 2^(1/8): the sum of the volumes, rounded in any order, gives one length.
double FaceStrengths::correlation_length(int law) const {
  constexpr double edges = 5,
                   root_of_72 = 8.48528137423857; // a regular tetrahedron has V = edge^3 / sqrt(72)
  double volume = 0;
  for (int t = 0; t < static_cast<int>(mesh_.tets.size()); ++t)
    volume += tet_volume(mesh_, t);
  const double edge = geom::portable::exp(
      geom::portable::log(root_of_72 * volume / static_cast<double>(mesh_.tets.size())) / 3);
  const Joint& joint = body_.joint_of(law);
  const double zone = joint.softening == Softening::none
                          ? 0
                          : body_.material.youngs_modulus * joint.fracture_energy_1 /
                                (joint.tensile_strength * joint.tensile_strength);
  const double octave = geom::portable::log(2) / 8;
  return geom::portable::exp(octave * std::round(geom::portable::log(std::max(edges * edge, zone)) / octave));
}

std::vector<double> FaceStrengths::draws(int law, const std::vector<geom::InnerFace>& inner) const {
  std::vector<double> volume(mesh_.tets.size(), 0); // that the faces of this law stand for
  for (const geom::InnerFace& face : inner) {
    const auto [a, b] = face.tets;
    const int region_a = mesh_.region[a], region_b = mesh_.region[b];
    if (!body_.bonding.bonds(region_a, region_b) || body_.region_laws.between(region_a, region_b) != law)
      continue;
    const bool is_joint = region_a != region_b && (law >= 0 || !body_.bonding.everywhere);
    for (const int tet : face.tets)
      volume[tet] = is_joint ? volume[tet] + tet_volume(mesh_, tet) / 4 : tet_volume(mesh_, tet);
  }
  const StrengthScatter& scatter = body_.joint_of(law).scatter;
  std::vector<double> factor(mesh_.tets.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < factor.size(); ++t)
    if (volume[t] > 0) {
      std::array<geom::Vec3, 4> corners;
      for (int k = 0; k < 4; ++k)
        corners[k] = mesh_.nodes[mesh_.tets[t][k]];
      factor[t] = scatter_factor(scatter, volume[t], geom::uniform(scatter.seed, id_of(corners), 0));
    }
  return factor;
}

// Each tet gets the least factor within half the length: of the cells of a lattice, four to a length.
void FaceStrengths::spread(std::vector<double>& factor, double length) const {
  constexpr int reach = 2; // cells
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, double> least;
  const auto cell_of = [&](std::size_t t) {
    geom::Vec3 centroid = geom::Vec3::Zero();
    for (const int node : mesh_.tets[t])
      centroid += 0.25 * mesh_.nodes[node];
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<std::int64_t>(std::floor(centroid[axis] / (0.25 * length)));
    return cell;
  };
  for (std::size_t t = 0; t < factor.size(); ++t) {
    const auto [found, fresh] = least.emplace(cell_of(t), factor[t]);
    found->second = std::min(found->second, factor[t]);
  }
  std::map<Cell, double> around;
  for (const auto& [cell, own] : least) {
    double lowest = own;
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        for (int z = -reach; z <= reach; ++z)
          if (x * x + y * y + z * z <= reach * reach)
            if (const auto found = least.find({cell[0] + x, cell[1] + y, cell[2] + z}); found != least.end())
              lowest = std::min(lowest, found->second);
    around.emplace(cell, lowest);
  }
  for (std::size_t t = 0; t < factor.size(); ++t)
    factor[t] = around.at(cell_of(t));
}

double interface_strength(const Joint& joint, const geom::Vec3& centroid_a, const geom::Vec3& centroid_b,
                          double volume) {
  if (!joint.scatter.on())
    return 1;
  const std::uint64_t id = id_of(std::array<geom::Vec3, 2>{centroid_a, centroid_b});
  return scatter_factor(joint.scatter, volume, geom::uniform(joint.scatter.seed, id, 0));
}

} // namespace cdem
