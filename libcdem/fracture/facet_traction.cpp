#include "libcdem/fracture/facet_traction.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/fracture/star_blocks.hpp"
#include "libcdem/model/build/face_strength.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/model/known_of_model.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace cdem {
namespace {

using geom::Mat3;
using geom::Vec3;

constexpr double plane_cosine = 1 - 1e-6; // between the normals of the faces of a plane facet
constexpr double most_told = 1e3;         // parts of a strength: a curve may have none at a tension

struct FacetFace {
  int tet = 0, face = 0, beyond = 0; // of the mesh; beyond: the tet on the other side
  RockStrength rock;
};
struct Facet {
  int body = 0, a = 0, b = 0; // its blocks, into StarBlocks::extent
  std::vector<FacetFace> faces;
};
struct Facets {
  StarBlocks stars;
  std::vector<Facet> all;      // between two of them
  std::vector<int> neighbours; // mesh_neighbours
};

std::array<int, 4> originals(const Model& model, int tet) {
  std::array<int, 4> nodes{};
  for (int k = 0; k < 4; ++k)
    nodes[k] = model.mesh.original[model.tets[model.mesh.first_tet + tet][k] - model.mesh.first_node];
  return nodes;
}

void add_facets(const Model& model, const Block& block, Facets& facets_of) {
  const StarBlocks& stars = facets_of.stars;
  const MeshData& mesh = model.mesh;
  const Body& body = model.bodies[block.body];
  const int first = block.tet_begin - mesh.first_tet;
  const OwnRocks rocks(body);
  MeshSeed seed;
  std::optional<FaceStrengths> strengths;
  if (has_own_strengths(body)) {
    seed = mesh_seed(model, static_cast<int>(&block - model.blocks.data()));
    strengths.emplace(body, seed.mesh);
  }
  std::map<std::pair<int, int>, Facet> facets;
  for (int t = first; t < block.tet_end - mesh.first_tet; ++t)
    for (int f = 0; f < 4; ++f) {
      const int beyond = facets_of.neighbours[4 * t + f] / 4;
      if (facets_of.neighbours[4 * t + f] < 0 || stars.of_tet[t] >= stars.of_tet[beyond])
        continue;
      RockStrength rock = rock_strength(body.joint_of(-1));
      if (strengths) {
        const FaceStrength own = strengths->of(t - first, beyond - first);
        rock = rocks.of(own.joint, own.tensile_strength, own.cohesion);
      }
      Facet& facet = facets[{stars.of_tet[t], stars.of_tet[beyond]}];
      facet.body = block.body;
      facet.a = stars.of_tet[t];
      facet.b = stars.of_tet[beyond];
      facet.faces.push_back({t, f, beyond, rock});
    }
  for (auto& [between, facet] : facets)
    facets_of.all.push_back(std::move(facet));
}

// Whether all its regions are stars: only then all forces at its facets are known.
bool is_of_stars(const Model& model, const Block& block, const StarBlocks& stars) {
  const auto at = stars.of_tet.begin() - model.mesh.first_tet;
  return block.tet_end > block.tet_begin && block.tet_begin >= model.mesh.first_tet &&
         std::all_of(at + block.tet_begin, at + block.tet_end, [](int star) { return star >= 0; });
}

Facets facets_of(const Model& model) {
  Facets facets{star_blocks(model), {}, {}};
  if (facets.stars.of_tet.empty())
    return facets;
  facets.neighbours = mesh_neighbours(model);
  for (const Block& block : model.blocks)
    if (is_of_stars(model, block, facets.stars))
      add_facets(model, block, facets);
  return facets;
}

// Where facets meet.
struct AtNode {
  struct Part {
    int facet = 0, a = 0, b = 0; // into `blocks`
    double area = 0;             // m2
    Vec3 force = Vec3::Zero();   // N, on a
  };
  std::vector<int> blocks;
  std::vector<Vec3> given, outside; // N, to each block; of its outer faces, by the stress of their tets
  std::vector<Part> parts;
  double unknown = 0; // N, of outer forces: which of the blocks they act on

