#include "libcdem/model/selection.hpp"

#include "libcdem/model/names.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/nearest.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace cdem {
namespace {

// The blocks that a selection of units means.
std::vector<char> chosen_units(const Model& model, const Selection& s) {
  const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                 [&](const Body& named) { return named.name == s.body; });
  if (body == model.bodies.end())
    refuse_body("body", s.body, model);
  if (s.units.back() > body->units)
    throw geom::InputError("numbers", std::to_string(s.units.back()),
                           fmt::format("a unit of \"{}\", which has {}", s.body, body->units));
  std::vector<char> chosen;
  chosen.reserve(model.blocks.size());
  for (const Block& block : model.blocks)
    chosen.push_back(model.bodies[block.body].name == s.body &&
                     std::binary_search(s.units.begin(), s.units.end(), block.unit));
  return chosen;
}

[[noreturn]] void no_such_faces(const Model& model, const Selection& s) {
  const auto is_body = [&](const Body& body) { return body.name == s.body; };
  if (!s.body.empty() && std::none_of(model.bodies.begin(), model.bodies.end(), is_body))
    throw geom::InputError("body", "\"" + s.body + "\"", "the name of a body of the model");
  std::vector<std::string> names;
  for (const auto& [key, faces] : model.mesh.named)
    if (s.body.empty() || model.bodies[key.first].name == s.body)
      names.push_back(key.second);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const std::string whose = s.body.empty() ? "the model's bodies" : "body \"" + s.body + "\"";
  if (names.empty())
    throw geom::InputError("name = \"" + s.faces + "\": no faces of " + whose +
                           " have a name; mesh:faces{ ..., name = \"" + s.faces +
                           "\" } gives them one, before the model is made");
  const std::string near = geom::did_you_mean(s.faces, names);
  throw geom::InputError("name = \"" + s.faces + "\": no faces of " + whose + " have that name" +
                         (near.empty() ? "." : near) + fmt::format(" There are: {}", fmt::join(names, ", ")));
}

