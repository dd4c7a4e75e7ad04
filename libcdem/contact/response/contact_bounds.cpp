#include "libcdem/contact/response/contact_bounds.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"

#include <cmath>
#include <map>

namespace cdem {
namespace {

// Largest fraction of a rigid body's surface in contact that the first time step allows for.
constexpr double touching_part = 0.02;
// Fraction of the stable step, for the contacts of rigid bodies. Rigid bodies have no elements, so only the stiffness
// of the contacts takes up an impact. At 0.9 an impact takes three steps and returns 0.75 to 1.5 of the energy. At 0.5
// it returns the energy within a tenth.
constexpr double most_of_rigid = 0.3, most_of_given = 0.5; // the second of a step that the user gives
// Part of that step which bodies in flight take: omega dt of an impact is 0.12, and it gains at most (omega dt)^4 of its energy. With
// 0.2 friction took 2.3 times its part where a wall topples, with 0.12 1.03 times (docs/contact.md, section 7).
constexpr double flight_part = 0.2;
// Parts of a unit normal, and of a block's size, in which triangles of one plane agree.
constexpr double plane_grid = 500;
// Largest motion in a step, over a tet's height.
constexpr double way_part = 0.1;

// How stiff the laws of a body's contacts say that they are.
struct GivenStiffness {
  double stiffest = 0;                // Pa/m
  bool by_all = true;                 // else some are as stiff as the tets beside them
  double with(double of_tets) const { // Pa/m, at most
    return by_all && stiffest > 0 ? stiffest : std::max(of_tets, stiffest);
  }
};

std::vector<GivenStiffness> given_stiffness(const Model& model) { // by body
  std::vector<GivenStiffness> given(model.bodies.size());
  const auto add = [&](int body, int number) {
    const Joint& law = model.joints[number];
    GivenStiffness& of = given[body];
    of.by_all = of.by_all && law.normal_stiffness;
    of.stiffest = std::max({of.stiffest, law.normal_stiffness.value_or(0), law.shear_stiffness.value_or(0)});
  };
  for (const auto& [bodies, law] : model.surface.joint)
    for (const int body : {bodies.first, bodies.second})
      add(body, law);
  for (const auto& [body, law] : model.surface.within)
    add(body, law);
  for (const BlockPairLaw& pair : model.surface.pairs)
    for (const int block : pair.blocks)
      add(model.blocks[block].body, pair.joint);
  for (const ContactTriangle& t : model.surface.triangles)
    if (t.left >= 0)
      add(model.blocks[t.block].body, t.left);
  return given;
}

struct ClosingStiffness {
  std::vector<double> elements, contact; // N/m (n_nodes); contact: 0 where an interface holds the face
};

ClosingStiffness closing_stiffness(const Model& model) {
  const std::vector<GivenStiffness> given = given_stiffness(model);
  std::vector<double> contact(model.node_mass.size(), 0.0);
  for (const ContactTriangle& t : model.surface.triangles)
    if (t.face < 0 && model.blocks[t.block].rigid < 0)
      for (const int node : t.nodes)
        contact[node] += 2 * t.area / 3 * given[model.blocks[t.block].body].stiffest;
  std::vector<double> elements = element_row_sums(model);
  std::vector<double> springs(model.node_mass.size(), 0.0);
  add_spring_row_sums(model, springs);
  for (std::size_t i = 0; i < contact.size(); ++i)
    if (!(contact[i] > springs[i]))
      contact[i] = 0;
  return {std::move(elements), std::move(contact)};
}

double for_rigid(double safety, bool given = false) {
  return std::min(safety, given ? most_of_given : most_of_rigid);
}

} // namespace

double contact_time_step(const Model& model, const State& state, const ContactLoads& loads,
                         const ContactStep& step) {
  double least = std::numeric_limits<double>::infinity();
  const std::vector<double>& mass = moving_mass(model, state);
  double fastest = 0; // 1/s2, of nodes without damping: one root is enough
  for (const auto& [node, block] : loads.touched) {
    const double beta =
        std::max(step.joint_damping,
                 step.damped ? model.bodies[model.blocks[block].body].material.stiffness_damping : 0);
    const double frequency2 = (step.row_sums[node] + loads.stiffness[node]) / mass[node];
    if (beta == 0)
      fastest = std::max(fastest, frequency2);
    else
      least = std::min(least,
                       step.safety * stable_time_step(frequency2, beta * step.row_sums[node] / mass[node]));
  }
  if (fastest > 0)
    least = std::min(least, step.safety * stable_time_step(fastest, 0));
  for (const ContactOnRigid& body : loads.on_rigid)
    least = std::min(least, for_rigid(step.safety, step.given) * stable_time_step(body.frequency2, 0));
  return least;
}

double rigid_time_step(const Model& model, double safety) {
  return rigid_time_step(model, model.rigid, safety);
}

double most_rigid_time_step(const Model& model) {
  return for_rigid(1, true) / for_rigid(1) * rigid_time_step(model, 1);
}

double rigid_time_step(const Model& model, const std::vector<RigidBody>& bodies, double safety) {
  double largest = 0, damped = 0; // 1/s2, 1/s
  const std::vector<GivenStiffness> given = given_stiffness(model);
  std::vector<double> springs(model.node_mass.size(), 0.0); // N/m, of interfaces
  add_spring_row_sums(model, springs);
  for (const RigidBody& body : bodies) {
    double stiffness = 0, arm = 0, held = 0,
           rate = 0; // held: 1/s2, by the springs of interfaces; rate: 1/s, likewise
    const Block& block = model.blocks[body.block];
    for (int t = model.surface.block_begin[body.block]; t < model.surface.block_begin[body.block + 1]; ++t) {
      const ContactTriangle& triangle = model.surface.triangles[t];
      if (triangle.face < 0)
        stiffness += triangle.area * given[block.body].with(1 / triangle.compliance);
    }
    for (int node = block.node_begin; node < block.node_end; ++node) {
      const double away = (model.node_position[node] - block.mass.centroid).norm();
      arm = std::max(arm, away);
      const double here = springs[node] * rigid_inverse_mass(body, away);
      held += here;
      rate += here > 0 ? damping_of(model, node) * here : 0;
    }
    damped = std::max(damped, rate);
    largest = std::max(largest, held);
    largest = std::max(largest, 2 * touching_part * stiffness * rigid_inverse_mass(body, arm));
  }
  return largest > 0 ? for_rigid(safety) * stable_time_step(largest, damped)
                     : std::numeric_limits<double>::infinity();
}

double closing_time_step(const Model& model, double safety) {
  const ClosingStiffness k = closing_stiffness(model);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < k.contact.size(); ++i)
    if (k.contact[i] > 0) {
      const double mass = model.node_mass[i];
      least =
          std::min(least, stable_time_step((k.elements[i] + k.contact[i]) / mass,
                                           damping_of(model, static_cast<int>(i)) * k.elements[i] / mass));
    }
  return safety * least;
}

