#include "libcdem/load/water_forces.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/load/flow.hpp"
#include "libcdem/load/opened_faces.hpp"
#include "libcdem/parallel/chunks.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double far_from_surface = 1e9; // m; heights over a surface that is not there

// Water at a node where it stands now, of a field that was asked nearby.
struct WaterHere {
  geom::Vec3 place = geom::Vec3::Zero(); // m
  double height = 0;                     // m, over the free surface
  double pressure = 0;                   // Pa
  bool wet() const { return height < 0; }
};

WaterHere continued(const NodeInWater& asked, const geom::Vec3& place) {
  const geom::Vec3 moved = place - asked.place;
  WaterHere here;
  here.place = place;
  here.height = std::clamp(place.z() - (asked.water.surface + asked.water.surface_slope.dot(moved)),
                           -far_from_surface, far_from_surface);
  here.pressure = asked.water.pressure + asked.water.pressure_gradient.dot(moved);
  return here;
}

// Integrals over the wet part of a triangle: of the shape functions (m2), and of these times the pressure (N).
struct WetTriangle {
  std::array<double, 3> area{}, pressure{};

  WetTriangle(const std::array<const WaterHere*, 3>& corner, double whole) {
    if (corner[0]->wet() && corner[1]->wet() && corner[2]->wet()) { // most are
      const double sum = corner[0]->pressure + corner[1]->pressure + corner[2]->pressure;
      for (int i = 0; i < 3; ++i) {
        area[i] = whole / 3;
        pressure[i] = whole / 12 * (sum + corner[i]->pressure);
      }
      return;
    }
    std::array<Point, 4> polygon{};
    int n = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double a = corner[i]->height, b = corner[j]->height;
      std::array<double, 3> weight{};
      if (a < 0) {
        weight[i] = 1;
        polygon[n++] = {weight, corner[i]->pressure};
      }
      if ((a < 0) != (b < 0)) {
        weight = {};
        weight[i] = b / (b - a);
        weight[j] = a / (a - b);
        polygon[n++] = {weight, 0};
      }
    }
    for (int i = 1; i + 1 < n; ++i)
      add({&polygon[0], &polygon[i], &polygon[i + 1]}, whole);
  }

private:
  struct Point {
    std::array<double, 3> weight;
    double pressure;
  };
  void add(const std::array<const Point*, 3>& part, double whole) {
    const auto edge = [&](int to, int axis) { return part[to]->weight[axis] - part[0]->weight[axis]; };
    const double share = whole * std::abs(edge(1, 1) * edge(2, 2) - edge(1, 2) * edge(2, 1));
    const double sum = part[0]->pressure + part[1]->pressure + part[2]->pressure;
    for (int i = 0; i < 3; ++i)
      for (const Point* p : part) {
        area[i] += share / 3 * p->weight[i];
        pressure[i] += share / 12 * p->weight[i] * (sum + p->pressure);
      }
  }
};

// A corner of a part of a tetrahedron.
struct TetCorner {
  Eigen::Vector4d weight; // shape functions of the whole one there
  double height;          // m, over the free surface
};

// Integral of the shape functions over the part below the free surface, of a part of this volume. An edge that crosses the
// surface divides the part in two.
Eigen::Vector4d wet_part(const std::array<TetCorner, 4>& corners, double volume) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (corners[i].height < 0 && corners[j].height > 0) {
        const double below = corners[i].height / (corners[i].height - corners[j].height);
        std::array<TetCorner, 4> lower = corners, upper = corners;
        lower[j] = upper[i] = {corners[i].weight + below * (corners[j].weight - corners[i].weight), 0};
        return wet_part(lower, below * volume) + wet_part(upper, (1 - below) * volume);
      }
  if (std::none_of(corners.begin(), corners.end(), [](const TetCorner& c) { return c.height < 0; }))
    return Eigen::Vector4d::Zero();
  return 0.25 * volume * (corners[0].weight + corners[1].weight + corners[2].weight + corners[3].weight);
}

// The volume that a block displaces: its own and that of the cavities that it closes, as tetrahedra.
class DisplacedVolume {
public:
  DisplacedVolume(const Model& model, const BlockInWater& in_water)
      : model_(model), in_water_(in_water), block_(model.blocks[in_water.asked.block]) {}

