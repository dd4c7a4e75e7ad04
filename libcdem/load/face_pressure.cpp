#include "libcdem/load/face_pressure.hpp"

#include "libcdem/load/water_table.hpp"
#include "libcdem/model/build/build_model.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/star_mesh.hpp"

#include <fmt/format.h>
#include <map>

namespace cdem {
namespace {

constexpr int parts = 4; // parts * parts of a triangle, where the pressure is not linear in it

using Weights = std::array<double, 3>; // of the corners of a triangle
using Corners = std::array<geom::Vec3, 3>;

geom::Vec3 place(const Corners& x, const Weights& w) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
}

bool of_water(const FacePressure& given) {
  return given.level || given.table;
}

double depth_at(const FacePressure& given, const geom::Vec3& x) { // m, below the water table
  return (given.level ? *given.level : required_height(*given.table, x)) - x.z();
}

double pressure_at(const FacePressure& given, const geom::Vec3& x) {
  if (of_water(given))
    return given.weight * std::max(0.0, depth_at(given, x));
  const double p = given.pressure(x);
  if (!std::isfinite(p))
    throw geom::InputError(fmt::format("pressure at ({:.4g}, {:.4g}, {:.4g}) m", x.x(), x.y(), x.z()),
                           fmt::format("{:g}", p), "a finite number (Pa)");
  return p;
}

// f(weights at a midpoint of an edge, third of the part's area over the triangle's) over a part of a triangle.
template <class F>
void each_midpoint(const std::array<Weights, 3>& part, const F& f) {
  const auto minus = [](const Weights& a, const Weights& b) {
    return Weights{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const Weights a = minus(part[1], part[0]), b = minus(part[2], part[0]);
  const double share = std::abs(a[1] * b[2] - a[2] * b[1]);
  for (int i = 0; i < 3; ++i) {
    const Weights &p = part[i], &q = part[(i + 1) % 3];
    f(Weights{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])}, share / 3);
  }
}

// What of a part of a triangle lies under water, which is deep at its corners: linear between them.
std::vector<Weights> under_water(const std::array<Weights, 3>& part, const std::array<double, 3>& deep) {
  std::vector<Weights> polygon;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double a = -deep[i], b = -deep[j];
    if (a < 0)
      polygon.push_back(part[i]);
    if ((a < 0) != (b < 0)) {
      Weights w{0, 0, 0};
      for (int k = 0; k < 3; ++k)
        w[k] = b / (b - a) * part[i][k] + a / (a - b) * part[j][k];
      polygon.push_back(w);
    }
  }
  return polygon;
}

