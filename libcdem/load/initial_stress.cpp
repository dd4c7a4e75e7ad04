#include "libcdem/load/initial_stress.hpp"

#include "libcdem/bond/freed_face.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

// Tractions below this part of the largest one are rounding.
constexpr double rounding = 1e-9;

void check(const InitialStress& field, double top) {
  for (const double component : field.stress)
    geom::require(std::isfinite(component), "stress", component,
                  "six finite numbers (xx yy zz xy yz xz), Pa");
  geom::require_at_least("gradient", field.gradient, 0, "Pa/m");
  for (const double k : field.k0)
    geom::require(std::isfinite(k) && k >= 0, "k0", k, "a finite number >= 0, or two of them {kx, ky}");
  if (field.surface && !std::isfinite(*field.surface))
    throw geom::InputError("surface", fmt::format("{:g}", *field.surface), "a finite height z, m",
                           fmt::format("the top of the model is at {:g} m", top));
}

geom::Vec3 centre_of(const Model& model, int tet) {
  geom::Vec3 sum = geom::Vec3::Zero();
  for (const int node : model.tets[tet])
    sum += model.node_position[node];
  return sum / 4;
}

// The springs of a bonded mesh would not carry the stress.
void require_carries(const Model& model, const Block& block, const Selection& on) {
  const Bonding& bonding = model.bodies[block.body].bonding;
  if (!block.convex() && !bonding.none() && !bonding.is_cohesive())
    throw geom::InputError(
        "on", on.text, "blocks, meshes without bonds, or cohesive meshes",
        "the springs of a mesh cannot be given an initial stress; bonds = \"cohesive\" can");
}

// A face of a cohesive body that holds takes the stress of its tets. One that is broken takes what pressure and friction hold of
// it. A crack that goes on is at its strength and takes none.
void add_to_faces(const Model& model, State& state, const std::vector<char>& selected,
                  const InitialStress& field, double top) {
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (selected[chunk.block] == 0 || holds(state.faces[batch].stage[lane]))
      return;
    const std::int64_t number = batch * lanes + lane;
    if (state.faces[batch].stage[lane] != FaceStage::cracking ||
        state.cohesive[number].damage != std::array{1.0, 1.0, 1.0})
      throw geom::InputError(
          "on", field.on.text, "cohesive bodies without open or growing cracks",
          "give the initial stress before the first stage; model:break_bonds may come before it");
    const FaceTets& tets = model.mesh.face_tets[number];
    const auto stress = [&](int tet) { return matrix(stress_at(field, top, centre_of(model, tet))); };
    break_face(model, state, chunk, batch, lane, 0.5 * (stress(tets.tet_a) + stress(tets.tet_b)));
  });
}

void add_to_block(const Model& model, State& state, const Block& block, const InitialStress& field,
                  double top) {
  // Kept by each tet, in the directions of now; of a rigid block in those it was made rigid in.
  const geom::Mat3 turn = block.rigid < 0 ? geom::Mat3::Identity() : rotation(state.rigid[block.rigid]);
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
    const Stress stress = stress_at(field, top, centre_of(model, tet));
    if (!block.meshed) {
      for (int c = 0; c < 6; ++c)
        state.initial_stress[tet][c] += stress[c];
      continue;
    }
    const Stress own = turned(turn.transpose(), stress);
    Stress sum = mesh_stress(model, state, tet);
    for (int c = 0; c < 6; ++c)
      sum[c] += own[c];
    set_mesh_stress(model, state, tet, sum);
  }
}

// How much of what holds a point its traction takes; 1: it breaks, opens or slides. strength: of the interface over that
// of its joint.
double utilisation_of(const Joint& joint, const InterfaceLaw& own, double path, double strength, bool intact,
                      double normal, double shear) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto over = [&](double load, double borne) {
    return load <= 0 ? 0 : borne > 0 ? load / borne : infinite;
  };
  if (own.law && !intact)
    return over(shear, joint_strength(*own.law, own.spring, -normal, path));
  const double cohesion = intact ? strength * joint.cohesion : 0,
               tension = intact ? strength * joint.tensile_strength : 0;
  return std::max(over(normal, tension),
                  over(shear, shear_strength(cohesion, geom::portable::tan(joint.friction_angle), normal)));
}

} // namespace