  // m3, by node: the part of it around each that is under water. height: m, of the nodes over the surface.
  void find_wet(const std::vector<double>& height, std::vector<double>& wet) const {
    const auto under = std::count_if(height.begin(), height.end(), [](double h) { return h < 0; });
    wet.assign(height.size(), 0.0);
    if (under == 0)
      return;
    if (under == static_cast<std::ptrdiff_t>(height.size())) // the same bits as the sum below
      wet = in_water_.volume;
    else
      for (int t = block_.tet_begin; t < block_.tet_end; ++t) {
        const geom::Tet& tet = model_.tets[t];
        std::array<TetCorner, 4> corners;
        for (int i = 0; i < 4; ++i)
          corners[i] = {Eigen::Vector4d::Unit(i), height[local(tet[i])]};
        const Eigen::Vector4d part = wet_part(corners, tet_volume(model_, t));
        for (int i = 0; i < 4; ++i)
          wet[local(tet[i])] += part[i];
      }
    for (const std::vector<geom::Triangle>& cavity : in_water_.cavities)
      add_cavity(cavity, height, wet);
  }

private:
  std::size_t local(int node) const { return static_cast<std::size_t>(node - block_.node_begin); }

  // Tetrahedra between the triangles of a shell and the middle of their corners.
  void add_cavity(const std::vector<geom::Triangle>& cavity, const std::vector<double>& height,
                  std::vector<double>& wet) const {
    geom::Vec3 middle = geom::Vec3::Zero();
    double height_of_middle = 0;
    const double per_corner = 1 / (3.0 * static_cast<double>(cavity.size()));
    for (const geom::Triangle& triangle : cavity)
      for (const int node : triangle) {
        middle += per_corner * model_.node_position[node];
        height_of_middle += per_corner * height[local(node)];
      }
    for (const geom::Triangle& triangle : cavity) {
      std::array<TetCorner, 4> corners;
      std::array<geom::Vec3, 3> x;
      for (int i = 0; i < 3; ++i) {
        corners[i] = {Eigen::Vector4d::Unit(i), height[local(triangle[i])]};
        x[i] = model_.node_position[triangle[i]] - middle;
      }
      corners[3] = {Eigen::Vector4d::Unit(3), height_of_middle};
      const Eigen::Vector4d part = wet_part(corners, -x[0].dot(x[1].cross(x[2])) / 6);
      for (int i = 0; i < 3; ++i)
        wet[local(triangle[i])] += part[i] + part[3] / 3;
    }
  }

  const Model& model_;
  const BlockInWater& in_water_;
  const Block& block_;
};

// Faces of a block that were not outside when the model was made.
void find_opened(const Model& model, const State& state, ResolvedFlow& flow) {
  std::vector<AskedWater*> of_block(model.blocks.size(), nullptr);
  for (BlockInWater& in_water : flow.in_water) {
    in_water.asked.cracks.clear();
    in_water.asked.bared.clear();
    of_block[in_water.asked.block] = &in_water.asked;
  }
  if (!flow.new_faces)
    return;
  for (const CrackSide& side : crack_sides(model, state, flow.meets))
    of_block[side.block]->cracks.push_back(side);
  for (BaredFace& bared : opened_faces(model, state, flow.meets))
    of_block[bared.face.block]->bared.push_back(std::move(bared));
}

// Writes the corners of the faces of a block, in their order.
class ForcesOnBlock {
public:
  using Force = std::pair<int, geom::Vec3>;
  // here: of the nodes. corner: null without drag. force: to which those on faces are added.
  ForcesOnBlock(const Model& model, const State& state, const BlockInWater& in_water,
                const std::vector<WaterHere>& here, FlowCorner* corner, Force* force)
      : model_(model), state_(state), in_water_(in_water), first_(in_water.asked.first_node), corner_(corner),
        force_(force), here_(here) {}

  // drag: a stream reaches it. smooth: null for the triangle's own normal.
  void triangle(const geom::Triangle& nodes, const CornerNormals* smooth, bool drag = true) {
    const std::array<const WaterHere*, 3> corner{&at(nodes[0]), &at(nodes[1]), &at(nodes[2])};
    if (!corner[0]->wet() && !corner[1]->wet() && !corner[2]->wet())
      return add_dry(nodes);
    const std::array<geom::Vec3, 3> x{corner[0]->place, corner[1]->place, corner[2]->place};
    const geom::Vec3 outward = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
    const double area = outward.norm();
    if (!(area > 0))
      return add_dry(nodes);
    const geom::Vec3 n = outward / area;
    const WetTriangle wet(corner, area);
    const CornerNormals normals = smooth && corner_ ? turned_with(*smooth, x) : CornerNormals{n, n, n};
    for (int i = 0; i < 3; ++i) {
      force_[nodes[i] - first_].second -= wet.pressure[i] * n;
      add(nodes[i], drag ? geom::Vec3(-wet.area[i] * normals[i]) : geom::Vec3(geom::Vec3::Zero()));
    }
  }

