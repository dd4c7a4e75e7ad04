#include "tests/vtk/sample.hpp"

#include <cmath>

namespace cdem::sample {

using geom::Vec3;

std::vector<Polygon> grid(double width, double height, int columns, int rows) {
  std::vector<Polygon> polygons;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x0 = width * i / columns, x1 = width * (i + 1) / columns;
      const double y0 = height * j / rows, y1 = height * (j + 1) / rows;
      polygons.push_back({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
    }
  return polygons;
}

std::vector<Polygon> cut(const std::vector<Polygon>& polygons, std::array<double, 2> point, double degrees) {
  const double angle = degrees * M_PI / 180;
  const std::array<double, 2> normal = {std::cos(angle),
                                        -std::sin(angle)}; // of a line turned from the y axis
  std::vector<Polygon> parts;
  for (const Polygon& polygon : polygons)
    for (const double side : {1., -1.}) {
      Polygon part;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const auto level = [&](const std::array<double, 2>& x) {
          return side * (normal[0] * (x[0] - point[0]) + normal[1] * (x[1] - point[1]));
        };
        const double la = level(a), lb = level(b);
        if (la >= 0)
          part.push_back(a);
        if (la * lb < 0)
          part.push_back({a[0] + (b[0] - a[0]) * la / (la - lb), a[1] + (b[1] - a[1]) * la / (la - lb)});
      }
      if (part.size() >= 3)
        parts.push_back(part);
    }
  return parts;
}

Snapshot blocks(const std::vector<Polygon>& polygons, double thickness) {
  Snapshot s;
  SnapshotField block_id{"block_id", "", 1, {}, true};
  for (std::size_t block = 0; block < polygons.size(); ++block) {
    const Polygon& polygon = polygons[block];
    const int n = static_cast<int>(polygon.size()), first = static_cast<int>(s.points.size());
    Vec3 centre = Vec3::Zero();
    for (const double z : {0., thickness})
      for (const auto& p : polygon) {
        s.points.emplace_back(p[0], p[1], z);
        centre += s.points.back() / (2 * n);
      }
    const int middle = static_cast<int>(s.points.size());
    s.points.push_back(centre);
    // Faces as loops seen from outside: bottom, top, sides.
    std::vector<std::vector<int>> faces(2);
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      faces[0].push_back(first + n - 1 - i);
      faces[1].push_back(first + n + i);
      faces.push_back({first + i, first + j, first + n + j, first + n + i});
      s.block_edges.push_back({first + i, first + j});
      s.block_edges.push_back({first + n + i, first + n + j});
      s.block_edges.push_back({first + i, first + n + i});
    }
    for (const std::vector<int>& face : faces) {
      Vec3 face_centre = Vec3::Zero();
      for (const int v : face)
        face_centre += s.points[static_cast<std::size_t>(v)] / static_cast<double>(face.size());
      const int c = static_cast<int>(s.points.size());
      s.points.push_back(face_centre);
      for (std::size_t i = 0; i < face.size(); ++i) {
        const int a = face[i], b = face[(i + 1) % face.size()];
        s.surface.push_back({c, a, b});
        s.surface_tet.push_back(static_cast<std::int64_t>(s.tets.size()));
        s.tets.push_back({middle, c, a, b});
        block_id.values.push_back(static_cast<double>(block + 1));
      }
    }
  }
  s.cell_fields.push_back(block_id);
  return s;
}

namespace {

// Smooth, so that blocks stay nearly whole: each point belongs to a wedge by which diagonal it lies beyond.
SnapshotField wedge_displacement(const std::vector<Vec3>& points, const geom::Box& box, double push) {
  const Vec3 half = 0.5 * box.size();
  SnapshotField u{"displacement", "m", 3, {}, false};
  for (const Vec3& x : points) {
    const double a = (x.x() - box.centre().x()) / half.x(), b = (x.y() - box.centre().y()) / half.y();
    const double side = 0.5 * (1 + std::tanh(6 * (std::abs(a) - std::abs(b))));
    u.values.push_back(push * side * std::tanh(4 * a));
    u.values.push_back(-0.6 * push * b * (1 - side) - 0.5 * push * (b + 1));
    u.values.push_back(0);
  }
  return u;
}

} // namespace

