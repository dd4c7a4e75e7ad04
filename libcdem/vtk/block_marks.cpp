#include "libcdem/vtk/block_marks.hpp"

#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/view.hpp"
#include "libgeom/core/error.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

namespace cdem {
namespace {

using geom::Vec3;

constexpr std::size_t most_marks = 1500;
constexpr double most_of_body = 0.08;
constexpr Colour arrow_colour = {0.1, 0.1, 0.1}, pressure_colour = {0.05, 0.2, 0.65},
                 tension_colour_of_cross = {0.8, 0.1, 0.1};

struct ShownBlock {
  double area = 0;
  Vec3 place = Vec3::Zero(), displacement = Vec3::Zero(); // m
  geom::Mat3 stress = geom::Mat3::Zero();                 // Pa
  geom::Box box;                                          // m
};

struct ShownBlocks {
  std::vector<ShownBlock> blocks;
  double longest = 0; // m, of a mark
};

geom::Mat3 tensor(const std::vector<double>& values, std::size_t cell) {
  const double* const s = values.data() + 6 * cell;
  geom::Mat3 m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return m;
}

// In the part of the page that `fit` shows.
std::function<bool(const Vec3&)> is_shown(const Snapshot& s, const PictureOptions& options) {
  if (!options.fit)
    return [](const Vec3&) { return true; };
  const View view = view_of(options, s.points, s.surface);
  return [view, shown = view.extent(*options.fit)](const Vec3& place) {
    const Vec3 x = view.in_view(place);
    return (x.head<2>().array() >= shown.min.head<2>().array()).all() &&
           (x.head<2>().array() <= shown.max.head<2>().array()).all();
  };
}

ShownBlocks shown_blocks(const Snapshot& s, const PictureOptions& options) {
  const SnapshotField *displacement = displacement_of(s.point_fields),
                      *stress = find_field(s.cell_fields, "stress"),
                      *id = find_field(s.cell_fields, "block_id");
  if (!displacement || !id)
    throw geom::InputError("arrows and crosses: only for the blocks of a model; leave joints out");
  std::map<double, ShownBlock> of;
  for (std::size_t t = 0; t < s.surface.size(); ++t) {
    const auto cell = static_cast<std::size_t>(s.surface_tet[t]);
    Vec3 place = Vec3::Zero(), moved = Vec3::Zero();
    std::array<Vec3, 3> x;
    geom::Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto point = static_cast<std::size_t>(s.surface[t][k]);
      const Vec3 u = Eigen::Map<const Vec3>(displacement->values.data() + 3 * point);
      x[k] = s.points[point] + options.deformation * u;
      box.extend(x[k]);
      place += x[k] / 3;
      moved += u / 3;
    }
    const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    ShownBlock& block = of[id->values[cell]];
    block.area += area;
    block.box.extend(box.min);
    block.box.extend(box.max);
    block.place += area * place;
    block.displacement += area * moved;
    if (stress)
      block.stress += area * tensor(stress->values, cell);
  }
  const auto in_picture = is_shown(s, options);
  double whole = 0;
  geom::Box box;
  for (auto block = of.begin(); block != of.end();) {
    if (!(block->second.area > 0) || !in_picture(block->second.place / block->second.area)) {
      block = of.erase(block);
      continue;
    }
    whole += block->second.area;
    box.extend(block->second.box.min);
    box.extend(block->second.box.max);
    ++block;
  }
  ShownBlocks shown;
  if (of.empty())
    return shown;
  const double wide = std::sqrt(whole / (6 * static_cast<double>(of.size())));
  shown.longest = std::min(most_of_body * box.size().norm(), 2 * wide);
  const std::size_t stride = (of.size() + most_marks - 1) / most_marks;
  std::size_t number = 0;
  for (auto& [key, block] : of) {
    if (number++ % stride != 0)
      continue;
    block.place /= block.area;
    block.displacement /= block.area;
    block.stress /= block.area;
    shown.blocks.push_back(block);
  }
  return shown;
}

std::string three_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

Polyline line(const std::vector<Vec3>& points, const Colour& colour, double width) {
  Polyline l;
  l.points = points;
  l.colour = colour;
  l.width = width;
  return l;
}

} // namespace

std::vector<Polyline> displacement_arrows(const Snapshot& s, const PictureOptions& options) {
  const ShownBlocks shown = shown_blocks(s, options);
  double most = 0;
  for (const ShownBlock& block : shown.blocks)
    most = std::max(most, block.displacement.norm());
  std::vector<Polyline> lines;
  if (!(most > 0))
    return lines;
  for (const ShownBlock& block : shown.blocks) {
    const Vec3 along = (shown.longest / most) * block.displacement;
    if (along.norm() < 0.02 * shown.longest)
      continue;
    const Vec3 tip = block.place + along;
    const Vec3 other = std::abs(along.y()) < 0.9 * along.norm() ? Vec3::UnitY() : Vec3::UnitX();
    const Vec3 wing = 0.1 * along.norm() * along.cross(other).normalized();
    const Vec3 back = tip - 0.25 * along;
    lines.push_back(line({block.place, tip}, arrow_colour, 2.5));
    lines.push_back(line({back + wing, tip, back - wing}, arrow_colour, 2.5));
  }
  lines.front().label = "longest arrow " + three_digits(1e3 * most) + " mm";
  return lines;
}

std::vector<Polyline> stress_crosses(const Snapshot& s, const PictureOptions& options) {
  const ShownBlocks shown = shown_blocks(s, options);
  std::vector<Eigen::SelfAdjointEigenSolver<geom::Mat3>> principal;
  double pressure = 0, tension = 0;
  for (const ShownBlock& block : shown.blocks) {
    principal.emplace_back(block.stress);
    pressure = std::max(pressure, -principal.back().eigenvalues().minCoeff());
    tension = std::max(tension, principal.back().eigenvalues().maxCoeff());
  }
  std::vector<Polyline> lines;
  const double most = std::max(pressure, tension);
  if (!(most > 0))
    return lines;
  std::string pressure_label = "pressure, at most " + three_digits(1e-6 * pressure) + " MPa",
              tension_label = "tension, at most " + three_digits(1e-6 * tension) + " MPa";
  for (std::size_t i = 0; i < shown.blocks.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double value = principal[i].eigenvalues()[k];
      const Vec3 half = (0.45 * shown.longest * std::abs(value) / most) * principal[i].eigenvectors().col(k);
      if (half.norm() < 0.01 * shown.longest)
        continue;
      const bool pulls = value > 0;
      lines.push_back(line({shown.blocks[i].place - half, shown.blocks[i].place + half},
                           pulls ? tension_colour_of_cross : pressure_colour, 2.5));
      std::string& label = pulls ? tension_label : pressure_label;
      lines.back().label = label;
      label.clear();
    }
  return lines;
}

} // namespace cdem
