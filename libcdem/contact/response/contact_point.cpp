#include "libcdem/contact/response/contact_point.hpp"

#include "libcdem/contact/geometry/face_cover.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/response/tet_potential.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Weights of a tet's corners that make up a place, which may lie a little outside.
std::array<double, 4> in_tet(const Model& model, const State& state, const geom::Tet& nodes,
                             const geom::Vec3& place) {
  std::array<geom::Vec3, 4> x;
  for (int i = 0; i < 4; ++i)
    x[i] = place_of(model, state, nodes[i]);
  const geom::Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0], p = place - x[0];
  const double volume = a.dot(b.cross(c));
  const double wa = p.dot(b.cross(c)) / volume, wb = a.dot(p.cross(c)) / volume,
               wc = a.dot(b.cross(p)) / volume;
  return {1 - wa - wb - wc, wa, wb, wc};
}

// 1/m, of the weights in in_tet.
std::array<geom::Vec3, 4> gradients_in_tet(const Model& model, const State& state, const geom::Tet& nodes) {
  std::array<geom::Vec3, 4> x;
  for (int i = 0; i < 4; ++i)
    x[i] = place_of(model, state, nodes[i]);
  const geom::Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  const double volume = a.dot(b.cross(c));
  const geom::Vec3 ga = b.cross(c) / volume, gb = c.cross(a) / volume, gc = a.cross(b) / volume;
  return {-ga - gb - gc, ga, gb, gc};
}

// Law between two blocks. area: m2; compliance: m/Pa, of both.
ContactLaw law_over(const Model& model, int block_a, int block_b, const Joint& joint, double tan_friction,
                    double area, double compliance) {
  const ContactStiffness stiffness = contact_stiffness(joint, compliance);
  const double half = 0.5 * area; // both bodies bring theirs
  const double e2 = joint.restitution * joint.restitution;
  const bool deforms = model.blocks[block_a].rigid < 0 || model.blocks[block_b].rigid < 0;
  return {stiffness.normal * half * 0.5 * (1 + e2),
          stiffness.shear * half,
          tan_friction,
          (1 - e2) / (1 + e2),
          deforms || e2 < 1,
          deforms};
}

// m/Pa, of two sides in series. That of a rigid body comes from a mesh that has no meaning of its own, so it counts only
// where both are rigid.
double compliance_between(const Model& model, int block_a, double a, int block_b, double b) {
  const bool rigid_a = model.blocks[block_a].rigid >= 0, rigid_b = model.blocks[block_b].rigid >= 0;
  return rigid_a == rigid_b ? a + b : rigid_a ? b : a;
}

void set_normal_weight(ContactArms& arms, int node, double weight) {
  for (int i = 0; i < 4; ++i)
    if (arms.target[i] == node)
      arms.normal[i] = weight;
}

} // namespace