  int place(int block) {
    const auto at = std::find(blocks.begin(), blocks.end(), block);
    const int found = static_cast<int>(at - blocks.begin());
    if (at == blocks.end()) {
      blocks.push_back(block);
      given.emplace_back(Vec3::Zero());
      outside.emplace_back(Vec3::Zero());
    }
    return found;
  }
  void add(int facet, int block_a, int block_b, double area, const Vec3& force) {
    auto at = std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.facet == facet; });
    if (at == parts.end())
      at = parts.insert(at, {facet, place(block_a), place(block_b), 0, Vec3::Zero()});
    at->area += area;
    at->force += force;
  }
  // What outer faces give is what all blocks miss together: to each by its own estimate, as far as their sum is right; what
  // is left to those that pull that way.
  void give_outside() {
    const Vec3 all = std::accumulate(given.begin(), given.end(), Vec3(Vec3::Zero())),
               estimated = std::accumulate(outside.begin(), outside.end(), Vec3(Vec3::Zero()));
    const double right =
        estimated.isZero(0) ? 0 : std::max(0.0, 1 - (all - estimated).norm() / estimated.norm());
    const Vec3 left = all - right * estimated;
    unknown = left.norm();
    std::vector<double> weight;
    double sum = 0;
    for (const Vec3& force : outside)
      sum += weight.emplace_back(std::max(0.0, force.dot(left)));
    for (std::size_t i = 0; i < given.size(); ++i)
      given[i] -=
          right * outside[i] + (sum > 0 ? weight[i] / sum : 1 / static_cast<double>(given.size())) * left;
  }
  void balance() {
    give_outside();
    const auto n = static_cast<Eigen::Index>(blocks.size());
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(n, n), missing(n, 3);
    for (Eigen::Index i = 0; i < n; ++i)
      missing.row(i) = given[static_cast<std::size_t>(i)].transpose();
    for (const Part& part : parts) {
      laplacian(part.a, part.a) += part.area;
      laplacian(part.b, part.b) += part.area;
      laplacian(part.a, part.b) -= part.area;
      laplacian(part.b, part.a) -= part.area;
      missing.row(part.a) -= part.force.transpose();
      missing.row(part.b) += part.force.transpose();
    }
    const Eigen::MatrixXd lambda = laplacian.completeOrthogonalDecomposition().solve(missing);
    for (Part& part : parts)
      part.force += part.area * (lambda.row(part.a) - lambda.row(part.b)).transpose();
  }
};

// 1 / the factor with which a traction on the plane n reaches the strength.
double part_of_strength(const Vec3& t, const Vec3& n, const RockStrength& rock) {
  const double normal = t.dot(n), shear = (t - normal * n).norm();
  if (!rock.curve.on())
    return std::max(normal / rock.tensile_strength,
                    (shear + normal * rock.sin_friction / rock.cos_friction) / rock.cohesion);
  const Mat3 s = t * n.transpose() + n * t.transpose() - normal * n * n.transpose(); // s n = t
  return std::min(strength_utilisation(s, rock, n, FacePlane::own), most_told);
}

// By the number that all copies of a node have.
std::set<int> nodes_at_cracks(const Model& model, const State& state) {
  std::set<int> nodes;
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const FaceStage stage = state.faces[batch].stage[lane];
    if (stage != FaceStage::holding && stage != FaceStage::resumed)
      for (const int node : face_nodes(model.mesh, chunk, batch, lane).a)
        nodes.insert(model.mesh.original[node - model.mesh.first_node]);
  });
  return nodes;
}

class Tractions {
public:
  Tractions(const Model& model, const State& state, const Facets& facets)
      : model_(model), state_(state), facets_(facets), stars_(facets.stars),
        cracked_(nodes_at_cracks(model, state)), volume_(stars_.extent.size(), 0),
        stress_volume_(stars_.extent.size(), Mat3(Mat3::Zero())) {}

  std::vector<FacetTraction> operator()() {
    for (std::size_t f = 0; f < facets_.all.size(); ++f)
      add_parts(static_cast<int>(f));
    for (int tet = 0; tet < static_cast<int>(stars_.of_tet.size()); ++tet)
      if (stars_.of_tet[tet] >= 0)
        add_tet(tet);
    for (auto& [node, at] : nodes_)
      at.balance();
    std::vector<FacetTraction> all;
    for (std::size_t f = 0; f < facets_.all.size(); ++f)
      if (is_whole(facets_.all[f]))
        if (const auto traction = of(static_cast<int>(f)))
          all.push_back(*traction);
    return all;
  }

private:
  Vec3 place(int tet, int corner) const {
    return place_of(model_, state_, model_.tets[model_.mesh.first_tet + tet][corner]);
  }
  Mat3 stress(int tet) const { return matrix(mesh_stress(model_, state_, model_.mesh.first_tet + tet)); }
  Vec3 area(int tet, int face) const { // m2, outward
    const auto& at = geom::tet_faces[face];
    return 0.5 * (place(tet, at[1]) - place(tet, at[0])).cross(place(tet, at[2]) - place(tet, at[0]));
  }
  // No crack is there or beside it.
  bool is_whole(const Facet& facet) const {
    return std::none_of(facet.faces.begin(), facet.faces.end(), [&](const FacetFace& face) {
      const std::array<int, 4> nodes = originals(model_, face.tet);
      return std::any_of(geom::tet_faces[face.face].begin(), geom::tet_faces[face.face].end(),
                         [&](int corner) { return cracked_.count(nodes[corner]) > 0; });
    });
  }

