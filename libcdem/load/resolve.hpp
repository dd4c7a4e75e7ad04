// Conditions turned into numbers on nodes: done at the start of a stage and after every change of topology.
#pragma once

#include "libcdem/load/bolts.hpp"
#include "libcdem/load/conditions.hpp"
#include "libcdem/load/crack_pressure.hpp"
#include "libcdem/load/free_field_column.hpp"
#include "libcdem/load/opened_faces.hpp"
#include "libcdem/load/smooth_normals.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Nodal pattern of one load that varies in time.
struct VaryingLoad {
  std::vector<std::pair<int, geom::Vec3>> forces; // node, N at amplitude 1
  Amplitude amplitude;
};

// A share of a face that meets a flow: the area of a corner along the inward normal.
struct FlowCorner {
  int node = 0;
  geom::Vec3 inward = geom::Vec3::Zero(); // m2
  geom::Vec3 stream = geom::Vec3::Zero(); // m/s, velocity of the water there; of a field
};

// Water at a node when the field was asked last (load/water_forces.hpp).
struct NodeInWater {
  geom::Vec3 place = geom::Vec3::Zero(); // m, of the node then
  WaterPoint water; // above the surface with the pressure of the water continued: below 0
  geom::Vec3 inertia =
      geom::Vec3::Zero(); // m/s2, force of accelerated water per mass that the wet volume displaces
};

// What is kept of a block from one time when the field is asked to the next.
struct AskedWater {
  int block = 0, first_node = 0;
  double time = 0;                // s, when the field was asked
  std::vector<NodeInWater> nodes; // of the block
  std::vector<CrackSide> cracks;
  std::vector<BaredFace> bared; // on other blocks before
};

// A face of a convex block, whole.
struct FaceFan {
  std::vector<geom::Triangle> triangles; // nodes
  double area = 0;                       // m2

  bool is_whole(const OuterFace& face) const { return face.area > (1 - 1e-9) * area; }
  std::size_t corners(const OuterFace& face) const {
    return is_whole(face) ? 3 * triangles.size() : face.node_area.size();
  }
};

struct BlockInWater {
  AskedWater asked;
  std::vector<int> faces;    // into ResolvedFlow::faces
  std::vector<FaceFan> fans; // of each face of a convex block that is no part of a mesh
  bool inertia = false;      // all faces of its body take part: its volume does
  std::vector<std::vector<geom::Triangle>> cavities; // that it closes; seen from inside of these
  std::vector<double> volume;   // m3, around each node, a quarter of each tetrahedron there; with inertia
  std::size_t face_corners = 0; // of these
  std::size_t first_corner = 0, first_force = 0; // among those of the flow (place_water)

  std::size_t corners() const { // with those of faces that have opened
    std::size_t sum = face_corners + 3 * asked.cracks.size();
    for (const BaredFace& bared : asked.bared)
      sum += fans[bared.face.face].corners(bared.face);
    return sum;
  }
};

// A flow's pattern follows the faces: it is found again now and then. That of a field of water is placed in every step.
struct ResolvedFlow {
  geom::Vec3 direction = geom::Vec3::Zero(); // unit
  std::vector<int> faces;                    // Model::outer_faces
  std::vector<CornerNormals> normals;        // of these
  std::vector<Met> meets;                    // of each block; with new_faces
  bool new_faces = false;
  std::size_t load = 0; // its place in ResolvedConditions::varying
  // For a flow relative to the surface: its forces are found anew in every step; the amplitude of its load is 1.
  std::function<double(double time)> velocity; // m/s; empty: the pattern times the pressure
  double water_density = 0;                    // kg/m3
  std::vector<FlowCorner> corners;             // the first of the load's forces, in this order
  // Of a field of water (load/water_forces.hpp).
  std::shared_ptr<const WaterField> water;
  std::vector<BlockInWater> in_water; // blocks whose faces it meets, ascending
  double drag = 1, added_mass = 0;
  double longest = 0; // s, between questions to the field

