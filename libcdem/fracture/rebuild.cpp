#include "libcdem/fracture/rebuild.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/cut_motion.hpp"
#include "libcdem/fracture/renew_interfaces.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace cdem {
namespace {

// A place counts as inside a tet when no barycentric weight is below this.
constexpr double inside = -1e-6;

using FaceKey = std::array<int, 4>; // block a, face a, block b, face b of the old model

std::map<FaceKey, int> interfaces_by_face(const Model& model) {
  std::map<FaceKey, int> found;
  for (int i = 0; i < static_cast<int>(model.interfaces.size()); ++i) {
    const Interface& f = model.interfaces[i];
    found[{f.block_a, f.face_a, f.block_b, f.face_b}] = i;
  }
  return found;
}

Eigen::Vector4d weights(const Model& model, int tet, const geom::Vec3& place) {
  const geom::Tet& t = model.tets[tet];
  const auto& x = model.node_position;
  geom::Mat3 edges;
  edges << x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]];
  const geom::Vec3 w = edges.inverse() * (place - x[t[0]]);
  return {1 - w.sum(), w[0], w[1], w[2]};
}

Node blend(const std::vector<Node>& values, const geom::Tet& tet, const Eigen::Vector4d& w) {
  Node n;
  for (int k = 0; k < 4; ++k) {
    n.x += w[k] * values[tet[k]].x;
    n.y += w[k] * values[tet[k]].y;
    n.z += w[k] * values[tet[k]].z;
  }
  return n;
}

// The tet of an old block that holds a place best.
int tet_at(const Model& old, const Block& block, const geom::Vec3& place) {
  int best = block.tet_begin;
  double best_weight = -1e30;
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet)
    if (const double w = weights(old, tet, place).minCoeff(); w > best_weight) {
      best = tet;
      best_weight = w;
    }
  return best;
}

// Nodal values at a place of an old block: of the tet that holds it best.
Node at_place(const Model& old, const std::vector<Node>& values, const Block& block,
              const geom::Vec3& place) {
  const int tet = tet_at(old, block, place);
  return blend(values, old.tets[tet], weights(old, tet, place));
}

// Stress of an old block at a place: mean over the tets that hold it, so that mirror images stay mirror images.
geom::Mat3 stress_at(const Model& old, const State& from, int block, const geom::Vec3& place) {
  const Block& b = old.blocks[block];
  geom::Mat3 sum = geom::Mat3::Zero();
  int count = 0;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet)
    if (weights(old, tet, place).minCoeff() >= inside) {
      sum += matrix(b.meshed ? mesh_stress(old, from, tet) : tet_stress(old, from, tet));
      ++count;
    }
  if (count == 0)
    return matrix(block_stress(old, from, block));
  return sum / count;
}

int nearest_point(const Model& old, const Interface& interface, const geom::Vec3& place) {
  int nearest = interface.point_begin;
  for (int p = interface.point_begin; p < interface.point_end; ++p)
    if ((old.point_position[p] - place).squaredNorm() < (old.point_position[nearest] - place).squaredNorm())
      nearest = p;
  return nearest;
}

bool may_break_now(MayBreak rule, InterfaceOrigin origin, const Block& a, const Block& b, bool before) {
  switch (rule) {
  case MayBreak::all:
    return before;
  case MayBreak::cut_faces:
    return origin == InterfaceOrigin::cut;
  case MayBreak::near_cuts:
    return origin == InterfaceOrigin::cut || (a.generation > 0 && b.generation > 0);
  }
  return before;
}

class Rebuilder {
public:
  Rebuilder(const Model& old, const State& from, std::vector<Successor> successors,
            const std::vector<int>& cut_joint, MayBreak may_break)
      : old_(old), from_(from), successors_(std::move(successors)), cut_joint_(cut_joint),
        may_break_(may_break), old_interfaces_(interfaces_by_face(old)) {}

