// Boolean operations, movements, measures and STEP files of solids, by OpenCASCADE through gmsh.
#include "libgeom/solid/gmsh_session.hpp"

#include "libgeom/core/check.hpp"

#include <gmsh.h>

#include <cmath>
#include <filesystem>

namespace geom {

namespace occ = gmsh::model::occ;

namespace {

void require_some(const std::string& field, const std::vector<Solid>& solids, std::size_t least) {
  if (solids.size() < least)
    throw InputError(field, std::to_string(solids.size()) + " solids", "at least " + std::to_string(least));
}

} // namespace

Solid::Solid(std::string brep, int regions)
    : brep_(std::make_shared<const std::string>(std::move(brep))), regions_(regions) {}

Solid united(const std::vector<Solid>& solids) {
  require_some("solids", solids, 1);
  if (solids.size() == 1)
    return solids.front();
  return in_session("union", [&] {
    Pieces out;
    std::vector<Pieces> map;
    occ::fuse(load(solids.front()), load_all(solids, 1), out, map);
    return store("union");
  });
}

Solid cut(const Solid& solid, const std::vector<Solid>& tools) {
  require_some("tools", tools, 1);
  return in_session("cut", [&] {
    Pieces out;
    std::vector<Pieces> map;
    occ::cut(load(solid), load_all(tools, 0), out, map);
    return store("cut");
  });
}

Solid common(const Solid& a, const Solid& b) {
  return in_session("common part", [&] {
    Pieces out;
    std::vector<Pieces> map;
    occ::intersect(load(a), load(b), out, map);
    return store("common part");
  });
}

Solid fragments(const std::vector<Solid>& solids) {
  require_some("solids", solids, 2);
  return in_session("fragments", [&] {
    Pieces out;
    std::vector<Pieces> map;
    const Pieces objects = load(solids.front()), tools = load_all(solids, 1); // never one list for both
    occ::fragment(objects, tools, out, map);
    return store("fragments");
  });
}

Solid translated(const Solid& solid, const Vec3& shift) {
  require_place("shift", shift);
  return in_session("translate", [&] {
    occ::translate(load(solid), shift.x(), shift.y(), shift.z());
    return store("translate");
  });
}

Solid rotated(const Solid& solid, const Vec3& axis, double angle, const Vec3& centre) {
  require_finite("axis", axis);
  require_place("centre", centre);
  if (!(axis.norm() > 0))
    throw InputError("axis", text(axis), "longer than zero");
  if (!std::isfinite(angle))
    throw InputError("angle", text(angle), "a finite number");
  return in_session("rotate", [&] {
    occ::rotate(load(solid), centre.x(), centre.y(), centre.z(), axis.x(), axis.y(), axis.z(), angle);
    return store("rotate");
  });
}

Solid scaled(const Solid& solid, double factor, const Vec3& centre) {
  require_place("centre", centre);
  require_between("factor", factor, 1e-6, 1e6);
  return in_session("scale", [&] {
    // Scaling on import keeps planes planes and cones cones; gmsh's dilate would turn them into splines.
    gmsh::option::setNumber("Geometry.OCCScaling", factor);
    const Pieces pieces = load(solid);
    const Vec3 shift = (1 - factor) * centre;
    occ::translate(pieces, shift.x(), shift.y(), shift.z());
    return store("scale");
  });
}

std::vector<double> region_volumes(const Solid& solid) {
  return in_session("volume", [&] {
    std::vector<double> volumes;
    for (const auto& [dim, tag] : load(solid)) {
      volumes.push_back(0);
      occ::getMass(dim, tag, volumes.back());
    }
    return volumes;
  });
}

MassProperties mass_properties(const Solid& solid) {
  return in_session("mass properties", [&] {
    std::vector<MassProperties> parts;
    MassProperties all;
    for (const auto& [dim, tag] : load(solid)) {
      MassProperties part;
      occ::getMass(dim, tag, part.volume);
      occ::getCenterOfMass(dim, tag, part.centroid.x(), part.centroid.y(), part.centroid.z());
      std::vector<double> rows;
      occ::getMatrixOfInertia(dim, tag, rows);
      part.inertia = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
      all.volume += part.volume;
      all.centroid += part.volume * part.centroid;
      parts.push_back(part);
    }
    all.centroid /= all.volume;
    for (const MassProperties& part : parts) { // Steiner
      const Vec3 d = part.centroid - all.centroid;
      all.inertia += part.inertia + part.volume * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
    return all;
  });
}

Box bounding_box(const Solid& solid) {
  return in_session("box", [&] {
    const auto box_of = [](int dim, int tag) {
      Vec3 low, high;
      occ::getBoundingBox(dim, tag, low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
      Box box;
      box.extend(low);
      box.extend(high);
      return box;
    };
    Box all;
    const Pieces pieces = load(solid);
    for (const auto& [dim, tag] : pieces) {
      const Box box = box_of(dim, tag);
      all.extend(box.min);
      all.extend(box.max);
    }
    // OpenCASCADE widens every box by its tolerance; that of a corner is nothing else.
    occ::synchronize();
    Pieces corners;
    gmsh::model::getEntities(corners, 0);
    if (!corners.empty()) {
      const Vec3 margin = 0.5 * box_of(0, corners.front().second).size();
      all.min += margin;
      all.max -= margin;
    }
    return all;
  });
}

namespace {

// A solid that can be read again and measured: what the file makes crash crashes here, where the message names it.
Solid tried(Solid solid) {
  gmsh::clear();
  for (const auto& [dim, tag] : load(solid)) {
    double volume = 0;
    occ::getMass(dim, tag, volume);
    if (!(std::isfinite(volume) && volume > 0))
      throw std::string("a volume of it is " + text(volume) + " m3");
  }
  return solid;
}

} // namespace

Solid read_step(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError("file", '"' + path + '"', "an existing STEP file");
  return in_session("reading " + path, limits_of_file(path), [&] {
    gmsh::option::setString("Geometry.OCCTargetUnit", "M");
    Pieces pieces;
    with_copy(path, ".step", [&](const std::string& copy) { occ::importShapes(copy, pieces, true, "step"); });
    for (const auto& [dim, tag] : pieces)
      if (dim < 3)
        throw InputError("file", '"' + path + '"', "a STEP file with a solid",
                         "it has surfaces or curves only");
    return tried(store("reading " + path));
  });
}

void write_step(const Solid& solid, const std::string& path) {
  in_session("writing " + path, [&] {
    // gmsh writes millimetres; OpenCASCADE keeps the unit of what was read before.
    gmsh::option::setNumber("Geometry.OCCScaling", 1000);
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
    load(solid);
    occ::synchronize();
    const TemporaryFile file(".step");
    gmsh::write(file.path());
    std::error_code failed;
    std::filesystem::copy_file(file.path(), path, std::filesystem::copy_options::overwrite_existing, failed);
    if (failed)
      throw std::runtime_error("cannot write " + path + ": " + failed.message());
    return 0;
  });
}

} // namespace geom