std::vector<double> closing_row_sums(const Model& model) {
  ClosingStiffness k = closing_stiffness(model);
  for (std::size_t i = 0; i < k.contact.size(); ++i)
    if (k.contact[i] > 0)
      k.contact[i] += k.elements[i];
  return k.contact;
}

std::vector<double> impact_frequencies2(const Model& model) {
  const ContactSurface& surface = model.surface;
  const std::vector<GivenStiffness> given = given_stiffness(model);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double of_rigid = infinite, of_others = infinite; // m/Pa, the least compliance
  for (const ContactTriangle& t : surface.triangles)
    if (double& least = model.blocks[t.block].rigid >= 0 ? of_rigid : of_others; t.face < 0)
      least = std::min(least, t.compliance);
  std::vector<double> frequencies2;
  for (const RigidBody& body : model.rigid) {
    const Block& block = model.blocks[body.block];
    std::map<std::array<long, 4>, double> faces; // m2, by plane
    std::map<int, double> corners;               // m2, of the semi-springs around a node
    double compliance = std::numeric_limits<double>::infinity(), frequency2 = 0;
    for (int t = surface.block_begin[body.block]; t < surface.block_begin[body.block + 1]; ++t) {
      const ContactTriangle& triangle = surface.triangles[t];
      if (triangle.face >= 0)
        continue;
      const geom::Vec3 &x = model.node_position[triangle.nodes[0]],
                       &y = model.node_position[triangle.nodes[1]],
                       &z = model.node_position[triangle.nodes[2]];
      const geom::Vec3 normal = (y - x).cross(z - x).normalized();
      const double level = normal.dot(x - block.mass.centroid) / block.size;
      faces[{std::lround(plane_grid * normal.x()), std::lround(plane_grid * normal.y()),
             std::lround(plane_grid * normal.z()), std::lround(plane_grid * level)}] += triangle.area;
      for (const int node : triangle.nodes)
        corners[node] += triangle.area / 3;
      compliance = std::min(compliance, triangle.compliance);
    }
    const double stiffness =
        given[block.body].with(std::max(1 / (compliance + of_rigid), 1 / of_others)); // Pa/m
    for (const auto& [plane, area] : faces)
      frequency2 = std::max(frequency2, stiffness * area / body.mass);
    for (const auto& [node, area] : corners)
      frequency2 = std::max(
          frequency2, stiffness * area *
                          rigid_inverse_mass(body, (model.node_position[node] - block.mass.centroid).norm()));
    frequencies2.push_back(frequency2);
  }
  return frequencies2;
}

