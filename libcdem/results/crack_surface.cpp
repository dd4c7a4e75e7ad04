#include "libcdem/results/crack_surface.hpp"

#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/model/build/add_meshes.hpp"
#include "libcdem/results/bond_surface.hpp"
#include "libcdem/results/crack_points.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace cdem {
namespace {

using geom::Vec3;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// When the bond at a place broke. Places are found again to the model's tolerance: a rebuilt model has them from other
// sums.
class BreakTimes {
public:
  BreakTimes(const std::vector<BreakRow>& breaks, double tolerance) : cell_(std::max(tolerance, 1e-12)) {
    for (const BreakRow& row : breaks)
      times_[cell_of(row.place)].push_back({row.place, row.time});
  }
  double at(const Vec3& place) const {
    const Cell c = cell_of(place);
    double time = unknown;
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = times_.find({c[0] + dx, c[1] + dy, c[2] + dz});
          if (found == times_.end())
            continue;
          for (const auto& [where, when] : found->second)
            if ((where - place).norm() <= cell_)
              time = std::fmax(time, when);
        }
    return time;
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& x) const {
    Cell c{};
    for (int axis = 0; axis < 3; ++axis)
      c[axis] = static_cast<std::int64_t>(std::floor(x[axis] / cell_));
    return c;
  }

  double cell_; // m
  std::map<Cell, std::vector<std::pair<Vec3, double>>> times_;
};

// One of a face's three bonds.
struct CrackedBond {
  CrackPoint crack;
  Vec3 gap = Vec3::Zero(), normal = Vec3::Zero(); // m, unit
  double time = unknown;
};

class Surface {
public:
  explicit Surface(bool damaged)
      : surface({{"mode", "", true},
                 {"damage", "1"},
                 {"opening", "m"},
                 {"slip", "m"},
                 {"time", "s"},
                 {"body", "", true}}),
        damaged_(damaged) {}

  bool shows(const CrackedBond (&bonds)[3]) const {
    int broken = 0;
    double damage = 0;
    for (const CrackedBond& bond : bonds) {
      broken += is_broken(bond.crack.mode);
      damage += bond.crack.damage;
    }
    return broken == 3 || (damaged_ && damage > 0);
  }

  // number: of its body, or -1. corners: place and displacement, m.
  void add(const CrackedBond (&bonds)[3], int number, const BondSurface::Corners& corners) {
    int mode = 0;
    double damage = 0, opening = 0, slip = 0, time = unknown;
    for (const CrackedBond& bond : bonds) {
      const double open = bond.gap.dot(bond.normal);
      // A contact that never was a bond says nothing of how the face broke.
      if (bond.crack.mode != BondMode::contact)
        mode = std::max(mode, static_cast<int>(bond.crack.mode));
      damage += bond.crack.damage / 3;
      opening += open / 3;
      slip += (bond.gap - open * bond.normal).norm() / 3;
      time = std::fmax(time, bond.time);
    }
    surface.add(corners,
                {static_cast<double>(mode), damage, opening, slip, time, static_cast<double>(number)});
  }

  BondSurface surface;

private:
  bool damaged_;
};

void add_interfaces(const Model& model, const State& state, const BreakTimes& times, Surface& surface) {
  for (const geom::Triangle& triangle : model.bond_triangles) {
    CrackedBond bonds[3];
    for (int i = 0; i < 3; ++i) {
      const int p = triangle[i];
      bonds[i].crack = crack_point(model, state, p);
      bonds[i].gap = movement_past(model, state, p);
      bonds[i].normal = model.points[p].normal;
    }
    if (!surface.shows(bonds))
      continue;
    for (int i = 0; i < 3; ++i)
      if (is_broken(bonds[i].crack.mode))
        bonds[i].time = times.at(model.point_position[triangle[i]]);
    const int body = bonds[0].crack.body;
    surface.add(bonds, body < static_cast<int>(model.bodies.size()) ? body : -1,
                spring_corners(model, state, triangle));
  }
}

void add_faces(const Model& model, const State& state, const BreakTimes& times, Surface& surface) {
  if (model.mesh.faces.empty())
    return;
  const std::vector<Node> position = present_places(model, state);
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    CrackedBond bonds[3];
    for (int point = 0; point < 3; ++point)
      bonds[point].crack = crack_point(model, state, chunk, {batch, point, lane});
    if (!surface.shows(bonds))
      return;
    for (int point = 0; point < 3; ++point) {
      const FaceSpringPlace at{batch, point, lane};
      const FaceSpring spring = face_point_response(model, state, position, chunk, at);
      bonds[point].gap = spring.gap;
      bonds[point].normal = spring.normal;
      if (is_broken(bonds[point].crack.mode))
        bonds[point].time = times.at(face_point(model, chunk, at));
    }
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    BondSurface::Corners corners;
    for (int i = 0; i < 3; ++i)
      corners[i] = {model.node_position[nodes.a[i]],
                    0.5 * (vec(state.displacement[nodes.a[i]]) + vec(state.displacement[nodes.b[i]]))};
    surface.add(bonds, bonds[0].crack.body, corners);
  });
}

} // namespace

Snapshot crack_surface(const Model& model, const State& state, const std::vector<BreakRow>& breaks,
                       bool damaged, const std::string& title) {
  Snapshot snapshot = snapshot_of(model, state, title);
  const BreakTimes times(breaks, model.tolerance);
  Surface surface(damaged);
  add_interfaces(model, state, times, surface);
  add_faces(model, state, times, surface);
  snapshot.bonds = std::move(surface.surface.faces);
  return snapshot;
}

} // namespace cdem
