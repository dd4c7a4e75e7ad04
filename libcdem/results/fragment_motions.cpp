#include "libcdem/results/fragment_motions.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

using geom::Mat3;
using geom::Vec3;

// One mass of a fragment: a node, or a rigid body with its inertia about its own centroid.
struct Mass {
  double mass = 0;
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero(); // N m s, angular momentum about its own centroid
  Mat3 inertia = Mat3::Zero();
  double kinetic = 0; // J
};

// visit(fragment, Mass) for all masses, in a fixed order.
template <class Visit>
void each_mass(const Model& model, const State& state, const std::vector<int>& of_node, const Visit& visit) {
  for (const Block& block : model.blocks) {
    if (block.rigid >= 0) {
      const RigidBody& body = model.rigid[block.rigid];
      const RigidState& motion = state.rigid[block.rigid];
      const Mat3 turned = rotation(motion);
      visit(of_node[block.node_begin],
            Mass{body.mass, vec(motion.centroid), vec(motion.velocity), vec(motion.angular_momentum),
                 turned * body.inertia * turned.transpose(),
                 kinetic_energy(body, motion, state.velocity_lag)});
      continue;
    }
    for (int i = block.node_begin; i < block.node_end; ++i) {
      const Vec3 v = velocity_of(state, i);
      const double m = model.node_mass[i];
      visit(of_node[i],
            Mass{m, place_of(model, state, i), v, Vec3::Zero(), Mat3::Zero(), 0.5 * m * v.squaredNorm()});
    }
  }
}

void add_bodies_and_volumes(const Model& model, const std::vector<int>& of_node,
                            std::vector<FragmentMotion>& list) {
  const auto& x = model.node_position;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const geom::Tet& tet = model.tets[t];
    const double volume =
        (x[tet[1]] - x[tet[0]]).dot((x[tet[2]] - x[tet[0]]).cross(x[tet[3]] - x[tet[0]])) / 6;
    FragmentMotion& f = list[of_node[tet[0]]];
    const int body = model.blocks[model.tet_block[t]].body;
    if (f.tets == 0)
      f.body = body;
    else if (f.body != body)
      f.body = -1;
    f.volume += volume;
    f.centroid += volume / 4 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]);
    ++f.tets;
  }
}

void add_motions(const Model& model, const State& state, const std::vector<int>& of_node,
                 std::vector<FragmentMotion>& list) {
  each_mass(model, state, of_node, [&](int fragment, const Mass& m) {
    FragmentMotion& f = list[fragment];
    f.mass += m.mass;
    f.centre += m.mass * m.place;
    f.momentum += m.mass * m.velocity;
    f.kinetic += m.kinetic;
  });
  for (FragmentMotion& f : list)
    f.centre /= f.mass;
  std::vector<Mat3> inertia(list.size(), Mat3::Zero());
  each_mass(model, state, of_node, [&](int fragment, const Mass& m) {
    const Vec3 arm = m.place - list[fragment].centre;
    list[fragment].angular_momentum += m.mass * arm.cross(m.velocity) + m.spin;
    inertia[fragment] += m.inertia + m.mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  });
  for (std::size_t i = 0; i < list.size(); ++i) {
    FragmentMotion& f = list[i];
    f.translation = 0.5 * f.momentum.squaredNorm() / f.mass;
    f.rotation = 0.5 * f.angular_momentum.dot(inertia[i].ldlt().solve(f.angular_momentum));
  }
}

} // namespace

std::vector<FragmentMotion> fragment_motions(const Model& model, const State& state,
                                             const ResolvedConditions& conditions) {
  const double sphere = 6 / 3.14159265358979323846; // volume of a cube over that of its sphere
  const std::vector<int> pieces = fragments_of_nodes(model, state);
  std::vector<int> place(pieces.size(), -1), of_node(pieces.size());
  std::vector<FragmentMotion> list;
  for (std::size_t node = 0; node < pieces.size(); ++node) {
    int& at = place[pieces[node]];
    if (at < 0) {
      at = static_cast<int>(list.size());
      list.emplace_back();
    }
    of_node[node] = at;
  }
  add_bodies_and_volumes(model, of_node, list);
  add_motions(model, state, of_node, list);
  for (const HeldNode& held : conditions.held)
    list[of_node[held.node]].held = true;
  for (FragmentMotion& f : list) {
    f.centroid /= f.volume;
    f.diameter = std::cbrt(sphere * f.volume);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Fragment& a, const Fragment& b) { return a.volume > b.volume; });
  return list;
}

std::vector<PassingRow> mass_passing(const std::vector<FragmentMotion>& fragments) {
  std::vector<PassingRow> rows;
  double all = 0;
  for (auto f = fragments.rbegin(); f != fragments.rend(); ++f) {
    all += f->mass;
    rows.push_back({f->diameter, all});
  }
  for (PassingRow& row : rows)
    row.passing = row.passing / all;
  return rows;
}

} // namespace cdem