double flight_time_step(const Model& model, const State& state, const ContactLoads& loads,
                        const Flight& flight) {
  double fast = 0, slow = 0, any = 0; // 1/s2, the largest
  for (std::size_t i = 0; i < model.rigid.size(); ++i) {
    const double frequency2 = flight.impact_frequency2[i];
    if (!flight.held.empty() && flight.held[i])
      continue;
    any = std::max(any, frequency2);
    if (loads.on_rigid[i].touches)
      continue;
    const double spin = vec(state.rigid[i].angular_momentum).norm() / model.rigid[i].principal.minCoeff();
    const double speed = vec(state.rigid[i].velocity).norm() + spin * model.blocks[model.rigid[i].block].size;
    // Pressed by its weight it sinks in by g / w^2 and moves at g / w at most.
    double& of = !flight.damped && speed * std::sqrt(frequency2) > flight.gravity ? fast : slow;
    of = std::max(of, frequency2);
  }
  const auto stable = [&](double frequency2) {
    return frequency2 > 0 ? stable_time_step(frequency2 + any, 0) : std::numeric_limits<double>::infinity();
  };
  return for_rigid(flight.safety) * std::min(flight_part * stable(fast), stable(slow));
}

std::vector<double> reaches_of_rigid(const Model& model, const State& state) {
  std::vector<double> reaches;
  for (const RigidBody& body : model.rigid) {
    double reach2 = 0;
    for (int node = model.blocks[body.block].node_begin; node < model.blocks[body.block].node_end; ++node)
      reach2 = std::max(reach2, vec(state.rigid_offset[node]).squaredNorm());
    reaches.push_back(std::sqrt(reach2));
  }
  return reaches;
}

double displacement_time_step(const Model& model, const State& state, const std::vector<double>& reaches) {
  double height = std::numeric_limits<double>::infinity(), fastest = 0; // m, m/s
  for (const double usual : model.surface.usual_height)
    if (usual > 0)
      height = std::min(height, usual);
  for (std::size_t i = 0; i < model.rigid.size(); ++i) {
    const double spin = vec(state.rigid[i].angular_momentum).norm() / model.rigid[i].principal.minCoeff();
    fastest = std::max(fastest, vec(state.rigid[i].velocity).norm() + spin * reaches[i]);
  }
  return fastest > 0 ? way_part * height / fastest : std::numeric_limits<double>::infinity();
}

void add_contact_row_sums(const Model& model, std::vector<double>& row_sums) {
  const std::vector<GivenStiffness> given = given_stiffness(model);
  for (const ContactTriangle& t : model.surface.triangles)
    if (t.face < 0)
      for (const int node : t.nodes)
        row_sums[node] += 4 * t.area / 3 *
                          given[model.blocks[t.block].body].with(
                              1 / t.compliance); // own springs, those of others, and edges
}

} // namespace cdem
