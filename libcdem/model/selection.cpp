#include "libcdem/model/selection.hpp"

#include "libcdem/model/model.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace cdem {
namespace {

bool selects(const Model& model, const Selection& s, const geom::Vec3& x, int body) {
  switch (s.kind) {
  case Selection::Kind::all:
    return true;
  case Selection::Kind::side: {
    const double side = s.upper ? model.box.max[s.axis] : model.box.min[s.axis];
    return std::abs(x[s.axis] - side) <= model.tolerance;
  }
  case Selection::Kind::plane:
    return std::abs(s.plane.level(x)) <= model.tolerance;
  case Selection::Kind::box:
    return s.box.contains(x, model.tolerance);
  case Selection::Kind::body:
    return model.bodies[body].name == s.body;
  case Selection::Kind::predicate:
    return s.predicate(x);
  }
  return false;
}

} // namespace

Selection Selection::side(const std::string& name) {
  Selection s;
  s.kind = Kind::side;
  s.text = name;
  if (name.size() != 2 || name[0] < 'x' || name[0] > 'z' || (name[1] != '-' && name[1] != '+'))
    throw geom::InputError("on", "\"" + name + "\"", "a side of the model's box (x- x+ y- y+ z- z+)");
  s.axis = name[0] - 'x';
  s.upper = name[1] == '+';
  return s;
}

Selection Selection::on_plane(const geom::Plane& plane) {
  Selection s;
  s.kind = Kind::plane;
  s.plane = plane;
  s.text = fmt::format("plane with normal ({:g}, {:g}, {:g}) and offset {:g} m", plane.normal.x(),
                       plane.normal.y(), plane.normal.z(), plane.offset);
  return s;
}

Selection Selection::in_box(const geom::Box& box) {
  Selection s;
  s.kind = Kind::box;
  s.box = box;
  s.text = fmt::format("box from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", box.min.x(), box.min.y(),
                       box.min.z(), box.max.x(), box.max.y(), box.max.z());
  return s;
}

Selection Selection::of_body(const std::string& name) {
  Selection s;
  s.kind = Kind::body;
  s.body = name;
  s.text = "body \"" + name + "\"";
  return s;
}

Selection Selection::where(std::function<bool(const geom::Vec3&)> predicate, std::string text) {
  Selection s;
  s.kind = Kind::predicate;
  s.predicate = std::move(predicate);
  s.text = std::move(text);
  return s;
}

bool selects_place(const Model& model, const Selection& selection, const geom::Vec3& place, int block) {
  return selects(model, selection, place, model.blocks[block].body);
}

bool selects_block(const Model& model, const Selection& selection, int block) {
  if (selection.kind == Selection::Kind::side) {
    const Block& b = model.blocks[block];
    if (b.meshed) {
      const auto begin = model.node_position.begin() + b.node_begin,
                 end = model.node_position.begin() + b.node_end;
      return std::any_of(begin, end,
                         [&](const geom::Vec3& x) { return selects(model, selection, x, b.body); });
    }
    const geom::Polyhedron& shape = b.shape;
    return std::any_of(shape.faces.begin(), shape.faces.end(), [&](const auto& face) {
      return std::all_of(face.loop.begin(), face.loop.end(), [&](int v) {
        return selects(model, selection, shape.vertices[v], model.blocks[block].body);
      });
    });
  }
  return selects(model, selection, model.blocks[block].mass.centroid, model.blocks[block].body);
}

bool selects_point(const Model& model, const Selection& selection, int point) {
  const Interface& interface = model.interfaces[model.points[point].interface];
  return selects(model, selection, model.point_position[point], model.blocks[interface.block_a].body) ||
         (selection.kind == Selection::Kind::body &&
          selects(model, selection, model.point_position[point], model.blocks[interface.block_b].body));
}

std::vector<int> selected_nodes(const Model& model, const Selection& selection) {
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(model.node_position.size()); ++node)
    if (selects(model, selection, model.node_position[node], model.blocks[model.node_block[node]].body))
      nodes.push_back(node);
  return nodes;
}

std::vector<int> selected_outer_faces(const Model& model, const Selection& selection) {
  std::vector<int> faces;
  for (int f = 0; f < static_cast<int>(model.outer_faces.size()); ++f) {
    const OuterFace& face = model.outer_faces[f];
    const Block& block = model.blocks[face.block];
    bool selected = true;
    if (face.boundary >= 0) {
      const geom::Triangle& t = model.mesh.boundary[face.boundary].nodes;
      const auto& x = model.node_position;
      if (selection.kind == Selection::Kind::predicate)
        selected = selects(model, selection, (x[t[0]] + x[t[1]] + x[t[2]]) / 3, block.body);
      else
        for (const int node : t)
          selected = selected && selects(model, selection, x[node], block.body);
    } else if (selection.kind == Selection::Kind::predicate)
      selected = selects(model, selection, model.node_position[block.face_centre(face.face)], block.body);
    else
      for (const int v : block.shape.faces[face.face].loop)
        selected = selected && selects(model, selection, block.shape.vertices[v], block.body);
    if (selected)
      faces.push_back(f);
  }
  return faces;
}

} // namespace cdem