  void block_face(const OuterFace& face, bool drag = true) {
    const FaceFan& fan = in_water_.fans[face.face];
    if (!fan.is_whole(face))
      return part_of_face(face, fan, drag);
    for (const geom::Triangle& nodes : fan.triangles)
      triangle(nodes, nullptr, drag);
  }

private:
  // Others cover the rest. The integral a of the shape function of each node is known of the part. Under water its
  // pressure is a p, exact in sum; where the surface cuts the face the node takes the share of what acts on the whole one.
  void part_of_face(const OuterFace& face, const FaceFan& fan, bool drag) {
    struct Whole {
      double area = 0, wet = 0, pressure = 0, continued = 0; // m2, m2, N, N; continued: above the surface too
    };
    const auto& parts = face.node_area; // of all nodes of the face, ascending
    thread_local std::vector<Whole> whole;
    whole.assign(parts.size() + 1, {}); // the last for nodes that a saved file leaves out
    const auto of = [&](int node) -> Whole& {
      const auto found = std::lower_bound(parts.begin(), parts.end(), node,
                                          [](const auto& part, int n) { return part.first < n; });
      return found != parts.end() && found->first == node ? whole[found - parts.begin()] : whole.back();
    };
    for (const geom::Triangle& nodes : fan.triangles) {
      const std::array<const WaterHere*, 3> corner{&at(nodes[0]), &at(nodes[1]), &at(nodes[2])};
      const auto& x = model_.node_position;
      const double area = 0.5 * (x[nodes[1]] - x[nodes[0]]).cross(x[nodes[2]] - x[nodes[0]]).norm(),
                   sum = corner[0]->pressure + corner[1]->pressure + corner[2]->pressure;
      const WetTriangle wet(corner, area);
      for (int i = 0; i < 3; ++i) {
        Whole& of_node = of(nodes[i]);
        of_node.area += area / 3;
        of_node.wet += wet.area[i];
        of_node.pressure += wet.pressure[i];
        of_node.continued += area / 12 * (sum + corner[i]->pressure);
      }
    }
    const geom::Vec3 normal = present_normal(model_, state_, face);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto& [node, area] = parts[i];
      const double share = area / whole[i].area, under = whole[i].wet / whole[i].area;
      const double pressure =
          share * whole[i].pressure + under * (area * at(node).pressure - share * whole[i].continued);
      force_[node - first_].second -= pressure * normal;
      add(node, drag ? geom::Vec3(-under * area * normal) : geom::Vec3(geom::Vec3::Zero()));
    }
  }

  const WaterHere& at(int node) const { return here_[node - first_]; }
  void add_dry(const geom::Triangle& nodes) {
    for (const int node : nodes)
      add(node, geom::Vec3::Zero());
  }
  void add(int node, const geom::Vec3& inward) {
    if (corner_)
      *corner_++ = {node, inward, in_water_.asked.nodes[node - first_].water.velocity};
  }

  const Model& model_;
  const State& state_;
  const BlockInWater& in_water_;
  int first_;
  FlowCorner* corner_;
  Force* force_;
  const std::vector<WaterHere>& here_;
};

// Forces on the nodes, and with those of the volume under water the mass that moves with them. force: null where not wanted.
void add_inertia(const Model& model, const ResolvedFlow& flow, const BlockInWater& in_water,
                 const std::vector<WaterHere>& here, std::pair<int, geom::Vec3>* force,
                 std::vector<double>& water_mass) {
  const std::vector<NodeInWater>& asked = in_water.asked.nodes;
  const int first = in_water.asked.first_node;
  for (std::size_t i = 0; force && i < asked.size(); ++i)
    force[i] = {first + static_cast<int>(i), geom::Vec3::Zero()};
  const bool accelerated =
      std::any_of(asked.begin(), asked.end(), [](const NodeInWater& n) { return !n.inertia.isZero(0); });
  if (!in_water.inertia || (flow.added_mass == 0 && !accelerated))
    return;
  thread_local std::vector<double> height, wet;
  height.clear();
  for (const WaterHere& water : here)
    height.push_back(water.height);
  DisplacedVolume(model, in_water).find_wet(height, wet);
  for (std::size_t i = 0; i < wet.size(); ++i) {
    const double mass = flow.water_density * wet[i];
    if (force)
      force[i].second = mass * asked[i].inertia;
    if (flow.added_mass > 0)
      water_mass[first + i] += flow.added_mass * mass;
  }
}

