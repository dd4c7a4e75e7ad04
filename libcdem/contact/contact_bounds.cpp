#include "libcdem/contact/contact_bounds.hpp"

#include "libcdem/contact/places.hpp"
#include "libcdem/rigid/inertia.hpp"
#include "libcdem/step/row_sums.hpp"

namespace cdem {
namespace {

// Of a rigid body's surface: what touches at most, by the step that it starts with.
constexpr double touching_part = 0.02;

} // namespace

double contact_time_step(const Model& model, const State& state, const Workspace& work,
                         const std::vector<double>& row_sums) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> rigid(model.rigid.size(), 0.0);
  const ContactWork& own = work.contact;
  for (const auto& [node, block] : own.touched) {
    const int body = model.blocks[block].rigid;
    if (body < 0) {
      const double mass = model.node_mass[node];
      const double beta = work.damped ? model.bodies[model.blocks[block].body].material.stiffness_damping : 0;
      least = std::min(least, stable_time_step((row_sums[node] + own.stiffness[node]) / mass,
                                               beta * row_sums[node] / mass));
      continue;
    }
    const std::array<double, 3>& c = state.rigid[body].centroid;
    const double arm = (place_of(model, state, node) - geom::Vec3(c[0], c[1], c[2])).norm();
    rigid[body] += own.stiffness[node] * rigid_inverse_mass(model.rigid[body], arm);
  }
  for (const double sum : rigid)
    least = std::min(least, stable_time_step(sum, 0));
  return least;
}

double rigid_frequency2(const Model& model) {
  double largest = 0;
  for (const RigidBody& body : model.rigid) {
    double stiffness = 0, arm = 0;
    const Block& block = model.blocks[body.block];
    for (int t = model.surface.block_begin[body.block]; t < model.surface.block_begin[body.block + 1]; ++t) {
      const ContactTriangle& triangle = model.surface.triangles[t];
      if (triangle.face < 0)
        stiffness += triangle.area / triangle.compliance;
    }
    for (int node = block.node_begin; node < block.node_end; ++node)
      arm = std::max(arm, (model.node_position[node] - block.mass.centroid).norm());
    largest = std::max(largest, 2 * touching_part * stiffness * rigid_inverse_mass(body, arm));
  }
  return largest;
}

void add_contact_row_sums(const Model& model, std::vector<double>& row_sums) {
  for (const ContactTriangle& t : model.surface.triangles)
    if (t.face < 0)
      for (const int node : t.nodes)
        row_sums[node] += 4 * t.area / (3 * t.compliance); // own springs, those of others, and edges
}

} // namespace cdem
