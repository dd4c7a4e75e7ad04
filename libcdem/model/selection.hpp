// Where a condition or a measurement applies. Judged on undeformed places, so a selection survives cutting.
#pragma once

#include "libgeom/core/types.hpp"

#include <functional>
#include <string>
#include <vector>

namespace cdem {

struct Selection {
  enum class Kind { all, side, plane, box, body, units, faces, predicate };
  Kind kind = Kind::all;
  std::string text = "all"; // as the user wrote it, for messages

  int axis = 0;           // side: 0 x, 1 y, 2 z
  bool upper = false;     // side: x+ rather than x-
  geom::Plane plane;      // plane
  geom::Box box;          // box
  std::string body;       // body, units: by name; faces: the same, or empty for all that have such faces
  std::string faces;      // faces: the name they were given on the mesh
  std::vector<int> units; // units: which blocks of the body, by their order in it, from 1; ascending
  std::function<bool(const geom::Vec3&)> predicate;

  static Selection everything() { return {}; }
  static Selection side(const std::string& name); // "x-" .. "z+"; throws geom::InputError
  static Selection on_plane(const geom::Plane&);
  static Selection in_box(const geom::Box&);
  static Selection of_body(const std::string& name);
  // Throws geom::InputError unless there are numbers, all from 1.
  static Selection of_units(const std::string& body, std::vector<int> numbers);
  // Outer faces of meshed bodies that were named on the mesh, of each unit of a pile; as nodes all that lie on them.
  static Selection of_faces(const std::string& name, const std::string& body = "");
  static Selection where(std::function<bool(const geom::Vec3&)> predicate, std::string text);
};

// Both select the same of every model. Two functions are never known to.
bool selects_same(const Selection&, const Selection&);

struct Model;

// All of the following throw geom::InputError for units or named faces that the model does not have.

// Nodes whose undeformed place is selected; block boundary nodes and centroids alike. Ascending.
std::vector<int> selected_nodes(const Model&, const Selection&);

// Outer faces (index into Model::outer_faces) all of whose vertices are selected; for a predicate, whose centre is.
std::vector<int> selected_outer_faces(const Model&, const Selection&);

bool selects_place(const Model&, const Selection&, const geom::Vec3& place, int block);
// By its centroid; a side, or a name of faces, selects the blocks that have a face there.
bool selects_block(const Model&, const Selection&, int block);
// By its place; a body selects the points of its faces.
bool selects_point(const Model&, const Selection&, int point);

} // namespace cdem
