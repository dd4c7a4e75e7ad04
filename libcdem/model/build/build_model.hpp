// From shapes to a Model: star meshes or zones, node numbering, interfaces with their springs, uncovered faces, chunks.
#pragma once

#include "libcdem/model/build/add_meshes.hpp"
#include "libgeom/mesh/block_mesh.hpp"

#include <functional>
#include <optional>

namespace cdem {

// A block before it is meshed.
struct BlockSeed {
  std::int64_t id = 0, parent = -1;
  int generation = 0;
  int body = 0;
  int unit = 0; // 0: a new one
  geom::Polyhedron shape;
  double first_size = 0;      // h of the generation-0 block, m; 0 = this is one
  geom::BlockMesh zones = {}; // those of a zoned block that was there before; none: it is meshed anew
};

// What an interface is made with; the default asks the bodies. fracture/ passes one that remembers the old interface.
struct InterfaceTraits {
  std::int64_t id = 0;
  int joint = 0;
  double thickness = 0; // L, m
  InterfaceOrigin origin = InterfaceOrigin::original;
  bool may_break = true;
  // The law at the interface's centroid, in place of `joint`; null: the same everywhere.
  const std::function<Joint(const geom::Vec3&)>* joint_at = nullptr;
  std::optional<double> strength = {}; // over that of the joint; none: a new draw where it scatters
};
using InterfaceRule =
    std::function<InterfaceTraits(const Model&, int block_a, int face_a, int block_b, int face_b)>;

// bodies, joints, pair_joint, built_box and next_id of `frame` are taken over. Throws geom::InputError for overlapping or
// touching bodies without a joint.
Model build_model(const Model& frame, std::vector<BlockSeed> blocks, const InterfaceRule& rule,
                  std::vector<MeshSeed> meshes = {});

// The zones of a block, to build it again.
geom::BlockMesh zones_of(const Model&, int block);

// The rule of a first model: within a body the law of the joint set or cut that made the faces, or else the body's own
// joint; between bodies that of the pair; L from the joint. Glued faces never break.
InterfaceTraits default_traits(const Model&, int block_a, int face_a, int block_b, int face_b);

} // namespace cdem
