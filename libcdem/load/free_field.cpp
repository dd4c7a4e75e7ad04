#include "libcdem/load/free_field.hpp"

#include "libcdem/material/wave_speeds.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {
namespace {

constexpr double least_spacing = 0.5; // of levels, over their mean: closer ones make the levels even

struct SideFace {
  double z = 0, area = 0; // of the centroid, m; m2
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity(); // m
  const Elastic* material = nullptr;
};

// The heights of the side's nodes; empty where an unstructured mesh has them at any height.
std::vector<double> levels_of(std::vector<double> z, double tolerance) {
  std::sort(z.begin(), z.end());
  const auto same = [&](double a, double b) { return b - a <= tolerance; };
  z.erase(std::unique(z.begin(), z.end(), same), z.end());
  if (z.size() < 2)
    throw geom::InputError("free_field: the side has no height; it must be a vertical side of the rock");
  const double height = z.back() - z.front();
  double least = height;
  for (std::size_t i = 1; i < z.size(); ++i)
    least = std::min(least, z[i] - z[i - 1]);
  if (least >= least_spacing * height / static_cast<double>(z.size() - 1))
    return z;
  return {};
}

ColumnLayer layer_of(const std::vector<SideFace>& faces, double low, double high) {
  double area = 0;
  ColumnLayer layer;
  layer.height = high - low;
  const auto add = [&](const SideFace& face, double weight) {
    const Elastic& m = *face.material;
    area += weight;
    layer.lambda += weight * m.lame_lambda();
    layer.shear += weight * m.shear_modulus();
    layer.p_modulus += weight * m.p_wave_modulus();
    layer.density += weight * m.density;
    layer.mass_damping += weight * m.viscosity / m.density;
    layer.stiffness_damping += weight * m.stiffness_damping;
  };
  for (const SideFace& face : faces)
    if (const double part = std::min(high, face.high) - std::max(low, face.low); part > 0)
      add(face, face.area * part / (face.high - face.low));
  if (area == 0) {
    const double middle = 0.5 * (low + high);
    add(*std::min_element(faces.begin(), faces.end(),
                          [&](const SideFace& a, const SideFace& b) {
                            return std::abs(a.z - middle) < std::abs(b.z - middle);
                          }),
        1);
  }
  for (double* value : {&layer.lambda, &layer.shear, &layer.p_modulus, &layer.density, &layer.mass_damping,
                        &layer.stiffness_damping})
    *value /= area;
  return layer;
}

// The foot of the model: the last quiet boundary on z-, else the last support of each axis there.
void set_foot(Column& column, const Conditions& conditions) {
  const Selection foot = Selection::side("z-");
  const ColumnLayer& lowest = column.layers.front();
  const double shear = std::sqrt(lowest.shear * lowest.density),
               normal = std::sqrt(lowest.p_modulus * lowest.density);
  const geom::Vec3 impedance(shear, shear, normal);
  bool quiet = false;
  for (const Quiet& q : conditions.quiets)
    if (selects_same(q.on, foot)) {
      quiet = true;
      column.foot_impedance = impedance;
      column.entering.emplace_back(2 * (impedance.cwiseProduct(q.velocity) + q.stress), q.amplitude);
    }
  for (const Fix& fix : conditions.fixes)
    if (selects_same(fix.on, foot))
      for (int axis = 0; axis < 3; ++axis)
        if (fix.axes[axis]) {
          column.held[axis] = !fix.release;
          column.support[axis] = {fix.velocity ? (*fix.velocity)[axis] : 0, fix.amplitude};
        }
  if (!quiet && !(column.held[0] || column.held[1] || column.held[2]))
    throw geom::InputError("free_field: the model has no foot for its columns; give model:quiet or model:fix "
                           "on = \"z-\" before");
}

} // namespace

