#include "libcdem/results/j_domain.hpp"

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/results/crack_points.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cdem {
namespace {

using geom::Vec3;

// Cosine of what counts as parallel; its complement of what counts as square.
constexpr double parallel = 0.999, square = 0.1;
// Part of the stress that may not come from the displacements; of the stored energy that may be kinetic.
constexpr double unexplained = 0.05, moving = 0.01;
// Traction on crack faces over the mean stress in the domain.
constexpr double carries = 0.02;

std::string text(const Vec3& x) {
  return fmt::format("{{{:.6g}, {:.6g}, {:.6g}}}", x.x(), x.y(), x.z());
}

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
  throw geom::InputError("j_integral: " + what + "; " + remedy);
}

class Checks {
public:
  Checks(const Model& model, const State& state, const JFront& front, const JDomain& domain,
         const std::vector<DomainTet>& tets)
      : model_(model), state_(state), front_(front), domain_(domain), tets_(tets) {}

  void body() const {
    for (const Block& block : model_.blocks)
      if (block.body == front_.body && (!block.meshed || block.rigid >= 0))
        refuse("body \"" + model_.bodies[front_.body].name + "\" has blocks of small strain, or rigid ones",
               "it needs a meshed body that deforms");
    if (tets_.empty())
      refuse(fmt::format("no tetrahedra between the radii {:.4g} and {:.4g} m around {}", domain_.inner,
                         domain_.outer, text(front_.point)),
             "the front must pass through the body, and the radii must span several tetrahedra");
  }

  void conditions(const ResolvedConditions& c) const {
    for (const HeldNode& held : c.held)
      if (of_body(held.node) && inside(model_.node_position[held.node]))
        for (int axis = 0; axis < 3; ++axis)
          if (vec(held.free)[axis] == 0 && std::abs(front_.front[axis]) < parallel)
            refuse("a support holds " + text(model_.node_position[held.node]) + ", in the domain",
                   "only supports along the front may be there; take a smaller outer radius");
    for (std::size_t i = 0; i < c.external.size(); ++i)
      if (of_body(static_cast<int>(i)) && inside(model_.node_position[i]) && !vec(c.external[i]).isZero(0))
        refuse("a load acts on " + text(model_.node_position[i]) + ", in the domain",
               "take a smaller outer radius; gravity and flows on the domain are not part of the integral");
  }

  void contacts() const {
    for (const Contact& contact : state_.contacts) {
      if (!(contact.effective_penetration() > 0))
        continue;
      const ContactArms arms = arms_of(model_, state_, contact);
      Vec3 place = Vec3::Zero(); // m, undeformed
      for (int i = 0; i < 4; ++i)
        place += arms.on_source[i] * model_.node_position[arms.source[i]];
      const auto [from, to] = blocks_of(model_, contact);
      for (const int block : {from, to}) {
        if (model_.blocks[block].body == front_.body && inside(place))
          refuse("a contact acts at " + text(place) + ", in the domain",
                 "the crack must be open and free; take a smaller outer radius");
      }
    }
    for (std::size_t p = 0; p < model_.points.size(); ++p) {
      const Interface& interface = model_.interfaces[model_.points[p].interface];
      const bool of_it = model_.blocks[interface.block_a].body == front_.body ||
                         model_.blocks[interface.block_b].body == front_.body;
      if (of_it && inside(model_.point_position[p]))
        refuse("blocks meet at " + text(model_.point_position[p]) + ", in the domain",
               "it must lie inside one meshed part");
    }
  }

  void faces() const {
    const double least = carries * mean_stress();
    const std::vector<Node> position = present_places(model_, state_);
    each_face(model_.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
      if (model_.blocks[chunk.block].body != front_.body)
        return;
      const FaceNodes nodes = face_nodes(model_.mesh, chunk, batch, lane);
      const Vec3 place = centre(nodes.a);
      if (!varies(place))
        return;
      const bool cohesive = model_.bodies[front_.body].bonding.is_cohesive();
      if (cohesive && holds(state_.faces[batch].stage[lane]))
        return;
      for (int point = 0; point < 3; ++point) {
        const FaceSpringPlace at{batch, point, lane};
        const Vec3 traction = face_point_response(model_, state_, position, chunk, at).force /
                              model_.mesh.faces[batch].area[lane];
        if (traction.norm() > least)
          refuse(fmt::format("a bond or a closed crack carries {:.3g} Pa at {}, in the domain",
                             traction.norm(), text(place)),
                 "choose radii that leave out what cracks and what presses; bodies with bonds = \"springs\" "
                 "have no "
                 "such domain where they are bonded");
      }
      require_parallel(nodes.a, "a crack face");
    });
    for (const BoundaryTriangle& triangle : model_.mesh.boundary)
      if (model_.blocks[triangle.block].body == front_.body && varies(centre(triangle.nodes)))
        require_parallel(triangle.nodes, "the surface");
  }

  void elasticity() const {
    double off = 0, all = 0, stored = 0, kinetic = 0;
    const Elastic& material = model_.bodies[front_.body].material;
    for (const DomainTet& t : tets_) {
      const geom::Mat3 stress = matrix(tet_stress(model_, state_, t.tet));
      off += t.volume * (stress - matrix(elastic_stress(material, t.gradient))).squaredNorm();
      all += t.volume * stress.squaredNorm();
      stored += 0.5 * t.volume * stress.cwiseProduct(t.gradient).sum();
      for (const int node : model_.tets[t.tet])
        kinetic += 0.125 * material.density * t.volume * velocity_of(state_, node).squaredNorm();
    }
    if (off > unexplained * unexplained * all)
      refuse(fmt::format(
                 "{:.2g} of the stress in the domain does not come from its displacements by Hooke's law",
                 std::sqrt(off / all)),
             "it is valid without initial stress, for strains and rotations below about 1e-3");
    if (kinetic > moving * stored && kinetic > 0)
      refuse(
          fmt::format("the domain moves: its kinetic energy is {:.2g} of what it stores", kinetic / stored),
          "it is valid at rest; relax first, or load more slowly");
  }

private:
  bool of_body(int node) const { return model_.blocks[block_of(model_, node)].body == front_.body; }
  bool inside(const Vec3& place) const { return distance_from_front(front_, place) < domain_.outer; }
  bool varies(const Vec3& place) const {
    return inside(place) && distance_from_front(front_, place) > domain_.inner;
  }
  Vec3 centre(const geom::Triangle& nodes) const {
    const auto& x = model_.node_position;
    return (x[nodes[0]] + x[nodes[1]] + x[nodes[2]]) / 3;
  }
  double mean_stress() const { // Pa, root mean square
    double sum = 0, volume = 0;
    for (const DomainTet& t : tets_) {
      sum += t.volume * matrix(tet_stress(model_, state_, t.tet)).squaredNorm();
      volume += t.volume;
    }
    return std::sqrt(sum / volume);
  }
  // A free surface gives nothing to the integral where it lies along the growth, or square to the front.
  void require_parallel(const geom::Triangle& nodes, const char* what) const {
    const auto& x = model_.node_position;
    const Vec3 normal = (x[nodes[1]] - x[nodes[0]]).cross(x[nodes[2]] - x[nodes[0]]).normalized();
    if (std::abs(normal.dot(front_.growth)) > square && std::abs(normal.dot(front_.front)) < parallel)
      refuse(fmt::format("{} at {}, between the radii {:.4g} and {:.4g} m, is not parallel to the growth",
                         what, text(centre(nodes)), domain_.inner, domain_.outer),
             "take a smaller outer radius, or a larger inner one around a blunt notch");
  }

  const Model& model_;
  const State& state_;
  const JFront& front_;
  const JDomain& domain_;
  const std::vector<DomainTet>& tets_;
};

} // namespace

