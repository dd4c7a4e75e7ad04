// Solids and their meshes as a script holds them.
#pragma once

#include "lua/binding/schema/value.hpp"

#include "libcdem/vtk/mesh_snapshot.hpp"
#include "libgeom/mesh/parts.hpp"
#include "libgeom/mesh/surface.hpp"
#include "libgeom/solid/solid.hpp"

#include <optional>

namespace cdem::script {

struct SolidObject final : Object {
  explicit SolidObject(geom::Solid given) : solid(std::move(given)) {}

  geom::Solid solid;
  std::string kind = "solid";      // "accropode", ...
  std::optional<double> height;    // m, of an armour unit as it was made
  std::optional<double> density;   // kg/m3
  std::optional<double> mesh_size; // m, unless mesh{} gives another

  const char* class_name() const override { return "Solid"; }
};

struct SurfaceObject final : Object {
  geom::Surface surface;
  const char* class_name() const override { return "Surface"; }
};

struct TetMeshObject final : Object {
  explicit TetMeshObject(geom::TetMesh given)
      : mesh(std::move(given)), faces(geom::outer_faces(mesh)), parts(geom::count_parts(mesh)) {}

  geom::TetMesh mesh;
  std::vector<geom::OuterFace> faces;
  int parts; // that do not hang together
  std::string title;
  std::string coarse; // what to warn of where it deforms; empty: nothing

  const char* class_name() const override { return "TetMesh"; }
};

// The record cdem.Inertia; density in kg/m3.
Value inertia_table(const geom::MassProperties&, double density);

} // namespace cdem::script