std::array<double, 4> within_tet(const Model& model, const State& state, const geom::Tet& nodes,
                                 const geom::Vec3& place) {
  std::array<double, 4> weights = in_tet(model, state, nodes, place);
  double sum = 0;
  for (double& weight : weights)
    sum += weight = std::max(0.0, weight);
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

TetSize tet_size(const Model& model, int tet) {
  const geom::Tet& n = model.tets[tet];
  const auto side = [&](int from, int to) -> geom::Vec3 {
    return model.node_position[n[to]] - model.node_position[n[from]];
  };
  TetSize size;
  for (const auto& plane : planes_of_tet)
    size.area += side(plane[0], plane[1]).cross(side(plane[0], plane[2])).norm() / 8;
  size.height = 0.5 * side(0, 1).dot(side(0, 2).cross(side(0, 3))) / size.area;
  return size;
}

TetPairLaw tet_pair_law(const Model& model, const Joint& joint, double tan_friction, int block,
                        const TetSize& a, const TetSize& b) {
  const double modulus = model.bodies[model.blocks[block].body].material.youngs_modulus;
  const ContactStiffness face = contact_stiffness(joint, (a.height + b.height) / modulus);
  const double area = 0.5 * (a.area + b.area), e2 = joint.restitution * joint.restitution;
  return {face.normal * (1 + e2) * area / 3,
          {0, face.shear * area / 3, tan_friction, (1 - e2) / (1 + e2), e2 < 1}};
}

namespace {

ContactArms tet_arms(const Model& model, const State& state, const Contact& c) {
  std::array<Node, 8> place;
  TetPairPress batch{};
  ContactArms arms;
  for (int k = 0; k < 8; ++k) {
    const int node = model.tets[k < 4 ? static_cast<int>(c.source) : c.target][k % 4];
    (k < 4 ? arms.source : arms.target)[k % 4] = node;
    const geom::Vec3 x = place_of(model, state, node);
    place[k] = {x.x(), x.y(), x.z(), 0};
    std::fill_n(batch.of.node[k], lanes, k);
  }
  std::fill_n(batch.phi0, lanes, c.reference_penetration);
  std::fill_n(batch.stiffness, lanes, 1.0);
  press_pairs(place.data(), &batch, 1);
  double sum = 0; // N
  const auto force = [&](int k) {
    return geom::Vec3(batch.force[k][0][0], batch.force[k][1][0], batch.force[k][2][0]);
  };
  for (int k = 0; k < 4; ++k)
    sum += force(k).dot(c.normal);
  for (int k = 0; k < 4; ++k) { // those that do not press: their middles
    arms.on_source[k] = sum > 0 ? force(k).dot(c.normal) / sum : 0.25;
    arms.normal[k] = sum > 0 ? -force(4 + k).dot(c.normal) / sum : 0.25;
  }
  geom::Vec3 between = geom::Vec3::Zero(); // m, what presses on the two
  for (int k = 0; k < 8; ++k)
    between +=
        0.5 * (k < 4 ? arms.on_source : arms.normal)[k % 4] * geom::Vec3(place[k].x, place[k].y, place[k].z);
  arms.on_source = within_tet(model, state, model.tets[static_cast<int>(c.source)], between);
  arms.shear = within_tet(model, state, model.tets[c.target], between);
  return arms;
}

// Law of a spring or an edge.
ContactLaw law_between(const Model& model, const Joint& joint, double tan_friction, const Contact& c) {
  const ContactSurface& s = model.surface;
  const auto [source, target] = triangles_of(c);
  return as_stiff_as(c, c.kind == Contact::spring
                            ? spring_law(model, joint, tan_friction, s.triangles[source], s.triangles[target])
                            : edge_law(model, joint, tan_friction, {source, c.fragment}, {target, c.beside}));
}

// Of a spring or an edge.
const Joint& joint_of(const Model& model, const Contact& c) {
  const auto [source, target] = triangles_of(c);
  return c.kind == Contact::spring ? *contact_joint(model, {source, source}, {target, target})
                                   : *contact_joint(model, {source, c.fragment}, {target, c.beside});
}

} // namespace

ContactLaw law_of(const Model& model, const Contact& c) {
  if (c.kind == Contact::tets) {
    const int a = static_cast<int>(c.source), block = model.tet_block[a];
    const Joint& joint = *contact_joint(model, block, block);
    ContactLaw law = tet_pair_law(model, joint, friction_within(model, joint, a, c.target), block,
                                  tet_size(model, a), tet_size(model, c.target))
                         .law;
    law.kn = c.stiffness;
    return law;
  }
  const Joint& joint = joint_of(model, c);
  return law_between(model, joint, geom::portable::tan(joint.friction_angle), c);
}

double normal_stiffness_of(const Model& model, const Contact& c) {
  return c.stiffness > 0 ? c.stiffness : law_between(model, joint_of(model, c), 0, c).kn;
}

ContactLaw spring_law(const Model& model, const Joint& joint, double tan_friction,
                      const ContactTriangle& from, const ContactTriangle& to) {
  // Both sides bring their springs. The finer side takes most of the pressure, in the ratio of the areas, and both together
  // the whole of it, wherever the springs of the coarser side stand.
  return law_over(model, from.block, to.block, joint, tan_friction, spring_area(from.area, to.area),
                  compliance_between(model, from.block, from.compliance, to.block, to.compliance));
}

ContactLaw edge_law(const Model& model, const Joint& joint, double tan_friction,
                    const std::array<int, 2>& from, const std::array<int, 2>& to) {
  const std::vector<ContactTriangle>& t = model.surface.triangles;
  const auto mean = [](double a, double b) { return 0.5 * (a + b); };
  const double area = edge_area(mean(t[from[0]].area, t[from[1]].area), mean(t[to[0]].area, t[to[1]].area));
  return law_over(model, t[from[0]].block, t[to[0]].block, joint, tan_friction, area,
                  compliance_between(model, t[from[0]].block,
                                     mean(t[from[0]].compliance, t[from[1]].compliance), t[to[0]].block,
                                     mean(t[to[0]].compliance, t[to[1]].compliance)));
}

std::pair<int, int> blocks_of(const Model& model, const Contact& c) {
  if (c.kind == Contact::tets)
    return {model.tet_block[c.source], model.tet_block[c.target]};
  const auto [source, target] = triangles_of(c);
  return {model.surface.triangles[source].block, model.surface.triangles[target].block};
}

geom::Vec3 spring_weights(int corner) {
  geom::Vec3 w = geom::Vec3::Constant(drawn_in);
  w[corner] = 1 - 2 * drawn_in;
  return w;
}

ContactArms spring_arms(const Model& model, const State& state, const ContactTriangle& from, int corner,
                        const ContactTriangle& to, const geom::Vec3& nearest) {
  ContactArms arms;
  const geom::Vec3 w = spring_weights(corner);
  arms.source = {from.nodes[0], from.nodes[1], from.nodes[2], from.nodes[0]};
  arms.target = model.tets[to.tet];
  arms.on_source = {w[0], w[1], w[2], 0};
  for (int i = 0; i < 3; ++i)
    set_normal_weight(arms, to.nodes[i], nearest[i]);
  arms.shear = in_tet(model, state, arms.target, weighted(corners_of(model, state, from.nodes), w));
  return arms;
}

ContactArms edge_arms(const Model& model, const State& state, const ContactEdge& e, const ContactEdge& f,
                      const NearestOfEdges& nearest) {
  ContactArms arms;
  if (nearest.stretch) { // one place on both, so that the force turns nothing
    arms.source = model.tets[model.surface.triangles[e.triangles[0]].tet];
    arms.target = model.tets[model.surface.triangles[f.triangles[0]].tet];
    arms.on_source = in_tet(model, state, arms.source, nearest.stretch->place);
    arms.normal = arms.shear = in_tet(model, state, arms.target, nearest.stretch->place);
    return arms;
  }
  const geom::PlacesOnSegments& at = nearest.at;
  arms.source = {e.nodes[0], e.nodes[1], e.nodes[0], e.nodes[0]};
  arms.on_source = {1 - at.s, at.s, 0, 0};
  arms.target = model.tets[model.surface.triangles[f.triangles[0]].tet];
  set_normal_weight(arms, f.nodes[0], 1 - at.t);
  set_normal_weight(arms, f.nodes[1], at.t);
  const geom::Vec3 place =
      (1 - at.s) * place_of(model, state, e.nodes[0]) + at.s * place_of(model, state, e.nodes[1]);
  arms.shear = in_tet(model, state, arms.target, place);
  return arms;
}

std::array<geom::Vec3, 4> forces_of_moment(const Model& model, const State& state, const geom::Tet& nodes,
                                           const geom::Vec3& moment) {
  std::array<geom::Vec3, 4> forces = gradients_in_tet(model, state, nodes);
  for (geom::Vec3& force : forces)
    force = 0.5 * moment.cross(force);
  return forces;
}

ContactArms arms_of(const Model& model, const State& state, const Contact& c) {
  const ContactSurface& s = model.surface;
  if (c.kind == Contact::tets)
    return tet_arms(model, state, c);
  if (c.kind == Contact::edge) {
    const ContactEdge e = edge_between(s, c.source / 3, c.source % 3, c.fragment, 0),
                      f = edge_between(s, c.target / 3, c.target % 3, c.beside, 0);
    return edge_arms(model, state, e, f, nearest_of_edges(model, state, e, f));
  }
  const ContactTriangle &from = s.triangles[c.source / 3], &to = s.triangles[c.target];
  const geom::Vec3 spring = weighted(corners_of(model, state, from.nodes), spring_weights(c.source % 3));
  const Corners y = corners_of(model, state, to.nodes);
  return spring_arms(model, state, from, c.source % 3, to,
                     geom::nearest_on_triangle(spring, y[0], y[1], y[2]).weights);
}

geom::Vec3 velocity_past(const State& state, const ContactArms& arms) {
  geom::Vec3 v = geom::Vec3::Zero();
  for (int i = 0; i < 4; ++i)
    if (arms.on_source[i] != 0)
      v += arms.on_source[i] * velocity_of(state, arms.source[i]);
  for (int i = 0; i < 4; ++i)
    v -= arms.shear[i] * velocity_of(state, arms.target[i]);
  return v;
}

} // namespace cdem
