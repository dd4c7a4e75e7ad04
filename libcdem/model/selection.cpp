#include "libcdem/model/selection.hpp"

#include "libcdem/model/model.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace cdem {
namespace {

// The blocks that a selection of units means.
std::vector<char> chosen_units(const Model& model, const Selection& s) {
  std::vector<char> chosen(model.blocks.size(), 0);
  int number = 0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    if (model.bodies[model.blocks[b].body].name == s.body)
      chosen[b] = std::binary_search(s.units.begin(), s.units.end(), ++number);
  if (number == 0)
    throw geom::InputError("body", "\"" + s.body + "\"", "the name of a body of the model");
  if (s.units.back() > number)
    throw geom::InputError("numbers", std::to_string(s.units.back()),
                           fmt::format("a unit of \"{}\", which has {}", s.body, number));
  return chosen;
}

// A selection applied to one model.
class Selector {
public:
  Selector(const Model& model, const Selection& selection) : model_(model), selection_(selection) {
    if (selection.kind == Selection::Kind::units)
      chosen_ = chosen_units(model, selection);
  }
  bool operator()(const geom::Vec3& place, int block) const;
  bool block(int block) const;

private:
  const Model& model_;
  const Selection& selection_;
  std::vector<char> chosen_; // units: by block
};

bool Selector::operator()(const geom::Vec3& x, int block) const {
  const Selection& s = selection_;
  const Model& model = model_;
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
    return model.bodies[model.blocks[block].body].name == s.body;
  case Selection::Kind::units:
    return chosen_[block] != 0;
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

Selection Selection::where(std::function<bool(const geom::Vec3&)> predicate, std::string text) {
  Selection s;
  s.kind = Kind::predicate;
  s.predicate = std::move(predicate);
  s.text = std::move(text);
  return s;
}

bool Selector::block(int block) const {
  const Block& b = model_.blocks[block];
  if (selection_.kind != Selection::Kind::side)
    return (*this)(b.mass.centroid, block);
  if (b.meshed) {
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
  const Selector selects(model, selection);
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(model.node_position.size()); ++node)
    if (selects(model.node_position[node], block_of(model, node)))
      nodes.push_back(node);
  return nodes;
}

std::vector<int> selected_outer_faces(const Model& model, const Selection& selection) {
  const Selector selects(model, selection);
  std::vector<int> faces;
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
      selected = selects(model.node_position[block.face_centre(face.face)], face.block);
    else
      for (const int v : block.shape.faces[face.face].loop)
        selected = selected && selects(block.shape.vertices[v], face.block);
    if (selected)
      faces.push_back(f);
  }
  return faces;
}

} // namespace cdem
