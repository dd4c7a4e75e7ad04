#include "libgeom/assembly/edit.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/rotation.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geom {

namespace {

// What is left of the block between the box's six planes has a volume.
bool reaches_into(const Polyhedron& block, const Box& box) {
  const Box own = bounding_box(block);
  const double tolerance = 1e-6 * own.size().norm();
  if (((own.max - box.min).array() <= tolerance).any() || ((box.max - own.min).array() <= tolerance).any())
    return false;
  Polyhedron left = block;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      const Vec3 outward = side * Vec3::Unit(axis);
      Cut halves = cut(left, Plane::through(side > 0 ? box.max : box.min, outward));
      if (!halves.below)
        return false;
      left = std::move(halves.below->shape);
    }
  return true;
}

// m; vertices nearer to a plane than this part of the smallest block lie on it, so that no block is left that is thinner.
double cut_tolerance(const Assembly& assembly) {
  constexpr double part = 1e-9;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Polyhedron& block : assembly.blocks)
    smallest = std::min(smallest, bounding_box(block).size().norm());
  return part * smallest;
}

void mark_cut_face(Part& part, const PlaneCutOptions& options, bool named) {
  for (std::size_t f = 0; f < part.shape.faces.size(); ++f)
    if (part.parent_face[f] == cut_face) {
      part.shape.faces[f].cut = named ? options.name : "";
      part.shape.faces[f].glued = options.glued;
    }
}

} // namespace

Assembly cut_by_plane(Assembly assembly, const Plane& given, const PlaneCutOptions& options) {
  const double length = given.normal.norm();
  if (!(std::isfinite(length) && length > 0))
    throw InputError("normal", text(given.normal), "three finite numbers, not all zero");
  if (!std::isfinite(given.offset))
    throw InputError("offset", text(given.offset), "a finite number (m)");
  if (!(options.clearance >= 0 && std::isfinite(options.clearance)))
    throw InputError("clearance", text(options.clearance), "finite and >= 0 m");
  const Plane plane{given.normal / length, given.offset / length};

  const double tolerance = cut_tolerance(assembly);
  Assembly result;
  result.blocks.reserve(assembly.blocks.size());
  for (std::size_t b = 0; b < assembly.blocks.size(); ++b) {
    Polyhedron& block = assembly.blocks[b];
    const Box box = bounding_box(block);
    const double reach = 0.5 * plane.normal.cwiseAbs().dot(box.size()) + options.clearance;
    const bool near = std::abs(plane.level(box.centre())) <= reach;
    if (!near || (options.inside && !options.inside->contains(mass_properties(block).centroid)) ||
        (options.crossing && !reaches_into(block, *options.crossing))) {
      result.blocks.push_back(std::move(block));
      continue;
    }
    Cut halves = options.clearance > 0
                     ? cut(block, shifted_clear_of_vertices(block, plane, options.clearance))
                     : cut(block, plane, tolerance);
    const bool named = !options.named || options.named(b);
    for (std::optional<Part>* part : {&halves.below, &halves.above}) {
      if (!*part)
        continue;
      mark_cut_face(**part, options, named);
      result.blocks.push_back(std::move((*part)->shape));
    }
  }
  return result;
}

Assembly kept(Assembly assembly, const Box& inside) {
  Assembly result;
  for (Polyhedron& block : assembly.blocks)
    if (inside.contains(mass_properties(block).centroid))
      result.blocks.push_back(std::move(block));
  if (result.blocks.empty())
    throw InputError("inside", text(inside.min) + " to " + text(inside.max),
                     "a box that holds a block's centroid");
  return result;
}

Assembly translated(Assembly assembly, const Vec3& shift) {
  require_finite("shift", shift);
  for (Polyhedron& block : assembly.blocks)
    for (Vec3& x : block.vertices)
      x += shift;
  return assembly;
}

Assembly rotated(Assembly assembly, const Vec3& axis, double angle, const Vec3& centre) {
  if (!(axis.allFinite() && axis.norm() > 0))
    throw InputError("axis", text(axis), "three finite numbers, not all zero");
  if (!std::isfinite(angle))
    throw InputError("angle", text(angle), "a finite number");
  require_finite("centre", centre);
  const Mat3 q = rotation_about(axis.normalized(), angle).toRotationMatrix();
  for (Polyhedron& block : assembly.blocks)
    for (Vec3& x : block.vertices)
      x = centre + q * (x - centre);
  return assembly;
}

Assembly merged(const std::vector<Assembly>& assemblies) {
  Assembly result;
  for (const Assembly& assembly : assemblies)
    result.blocks.insert(result.blocks.end(), assembly.blocks.begin(), assembly.blocks.end());
  return result;
}

} // namespace geom