double distance_from_front(const JFront& front, const Vec3& place) {
  const Vec3 from = place - front.point;
  return (from - from.dot(front.front) * front.front).norm();
}

double weight_in_domain(const JDomain& domain, double distance) {
  if (distance <= domain.inner)
    return 1;
  return distance >= domain.outer ? 0 : (domain.outer - distance) / (domain.outer - domain.inner);
}

std::vector<DomainTet> domain_tets(const Model& model, const State& state, const JFront& front,
                                   const JDomain& domain) {
  std::vector<DomainTet> tets;
  for (int t = 0; t < static_cast<int>(model.tets.size()); ++t) {
    const Block& block = model.blocks[model.tet_block[t]];
    if (block.body != front.body)
      continue;
    double weight[4];
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k) {
      x[k] = model.node_position[model.tets[t][k]];
      weight[k] = weight_in_domain(domain, distance_from_front(front, x[k]));
    }
    if (weight[0] == weight[1] && weight[0] == weight[2] && weight[0] == weight[3])
      continue;
    const TetGradients shape = tet_gradients(x);
    DomainTet tet;
    tet.tet = t;
    tet.volume = shape.volume;
    tet.gradient = displacement_gradient(model, state.displacement, t);
    for (int k = 0; k < 4; ++k)
      tet.weight_slope += weight[k] * shape.gradient[k];
    tets.push_back(tet);
  }
  return tets;
}

void require_valid(const Model& model, const State& state, const ResolvedConditions& conditions,
                   const JFront& front, const JDomain& domain, const std::vector<DomainTet>& tets) {
  const Checks checks(model, state, front, domain, tets);
  checks.body();
  checks.conditions(conditions);
  checks.contacts();
  checks.faces();
  checks.elasticity();
}

} // namespace cdem