  void add_parts(int number) {
    const Facet& facet = facets_.all[static_cast<std::size_t>(number)];
    for (const FacetFace& face : facet.faces) {
      const Vec3 s = area(face.tet, face.face);
      const Vec3 force = 0.5 * (stress(face.tet) + stress(face.beyond)) * s / 3;
      const std::array<int, 4> nodes = originals(model_, face.tet);
      for (const int corner : geom::tet_faces[face.face])
        nodes_[nodes[corner]].add(number, facet.a, facet.b, s.norm() / 3, force);
    }
  }
  void add_tet(int tet) {
    const std::array<int, 4> nodes = originals(model_, tet);
    const Mat3 s = stress(tet);
    const int block = stars_.of_tet[tet];
    const double volume = tet_volume(model_, model_.mesh.first_tet + tet);
    volume_[block] += volume;
    stress_volume_[block] += volume * s;
    for (int f = 0; f < 4; ++f) {
      const Vec3 force = s * area(tet, f) / 3;
      if (const auto at = nodes_.find(nodes[f]); at != nodes_.end())
        at->second.given[at->second.place(block)] -= force;
      if (facets_.neighbours[4 * tet + f] < 0)
        for (const int corner : geom::tet_faces[f])
          if (const auto at = nodes_.find(nodes[corner]); at != nodes_.end())
            at->second.outside[at->second.place(block)] += force;
    }
  }

  std::optional<FacetTraction> of(int number) const {
    const Facet& facet = facets_.all[static_cast<std::size_t>(number)];
    FacetTraction result;
    result.body = facet.body;
    result.least_extent = std::min(stars_.extent[facet.a], stars_.extent[facet.b]);
    for (const int block : {facet.a, facet.b})
      result.block_stress = std::max(result.block_stress, stress_volume_[block].norm() / volume_[block]);
    double whole = 0;
    Vec3 along = Vec3::Zero();
    for (const FacetFace& face : facet.faces) {
      const Vec3 s = area(face.tet, face.face);
      along += s;
      whole += s.norm();
      for (const int corner : geom::tet_faces[face.face])
        result.centroid += s.norm() / 3 * place(face.tet, corner);
    }
    if (along.norm() < plane_cosine * whole)
      return std::nullopt;
    result.centroid /= whole;
    result.normal = along.normalized();
    result.area = whole;
    Mat3 second = Mat3::Zero(); // J, m4
    std::map<int, Vec3> arms;   // r of each node
    for (const FacetFace& face : facet.faces) {
      const std::array<int, 4> nodes = originals(model_, face.tet);
      Vec3 sum = Vec3::Zero();
      Mat3 squares = Mat3::Zero();
      for (const int corner : geom::tet_faces[face.face]) {
        const Vec3 r = place(face.tet, corner) - result.centroid;
        arms[nodes[corner]] = r;
        sum += r;
        squares += r * r.transpose();
      }
      second += area(face.tet, face.face).norm() / 12 * (squares + sum * sum.transpose());
    }
    Vec3 resultant = Vec3::Zero(), bending = Vec3::Zero(), moment = Vec3::Zero();
    for (const auto& [node, r] : arms)
      for (const AtNode::Part& part : nodes_.at(node).parts)
        if (part.facet == number) {
          resultant += part.force;
          result.unknown = std::max(result.unknown, nodes_.at(node).unknown / part.area / 2);
          bending += part.force.dot(result.normal) * r;
          moment += r.cross(part.force);
        }
    const Vec3& n = result.normal;
    const double polar = second.trace();
    const Vec3 slope = (second + polar * n * n.transpose()).inverse() * bending;
    const Vec3 turn = n.dot(moment) / polar * n;
    result.mean = resultant / whole;
    result.gradient = n * (slope - slope.dot(n) * n).transpose();
    for (int axis = 0; axis < 3; ++axis)
      result.gradient.col(axis) += turn.cross(Vec3::Unit(axis));
    for (const FacetFace& face : facet.faces)
      for (const int corner : geom::tet_faces[face.face]) {
        const Vec3 x = place(face.tet, corner);
        const double used = part_of_strength(result.at(x), n, face.rock);
        if (used > result.utilisation) {
          result.utilisation = used;
          result.worst = x;
        }
      }
    return result;
  }

  const Model& model_;
  const State& state_;
  const Facets& facets_;
  const StarBlocks& stars_;
  std::set<int> cracked_;
  std::vector<double> volume_;      // m3, of each block
  std::vector<Mat3> stress_volume_; // N m, likewise
  std::map<int, AtNode> nodes_;     // by the number that all copies of a node have
};

} // namespace

bool may_have_facets(const Model& model) {
  return std::any_of(model.blocks.begin(), model.blocks.end(),
                     [&](const Block& block) { return may_have_stars(model, block); });
}

std::vector<FacetTraction> facet_tractions(const Model& model, const State& state) {
  if (!may_have_facets(model))
    return {};
  static KnownOfModel<Facets> known;
  const std::shared_ptr<const Facets> facets = known.of(model, [&] { return facets_of(model); });
  return facets->all.empty() ? std::vector<FacetTraction>{} : Tractions(model, state, *facets)();
}

} // namespace cdem
