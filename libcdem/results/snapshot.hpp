// One moment of a model, ready to be drawn or written: plain arrays and names, nothing of the solver and nothing of
// VTK. results/ makes it, vtk/ reads it. For files it is the whole model (make_snapshot), for a picture what that shows
// (picture_snapshot): fields that it does not show are named there and have no values.
#pragma once

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/results/water_sheet.hpp"
#include "libgeom/core/types.hpp"

#include <string>
#include <vector>

namespace cdem {

struct SnapshotField {
  std::string name;           // snake_case, e.g. "displacement", "stress", "block_id", "damage"
  std::string unit;           // "m", "Pa", "1"; empty for ids
  int components = 1;         // 1 scalar, 3 vector, 6 symmetric tensor in the order xx yy zz xy yz xz
  std::vector<double> values; // components values for each point or cell, cell-major
  bool integer = false;       // written as Int64 (ids, modes)
  std::vector<std::string> names = {}; // of the numbers 0, 1, ...: what a colour bar shows in their place
};

// Interfaces between blocks as triangles over the spring points (undeformed places).
struct BondSnapshot {
  std::vector<geom::Vec3> points;        // m, where displacement counts from, undeformed by default
  std::vector<geom::Triangle> triangles; // over points
  // "mode", "damage", "opening" m, "slip" m, "traction" Pa, "displacement" m.
  std::vector<SnapshotField> point_fields;
  std::vector<SnapshotField> triangle_fields; // "interface_id", "mode": the worst of its three points
  bool left_out = false;                      // there are bonds that do not stand here: those that hold
};

struct Snapshot {
  double time = 0; // s, or pseudo-time
  std::int64_t step = 0;
  std::string title;                   // e.g. "uniaxial_compression, stage 3 (relax)"
  std::vector<std::string> body_names; // by their numbers in cell field "body"; empty: not known
  std::vector<geom::Vec3>
      points; // m, where displacement counts from, undeformed by default; blocks do not share points
  std::vector<geom::Tet> tets;             // over points
  std::vector<SnapshotField> point_fields; // "displacement" m, "velocity" m/s, ...
  // Per tet: "stress" Pa (6), "principal_stress" Pa (3), "block_id", ...
  std::vector<SnapshotField> cell_fields;
  std::vector<geom::Triangle> surface;         // triangles of all block faces, outward
  std::vector<std::int64_t> surface_tet;       // the tet each surface triangle belongs to
  std::vector<std::array<int, 2>> block_edges; // true edges of the blocks, over points (for drawing)
  std::vector<std::array<int, 2>> outline; // edges of the bodies, over points; where joints are drawn alone
  BondSnapshot bonds;
  std::vector<WaterSheet> water; // of each field that loads the model, over its extent
};

} // namespace cdem
