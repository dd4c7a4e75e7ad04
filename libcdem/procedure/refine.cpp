#include "libcdem/procedure/refine.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/failure_plane.hpp"
#include "libcdem/fracture/slicing.hpp"
#include "libcdem/fracture/tip_field.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// A vertex nearer to a plane than this part of the block's size lies on it.
constexpr double on_plane = 1e-9;

constexpr double right_angle = 1.57079632679489661923; // rad

void check(const RefineOptions& o) {
  geom::require_at_least("tension_threshold", o.tension_threshold, 0, "Pa");
  geom::require_at_least("shear_threshold", o.shear_threshold, 0, "Pa");
  if (o.cohesion)
    geom::require_at_least("cohesion", *o.cohesion, 0, "Pa");
  if (o.friction_angle)
    geom::require(*o.friction_angle >= 0 && *o.friction_angle < right_angle, "friction_angle",
                  *o.friction_angle * 90 / right_angle, "in [0, 90) degrees");
  if (o.tensile_strength)
    geom::require_at_least("tensile_strength", *o.tensile_strength, 0, "Pa");
  geom::require(o.planes >= 1 && o.planes <= 15, "planes", o.planes, "an integer in 1..15");
  if (o.anchor && !o.anchor->allFinite())
    throw geom::InputError("anchor", geom::shown(*o.anchor), "a finite place, m");
  geom::require(o.max_depth >= 1 && o.max_depth <= 6, "max_depth", o.max_depth, "an integer in 1..6");
}

BlockStrength strength_of(const Body& body, const RefineOptions& o) {
  return {o.cohesion.value_or(body.joint.cohesion), o.friction_angle.value_or(body.joint.friction_angle),
          o.tensile_strength.value_or(body.joint.tensile_strength)};
}

void require_strength(const Body& body, const BlockStrength& s) {
  if (s.cohesion <= 0 && s.tensile_strength <= 0)
    throw geom::InputError(
        "refine: body \"" + body.name +
        "\" has neither cohesion nor tensile_strength to judge its blocks by; give them to refine, "
        "to the body's joint, or leave the body out with region");
}

// Rotation about the model's mass centre that fits the displacements best (least squares, small angles), as a
// displacement gradient. Taken out so that a model that turns as a whole prefers neither conjugate plane.
geom::Mat3 rigid_rotation(const Model& model, const State& state) {
  double mass = 0;
  geom::Vec3 centre = geom::Vec3::Zero(), drift = geom::Vec3::Zero();
  const auto displacement = [&](std::size_t i) {
    return geom::Vec3(state.displacement[i].x, state.displacement[i].y, state.displacement[i].z);
  };
  for (std::size_t i = 0; i < model.node_position.size(); ++i) {
    mass += model.node_mass[i];
    centre += model.node_mass[i] * model.node_position[i];
    drift += model.node_mass[i] * displacement(i);
  }
  centre /= mass;
  drift /= mass;
  geom::Mat3 inertia = geom::Mat3::Zero();
  geom::Vec3 moment = geom::Vec3::Zero();
  for (std::size_t i = 0; i < model.node_position.size(); ++i) {
    const geom::Vec3 arm = model.node_position[i] - centre;
    inertia += model.node_mass[i] * (arm.squaredNorm() * geom::Mat3::Identity() - arm * arm.transpose());
    moment += model.node_mass[i] * arm.cross(displacement(i) - drift);
  }
  const geom::Vec3 w = inertia.ldlt().solve(moment);
  geom::Mat3 turn;
  turn << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return turn;
}

// Parts of one block between parallel planes, from below upwards.
std::vector<Successor> slice(const Model& model, int block, const std::vector<geom::Plane>& planes) {
  std::vector<Successor> parts;
  Successor rest = whole_block(model, block);
  for (const geom::Plane& plane : planes) {
    geom::Cut pieces = geom::cut(rest.shape, plane, on_plane * model.blocks[block].size);
    if (!pieces.above || !pieces.below)
      continue;
    const auto inherit = [&](const geom::Part& piece) {
      Successor s;
      s.old_block = block;
      s.whole = false;
      s.shape = piece.shape;
      for (const int face : piece.parent_face)
        s.old_face.push_back(face == geom::cut_face ? geom::cut_face : rest.old_face[face]);
      return s;
    };
    parts.push_back(inherit(*pieces.below));
    rest = inherit(*pieces.above);
  }
  parts.push_back(std::move(rest));
  return parts;
}

