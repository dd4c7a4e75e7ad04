#include "libgeom/assembly/discs.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/stop.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace geom {
namespace {

constexpr double usual_clearance = 1e-3; // of a block's diagonal, between a plane and the block's vertices

void check(const Disc& disc) {
  const std::string name = "disc " + std::to_string(disc.id) + ": ";
  require_finite(name + "centre", disc.centre);
  if (!(disc.dip >= 0 && disc.dip <= M_PI / 2 * (1 + 1e-12)))
    throw InputError(name + "dip", text(disc.dip * 180 / M_PI), "from 0 to 90 degrees");
  if (!(disc.dip_direction >= 0 && disc.dip_direction <= 2 * M_PI * (1 + 1e-12)))
    throw InputError(name + "dip_direction", text(disc.dip_direction * 180 / M_PI), "from 0 to 360 degrees");
  if (!(std::isfinite(disc.radius) && disc.radius > 0))
    throw InputError(name + "radius", text(disc.radius), "a finite number > 0 m");
}

// Whether a convex face in the disc's plane comes nearer to its centre than its radius.
bool reaches(const Disc& disc, const Vec3& normal, const Polyhedron& shape, const PolyhedronFace& face) {
  bool inside = true;
  double turn = 0;
  const std::size_t n = face.loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = shape.vertices[face.loop[i]], &b = shape.vertices[face.loop[(i + 1) % n]];
    const Vec3 edge = b - a, to_centre = disc.centre - a;
    const double part = std::clamp(to_centre.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    if ((to_centre - part * edge).norm() < disc.radius)
      return true;
    const double side = edge.cross(to_centre).dot(normal);
    inside = inside && side * turn >= 0;
    turn = side;
  }
  return inside;
}

bool near(const Disc& disc, const Vec3& normal, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = disc.radius * std::sqrt(std::max(0.0, 1 - normal[axis] * normal[axis]));
    if (disc.centre[axis] + reach < box.min[axis] || disc.centre[axis] - reach > box.max[axis])
      return false;
  }
  return true;
}

// Faces of discs are marked with the disc's number while others may still cut them.
const char mark = '\n'; // no name of a set has it

std::string marked(std::size_t disc) {
  return mark + std::to_string(disc);
}

int cut_face_of(const Part& part) {
  for (std::size_t f = 0; f < part.shape.faces.size(); ++f)
    if (part.parent_face[f] == cut_face)
      return static_cast<int>(f);
  return -1;
}

// The two faces of a cut that the disc reaches.
std::optional<std::pair<int, int>> reaching(const Disc& disc, const Vec3& normal, const Cut& halves) {
  if (!halves.below || !halves.above)
    return std::nullopt;
  const int lower = cut_face_of(*halves.below), upper = cut_face_of(*halves.above);
  if (lower < 0 || upper < 0 || !reaches(disc, normal, halves.below->shape, halves.below->shape.faces[lower]))
    return std::nullopt;
  return std::pair(lower, upper);
}

void cut_all(std::vector<Polyhedron>& blocks, const Disc& disc, std::size_t number,
             const std::optional<double>& clearance, MovedCuts& moved) {
  const Vec3 normal = normal_of_dip(disc.dip, disc.dip_direction);
  const Plane plane = Plane::through(disc.centre, normal);
  const std::size_t before = blocks.size();
  for (std::size_t b = 0; b < before; ++b) {
    const Box box = bounding_box(blocks[b]);
    if (!near(disc, normal, box))
      continue;
    const double clear = clearance.value_or(usual_clearance * box.size().norm());
    const Plane at = clear > 0 ? shifted_clear_of_vertices(blocks[b], plane, clear) : plane;
    const double shift = std::abs(at.offset - plane.offset);
    const bool crosses = shift > 0 && reaching(disc, normal, cut(blocks[b], plane)).has_value();
    Cut halves = cut(blocks[b], at);
    const auto faces = reaching(disc, normal, halves);
    if (shift > 0 && (faces || crosses)) { // moved, or on to a face that is there
      ++moved.count;
      moved.farthest = std::max(moved.farthest, shift);
    }
    if (!faces)
      continue;
    const auto [lower, upper] = *faces;
    halves.below->shape.faces[lower].cut = halves.above->shape.faces[upper].cut = marked(number);
    blocks[b] = std::move(halves.below->shape);
    blocks.push_back(std::move(halves.above->shape));
  }
}

void name_faces(Polyhedron& block, const std::vector<Disc>& discs) {
  for (int f = 0; f < static_cast<int>(block.faces.size()); ++f) {
    std::string& name = block.faces[f].cut;
    if (name.empty() || name[0] != mark)
      continue;
    const Disc& disc = discs[std::stoul(name.substr(1))];
    const bool joint = (face_centroid(block, f) - disc.centre).norm() <= disc.radius;
    name = joint ? disc.set : "";
  }
}

} // namespace

Assembly cut_by_discs(const Assembly& assembly, std::vector<Disc> discs, std::optional<double> clearance,
                      MovedCuts* moved) {
  if (clearance && !(*clearance >= 0 && std::isfinite(*clearance)))
    throw InputError("clearance", text(*clearance), "finite and >= 0 m");
  MovedCuts cuts;
  std::stable_sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.id < b.id; });
  for (std::size_t i = 0; i < discs.size(); ++i) {
    check(discs[i]);
    if (i > 0 && discs[i].id == discs[i - 1].id)
      throw InputError("disc " + std::to_string(discs[i].id) +
                       ": given twice; each disc has an id of its own");
  }
  Assembly result = assembly;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    throw_if_stopped();
    cut_all(result.blocks, discs[i], i, clearance, cuts);
    require_block_count("discs", std::to_string(discs.size()), static_cast<double>(result.blocks.size()),
                        "use fewer or smaller discs, or fewer blocks");
  }
  for (Polyhedron& block : result.blocks)
    name_faces(block, discs);
  if (moved != nullptr)
    *moved = cuts;
  return result;
}

} // namespace geom