void add_wedge_fields(Snapshot& s, double push) {
  geom::Box box;
  for (const Vec3& x : s.points)
    box.extend(x);
  const Vec3 half = 0.5 * box.size();
  SnapshotField stress{"stress", "Pa", 6, {}, false};
  for (const geom::Tet& t : s.tets) {
    Vec3 centre = Vec3::Zero();
    for (const int v : t)
      centre += 0.25 * s.points[static_cast<std::size_t>(v)];
    const double a = (centre.x() - box.centre().x()) / half.x(),
                 b = (centre.y() - box.centre().y()) / half.y();
    const double level = -30e6 * (1 - 0.6 * std::tanh(3 * std::max(0., std::abs(a) - std::abs(b))));
    for (const double v : {0.1 * level * a * b, level, 0.05 * level, 4e6 * a * b, 0., 0.})
      stress.values.push_back(v);
  }
  s.point_fields.push_back(wedge_displacement(s.points, box, push));
  s.bonds.point_fields.push_back(wedge_displacement(s.bonds.points, box, push));
  s.cell_fields.push_back(stress);
}

void add_interface(Snapshot& s, std::array<double, 2> a, std::array<double, 2> b, double thickness,
                   BondMode mode, int pieces) {
  BondSnapshot& bonds = s.bonds;
  if (bonds.triangle_fields.empty()) {
    bonds.point_fields = {
        {"mode", "", 1, {}, true}, {"opening", "m", 1, {}, false}, {"traction", "Pa", 3, {}, false}};
    bonds.triangle_fields = {{"interface_id", "", 1, {}, true}, {"mode", "", 1, {}, true}};
  }
  const double id = bonds.triangle_fields[0].values.empty() ? 1 : bonds.triangle_fields[0].values.back() + 1;
  const int first = static_cast<int>(bonds.points.size());
  for (int i = 0; i <= pieces; ++i)
    for (const double z : {0., thickness}) {
      const double w = static_cast<double>(i) / pieces;
      bonds.points.emplace_back(a[0] + w * (b[0] - a[0]), a[1] + w * (b[1] - a[1]), z);
      bonds.point_fields[0].values.push_back(static_cast<double>(mode));
      bonds.point_fields[1].values.push_back(mode == BondMode::broken_tension ? 1e-5 : 0);
      for (const double t : {1e5, -2e6, 0.1})
        bonds.point_fields[2].values.push_back(mode == BondMode::intact ? t : 0);
    }
  for (int i = 0; i < pieces; ++i)
    for (const geom::Triangle& t : {geom::Triangle{0, 2, 3}, geom::Triangle{0, 3, 1}}) {
      const int n = first + 2 * i;
      bonds.triangles.push_back({n + t[0], n + t[1], n + t[2]});
      bonds.triangle_fields[0].values.push_back(id);
      bonds.triangle_fields[1].values.push_back(static_cast<double>(mode));
    }
}

Snapshot plate() {
  const double side = 0.3, thickness = 0.03;
  std::vector<Polygon> polygons;
  for (const Polygon& square : grid(side, side, 10, 10)) {
    const double x = 0.5 * (square[0][0] + square[2][0]), y = 0.5 * (square[0][1] + square[2][1]);
    const double a = x / side - 0.5, b = y / side - 0.5;
    std::vector<Polygon> parts = {square};
    if (std::abs(std::abs(a) - std::abs(b)) < 0.11) // near the diagonals: two cuts, "\" or "/"
      for (const double shift : {-0.005, 0.005})
        parts = cut(parts, {x + shift, y}, a * b < 0 ? -30 : 30);
    polygons.insert(polygons.end(), parts.begin(), parts.end());
  }
  Snapshot s = blocks(polygons, thickness);
  s.title = "uniaxial_compression, stage 3 (relax)";
  s.time = 0.125;
  s.step = 41600;
  for (int i = 0; i < 10; ++i) {
    const double x = (i + 0.5) * 0.03;
    for (const bool rising : {true, false}) { // on the left one of the two cuts of the diagonal blocks
      const double y = rising ? x : side - x, half = 0.5 * side / 10;
      const double lean = half * std::tan(M_PI / 6) * (rising ? 1 : -1), middle = x - 0.005;
      add_interface(s, {middle - lean, y - half}, {middle + lean, y + half}, thickness,
                    BondMode::broken_shear, 3);
    }
  }
  for (int j = 3; j < 7; ++j) {
    add_interface(s, {0.03, 0.03 * j}, {0.03, 0.03 * (j + 1)}, thickness, BondMode::broken_tension, 2);
    add_interface(s, {0.27, 0.03 * j}, {0.27, 0.03 * (j + 1)}, thickness, BondMode::broken_tension, 2);
    add_interface(s, {0.12, 0.03 * j}, {0.12, 0.03 * (j + 1)}, thickness, BondMode::intact, 2);
  }
  add_wedge_fields(s, 0.45e-3);
  return s;
}

} // namespace cdem::sample