  Rebuilt operator()() {
    Rebuilt result;
    result.model = build_model(
        old_, seeds(),
        [this](const Model& model, int a, int fa, int b, int fb) { return traits(model, a, fa, b, fb); },
        mesh_seeds());
    result.state = initial_state(result.model);
    if (!from_.water_pressure.empty())
      result.state.water_pressure.assign(result.model.points.size(), 0);
    result.state.time = from_.time;
    result.state.step = from_.step;
    result.state.velocity_lag = from_.velocity_lag;
    result.state.spent = from_.spent;
    result.state.column_displacement = from_.column_displacement;
    result.state.column_velocity = from_.column_velocity;
    result.state.bolts = from_.bolts;
    result.state.crack_energy = from_.crack_energy;
    for (const Successor& s : successors_)
      result.old_block.push_back(s.old_block);
    carry_blocks(result);
    carry_faces(result);
    carry_support(result);
    carry_rigid(result);
    for (const Interface& interface : result.model.interfaces)
      carry_interface(result, interface);
    carry_renewed(result);
    carry_contacts(result);
    return result;
  }

private:
  std::vector<BlockSeed> seeds() const {
    std::vector<BlockSeed> seeds;
    for (const Successor& s : successors_) {
      const Block& parent = old_.blocks[s.old_block];
      if (!parent.convex())
        continue;
      BlockSeed seed;
      seed.id = s.whole ? parent.id : 0;
      seed.parent = s.whole ? parent.parent : parent.id;
      seed.generation = parent.generation + (s.whole ? 0 : 1);
      seed.body = parent.body;
      seed.shape = s.shape;
      seed.first_size = parent.first_size;
      if (s.whole)
        seed.zones = zones_of(old_, s.old_block);
      seeds.push_back(std::move(seed));
    }
    return seeds;
  }

  std::vector<MeshSeed> mesh_seeds() const {
    std::vector<MeshSeed> seeds;
    for (const Successor& s : successors_)
      if (!old_.blocks[s.old_block].convex())
        seeds.push_back(mesh_seed(old_, s.old_block));
    return seeds;
  }

  // The old interface that a new face pair lies in; null for a new cut.
  const Interface* old_interface(int a, int fa, int b, int fb) const {
    const Successor &sa = successors_[a], &sb = successors_[b];
    const int old_fa = sa.old_face[fa], old_fb = sb.old_face[fb];
    if (old_fa == geom::cut_face || old_fb == geom::cut_face)
      return nullptr;
    const FaceKey key = sa.old_block < sb.old_block ? FaceKey{sa.old_block, old_fa, sb.old_block, old_fb}
                                                    : FaceKey{sb.old_block, old_fb, sa.old_block, old_fa};
    const auto found = old_interfaces_.find(key);
    return found == old_interfaces_.end() ? nullptr : &old_.interfaces[found->second];
  }

  InterfaceTraits traits(const Model& model, int a, int fa, int b, int fb) const {
    InterfaceTraits t;
    if (const Interface* before = old_interface(a, fa, b, fb)) {
      t.id = successors_[a].whole && successors_[b].whole ? before->id : 0;
      t.joint = before->joint;
      t.thickness = before->thickness;
      t.origin = before->origin;
      t.strength = before->strength; // parts of a face are no stronger and no weaker than it was
      t.may_break = !model.joints[t.joint].glued &&
                    may_break_now(may_break_, t.origin, model.blocks[a], model.blocks[b], before->may_break);
      return t;
    }
    t = default_traits(model, a, fa, b, fb);
    if (successors_[a].old_block == successors_[b].old_block) {
      t.origin = InterfaceOrigin::cut;
      if (!cut_joint_.empty())
        t.joint = cut_joint_[model.blocks[a].body];
      const Joint& joint = model.joints[t.joint];
      t.thickness = joint.thickness.value_or(joint.thickness_ratio * model.blocks[a].first_size);
    }
    t.may_break = !model.joints[t.joint].glued &&
                  may_break_now(may_break_, t.origin, model.blocks[a], model.blocks[b], true);
    return t;
  }