// f(part) for n * n equal parts of a triangle.
template <class F>
void each_part(int n, const F& f) {
  const auto at = [n](int i, int j) {
    const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / n;
    return Weights{1 - a - b, a, b};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n - i; ++j) {
      f(std::array<Weights, 3>{at(i, j), at(i + 1, j), at(i, j + 1)});
      if (j < n - i - 1)
        f(std::array<Weights, 3>{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

// Integral of p N over a triangle, for its three corners, N.
Weights integral(const Corners& x, const FacePressure& given) {
  const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  Weights sum{0, 0, 0};
  const auto add = [&](const Weights& w, double share) {
    const double force = share * area * pressure_at(given, place(x, w));
    for (int i = 0; i < 3; ++i)
      sum[i] += force * w[i];
  };
  if (of_water(given)) {
    const bool linear = given.level || given.table->is_plane();
    each_part(linear ? 1 : parts, [&](const std::array<Weights, 3>& part) {
      std::array<double, 3> deep{};
      for (int i = 0; i < 3; ++i)
        deep[i] = depth_at(given, place(x, part[i]));
      const std::vector<Weights> wet = under_water(part, deep);
      for (std::size_t i = 1; i + 1 < wet.size(); ++i)
        each_midpoint({wet[0], wet[i], wet[i + 1]}, add);
    });
    return sum;
  }
  each_part(parts, [&](const std::array<Weights, 3>& part) { each_midpoint(part, add); });
  return sum;
}

using FaceKey = std::pair<int, int>; // block, face

// Forces on the nodes of faces of convex blocks, without what other blocks cover.
class BlockFaces {
public:
  BlockFaces(const Model& model, const FacePressure& given) : model_(model), given_(given) {
    for (std::size_t i = 0; i < model.interfaces.size(); ++i) {
      const Interface& interface = model.interfaces[i];
      covers_[{interface.block_a, interface.face_a}].push_back({static_cast<int>(i), true});
      covers_[{interface.block_b, interface.face_b}].push_back({static_cast<int>(i), false});
    }
  }

  std::map<int, double> forces(const OuterFace& face) {
    std::map<int, double> force;
    const Block& block = model_.blocks[face.block];
    const auto mesh = meshes_.find(face.block);
    const geom::BlockMesh& own = mesh != meshes_.end()
                                     ? mesh->second
                                     : meshes_
                                           .emplace(face.block, block.zoned ? zones_of(model_, face.block)
                                                                            : geom::star_mesh(block.shape))
                                           .first->second;
    for (const geom::Triangle& t : own.fans[face.face]) {
      Corners x;
      for (int i = 0; i < 3; ++i)
        x[i] = model_.node_position[block.node_begin + t[i]];
      const Weights sum = integral(x, given_);
      for (int i = 0; i < 3; ++i)
        force[block.node_begin + t[i]] += sum[i];
    }
    const auto covers = covers_.find({face.block, face.face});
    if (covers != covers_.end())
      for (const auto& [interface, is_a] : covers->second)
        subtract(model_.interfaces[interface], is_a, force);
    return force;
  }

private:
  void subtract(const Interface& interface, bool is_a, std::map<int, double>& force) const {
    for (int t = interface.triangle_begin; t < interface.triangle_end; ++t) {
      const geom::Triangle& triangle = model_.bond_triangles[t];
      Corners x;
      for (int i = 0; i < 3; ++i)
        x[i] = model_.point_position[triangle[i]];
      const Weights sum = integral(x, given_);
      for (int i = 0; i < 3; ++i) {
        const BondPoint& point = model_.points[triangle[i]];
        for (int k = 0; k < 3; ++k)
          force[is_a ? point.node_a[k] : point.node_b[k]] -=
              sum[i] * (is_a ? point.weight_a[k] : point.weight_b[k]);
      }
    }
  }

  const Model& model_;
  const FacePressure& given_;
  std::map<FaceKey, std::vector<std::pair<int, bool>>> covers_; // interface; whether the face is its a
  std::map<int, geom::BlockMesh> meshes_;                       // by block
};

} // namespace

std::vector<std::pair<int, geom::Vec3>> pressure_pattern(const Model& model, const std::vector<int>& faces,
                                                         const FacePressure& given) {
  std::vector<std::pair<int, geom::Vec3>> pattern;
  BlockFaces blocks(model, given);
  for (const int f : faces) {
    const OuterFace& face = model.outer_faces[f];
    if (face.boundary < 0) {
      for (const auto& [node, force] : blocks.forces(face))
        if (force != 0)
          pattern.emplace_back(node, -force * face.normal);
      continue;
    }
    const geom::Triangle& nodes = model.mesh.boundary[face.boundary].nodes;
    Corners x;
    for (int i = 0; i < 3; ++i)
      x[i] = model.node_position[nodes[i]];
    const Weights sum = integral(x, given);
    for (int i = 0; i < 3; ++i)
      if (sum[i] != 0)
        pattern.emplace_back(nodes[i], -sum[i] * face.normal);
  }
  if (pattern.empty() && given.level)
    throw geom::InputError("level", fmt::format("{:g}", *given.level),
                           "above the lowest of the faces that `on` selects", "none of them is under water");
  if (pattern.empty() && given.table)
    throw geom::InputError("water_table", "below all of them",
                           "above the lowest of the faces that `on` selects", "none of them is under water");
  return pattern;
}

} // namespace cdem
