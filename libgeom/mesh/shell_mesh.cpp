#include "libgeom/mesh/shell_mesh.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/mesh/sound_surface.hpp"
#include "libgeom/query/closest.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>

namespace geom {
namespace {

constexpr double flat = 0.02;       // eigenvalue over the largest: normals do not differ in this direction
constexpr double longest = 3;       // thicknesses: a point of a sharp edge moves no further
constexpr double least_part = 1e-3; // of the volume of a straight prism: less is folded

Vec3 normal_of(const std::array<Vec3, 3>& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]);
}

// Turns triangles so that neighbours run through a shared edge in opposite directions. Returns the part of each.
std::vector<int> turn_alike(Surface& surface) {
  std::map<std::array<int, 2>, std::vector<int>> at_edge;
  const auto runs = [&](int t, std::size_t k) {
    return std::array<int, 2>{surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]};
  };
  const auto sorted = [](std::array<int, 2> edge) {
    std::sort(edge.begin(), edge.end());
    return edge;
  };
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      at_edge[sorted(runs(t, k))].push_back(t);
  std::vector<int> part(surface.triangles.size(), -1);
  int parts = 0;
  for (int first = 0; first < static_cast<int>(part.size()); ++first) {
    if (part[first] >= 0)
      continue;
    std::vector<int> open{first};
    part[first] = parts;
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<int, 2> edge = runs(t, k);
        for (const int other : at_edge.at(sorted(edge))) {
          if (other == t)
            continue;
          const bool same = runs(other, 0) == edge || runs(other, 1) == edge || runs(other, 2) == edge;
          if (part[other] < 0) {
            if (same)
              std::swap(surface.triangles[other][1], surface.triangles[other][2]);
            part[other] = parts;
            open.push_back(other);
          } else if (same) {
            throw InputError("surface", "one-sided at " + place_text(surface.points[edge[0]]),
                             "a surface with two sides", "a Moebius strip has no front");
          }
        }
      }
    }
    ++parts;
  }
  return part;
}

// Turns each part to the place: the triangle of it that is nearest looks there.
void turn_to(Surface& surface, const std::vector<int>& part, const Vec3& front) {
  std::map<int, std::pair<double, bool>> nearest; // distance, whether its triangle looks away
  for (std::size_t t = 0; t < part.size(); ++t) {
    const auto x = surface.corners(t);
    const Vec3 w = nearest_on_triangle(front, x[0], x[1], x[2]).weights;
    const Vec3 to = front - (w[0] * x[0] + w[1] * x[1] + w[2] * x[2]);
    const auto known = nearest.try_emplace(part[t], std::numeric_limits<double>::infinity(), false).first;
    // Several are as near beside an edge: the one that faces the place best tells.
    const double faces = std::abs(to.dot(normal_of(x).normalized()));
    const double far = to.norm() + 1e-3 * (to.norm() - faces);
    if (far < known->second.first)
      known->second = {far, to.dot(normal_of(x)) < 0};
  }
  for (std::size_t t = 0; t < part.size(); ++t)
    if (nearest.at(part[t]).second)
      std::swap(surface.triangles[t][1], surface.triangles[t][2]);
}

// Behind each point, by a thickness of 1.
std::vector<Vec3> offsets(const Surface& surface) {
  std::vector<Mat3> planes(surface.points.size(), Mat3::Zero());
  std::vector<Vec3> sum(surface.points.size(), Vec3::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto x = surface.corners(t);
    const Vec3 n = normal_of(x).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = (x[(k + 1) % 3] - x[k]).normalized(), b = (x[(k + 2) % 3] - x[k]).normalized();
      const double angle = portable::acos(std::clamp(a.dot(b), -1., 1.));
      planes[surface.triangles[t][k]] += angle * n * n.transpose();
      sum[surface.triangles[t][k]] += angle * n;
    }
  }
  std::vector<Vec3> behind;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const Eigen::SelfAdjointEigenSolver<Mat3> own(planes[i]);
    Vec3 d = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      if (const double value = own.eigenvalues()[k]; value > flat * own.eigenvalues()[2])
        d -= own.eigenvectors().col(k) * (own.eigenvectors().col(k).dot(sum[i]) / value);
    behind.push_back(d * std::min(1., longest / std::max(1., d.norm())));
  }
  return behind;
}

} // namespace

TetMesh shell_mesh(const Surface& given, double thickness, const std::optional<Vec3>& front) {
  require_positive("thickness", thickness);
  if (given.triangles.empty())
    throw InputError("surface: it has no triangles");
  require_single(given, "surface");
  Surface surface{{}, given.triangles};
  std::vector<int> place(given.points.size(), -1); // points that some triangle has
  for (Triangle& triangle : surface.triangles)
    for (int& corner : triangle) {
      if (place[corner] < 0) {
        place[corner] = static_cast<int>(surface.points.size());
        surface.points.push_back(given.points[corner]);
      }
      corner = place[corner];
    }
  const std::vector<int> part = turn_alike(surface);
  if (front)
    turn_to(surface, part, *front);

  TetMesh mesh;
  mesh.nodes = surface.points;
  const auto count = static_cast<int>(surface.points.size());
  const std::vector<Vec3> behind = offsets(surface);
  for (int i = 0; i < count; ++i)
    mesh.nodes.push_back(surface.points[i] + thickness * behind[i]);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Triangle v = surface.triangles[t];
    const Vec3 a = surface.points[v[0]];
    const double prism = 0.5 * normal_of(surface.corners(t)).norm() * thickness;
    bool odd = false; // whether sorting turns the triangle round
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)})
      if (v[i] > v[j]) {
        std::swap(v[i], v[j]);
        odd = !odd;
      }
    const auto [p, q, r] = v;
    for (Tet tet : {Tet{p, q, r, r + count}, Tet{p, q + count, q, r + count},
                    Tet{p, p + count, q + count, r + count}}) {
      if (!odd)
        std::swap(tet[2], tet[3]);
      const auto& x = mesh.nodes;
      const double volume =
          (x[tet[1]] - x[tet[0]]).cross(x[tet[2]] - x[tet[0]]).dot(x[tet[3]] - x[tet[0]]) / 6;
      if (!(volume > least_part * prism / 3))
        throw InputError("thickness", text(thickness),
                         "less than the surface is bent: its back folds at " + place_text(a),
                         "give a thinner wall, a smoother surface, or `front` on its other side");
      mesh.tets.push_back(tet);
    }
  }
  mesh.region.assign(mesh.tets.size(), 0);
  require_uncrossed(surface_of(mesh), "thickness: the wall", same_corner * bounding_box(mesh).size().norm());
  return mesh;
}

} // namespace geom