  void carry_blocks(Rebuilt& r) const {
    std::map<int, std::vector<int>> parts; // of a cut block: the nodes of its parts
    for (std::size_t b = 0; b < r.model.blocks.size(); ++b) {
      const Block& now = r.model.blocks[b];
      const Block& before = old_.blocks[successors_[b].old_block];
      if (!from_.escaped.empty()) {
        r.state.escaped.resize(r.model.node_position.size(), 0);
        std::fill(r.state.escaped.begin() + now.node_begin, r.state.escaped.begin() + now.node_end,
                  from_.escaped[before.node_begin]);
      }
      if (!from_.displacement_zero.empty())
        carry_zero(r, b);
      for (int node = now.node_begin; node < now.node_end; ++node) {
        if (successors_[b].whole) {
          const int same = before.node_begin + (node - now.node_begin);
          r.state.displacement[node] = from_.displacement[same];
          r.state.velocity[node] = from_.velocity[same];
        } else {
          const geom::Vec3& place = r.model.node_position[node];
          const int tet = tet_at(old_, before, place);
          const Eigen::Vector4d w = weights(old_, tet, place);
          r.state.displacement[node] = blend(from_.displacement, old_.tets[tet], w);
          r.state.velocity[node] = blend(from_.velocity, old_.tets[tet], w);
          parts[successors_[b].old_block].push_back(node);
        }
      }
      for (int tet = now.tet_begin; tet < now.tet_end; ++tet) {
        const int source = successors_[b].whole ? before.tet_begin + (tet - now.tet_begin)
                                                : tet_at(old_, before, centre_of(r.model, tet));
        if (now.meshed) {
          set_mesh_stress(r.model, r.state, tet, mesh_stress(old_, from_, source));
          if (!from_.plastic_strain.empty())
            plastic_strain_of(r.model, r.state, tet) = plastic_strain_of(old_, from_, source);
        } else
          r.state.initial_stress[tet] = from_.initial_stress[source];
      }
    }
    for (const auto& [block, nodes] : parts)
      keep_motion(old_, from_, block, r.model, nodes, r.state);
  }

