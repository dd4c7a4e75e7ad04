// The only place that sees gmsh, and through it OpenCASCADE. gmsh is one global thing per process that stays
// "busy" after an error: every operation therefore starts it, works and shuts it down, so that a failure
// leaves nothing behind. It throws std::string.
#include "libgeom/solid/solid.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/mesh/solid_mesh.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <sstream>
#include <unordered_map>

#include <unistd.h>

namespace geom {
namespace {

namespace occ = gmsh::model::occ;
using Pieces = gmsh::vectorpair; // (dimension, tag)

// Holds gmsh for one operation; what it or OpenCASCADE says on std::cout is dropped.
class Session {
public:
  Session() : lock_(mutex()), cout_(std::cout.rdbuf(nullptr)) {
    gmsh::initialize(0, nullptr, false);
    for (const auto& [name, value] : {std::pair<const char*, double>{"General.Terminal", 0},
                                      {"General.NumThreads", 1},
                                      {"Geometry.OCCParallel", 0},
                                      {"Geometry.OCCUnionUnify", 1}})
      gmsh::option::setNumber(name, value);
  }
  ~Session() {
    try {
      gmsh::finalize();
    } catch (...) { // nothing is left to be done about it
    }
    std::cout.rdbuf(cout_);
    std::cout.clear();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  std::streambuf* cout_;
};

// Runs body in a session; every failure of gmsh arrives as an InputError that says what was being done.
template <class Body>
auto in_session(const std::string& what, Body body) {
  try {
    const Session session;
    return body();
  } catch (const std::string& message) {
    throw InputError(what + ": the geometry kernel cannot do it: " + message);
  } catch (const std::exception&) {
    throw;
  } catch (...) { // OpenCASCADE's failures are no std::exception
    throw InputError(what + ": the geometry kernel cannot do it");
  }
}

class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& ending) {
    path_ = (std::filesystem::temp_directory_path() / ("cdem-XXXXXX" + ending)).string();
    const int file = mkstemps(path_.data(), static_cast<int>(ending.size()));
    if (file < 0)
      throw std::runtime_error("cannot write a temporary file " + path_);
    close(file);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

Pieces load(const Solid& solid) {
  const TemporaryFile file(".brep");
  std::ofstream(file.path()) << solid.brep();
  Pieces pieces;
  occ::importShapes(file.path(), pieces, true, "brep");
  return pieces;
}

// The model's volumes as a value.
Solid store(const std::string& what) {
  occ::synchronize();
  Pieces volumes;
  gmsh::model::getEntities(volumes, 3);
  if (volumes.empty())
    throw InputError(what + ": nothing is left");
  const TemporaryFile file(".brep");
  gmsh::write(file.path());
  std::ostringstream text;
  text << std::ifstream(file.path()).rdbuf();
  return {text.str(), static_cast<int>(volumes.size())};
}

void require_place(const std::string& field, const Vec3& x) {
  require_finite(field, x);
  if (!(x.cwiseAbs().maxCoeff() <= max_coordinate))
    throw InputError(field, text(x), "within 100 km of the origin");
}

void require_length(const std::string& field, double x) {
  if (!(x >= min_length && x <= max_coordinate))
    throw InputError(field, text(x), "from 0.1 mm to 100 km");
}

void require_some(const std::string& field, const std::vector<Solid>& solids, std::size_t least) {
  if (solids.size() < least)
    throw InputError(field, std::to_string(solids.size()) + " solids", "at least " + std::to_string(least));
}

Pieces load_all(const std::vector<Solid>& solids, std::size_t from) {
  Pieces all;
  for (std::size_t i = from; i < solids.size(); ++i) {
    const Pieces pieces = load(solids[i]);
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  return all;
}

} // namespace

Solid::Solid(std::string brep, int regions)
    : brep_(std::make_shared<const std::string>(std::move(brep))), regions_(regions) {}

Solid make_solid(const FacetedSurface& surface) {
  for (const Vec3& x : surface.vertices)
    require_place("vertices", x);
  return in_session("solid of flat faces", [&] {
    std::vector<int> points, faces;
    for (const Vec3& x : surface.vertices)
      points.push_back(occ::addPoint(x.x(), x.y(), x.z()));
    std::map<std::array<int, 2>, int> lines; // by ends, ascending: neighbouring faces share them
    for (const auto& loops : surface.faces) {
      std::vector<int> wires;
      for (const auto& loop : loops) {
        std::vector<int> curves;
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const int a = loop[i], b = loop[(i + 1) % loop.size()];
          const auto [line, added] = lines.try_emplace({std::min(a, b), std::max(a, b)}, 0);
          if (added)
            line->second = occ::addLine(points[line->first[0]], points[line->first[1]]);
          curves.push_back(line->second);
        }
        wires.push_back(occ::addCurveLoop(curves));
      }
      faces.push_back(occ::addPlaneSurface(wires));
    }
    occ::addVolume({occ::addSurfaceLoop(faces)});
    return store("solid of flat faces");
  });
}

Solid make_solid(const Polyhedron& polyhedron) {
  FacetedSurface surface;
  surface.vertices = polyhedron.vertices;
  for (const PolyhedronFace& face : polyhedron.faces)
    surface.faces.push_back({face.loop});
  return make_solid(surface);
}

Solid box(const Vec3& size, const Vec3& origin) {
  require_positive("size", size);
  require_length("size", size.minCoeff());
  require_place("origin", origin);
  require_place("size", size);
  return make_solid(make_box(origin, origin + size));
}

Solid cylinder(const Vec3& base, const Vec3& axis, double radius) {
  require_place("base", base);
  require_finite("axis", axis);
  require_length("axis (length)", axis.norm());
  require_length("radius", radius);
  return in_session("cylinder", [&] {
    occ::addCylinder(base.x(), base.y(), base.z(), axis.x(), axis.y(), axis.z(), radius);
    return store("cylinder");
  });
}

Solid cone(const Vec3& base, const Vec3& axis, double radius, double top) {
  if (radius == top && radius > 0) // OpenCASCADE has no such cone
    return cylinder(base, axis, radius);
  require_place("base", base);
  require_finite("axis", axis);
  require_length("axis (length)", axis.norm());
  if (radius != 0)
    require_length("radius", radius);
  if (top != 0)
    require_length("top_radius", top);
  return in_session("cone", [&] {
    occ::addCone(base.x(), base.y(), base.z(), axis.x(), axis.y(), axis.z(), radius, top);
    return store("cone");
  });
}

Solid sphere(const Vec3& centre, double radius) {
  require_place("centre", centre);
  require_length("radius", radius);
  return in_session("sphere", [&] {
    occ::addSphere(centre.x(), centre.y(), centre.z(), radius);
    return store("sphere");
  });
}

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

Solid read_step(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError("file", '"' + path + '"', "an existing STEP file");
  return in_session("reading " + path, [&] {
    gmsh::option::setString("Geometry.OCCTargetUnit", "M");
    Pieces pieces;
    occ::importShapes(path, pieces, true, "step");
    for (const auto& [dim, tag] : pieces)
      if (dim < 3)
        throw InputError("file", '"' + path + '"', "a STEP file with a solid",
                         "it has surfaces or curves only");
    return store("reading " + path);
  });
}

void write_step(const Solid& solid, const std::string& path) {
  in_session("writing " + path, [&] {
    gmsh::option::setNumber("Geometry.OCCScaling", 1000); // gmsh writes millimetres
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

namespace {

// The tets of gmsh's model, each volume a region, and the nodes they use in the order they are met.
TetMesh collect(const std::string& what) {
  constexpr int linear_tet = 4; // gmsh's number of the element
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, ignored;
  gmsh::model::mesh::getNodes(tags, coordinates, ignored, -1, -1, false, false);
  std::unordered_map<std::size_t, std::size_t> place; // by tag
  for (std::size_t i = 0; i < tags.size(); ++i)
    place[tags[i]] = i;

  TetMesh mesh;
  std::unordered_map<std::size_t, int> node_of; // by tag
  Pieces volumes;
  gmsh::model::getEntities(volumes, 3);
  int region = 0;
  for (const auto& [dim, tag] : volumes) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, corners;
    gmsh::model::mesh::getElements(types, elements, corners, dim, tag);
    for (std::size_t k = 0; k < types.size(); ++k) {
      if (types[k] != linear_tet)
        throw InputError(what +
                         ": has volume elements that are not tetrahedra with four nodes; mesh it with linear "
                         "tetrahedra");
      for (std::size_t t = 0; t < elements[k].size(); ++t) {
        Tet tet;
        for (std::size_t c = 0; c < 4; ++c) {
          const std::size_t corner = corners[k][4 * t + c];
          const auto at = place.find(corner);
          if (at == place.end())
            throw InputError(what + ": an element names node " + std::to_string(corner) +
                             ", which is not there");
          const auto [node, added] = node_of.try_emplace(corner, static_cast<int>(mesh.nodes.size()));
          if (added)
            mesh.nodes.emplace_back(Eigen::Map<const Vec3>(&coordinates[3 * at->second]));
          tet[c] = node->second;
        }
        mesh.tets.push_back(tet);
        mesh.region.push_back(region);
      }
    }
    if (mesh.region.empty() || mesh.region.back() != region)
      throw InputError(what + ": volume " + std::to_string(region + 1) + " has no tetrahedra");
    ++region;
  }
  return mesh;
}

} // namespace

TetMesh mesh_solid(const Solid& solid, const MeshSize& sizes) {
  validate(sizes);
  const double expected = expected_tets(sizes, bounding_box(solid), mass_properties(solid).volume);
  if (!(expected <= max_tets))
    throw InputError("size", text(sizes.size), "such that there are at most 20 million tetrahedra",
                     "this asks for about " + text(std::round(expected * 1e-6)) + " million");
  TetMesh mesh = in_session("mesh", [&] {
    // Delaunay (1), not HXT (10): HXT's mesh differs from run to run, even on one thread.
    for (const auto& [name, value] : {std::pair<const char*, double>{"Mesh.Algorithm", 6},
                                      {"Mesh.Algorithm3D", 1},
                                      {"Mesh.MaxNumThreads1D", 1},
                                      {"Mesh.MaxNumThreads2D", 1},
                                      {"Mesh.MaxNumThreads3D", 1},
                                      {"Mesh.Optimize", 1},
                                      {"Mesh.MeshSizeExtendFromBoundary", 0},
                                      {"Mesh.MeshSizeFromPoints", 0}})
      gmsh::option::setNumber(name, value);
    load(solid);
    occ::synchronize();
    gmsh::model::mesh::setSizeCallback([&](int, int, double x, double y, double z) {
      return size_at(sizes, {x, y, z});
    });
    // Surfaces are meshed in a parallel region, from which nothing can be thrown: errors are asked for after
    // it.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::logger::start();
    gmsh::model::mesh::generate(3);
    std::vector<std::string> log;
    gmsh::logger::get(log);
    gmsh::logger::stop();
    for (const std::string& line : log)
      if (line.compare(0, 6, "Error:") == 0)
        throw InputError("mesh: the solid cannot be meshed with this size:" + line.substr(6) +
                         "; try another size, and make sure that no faces nearly touch");
    return collect("mesh");
  });
  validate(mesh, "mesh");
  return mesh;
}

TetMesh read_mesh(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError("file", '"' + path + '"', "an existing mesh file");
  TetMesh mesh = in_session("reading " + path, [&] {
    gmsh::merge(path);
    return collect(path);
  });
  validate(mesh, path);
  return mesh;
}

} // namespace geom