  bool relative() const { return velocity || water; }
};

// A node of which a component at least is held.
struct HeldNode {
  int node = 0;
  Node free;       // 1 where a component is free, 0 where it is held
  Node prescribed; // m/s, velocity of the held components
  Node target;     // m, displacement the held components are to reach; NaN: none
  std::array<int, 3> varying{-1, -1,
                             -1}; // into ResolvedConditions::varying_holds; -1: the velocity is constant
  int dashpot = -1;               // into ResolvedConditions::dashpots; -1: none
};

// The velocity of supports that varies in time.
struct VaryingHold {
  geom::Vec3 velocity = geom::Vec3::Zero(); // m/s at amplitude 1
  Amplitude amplitude;
  std::vector<int> rigid; // rigid bodies that move with it
};

struct ResolvedConditions {
  // By number: nodes of which a component is held or on which a dashpot acts; all those of rigid bodies that are held.
  std::vector<HeldNode> held;
  std::vector<VaryingHold> varying_holds;
  std::vector<geom::Mat3> dashpots; // N s/m, force per velocity of a node (load/quiet.hpp)
  std::vector<Column> columns;      // of free fields
  std::vector<ResolvedBolt> bolts;
  std::size_t bolt_load = 0;                    // their forces on the rock in `varying`
  std::vector<std::optional<geom::Vec3>> rigid; // m/s, of the rigid bodies that are held (n rigid bodies)
  std::vector<Node> constant; // N, loads that do not vary (n_nodes); empty where none varies
  std::vector<Node> external; // N, all loads at the present time (n_nodes); empty without loads
  std::vector<Node> internal; // N, forces of the initial stress (n_nodes); empty without
  std::vector<VaryingLoad> varying;
  std::vector<std::size_t> boundary_loads; // of these: what enters through quiet boundaries and from columns
  std::vector<ResolvedFlow> flows;
  std::vector<CrackLoad> cracks;
  std::vector<double> water_mass; // kg, of water that moves with a node where it is (n_nodes); empty without
  bool has_target = false;
};

// free(range) for the runs of nodes between held ones, held(node) for these, all in order.
template <class Free, class Held>
void each_node(const ResolvedConditions& r, Range nodes, const Free& free, const Held& held) {
  auto next = std::lower_bound(r.held.begin(), r.held.end(), nodes.begin,
                               [](const HeldNode& h, std::int64_t node) { return h.node < node; });
  std::int64_t begin = nodes.begin;
  for (; next != r.held.end() && next->node < nodes.end; ++next) {
    if (begin < next->node)
      free(Range{begin, next->node});
    held(*next);
    begin = next->node + 1;
  }
  if (begin < nodes.end)
    free(Range{begin, nodes.end});
}

// A rigid body is held as a whole where a fix holds any of its nodes. Throws geom::InputError when a condition selects
// nothing, and when a rigid body is held in part.
ResolvedConditions resolve(const Model&, const State&, const Conditions&);

// The factor of gravity at a time. Throws geom::InputError where it is not 1 beside water whose pressure carries bodies. Empty: 1.
Amplitude amplitude_of_gravity(const Model&, const Conditions&);

// The patterns of flows for where the faces are now; fields of water are asked again.
void refresh_flows(const Model&, const State&, ResolvedConditions&);

// external at `time`; does nothing when no load varies. velocity: m/s (n_nodes), of surfaces in a flow; null: they are
// at rest.
void update_external(ResolvedConditions&, double time, const std::vector<Node>* velocity = nullptr);

// Velocities of supports at `time`: the middle of the step they move in.
void update_supports(ResolvedConditions&, double time);

// Gives the held components that have a target the velocity that brings them there in `left` (s, or steps of a
// relaxation).
void aim_supports(const Model&, const State&, ResolvedConditions&, double left);

// m, of a held node to its target; 0: all stand there, but for rounding.
double longest_way(const Model&, const State&, const ResolvedConditions&);

} // namespace cdem