  // Of meshes, which stay whole: their faces stand in the same order as before.
  void carry_faces(Rebuilt& r) const {
    struct Place {
      std::int64_t batch;
      int lane;
    };
    std::map<int, std::vector<Place>> before; // by block
    each_face(old_.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
      before[chunk.block].push_back({batch, lane});
    });
    std::map<int, std::size_t> next;
    each_face(r.model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
      const int old_block = successors_[chunk.block].old_block;
      const Place was = before.at(old_block)[next[old_block]++];
      const FaceStateBatch& from = from_.faces[was.batch];
      FaceStateBatch& to = r.state.faces[batch];
      for (int point = 0; point < 3; ++point)
        to.mode[point][lane] = from.mode[point][was.lane];
      to.handed_over[lane] = from.handed_over[was.lane];
      to.stage[lane] = from.stage[was.lane];
      to.preloaded[lane] = from.preloaded[was.lane];
      if (const FaceSlip* slip = slip_of(from_, was.batch, was.lane))
        slip_of(r.state, batch, lane) = *slip;
      const std::int64_t old_face = was.batch * lanes + was.lane, face = batch * lanes + lane;
      if (!from_.cohesive.empty())
        r.state.cohesive[face] = from_.cohesive[old_face];
      if (!from_.rate_factor.empty())
        r.state.rate_factor[face] = from_.rate_factor[old_face];
    });
  }

  void carry_zero(Rebuilt& r, std::size_t b) const {
    const Block &now = r.model.blocks[b], &before = old_.blocks[successors_[b].old_block];
    r.state.displacement_zero.resize(r.model.node_position.size());
    for (int node = now.node_begin; node < now.node_end; ++node)
      r.state.displacement_zero[node] =
          successors_[b].whole ? from_.displacement_zero[before.node_begin + (node - now.node_begin)]
                               : at_place(old_, from_.displacement_zero, before, r.model.node_position[node]);
  }

  // Forces on the nodes of a cut block go to the nearest nodes of its parts, in equal shares.
  void carry_support(Rebuilt& r) const {
    if (from_.support_force.empty())
      return;
    r.state.support_force.resize(r.model.node_position.size());
    std::map<int, std::vector<int>> parts; // of a cut block
    for (std::size_t b = 0; b < r.model.blocks.size(); ++b) {
      const Block &now = r.model.blocks[b], &before = old_.blocks[successors_[b].old_block];
      if (successors_[b].whole)
        std::copy_n(from_.support_force.begin() + before.node_begin, before.node_end - before.node_begin,
                    r.state.support_force.begin() + now.node_begin);
      else
        for (int node = now.node_begin; node < now.node_end; ++node)
          parts[successors_[b].old_block].push_back(node);
    }
    for (const auto& [block, nodes] : parts)
      for (int old = old_.blocks[block].node_begin; old < old_.blocks[block].node_end; ++old) {
        const Node& force = from_.support_force[old];
        if (force.x == 0 && force.y == 0 && force.z == 0)
          continue;
        const auto away = [&](int node) {
          return (r.model.node_position[node] - old_.node_position[old]).norm();
        };
        double least = away(nodes.front());
        for (const int node : nodes)
          least = std::min(least, away(node));
        const auto near = [&](int node) { return away(node) <= least + old_.tolerance; };
        const double share = 1 / static_cast<double>(std::count_if(nodes.begin(), nodes.end(), near));
        for (const int node : nodes)
          if (near(node)) {
            Node& sum = r.state.support_force[node];
            sum = {sum.x + share * force.x, sum.y + share * force.y, sum.z + share * force.z, 0};
          }
      }
  }

  static geom::Vec3 centre_of(const Model& model, int tet) {
    geom::Vec3 sum = geom::Vec3::Zero();
    for (const int node : model.tets[tet])
      sum += model.node_position[node];
    return sum / 4;
  }

  // Blocks that keep their shape are never cut.
  void carry_rigid(Rebuilt& r) const {
    for (Block& block : r.model.blocks)
      block.rigid = -1;
    r.model.rigid.clear();
    r.state.rigid.clear();
    r.state.rigid_offset.assign(old_.rigid.empty() ? 0 : r.model.node_position.size(), Node{});
    for (int b = 0; b < static_cast<int>(r.model.blocks.size()); ++b) {
      const Block& before = old_.blocks[successors_[b].old_block];
      if (before.rigid < 0)
        continue;
      Block& now = r.model.blocks[b];
      now.rigid = static_cast<int>(r.model.rigid.size());
      r.model.rigid.push_back(old_.rigid[before.rigid]);
      r.model.rigid.back().block = b;
      r.state.rigid.push_back(from_.rigid[before.rigid]);
      std::copy(from_.rigid_offset.begin() + before.node_begin, from_.rigid_offset.begin() + before.node_end,
                r.state.rigid_offset.begin() + now.node_begin);
    }
    if (r.model.rigid.empty())
      r.state.rigid_offset.clear();
  }

  // Contacts between blocks that are still whole; those of a block that was cut are found anew.
  void carry_contacts(Rebuilt& r) const {
    carry_tet_contacts(r);
    if (from_.contacts.empty() || r.model.surface.empty())
      return;
    std::vector<int> new_block(old_.blocks.size(), -1);
    for (std::size_t b = 0; b < successors_.size(); ++b)
      if (successors_[b].whole)
        new_block[successors_[b].old_block] = static_cast<int>(b);
    const auto triangle_now = [&](int triangle) {
      const int block = old_.surface.triangles[triangle].block, now = new_block[block];
      return now < 0 ? -1 : triangle - old_.surface.block_begin[block] + r.model.surface.block_begin[now];
    };
    const std::vector<int> pieces = fragments_of_nodes(r.model, r.state);
    for (Contact c : from_.contacts) {
      const auto [old_source, old_target] = triangles_of(c);
      const int source = triangle_now(old_source), target = triangle_now(old_target);
      const bool edge = c.kind == Contact::edge;
      const int beside = edge ? triangle_now(c.beside) : c.beside;
      const int own_second = edge ? triangle_now(c.fragment) : 0;
      if (source < 0 || target < 0 || (edge && (beside < 0 || own_second < 0)))
        continue;
      c.source = static_cast<std::uint32_t>(3 * source + static_cast<int>(c.source) % 3) & 0x7fffffffu;
      c.target = edge ? 3 * target + c.target % 3 : target;
      c.beside = beside;
      c.fragment = edge ? own_second : pieces[r.model.surface.triangles[target].nodes[0]];
      r.state.contacts.push_back(c);
    }
    std::sort(r.state.contacts.begin(), r.state.contacts.end(),
              [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  }

  void carry_tet_contacts(Rebuilt& r) const {
    std::vector<int> moved(old_.blocks.size(), -1); // first tet now
    for (std::size_t b = 0; b < successors_.size(); ++b)
      if (successors_[b].whole)
        moved[successors_[b].old_block] = r.model.blocks[b].tet_begin;
    for (TetContact c : from_.tet_contacts) {
      const int block = old_.tet_block[c.a], shift = moved[block] - old_.blocks[block].tet_begin;
      if (moved[block] < 0)
        continue;
      c.a += shift;
      c.b += shift;
      r.state.tet_contacts.push_back(c);
    }
    std::sort(r.state.tet_contacts.begin(), r.state.tet_contacts.end());
  }

  void carry_interface(Rebuilt& r, const Interface& now) const {
    const Interface* before = old_interface(now.block_a, now.face_a, now.block_b, now.face_b);
    const bool same = before && successors_[now.block_a].whole && successors_[now.block_b].whole;
    if (before && is_renewed(*before))
      return;
    assert(!same || before->point_end - before->point_begin == now.point_end - now.point_begin);
    // Blocks keep their order, so side a of the old interface is side a of the new one.
    for (int p = now.point_begin; p < now.point_end; ++p) {
      if (before) {
        const int source = same ? before->point_begin + (p - now.point_begin)
                                : nearest_point(old_, *before, r.model.point_position[p]);
        if (now.frame >= 0)
          r.state.released[now.frame] = static_cast<std::uint8_t>(released(from_, *before));
        r.state.bond_mode[p] = from_.bond_mode[source];
        r.state.bond_offset[p] = from_.bond_offset[source];
        if (!from_.bond_damage.empty()) {
          r.state.bond_damage[p] = from_.bond_damage[source];
          r.state.bond_slip[p] = from_.bond_slip[source];
        }
        if (!from_.joint_history.empty())
          r.state.joint_history[p] = from_.joint_history[source];
        if (!from_.water_pressure.empty())
          r.state.water_pressure[p] = from_.water_pressure[source];
      } else if (now.origin == InterfaceOrigin::cut) {
        preload(r, now, p);
      }
    }
  }

  bool is_renewed(const Interface& interface) const {
    return interface.frame >= 0 && old_.frames[interface.frame].renewed;
  }

  // Interfaces whose faces had slid: their springs stand where the faces lie on each other now.
  void carry_renewed(Rebuilt& r) const {
    std::vector<InterfaceToRenew> list;
    for (int i = 0; i < static_cast<int>(r.model.interfaces.size()); ++i) {
      const Interface& now = r.model.interfaces[i];
      const Interface* before = old_interface(now.block_a, now.face_a, now.block_b, now.face_b);
      if (!before || !is_renewed(*before))
        continue;
      list.push_back({i, InterfaceMemory(old_, from_, *before)});
      r.state.released[now.frame] = static_cast<std::uint8_t>(released(from_, *before));
    }
    if (!list.empty())
      renew_interfaces(r.model, r.state, list, 1);
  }

  void preload(Rebuilt& r, const Interface& now, int p) const {
    const int parent = successors_[now.block_a].old_block;
    const geom::Mat3 turn = block_rotation(old_, from_, parent);
    const geom::Vec3 traction =
        turn.transpose() * stress_at(old_, from_, parent, r.model.point_position[p]) * turn * now.normal;
    const double normal = traction.dot(now.normal);
    const geom::Vec3 stretch = normal / now.kn * now.normal + (traction - normal * now.normal) / now.ks;
    r.state.bond_offset[p] = local_jump(r.model, r.state.displacement, p) - stretch;
  }

  const Model& old_;
  const State& from_;
  std::vector<Successor> successors_;
  const std::vector<int>& cut_joint_;
  MayBreak may_break_;
  std::map<FaceKey, int> old_interfaces_;
};

} // namespace

Successor whole_block(const Model& model, int block) {
  Successor s;
  s.old_block = block;
  s.shape = model.blocks[block].shape;
  for (int f = 0; f < static_cast<int>(s.shape.faces.size()); ++f)
    s.old_face.push_back(f);
  return s;
}

Rebuilt rebuild(const Model& old, const State& from, std::vector<Successor> successors,
                const std::vector<int>& cut_joint, MayBreak may_break) {
  return Rebuilder(old, from, std::move(successors), cut_joint, may_break)();
}

} // namespace cdem