Column free_field_column(const Model& model, const Conditions& conditions, const FreeField& field,
                         const std::vector<int>& faces) {
  if (field.on.kind != Selection::Kind::side || field.on.axis == 2)
    throw geom::InputError("on", field.on.text, "one of \"x-\", \"x+\", \"y-\", \"y+\"",
                           "a free field stands at a vertical side");
  Column column;
  column.axis = field.on.axis;
  column.upper = field.on.upper;
  std::vector<SideFace> side;
  std::vector<double> heights;
  double area = 0;
  for (const int f : faces) {
    const OuterFace& face = model.outer_faces[f];
    SideFace s;
    s.material = &model.bodies[model.blocks[face.block].body].material;
    each_face_node(model, face, [&](int node, double share) {
      s.z += share * model.node_position[node].z();
      s.area += share;
      s.low = std::min(s.low, model.node_position[node].z());
      s.high = std::max(s.high, model.node_position[node].z());
      heights.push_back(model.node_position[node].z());
    });
    s.z /= s.area;
    area += s.area;
    side.push_back(s);
  }
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double bottom = *low, top = *high;
  column.z = levels_of(std::move(heights), model.tolerance);
  if (column.z.empty()) {
    // A triangle has half of a square on its edge, a node of a face of many the whole of it.
    double squares = 0;
    for (const int f : faces)
      squares += model.outer_faces[f].boundary >= 0
                     ? 0.5
                     : static_cast<double>(model.outer_faces[f].node_area.size());
    const double edge = std::sqrt(area / squares);
    // Even heights between the ends of tall faces: there the material may change.
    std::vector<double> ends{bottom, top};
    for (const SideFace& face : side)
      if (face.high - face.low > 2 * edge)
        ends.insert(ends.end(), {face.low, face.high});
    std::sort(ends.begin(), ends.end());
    column.z.push_back(bottom);
    for (const double end : ends) {
      const double from = column.z.back();
      if (end - from <= 0.5 * edge && end != top)
        continue;
      const int layers = std::max(1, static_cast<int>(std::round((end - from) / edge)));
      for (int i = 1; i <= layers && end > from; ++i)
        column.z.push_back(i == layers ? end : from + (end - from) * i / layers);
    }
  }
  column.mass.assign(column.z.size(), 0);
  for (std::size_t i = 0; i + 1 < column.z.size(); ++i) {
    column.layers.push_back(layer_of(side, column.z[i], column.z[i + 1]));
    const double half = 0.5 * column.layers[i].density * column.layers[i].height;
    column.mass[i] += half;
    column.mass[i + 1] += half;
  }
  const auto layer_at = [&](double z) {
    const auto above = std::upper_bound(column.z.begin(), column.z.end(), z) - column.z.begin();
    return static_cast<int>(
        std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(column.layers.size()) - 1));
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const OuterFace& face = model.outer_faces[faces[i]];
    const geom::Mat3 impedance = wave_impedance(*side[i].material, face.normal);
    each_face_node(model, face, [&](int node, double share) {
      const double z = model.node_position[node].z();
      const int level = layer_at(z);
      const double height = column.layers[level].height,
                   above = std::clamp((z - column.z[level]) / height, 0.0, 1.0);
      const auto take = [&](int layer, double part) {
        column.shares.push_back({node, part, layer, level, above, impedance});
      };
      if (side[i].high - side[i].low < 1.5 * height) {
        take(layer_at(side[i].z), share);
      } else { // a face of many nodes: what a node stands for lies half above and half below it
        take(layer_at(std::max(side[i].low + 1e-6 * height, z - 0.25 * height)), 0.5 * share);
        take(layer_at(std::min(side[i].high - 1e-6 * height, z + 0.25 * height)), 0.5 * share);
      }
    });
  }
  set_foot(column, conditions);
  return column;
}

std::size_t column_levels(const ResolvedConditions& r) {
  return r.columns.empty() ? 0 : r.columns.back().first + r.columns.back().z.size();
}

} // namespace cdem
