// Triangles of joints or cracks with a row of values each, as a snapshot for files and pictures.
#pragma once

#include "libcdem/results/snapshot.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

class BondSurface {
public:
  struct Column {
    const char* name;
    const char* unit;
    bool integer = false;
  };
  explicit BondSurface(const std::vector<Column>& columns);

  // Place and displacement of its three corners, m.
  using Corners = std::array<std::pair<geom::Vec3, geom::Vec3>, 3>;
  void add(const Corners&, const std::vector<double>& row); // as many values as there are columns

  BondSnapshot faces; // point field "displacement"
};

// Corners of a triangle over the springs of interfaces: the middle of their two sides.
BondSurface::Corners spring_corners(const Model&, const State&, const geom::Triangle&);

// Time, step, title and names of bodies; nothing to draw yet.
Snapshot snapshot_of(const Model&, const State&, const std::string& title);

} // namespace cdem