// Index of the joint that cut faces of each body get: bonded, with the strength the criterion used.
std::vector<int> cut_joints(Model& frame, const RefineOptions& o) {
  std::vector<int> joints;
  for (int b = 0; b < static_cast<int>(frame.bodies.size()); ++b) {
    const BlockStrength strength = strength_of(frame.bodies[b], o);
    const Joint& own = frame.bodies[b].joint;
    const bool same = own.bonded && own.cohesion == strength.cohesion &&
                      own.friction_angle == strength.friction_angle &&
                      own.tensile_strength == strength.tensile_strength;
    if (same) {
      joints.push_back(frame.pair_joint.at({b, b}));
      continue;
    }
    Joint joint = own;
    joint.bonded = true;
    joint.cohesion = strength.cohesion;
    joint.friction_angle = strength.friction_angle;
    joint.tensile_strength = strength.tensile_strength;
    joints.push_back(static_cast<int>(frame.joints.size()));
    frame.joints.push_back(joint);
  }
  return joints;
}

// The same for bodies that move far (Kabsch): R of the least squares fit of R X + c to the nodes' positions.
geom::Mat3 best_rotation(const Model& model, const State& state) {
  double mass = 0;
  geom::Vec3 before = geom::Vec3::Zero(), now = geom::Vec3::Zero();
  for (std::size_t i = 0; i < model.node_position.size(); ++i) {
    mass += model.node_mass[i];
    before += model.node_mass[i] * model.node_position[i];
    now += model.node_mass[i] * place_of(model, state, static_cast<int>(i));
  }
  geom::Mat3 moments = geom::Mat3::Zero();
  for (std::size_t i = 0; i < model.node_position.size(); ++i)
    moments += model.node_mass[i] * (place_of(model, state, static_cast<int>(i)) - now / mass) *
               (model.node_position[i] - before / mass).transpose();
  return rotation_in(moments);
}

// Stress and displacement gradient of a block in its undeformed directions, in which it is cut; the motion of the whole
// model is taken out of the gradient.
MeanField field_of(const Model& model, const State& state, int block, const geom::Mat3& small_turn,
                   const geom::Mat3& far_turn) {
  const geom::Mat3 stress = matrix(block_stress(model, state, block)),
                   gradient = block_gradient(model, state.displacement, model.blocks[block]);
  if (!model.blocks[block].meshed)
    return {stress, gradient - small_turn};
  const geom::Mat3 turn = block_rotation(model, state, block), one = geom::Mat3::Identity();
  return {turn.transpose() * stress * turn, far_turn.transpose() * (one + gradient) - one};
}

} // namespace

bool may_be_cut(const Model& model, int index, const RefineOptions& o) {
  const Block& block = model.blocks[index];
  return block.rigid < 0 && block.generation < o.max_depth &&
         (!o.near || is_near(block, o.near->centre, o.near->radius)) &&
         (!o.region || selects_block(model, *o.region, index));
}

Refined refine(const Model& model, const State& state, const RefineOptions& options) {
  check(options);
  Model frame = model;
  const std::vector<int> joints = cut_joints(frame, options);
  const geom::Mat3 turn = rigid_rotation(model, state);
  const geom::Mat3 far_turn = model.mesh.empty() ? geom::Mat3::Identity() : best_rotation(model, state);
  std::optional<MeanField> around;
  if (options.judged_by)
    around = mean_field(model, state, options.judged_by->centre, options.judged_by->radius);

  Refined result;
  std::vector<Successor> successors;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    std::optional<FailurePlane> plane;
    if (may_be_cut(model, b, options)) {
      const BlockStrength strength = strength_of(model.bodies[block.body], options);
      require_strength(model.bodies[block.body], strength);
      const MeanField field = around ? MeanField{around->stress, around->gradient - turn}
                                     : field_of(model, state, b, turn, far_turn);
      plane = failure_plane(field.stress, field.gradient, strength, options);
    }
    std::vector<Successor> parts;
    if (plane) {
      const Slicing cuts = slicing(block, plane->normal, options);
      plane->normal = cuts.normal;
      parts = slice(model, b, cuts.planes);
    }
    if (parts.size() < 2) {
      successors.push_back(whole_block(model, b));
      continue;
    }
    result.cuts.push_back({block.id, plane->mode, block.mass.centroid, plane->normal, plane->principal,
                           plane->angle_to_sigma1, block.generation, static_cast<int>(parts.size()),
                           plane->tie});
    for (Successor& part : parts)
      successors.push_back(std::move(part));
  }
  std::sort(result.cuts.begin(), result.cuts.end(),
            [](const BlockCut& a, const BlockCut& b) { return a.block < b.block; });
  // Where nothing is cut, what may break stays as it was: a rule about cuts would leave nothing that may.
  const MayBreak may_break = result.cuts.empty() ? MayBreak::all : options.may_break;
  result.rebuilt = rebuild(frame, state, std::move(successors), joints, may_break);
  return result;
}

} // namespace cdem
