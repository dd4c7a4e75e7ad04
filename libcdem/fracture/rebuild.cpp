#include "libcdem/fracture/rebuild.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/cut_motion.hpp"
#include "libcdem/fracture/place_in_block.hpp"
#include "libcdem/fracture/renew_interfaces.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/state/carry.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace cdem {
namespace {

using FaceKey = std::array<int, 4>; // block a, face a, block b, face b of the old model

std::map<FaceKey, int> interfaces_by_face(const Model& model) {
  std::map<FaceKey, int> found;
  for (int i = 0; i < static_cast<int>(model.interfaces.size()); ++i) {
    const Interface& f = model.interfaces[i];
    found[{f.block_a, f.face_a, f.block_b, f.face_b}] = i;
  }
  return found;
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
    for (const Successor& s : successors_)
      result.old_block.push_back(s.old_block);
    keep_rigid(result.model);
    result.state = from_;
    carry(old_, result.model, map_to(result.model), result.state);
    for (const auto& [block, nodes] : parts_of(result.model))
      keep_motion(old_, from_, block, result.model, nodes, result.state);
    for (const Interface& interface : result.model.interfaces)
      if (interface.origin == InterfaceOrigin::cut && !old_interface(interface))
        preload(result, interface);
    carry_renewed(result);
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
      seed.unit = parent.unit;
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

  const Interface* old_interface(const Interface& now) const {
    return old_interface(now.block_a, now.face_a, now.block_b, now.face_b);
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

  // Blocks that keep their shape are never cut.
  void keep_rigid(Model& model) const {
    for (Block& block : model.blocks)
      block.rigid = -1;
    model.rigid.clear();
    for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
      if (const int before = old_.blocks[successors_[b].old_block].rigid; before >= 0) {
        model.blocks[b].rigid = static_cast<int>(model.rigid.size());
        model.rigid.push_back(old_.rigid[before]);
        model.rigid.back().block = b;
      }
  }

  TopologyMap map_to(const Model& model) const {
    TopologyMap map;
    map_blocks(model, map);
    map_faces(model, map);
    map_interfaces(model, map);
    map_triangles(model, map);
    map.rigid_body.emplace();
    for (const RigidBody& body : model.rigid)
      map.rigid_body->push_back(old_.blocks[successors_[body.block].old_block].rigid);
    map.fragments_of_nodes = [](const Model& m, const State& s) { return fragments_of_nodes(m, s); };
    return map;
  }

  // By cut block: the nodes of its parts.
  std::map<int, std::vector<int>> parts_of(const Model& model) const {
    std::map<int, std::vector<int>> parts;
    for (std::size_t b = 0; b < model.blocks.size(); ++b)
      if (!successors_[b].whole)
        for (int node = model.blocks[b].node_begin; node < model.blocks[b].node_end; ++node)
          parts[successors_[b].old_block].push_back(node);
    return parts;
  }

  void map_blocks(const Model& model, TopologyMap& map) const {
    std::vector<int>&old_node = map.node.emplace(model.node_position.size(), -1),
    &old_tet = map.tet.emplace(model.tets.size(), -1);
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      const Block &now = model.blocks[b], &before = old_.blocks[successors_[b].old_block];
      const bool whole = successors_[b].whole;
      for (int node = now.node_begin; node < now.node_end; ++node)
        if (whole) {
          old_node[node] = before.node_begin + (node - now.node_begin);
          map.divided.push_back({old_node[node], node, 1});
        } else {
          const geom::Vec3& place = model.node_position[node];
          const int tet = tet_at(old_, before, place);
          map.blended.push_back({node, old_.tets[tet], weights_in_tet(old_, tet, place)});
        }
      for (int tet = now.tet_begin; tet < now.tet_end; ++tet)
        old_tet[tet] =
            whole ? before.tet_begin + (tet - now.tet_begin) : tet_at(old_, before, centre_of(model, tet));
    }
    divide_among_parts(model, map);
  }

  // What a node of a cut block has goes to the nearest nodes of its parts, in equal shares.
  void divide_among_parts(const Model& model, TopologyMap& map) const {
    for (const auto& [block, nodes] : parts_of(model))
      for (int old = old_.blocks[block].node_begin; old < old_.blocks[block].node_end; ++old) {
        const auto away = [&](int node) {
          return (model.node_position[node] - old_.node_position[old]).norm();
        };
        double least = away(nodes.front());
        for (const int node : nodes)
          least = std::min(least, away(node));
        const auto near = [&](int node) { return away(node) <= least + old_.tolerance; };
        const double part = 1 / static_cast<double>(std::count_if(nodes.begin(), nodes.end(), near));
        for (const int node : nodes)
          if (near(node))
            map.divided.push_back({old, node, part});
      }
  }

  // Meshes stay whole: their faces stand in the same order as before.
  void map_faces(const Model& model, TopologyMap& map) const {
    std::map<int, std::vector<std::int64_t>> before; // by block
    each_face(old_.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
      before[chunk.block].push_back(batch * lanes + lane);
    });
    std::vector<std::int64_t>& old_face = map.face.emplace(model.mesh.face_tets.size(), -1);
    std::map<int, std::size_t> next;
    each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
      const int old_block = successors_[chunk.block].old_block;
      old_face[batch * lanes + lane] = before.at(old_block)[next[old_block]++];
    });
  }

  // Springs of parts of a face take their state from the nearest spring that was there. Blocks keep their order, so side a
  // of the old interface is side a of the new one. Renewed interfaces have a way of their own (carry_renewed).
  void map_interfaces(const Model& model, TopologyMap& map) const {
    std::vector<int>&old_point = map.bond.emplace(model.points.size(), -1),
    &old_frame = map.frame.emplace(model.frames.size(), -1);
    for (const Interface& now : model.interfaces) {
      const Interface* before = old_interface(now);
      if (!before)
        continue;
      if (now.frame >= 0)
        old_frame[now.frame] = before->frame;
      if (is_renewed(*before))
        continue;
      const bool same = successors_[now.block_a].whole && successors_[now.block_b].whole;
      assert(!same || before->point_end - before->point_begin == now.point_end - now.point_begin);
      for (int p = now.point_begin; p < now.point_end; ++p)
        old_point[p] = same ? before->point_begin + (p - now.point_begin)
                            : nearest_point(old_, *before, model.point_position[p]);
    }
  }

  // Contacts of a block that was cut are found again.
  void map_triangles(const Model& model, TopologyMap& map) const {
    std::vector<int>& new_triangle = map.new_triangle.emplace();
    std::vector<int> new_block(old_.blocks.size(), -1);
    for (std::size_t b = 0; b < successors_.size(); ++b)
      if (successors_[b].whole)
        new_block[successors_[b].old_block] = static_cast<int>(b);
    for (int t = 0; t < static_cast<int>(old_.surface.triangles.size()); ++t) {
      const int block = old_.surface.triangles[t].block, now = new_block[block];
      new_triangle.push_back(now < 0 || model.surface.empty()
                                 ? -1
                                 : t - old_.surface.block_begin[block] + model.surface.block_begin[now]);
    }
  }

  static geom::Vec3 centre_of(const Model& model, int tet) {
    geom::Vec3 sum = geom::Vec3::Zero();
    for (const int node : model.tets[tet])
      sum += model.node_position[node];
    return sum / 4;
  }

  bool is_renewed(const Interface& interface) const {
    return interface.frame >= 0 && old_.frames[interface.frame].renewed;
  }

  // Interfaces whose faces had slid: their springs stand where the faces lie on each other now.
  void carry_renewed(Rebuilt& r) const {
    std::vector<InterfaceToRenew> list;
    for (int i = 0; i < static_cast<int>(r.model.interfaces.size()); ++i) {
      const Interface& now = r.model.interfaces[i];
      const Interface* before = old_interface(now);
      if (before && is_renewed(*before))
        list.push_back({i, InterfaceMemory(old_, from_, *before)});
    }
    if (!list.empty())
      renew_interfaces(r.model, r.state, list, 1);
  }

  // The springs of a cut carry the traction that stood there.
  void preload(Rebuilt& r, const Interface& now) const {
    const int parent = successors_[now.block_a].old_block;
    const geom::Mat3 turn = block_rotation(old_, from_, parent);
    for (int p = now.point_begin; p < now.point_end; ++p) {
      const geom::Vec3 traction =
          turn.transpose() * stress_at(old_, from_, parent, r.model.point_position[p]) * turn * now.normal;
      const double normal = traction.dot(now.normal);
      const geom::Vec3 stretch = normal / now.kn * now.normal + (traction - normal * now.normal) / now.ks;
      r.state.bond_offset[p] = local_jump(r.model, r.state.displacement, p) - stretch;
    }
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