// The triangles that a selection of named faces means: into MeshData::boundary, ascending.
std::vector<int> chosen_boundary(const Model& model, const Selection& s) {
  std::vector<int> chosen;
  for (const auto& [key, faces] : model.mesh.named)
    if (key.second == s.faces && (s.body.empty() || model.bodies[key.first].name == s.body))
      chosen.insert(chosen.end(), faces.begin(), faces.end());
  if (chosen.empty())
    no_such_faces(model, s);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// All copies of the nodes of those triangles, ascending: where bonds split a mesh, neighbours meet there too.
std::vector<int> nodes_on(const Model& model, const std::vector<int>& boundary) {
  const MeshData& mesh = model.mesh;
  std::vector<int> originals, nodes;
  for (const int b : boundary)
    for (const int node : mesh.boundary[b].nodes)
      originals.push_back(mesh.original[node - mesh.first_node]);
  std::sort(originals.begin(), originals.end());
  for (int i = 0; i < static_cast<int>(mesh.original.size()); ++i)
    if (std::binary_search(originals.begin(), originals.end(), mesh.original[i]))
      nodes.push_back(mesh.first_node + i);
  return nodes;
}

// A selection applied to one model.
class Selector {
public:
  Selector(const Model& model, const Selection& selection) : model_(model), selection_(selection) {
    if (selection.kind == Selection::Kind::units)
      chosen_ = chosen_units(model, selection);
    if (selection.kind == Selection::Kind::faces) {
      chosen_.resize(model.blocks.size(), 0);
      for (const int b : chosen_boundary(model, selection))
        chosen_[model.mesh.boundary[b].block] = 1;
    }
  }
  bool operator()(const geom::Vec3& place, int block) const;
  bool block(int block) const;

private:
  const Model& model_;
  const Selection& selection_;
  std::vector<char> chosen_; // units, faces: by block
};

bool Selector::operator()(const geom::Vec3& x, int block) const {
  const Selection& s = selection_;
  const Model& model = model_;
  switch (s.kind) {
  case Selection::Kind::all:
    return true;
  case Selection::Kind::side: {
    const double side = s.upper ? model.built_box.max[s.axis] : model.built_box.min[s.axis];
    return std::abs(x[s.axis] - side) <= model.tolerance;
  }
  case Selection::Kind::plane:
    return std::abs(s.plane.level(x)) <= model.tolerance;
  case Selection::Kind::box:
    return s.box.contains(x, model.tolerance);
  case Selection::Kind::body:
    return model.bodies[model.blocks[block].body].name == s.body;
  case Selection::Kind::units:
    return chosen_[block] != 0;
  case Selection::Kind::predicate:
    return s.predicate(x);
  case Selection::Kind::faces: // a place alone is on no face
    return false;
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

bool selects_same(const Selection& a, const Selection& b) {
  return a.kind == b.kind && a.kind != Selection::Kind::predicate && a.axis == b.axis && a.upper == b.upper &&
         a.plane.normal == b.plane.normal && a.plane.offset == b.plane.offset && a.box.min == b.box.min &&
         a.box.max == b.box.max && a.body == b.body && a.faces == b.faces && a.units == b.units;
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

Selection Selection::of_units(const std::string& body, std::vector<int> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.empty())
    throw geom::InputError("numbers", "{}", "a list of at least one unit");
  if (numbers.front() < 1)
    throw geom::InputError("numbers", std::to_string(numbers.front()),
                           "at least 1: units are counted from 1");
  Selection s;
  s.kind = Kind::units;
  s.body = body;
  s.text = "units ";
  for (std::size_t i = 0; i < numbers.size(); ++i)
    s.text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
  s.text += " of body \"" + body + "\"";
  s.units = std::move(numbers);
  return s;
}

Selection Selection::of_faces(const std::string& name, const std::string& body) {
  Selection s;
  s.kind = Kind::faces;
  s.faces = name;
  s.body = body;
  s.text = "faces \"" + name + "\"" + (body.empty() ? "" : " of body \"" + body + "\"");
  return s;
}

Selection Selection::where(std::function<bool(const geom::Vec3&)> predicate, std::string text) {
  Selection s;
  s.kind = Kind::predicate;
  s.predicate = std::move(predicate);
  s.text = std::move(text);
  return s;
}

bool Selector::block(int block) const {
  const Block& b = model_.blocks[block];
  if (selection_.kind == Selection::Kind::faces)
    return chosen_[block] != 0;
  if (selection_.kind != Selection::Kind::side)
    return (*this)(b.mass.centroid, block);
  if (!b.convex()) {
    const auto begin = model_.node_position.begin() + b.node_begin,
               end = model_.node_position.begin() + b.node_end;
    return std::any_of(begin, end, [&](const geom::Vec3& x) { return (*this)(x, block); });
  }
  return std::any_of(b.shape.faces.begin(), b.shape.faces.end(), [&](const auto& face) {
    return std::all_of(face.loop.begin(), face.loop.end(),
                       [&](int v) { return (*this)(b.shape.vertices[v], block); });
  });
}

bool selects_place(const Model& model, const Selection& selection, const geom::Vec3& place, int block) {
  return Selector(model, selection)(place, block);
}

bool selects_block(const Model& model, const Selection& selection, int block) {
  return Selector(model, selection).block(block);
}

bool selects_point(const Model& model, const Selection& selection, int point) {
  const Selector selects(model, selection);
  const Interface& interface = model.interfaces[model.points[point].interface];
  const bool of_faces = selection.kind == Selection::Kind::body || selection.kind == Selection::Kind::units;
  return selects(model.point_position[point], interface.block_a) ||
         (of_faces && selects(model.point_position[point], interface.block_b));
}

std::vector<int> selected_nodes(const Model& model, const Selection& selection) {
  if (selection.kind == Selection::Kind::faces)
    return nodes_on(model, chosen_boundary(model, selection));
  const Selector selects(model, selection);
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(model.node_position.size()); ++node)
    if (selects(model.node_position[node], block_of(model, node)))
      nodes.push_back(node);
  return nodes;
}

std::vector<int> selected_outer_faces(const Model& model, const Selection& selection) {
  std::vector<int> faces;
  if (selection.kind == Selection::Kind::faces) {
    const std::vector<int> boundary = chosen_boundary(model, selection);
    for (int f = 0; f < static_cast<int>(model.outer_faces.size()); ++f)
      if (std::binary_search(boundary.begin(), boundary.end(), model.outer_faces[f].boundary))
        faces.push_back(f);
    return faces;
  }
  const Selector selects(model, selection);
  for (int f = 0; f < static_cast<int>(model.outer_faces.size()); ++f) {
    const OuterFace& face = model.outer_faces[f];
    const Block& block = model.blocks[face.block];
    bool selected = true;
    if (face.boundary >= 0) {
      const geom::Triangle& t = model.mesh.boundary[face.boundary].nodes;
      const auto& x = model.node_position;
      if (selection.kind == Selection::Kind::predicate)
        selected = selects((x[t[0]] + x[t[1]] + x[t[2]]) / 3, face.block);
      else
        for (const int node : t)
          selected = selected && selects(x[node], face.block);
    } else if (selection.kind == Selection::Kind::predicate)
      selected = selects(geom::face_centroid(block.shape, face.face), face.block);
    else
      for (const int v : block.shape.faces[face.face].loop)
        selected = selected && selects(block.shape.vertices[v], face.block);
    if (selected)
      faces.push_back(f);
  }
  return faces;
}

} // namespace cdem