void clear_water_mass(const Model& model, ResolvedConditions& r) {
  for (const ResolvedFlow& flow : r.flows) {
    if (!flow.water || flow.added_mass == 0)
      continue;
    r.water_mass.resize(model.node_position.size(), 0.0);
    for (const BlockInWater& in_water : flow.in_water) {
      const Block& block = model.blocks[in_water.asked.block];
      std::fill(r.water_mass.begin() + block.node_begin, r.water_mass.begin() + block.node_end, 0.0);
    }
  }
}

} // namespace

void ask_water(const Model& model, const State& state, ResolvedFlow& flow) {
  find_opened(model, state, flow);
  for (BlockInWater& in_water : flow.in_water) {
    std::vector<NodeInWater>& nodes = in_water.asked.nodes;
    const Block& block = model.blocks[in_water.asked.block];
    in_water.asked.time = state.time;
    nodes.clear();
    for (int node = block.node_begin; node < block.node_end; ++node) {
      NodeInWater& asked = nodes.emplace_back();
      asked.place = place_of(model, state, node);
      asked.water = flow.water->at(asked.place, state.time);
      const WaterPoint& water = asked.water;
      if (const double height = continued(asked, asked.place).height; height > 0 && height < far_from_surface)
        asked.water.pressure =
            water.pressure_gradient.z() * height; // that of the water below, so far continued
      if (!in_water.inertia)
        continue;
      asked.inertia = flow.added_mass * water.acceleration;
      if (!flow.water->has_dynamic_pressure())
        asked.inertia += water.acceleration + flow.water->gravity() * water.surface_slope;
    }
  }
}

bool water_is_old(const ResolvedConditions& r, double time) {
  return std::any_of(r.flows.begin(), r.flows.end(), [&](const ResolvedFlow& flow) {
    return flow.water &&
           std::any_of(flow.in_water.begin(), flow.in_water.end(), [&](const BlockInWater& in_water) {
             return time - in_water.asked.time >= flow.longest;
           });
  });
}

void place_water(const Model& model, const State& state, Range nodes, int threads, ResolvedConditions& r) {
  clear_water_mass(model, r);
  for (ResolvedFlow& flow : r.flows) {
    if (!flow.water)
      continue;
    const bool drag = flow.drag > 0;
    std::size_t corners = 0, nodes_in_water = 0;
    for (BlockInWater& in_water : flow.in_water) {
      in_water.first_corner = corners;
      in_water.first_force = nodes_in_water;
      corners += drag ? in_water.corners() : 0;
      nodes_in_water += in_water.asked.nodes.size();
    }
    // Forces on the corners, then those on the nodes.
    std::vector<std::pair<int, geom::Vec3>>& forces = r.varying[flow.load].forces;
    flow.corners.resize(corners);
    forces.resize(corners + nodes_in_water);
    for_chunks(static_cast<std::int64_t>(flow.in_water.size()), threads, [&](std::int64_t b) {
      const BlockInWater& in_water = flow.in_water[b];
      const AskedWater& asked = in_water.asked;
      const Block& block = model.blocks[asked.block];
      FlowCorner* const corner = flow.corners.data() + in_water.first_corner;
      std::pair<int, geom::Vec3>* const force = forces.data() + corners + in_water.first_force;
      const bool away = block.node_begin >= nodes.end || block.node_end <= nodes.begin;
      if (away) {
        std::fill_n(corner, drag ? in_water.corners() : 0,
                    FlowCorner{asked.first_node, geom::Vec3::Zero(), geom::Vec3::Zero()});
        std::fill_n(force, asked.nodes.size(), std::pair(asked.first_node, geom::Vec3(geom::Vec3::Zero())));
      }
      if (away && block.rigid < 0) // a rigid body may be placed here all the same
        return;
      thread_local std::vector<WaterHere> here;
      here.clear();
      for (std::size_t i = 0; i < asked.nodes.size(); ++i)
        here.push_back(
            continued(asked.nodes[i], place_of(model, state, asked.first_node + static_cast<int>(i))));
      add_inertia(model, flow, in_water, here, away ? nullptr : force, r.water_mass);
      if (away)
        return;
      ForcesOnBlock on_block(model, state, in_water, here, drag ? corner : nullptr, force);
      for (const int i : in_water.faces) {
        const OuterFace& face = model.outer_faces[flow.faces[i]];
        if (face.boundary >= 0)
          on_block.triangle(model.mesh.boundary[face.boundary].nodes, &flow.normals[i]);
        else
          on_block.block_face(face);
      }
      for (const CrackSide& side : asked.cracks)
        on_block.triangle(side.nodes, nullptr, side.parted);
      for (const BaredFace& bared : asked.bared)
        on_block.block_face(bared.face, bared.parted);
    });
    for (std::size_t i = 0; i < corners; ++i)
      forces[i].first = flow.corners[i].node;
  }
}

} // namespace cdem