Stress stress_at(const InitialStress& field, double top, const geom::Vec3& place) {
  const double depth = std::max(0.0, field.surface.value_or(top) - place.z());
  const double vertical = -field.gradient * depth;
  Stress stress = field.stress;
  stress[0] += field.k0[0] * vertical;
  stress[1] += field.k0[1] * vertical;
  stress[2] += vertical;
  return stress;
}

void add_initial_stress(const Model& model, State& state, const InitialStress& field) {
  const double top = model.box.max.z();
  check(field, top);
  std::vector<char> selected(model.blocks.size(), 0);
  for (int b = 0; b < static_cast<int>(selected.size()); ++b)
    if (selects_block(model, field.on, b)) {
      selected[b] = 1;
      require_carries(model, model.blocks[b], field.on);
    }
  if (std::find(selected.begin(), selected.end(), 1) == selected.end())
    throw geom::InputError("on", field.on.text, "a place that holds block centroids",
                           "nothing of the model lies there");
  for (std::size_t b = 0; b < selected.size(); ++b)
    if (selected[b] != 0)
      add_to_block(model, state, model.blocks[b], field, top);
  add_to_faces(model, state, selected, field, top);
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const Interface& interface = model.interfaces[model.points[p].interface];
    // The traction is the mean of the stress on both sides, so that layers that are given one by one load the faces
    // between them, in whatever order they come.
    const double share = 0.5 * (selected[interface.block_a] + selected[interface.block_b]);
    if (share == 0)
      continue;
    const geom::Mat3 sigma = share * matrix(stress_at(field, top, model.point_position[p]));
    const geom::Mat3 turn = interface_rotation(model, state.displacement.data(), interface);
    const geom::Vec3 t = turn.transpose() * sigma * turn * interface.normal;
    add_traction(model, state, static_cast<int>(p), t);
  }
}

BeyondStrength beyond_strength(const Model& model, const State& state) {
  struct JointTraction {
    double normal, shear;
  };
  std::vector<JointTraction> tractions;
  double largest = 0;
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p) {
    const BondPoint& point = model.points[p];
    const Interface& interface = model.interfaces[point.interface];
    // As if it held: a contact beyond its strength has already let go in traction().
    const geom::Vec3 stretch = local_jump(model, state.displacement, p) - state.bond_offset[p];
    const double open = stretch.dot(point.normal);
    const double normal = state.joint_history.empty() || open > 0
                              ? interface.kn * open
                              : traction(model, state, p).dot(point.normal);
    tractions.push_back({normal, interface.ks * (stretch - open * point.normal).norm()});
    if (released(state, interface))
      tractions.back() = {0, 0};
    largest = std::max({largest, std::abs(tractions.back().normal), tractions.back().shear});
  }
  BeyondStrength found;
  for (std::size_t p = 0; p < tractions.size(); ++p) {
    const Interface& interface = model.interfaces[model.points[p].interface];
    const auto [normal, shear] = tractions[p];
    if (std::max(normal, shear) <= rounding * largest)
      continue;
    const bool intact = is_intact(state.bond_mode[p]);
    if (intact && !interface.may_break)
      continue;
    const double path = state.joint_history.empty() ? 0 : state.joint_history[p].path;
    const double utilisation =
        utilisation_of(model.joints[interface.joint], law_of_interface(model, interface), path,
                       interface.strength, intact, normal, shear);
    if (utilisation > 1 + rounding)
      ++found.points;
    if (utilisation > found.largest_utilisation) {
      found.largest_utilisation = utilisation;
      found.place = model.point_position[p];
    }
  }
  return found;
}

} // namespace cdem
